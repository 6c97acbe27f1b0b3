// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/deterministic_cases.h"

#include <benchmark/benchmark.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/bullet/deformable_body.h>
#include <tetskin/bullet/deformable_world.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/surface_contact.h>

#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "scenes/caged_mesh.h"
#include "scenes/input_error.h"
#include "scenes/serpent.h"
#include "scenes/world.h"

namespace tetskin::bench {
namespace {

using benchmark::State;

/// Bodies, which hang if there is one, and otherwise lie on each other and a floor.
class Bodies {
 public:
  Bodies(std::size_t count, std::size_t tets, bool deterministic) : world_(options(deterministic)) {
    const scenes::CagedMesh serpent = scenes::inWorld(scenes::makeSerpent(), tets);
    const auto binding = scenes::boundTo(serpent.cage, serpent.mesh);
    SoftBodyOptions body = scenes::oneKilogram();
    if (count == 1) {
      const double end = boundingBox(serpent.cage.mesh.nodes).max().x();
      body.pinned = [end](const Eigen::Vector3d& p) { return p.x() > end - 0.2; };
      bodies_.push_back(DeformableBody::add(world_, serpent.cage, body).value());
      return;
    }
    world_.addRigidBody(&floor_);
    const auto shape = ContactShape::create(serpent.cage, serpent.mesh, {}).value();
    meetings_ = SoftContacts::add(world_).value();
    for (std::size_t k = 0; k < count; ++k) {
      Cage placed = serpent.cage;
      const auto step = static_cast<double>(k);
      for (Eigen::Vector3d& p : placed.mesh.nodes) p += Eigen::Vector3d(0.1 * step, 0.8 * step, 0.05 * step);
      bodies_.push_back(DeformableBody::add(world_, placed, body).value());
      contacts_.push_back(SurfaceContact::add(world_, bodies_.back()->body(), *binding, serpent.mesh).value());
      scenes::require(meetings_->add(bodies_.back()->body(), shape));
    }
  }
  ~Bodies() {
    if (floor_.isInWorld()) world_.removeRigidBody(&floor_);
  }
  Bodies(const Bodies&) = delete;
  Bodies& operator=(const Bodies&) = delete;

  DeformableWorld& world() { return world_; }
  void frame() { world_.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240); }

 private:
  static DeformableWorldOptions options(bool deterministic) {
    DeformableWorldOptions options;
    options.deterministic = deterministic;
    return options;
  }

  btStaticPlaneShape plane_{btVector3(0, 1, 0), btScalar(-1)};
  btRigidBody floor_{btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane_)};
  DeformableWorld world_;
  std::vector<std::unique_ptr<DeformableBody>> bodies_;
  std::vector<std::unique_ptr<SurfaceContact>> contacts_;
  std::unique_ptr<SoftContacts> meetings_;
};

/// The same twenty frames again and again.
void frames(State& state, std::size_t count, std::size_t tets, bool deterministic) {
  constexpr int kBefore = 40, kTimed = 20;
  Bodies bodies(count, tets, deterministic);
  for (int frame = 0; frame < kBefore; ++frame) bodies.frame();
  std::vector<unsigned char> start(bodies.world().save(nullptr, 0).value());
  scenes::require(bodies.world().save(start.data(), start.size()).status());
  for (auto _ : state) {
    state.PauseTiming();
    scenes::require(bodies.world().restore(start.data(), start.size()));
    state.ResumeTiming();
    for (int frame = 0; frame < kTimed; ++frame) bodies.frame();
  }
}

}  // namespace

void registerDeterministicCases() {
  for (const auto& [name, count, tets] : {std::tuple<std::string, std::size_t, std::size_t>("body", 1, 3000),
                                          std::tuple<std::string, std::size_t, std::size_t>("contact", 4, 900)}) {
    for (const bool on : {false, true}) {
      benchmark::RegisterBenchmark(("Deterministic/" + name + (on ? "/on" : "/off")).c_str(), frames, count, tets, on)
          ->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace tetskin::bench
