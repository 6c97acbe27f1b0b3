// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/contact_cases.h"

#include <BulletSoftBody/btSoftBody.h>
#include <benchmark/benchmark.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/cage/cage_builder.h>

#include <cmath>
#include <ctime>
#include <functional>
#include <memory>
#include <string>

#include "scenes/placement.h"
#include "scenes/serpent.h"
#include "scenes/world.h"

namespace tetskin::bench {
namespace {

using benchmark::State;
using scenes::Contact;

constexpr std::size_t kContactTets = 1000;
constexpr int kSubsteps = 4;
/// A landing, and rest.
constexpr int kContactFrames = 180;

/// Processor time spent with pairs of bodies.
std::clock_t inPairs = 0;

void timedNearCallback(btBroadphasePair& pair, btCollisionDispatcher& dispatcher, const btDispatcherInfo& info) {
  const std::clock_t begin = std::clock();
  btCollisionDispatcher::defaultNearCallback(pair, dispatcher, info);
  inPairs += std::clock() - begin;
}

/// What a body falls on, its top at the origin, or what it hangs around.
struct ContactObstacle {
  std::unique_ptr<btTriangleMesh> triangles;
  std::unique_ptr<btCollisionShape> shape;
  btVector3 centre{0, 0, 0};
};

ContactObstacle ground() {
  return {nullptr, std::make_unique<btBoxShape>(btVector3(10, 1, 10)), btVector3(0, -1, 0)};
}
ContactObstacle sphere() {
  return {nullptr, std::make_unique<btSphereShape>(btScalar(1.2)), btVector3(0, btScalar(-1.2), 0)};
}
ContactObstacle hull() {
  auto shape = std::make_unique<btConvexHullShape>();
  constexpr int kRings = 12;
  for (int i = 0; i <= kRings; ++i) {
    for (int j = 0; j < 2 * kRings; ++j) {
      const double theta = EIGEN_PI * i / kRings, phi = EIGEN_PI * j / kRings;
      shape->addPoint(toBullet({1.5 * std::sin(theta) * std::cos(phi), 0.8 * std::cos(theta),
                                1.5 * std::sin(theta) * std::sin(phi)}),
                      false);
    }
  }
  shape->recalcLocalAabb();
  return {nullptr, std::move(shape), btVector3(0, btScalar(-0.8), 0)};
}
/// A hilly square of 1,152 triangles.
ContactObstacle hills() {
  auto triangles = std::make_unique<btTriangleMesh>();
  constexpr int kCells = 24;
  const auto corner = [](int i, int j) {
    const double x = 0.25 * (i - kCells / 2), z = 0.25 * (j - kCells / 2);
    return toBullet({x, 0.12 * std::sin(2 * x) * std::cos(2 * z), z});
  };
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      triangles->addTriangle(corner(i, j), corner(i, j + 1), corner(i + 1, j));
      triangles->addTriangle(corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1));
    }
  }
  auto shape = std::make_unique<btBvhTriangleMeshShape>(triangles.get(), true);
  return {std::move(triangles), std::move(shape), btVector3(0, 0, 0)};
}
/// In the body's box, but not near its surface.
ContactObstacle apart() {
  return {nullptr, std::make_unique<btSphereShape>(btScalar(0.05)), btVector3(btScalar(0.6), 1, 0)};
}

/// A serpent on an obstacle, and what contact costs.
class ContactRun {
 public:
  ContactRun(const Cage& cage, const TriangleMesh& mesh, ContactObstacle obstacle, Contact how, bool falls)
      : obstacle_(std::move(obstacle)), world_(scenes::Force::Elastic, btVector3(0, falls ? btScalar(-9.81) : 0, 0)) {
    rigid_ = std::make_unique<btRigidBody>(0, nullptr, obstacle_.shape.get());
    const btTransform at(btQuaternion::getIdentity(), obstacle_.centre);
    rigid_->setWorldTransform(at);
    rigid_->setInterpolationWorldTransform(at);
    world_.bullet().addRigidBody(rigid_.get());
    btSoftBody& body = world_.add(cage, scenes::oneKilogram());
    body.setActivationState(DISABLE_DEACTIVATION);
    const auto binding = SoftBodyBinding::make(cage, mesh).value();
    if (how == Contact::Surface) world_.touchBySurface(body, *binding, mesh);
    static_cast<btCollisionDispatcher*>(world_.bullet().getDispatcher())->setNearCallback(timedNearCallback);
  }
  ~ContactRun() { world_.bullet().removeRigidBody(rigid_.get()); }
  ContactRun(const ContactRun&) = delete;
  ContactRun& operator=(const ContactRun&) = delete;

  /// Seconds a substep, of one frame.
  double step() {
    inPairs = 0;
    for (int k = 0; k < kSubsteps; ++k) world_.step(1.0 / (60 * kSubsteps));
    return static_cast<double>(inPairs) / CLOCKS_PER_SEC / kSubsteps;
  }

 private:
  ContactObstacle obstacle_;
  std::unique_ptr<btRigidBody> rigid_;
  scenes::World world_;
};

void findContacts(State& state, const std::function<ContactObstacle()>& obstacle, Contact how, bool falls) {
  CageOptions options;
  options.targetTets = kContactTets;
  TriangleMesh mesh = scenes::makeSerpent();
  Cage cage = buildCage(mesh, options).value();
  const double scale = scenes::kSize / boundingBox(cage.nodes).sizes().maxCoeff();
  const double lift = falls ? 0.2 - scale * boundingBox(mesh.positions).min().y() : 0.0;
  for (auto* points : {&cage.nodes, &mesh.positions}) {
    for (Eigen::Vector3d& p : *points) p = scale * p + lift * Eigen::Vector3d::UnitY();
  }
  std::unique_ptr<ContactRun> run;
  int frame = kContactFrames;
  for (auto _ : state) {
    if (frame == kContactFrames) {
      run = std::make_unique<ContactRun>(cage, mesh, obstacle(), how, falls);
      frame = 0;
    }
    state.SetIterationTime(run->step());
    ++frame;
  }
  state.counters["tets"] = static_cast<double>(cage.tetCount());
  state.counters["triangles"] = static_cast<double>(mesh.triangleCount());
}

}  // namespace

void registerContactCases() {
  struct Case {
    const char* name;
    ContactObstacle (*obstacle)();
    bool falls;
  };
  const Case cases[] = {{"box", ground, true},
                        {"sphere", sphere, true},
                        {"hull", hull, true},
                        {"mesh", hills, true},
                        {"apart", apart, false}};
  for (const Case& made : cases) {
    for (const Contact how : {Contact::Surface, Contact::Cage}) {
      const std::string name = std::string("Contact/") + made.name + (how == Contact::Cage ? "/cage" : "/surface");
      benchmark::RegisterBenchmark(name.c_str(),
                                   [made, how](State& state) { findContacts(state, made.obstacle, how, made.falls); })
          ->UseManualTime()
          ->Iterations(kContactFrames)
          ->Unit(benchmark::kMicrosecond);
    }
  }
}

}  // namespace tetskin::bench
