// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/snapshot_cases.h"

#include <benchmark/benchmark.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/replay/snapshot.h>
#include <tetskin/solver/deformable_world.h>

#include <memory>
#include <string>
#include <vector>

#include "scenes/caged_mesh.h"
#include "scenes/input_error.h"
#include "scenes/serpent.h"
#include "scenes/world.h"

namespace tetskin::bench {
namespace {

using benchmark::State;

/// Bodies that fall onto each other and the floor, with contact at their surfaces.
std::unique_ptr<scenes::World> fallen(std::size_t bodies, std::size_t tets) {
  const scenes::CagedMesh serpent = scenes::inWorld(scenes::makeSerpent(), tets);
  auto world = std::make_unique<scenes::World>(scenes::Force::Elastic, btVector3(0, btScalar(-scenes::kEarth), 0));
  world->addBox({0, -2.0, 0}, {10, 1, 10});
  std::shared_ptr<const ContactShape> shape;
  if (bodies > 1) shape = ContactShape::create(serpent.cage, serpent.mesh, {}).value();
  const auto binding = SoftBodyBinding::create(serpent.cage, serpent.mesh).value();
  for (std::size_t k = 0; k < bodies; ++k) {
    Cage placed = serpent.cage;
    for (Eigen::Vector3d& p : placed.mesh.nodes) {
      p += Eigen::Vector3d(0.3 * static_cast<double>(k % 2), 0.8 * static_cast<double>(k),
                           0.2 * static_cast<double>(k % 3));
    }
    btSoftBody& body = world->add(placed, scenes::oneKilogram());
    world->touchBySurface(body, *binding, serpent.mesh);
    if (shape) world->touchEachOther(body, shape);
  }
  for (int step = 0; step < 300; ++step) world->step(1.0 / 240.0);
  return world;
}

std::vector<unsigned char> saved(const btDeformableMultiBodyDynamicsWorld& world) {
  std::vector<unsigned char> bytes(saveSnapshot(world, nullptr, 0).value());
  scenes::require(saveSnapshot(world, bytes.data(), bytes.size()).status());
  return bytes;
}

void save(State& state, std::size_t bodies, std::size_t tets) {
  const auto world = fallen(bodies, tets);
  std::vector<unsigned char> bytes = saved(*world->deformableWorld());
  for (auto _ : state)
    benchmark::DoNotOptimize(saveSnapshot(*world->deformableWorld(), bytes.data(), bytes.size()).ok());
  state.counters["bytes"] = static_cast<double>(bytes.size());
}

/// Goes back by 8 steps, which are made untimed.
void restore(State& state, std::size_t bodies, std::size_t tets) {
  const auto world = fallen(bodies, tets);
  const std::vector<unsigned char> bytes = saved(*world->deformableWorld());
  for (auto _ : state) {
    state.PauseTiming();
    for (int step = 0; step < 8; ++step) world->step(1.0 / 240.0);
    state.ResumeTiming();
    scenes::require(restoreSnapshot(*world->deformableWorld(), bytes.data(), bytes.size()));
  }
  state.counters["bytes"] = static_cast<double>(bytes.size());
}

}  // namespace

void registerSnapshotCases() {
  const auto add = [](const std::string& name, auto* measured, std::size_t bodies, std::size_t tets) {
    benchmark::RegisterBenchmark(name.c_str(), measured, bodies, tets)->Unit(benchmark::kMicrosecond);
  };
  for (const auto& [name, bodies, tets] : {std::tuple<std::string, std::size_t, std::size_t>("body", 1, 3000),
                                           std::tuple<std::string, std::size_t, std::size_t>("heap", 8, 900)}) {
    add("Snapshot/" + name + "/save", save, bodies, tets);
    add("Snapshot/" + name + "/restore", restore, bodies, tets);
  }
}

}  // namespace tetskin::bench
