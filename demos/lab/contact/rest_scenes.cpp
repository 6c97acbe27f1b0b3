// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies at rest on a floor, and bodies that begin deep inside one.
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <memory>

#include "contact/scene_list.h"
#include "measure/extremes.h"
#include "measure/measuring_world.h"
#include "measure/obstacles.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Vector3d;

/// Reports whether the floor pushes back as strongly as gravity pulls, where contacts report impulses.
class Weighing {
 public:
  Weighing(const SoftObject& body) : body_(body), perStep_(body.motion().mass * scenes::kEarth * kStep) {}

  void step() {
    const auto impulse = body_.contactImpulse();
    if (!impulse) return;
    push_ += impulse->y();
    ++steps_;
  }
  void report(Run& run) const {
    if (steps_ > 0) run.report("push over weight", push_ / (steps_ * perStep_));
  }

 private:
  const SoftObject& body_;
  double perStep_, push_ = 0.0;
  int steps_ = 0;
};

void rest(Run& run, const ModelPtr& model, const BodyOptions& options) {
  MeasuringWorld world(run);
  world.addFloor();
  SoftObject& body = world.addSoftOn(0.0, model, options);
  world.simulate(4);
  const long iterations = run.iterations, steps = run.steps;
  Weighing weighing(body);
  double gap = 0.0, fastest = 0.0;
  world.simulate(1, [&] {
    raiseMagnitude(gap, body.floorGap() - kMargin * model->size);
    raise(fastest, body.fastest());
    weighing.step();
  });
  run.report("gap, S", gap / model->size);
  run.report("fastest node, m/s", fastest);
  weighing.report(run);
  run.report("iterations per step", static_cast<double>(run.iterations - iterations) / (run.steps - steps));
}

/// A ball between two slopes of 45 degrees.
void restInV(Run& run, double stiffness) {
  MeasuringWorld world(run);
  for (const double side : {-1.0, 1.0}) {
    const btQuaternion turn(btVector3(0, 0, 1), static_cast<btScalar>(side * EIGEN_PI / 4));
    world.addRigid(std::make_unique<btBoxShape>(btVector3(2, btScalar(0.5), 2)),
                   btTransform(turn, quatRotate(turn, btVector3(0, btScalar(-0.5), 0))));
  }
  SoftObject& body =
      world.addSoft(makeBall(), BodyOptions{stiffness}, Vector3d(0, std::sqrt(2.0) * (0.5 + kMargin), 0));
  world.simulate(4);
  Weighing weighing(body);
  double fastest = 0.0;
  world.simulate(1, [&] {
    raise(fastest, body.fastest());
    weighing.step();
  });
  run.report("fastest node, m/s", fastest);
  weighing.report(run);
}

/// A flat floor, its upper side at y = 0.
void addFlatFloor(btTriangleMesh& mesh) {
  constexpr int kHalf = 8;
  constexpr btScalar kEdge = btScalar(0.5);
  const auto corner = [&](int x, int z) { return btVector3(x * kEdge, 0, z * kEdge); };
  for (int x = -kHalf; x < kHalf; ++x) {
    for (int z = -kHalf; z < kHalf; ++z) {
      mesh.addTriangle(corner(x, z), corner(x, z + 1), corner(x + 1, z + 1));
      mesh.addTriangle(corner(x, z), corner(x + 1, z + 1), corner(x + 1, z));
    }
  }
}

/// A ball that begins this deep in the floor.
void deep(Run& run, double stiffness, double depth, bool inMesh) {
  MeasuringWorld world(run);
  if (inMesh) {
    world.addRigid(std::make_unique<TriangleShape>(addFlatFloor), btTransform::getIdentity());
  } else {
    world.addFloor();
  }
  SoftObject& body = world.addSoft(makeBall(), BodyOptions{stiffness}, Vector3d(0, 0.5 - depth, 0));
  double fastest = 0.0;
  world.simulate(3, [&] { raise(fastest, body.fastest()); });
  run.report("fastest node, S/s", fastest);
  run.report("gap at the end, S", body.floorGap() - kMargin);
}

}  // namespace

void addRestScenes(ContactScenes& scenes) {
  const auto add = [&](const std::string& name, const BodyOptions& options) {
    scenes.push_back({"rest/ball/" + name, [=](Run& run) { rest(run, makeBall(), options); }});
    scenes.push_back({"rest/box/" + name, [=](Run& run) { rest(run, makeBox({0.5, 0.25, 0.5}), options); }});
  };
  for (const double k : {50.0, 500.0, 5000.0}) add("k" + text(k), BodyOptions{k});
  for (const double k : {50.0, 500.0}) {
    scenes.push_back({"rest/ball in a V/k" + text(k), [=](Run& run) { restInV(run, k); }});
  }
  BodyOptions stiff;
  stiff.youngsModulus = 1e9;
  add("1e9Pa", stiff);
  for (const double k : {50.0, 500.0}) {
    const std::string end = "/k" + text(k);
    for (const double depth : {0.3, 0.6}) {
      scenes.push_back({"deep/" + text(depth) + "S in a box" + end, [=](Run& run) { deep(run, k, depth, false); }});
    }
    scenes.push_back({"deep/0.1S in a mesh" + end, [=](Run& run) { deep(run, k, 0.1, true); }});
  }
}

}  // namespace tetskin::contact_demo
