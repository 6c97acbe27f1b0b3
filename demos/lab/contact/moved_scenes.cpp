// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Kinematic plates that the scene moves, and thin plates.
#include <btBulletDynamicsCommon.h>

#include <cmath>

#include "contact/scene_list.h"
#include "measure/extremes.h"
#include "measure/measuring_world.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Vector3d;

/// A plate that moves along one axis.
class MovedPlate {
 public:
  MovedPlate(MeasuringWorld& world, const Vector3d& centre, const Vector3d& halfExtents, const Vector3d& direction)
      : body_(MeasuringWorld::makeKinematic(world.addBox(centre, halfExtents))),
        centre_(centre),
        half_(halfExtents.cwiseProduct(direction).norm()),
        direction_(direction) {}

  /// Moves the plate by the distance that it covers in the next step.
  void advance(double distance) {
    centre_ += distance * direction_;
    body_.setWorldTransform(btTransform(btQuaternion::getIdentity(), toBullet(centre_)));
  }
  /// Distance from the side that faces the motion.
  double distance(const Vector3d& p) const { return (p - centre_).dot(direction_) - half_; }

 private:
  btRigidBody& body_;
  Vector3d centre_;
  double half_;
  Vector3d direction_;
};

const Vector3d kPlateHalf(1.5, 0.2, 1.5), kPlateCentre(0, -0.2, 0);

/// A plate moves up under a ball, and throws it.
void kick(Run& run, double stiffness, double speed) {
  MeasuringWorld world(run);
  MovedPlate plate(world, kPlateCentre, kPlateHalf, Vector3d::UnitY());
  SoftObject& ball = world.addSoftOn(0.0, makeBall(), BodyOptions{stiffness});
  double gap = HUGE_VAL;
  for (int k = 0; k < 36; ++k) {
    plate.advance(speed * kStep);
    world.step();
    lower(gap, ball.gap([&](const Vector3d& p) { return plate.distance(p); }));
  }
  run.report("least gap, S", gap);
}

/// A plate lifts a box; measures the gap during the steady part.
void carry(Run& run, double stiffness) {
  constexpr double kSpeed = 1.0;
  MeasuringWorld world(run);
  MovedPlate plate(world, kPlateCentre, kPlateHalf, Vector3d::UnitY());
  SoftObject& box = world.addSoftOn(0.0, makeBox({0.5, 0.25, 0.5}), BodyOptions{stiffness});
  double gap = 0.0;
  for (int k = 0; k < 480; ++k) {
    plate.advance(kSpeed * kStep);
    world.step();
    gap = box.gap([&](const Vector3d& p) { return plate.distance(p); });
  }
  run.report("gap, S", gap - kMargin);
}

/// Two plates squeeze a cube by a tenth of its width, and hold it by friction.
void grip(Run& run, double stiffness) {
  constexpr double kSpeed = 0.25, kPressed = 0.05;
  MeasuringWorld world(run);
  const Vector3d half(0.2, 1, 1);
  const double start = 0.5 + kMargin + half.x();
  MovedPlate left(world, {-start, 0, 0}, half, Vector3d::UnitX());
  MovedPlate right(world, {start, 0, 0}, half, -Vector3d::UnitX());
  SoftObject& cube = world.addSoft(makeBox({0.5, 0.5, 0.5}), BodyOptions{stiffness}, Vector3d(0, 0, 0));
  const auto simulate = [&](double seconds, double speed) {
    for (long k = 0; k < std::lround(seconds / kStep); ++k) {
      left.advance(speed * kStep);
      right.advance(speed * kStep);
      world.step();
    }
  };
  simulate(kPressed / kSpeed, kSpeed);
  simulate(1, 0);
  const double before = cube.motion().centroid.y();
  simulate(2, 0);
  run.report("sinks in 2 s, S", before - cube.motion().centroid.y());
}

/// A ball falls on a plate whose thickness is a fiftieth of the ball's size.
void fallOnThin(Run& run, double stiffness, double speed) {
  MeasuringWorld world(run);
  const double half = 0.01;
  world.addBox({0, -half, 0}, {2, half, 2});
  SoftObject& ball = world.addSoft(makeBall(), BodyOptions{stiffness}, Vector3d(0, 1, 0));
  ball.push(Vector3d(0, -speed, 0));
  double gap = HUGE_VAL;
  world.simulate(0.5, [&] { lower(gap, ball.floorGap()); });
  run.report("least gap, S", gap);
}

}  // namespace

void addMovedScenes(ContactScenes& scenes) {
  for (const double k : {50.0, 500.0}) {
    const std::string end = "/k" + text(k);
    for (const double v : {2.0, 10.0}) {
      scenes.push_back({"moved plate/kicks at " + text(v) + end, [=](Run& run) { kick(run, k, v); }});
    }
    scenes.push_back({"moved plate/carries" + end, [=](Run& run) { carry(run, k); }});
    scenes.push_back({"gripped" + end, [=](Run& run) { grip(run, k); }});
    scenes.push_back({"thin plate/15" + end, [=](Run& run) { fallOnThin(run, k, 15); }});
  }
}

}  // namespace tetskin::contact_demo
