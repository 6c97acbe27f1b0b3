// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Landings, impacts, squeezing: no energy is gained, and no surface penetrates deeply.
#include <btBulletDynamicsCommon.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "contact/scene_list.h"
#include "measure/extremes.h"
#include "measure/measuring_world.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Vector3d;

/// Runs for half a second.
void reportEnergy(Run& run, MeasuringWorld& world, SoftObject& body, const Distance& distance) {
  const double start = world.energy();
  double maximum = 0.0, gap = HUGE_VAL;
  world.simulate(0.5, [&] {
    raise(maximum, world.energy());
    lower(gap, body.gap(distance));
  });
  run.report("energy over its start", maximum / start);
  run.report("least gap, S", gap);
}

double toFloor(const Vector3d& p) {
  return p.y();
}

void land(Run& run, const ModelPtr& model, const Eigen::Isometry3d& at, double stiffness, double speed) {
  MeasuringWorld world(run);
  world.addFloor();
  SoftObject& body = world.addSoft(model, BodyOptions{stiffness}, at);
  body.push(speed * Vector3d(0.3, -1, 0));
  reportEnergy(run, world, body, toFloor);
}

void landBall(Run& run, double stiffness, double speed) {
  land(run, makeBall(), Eigen::Isometry3d(Eigen::Translation3d(0, 0.56, 0)), stiffness, speed);
}

/// A box lands on a corner.
void landBox(Run& run, double stiffness, double speed) {
  const Eigen::AngleAxisd turn(0.4, Vector3d(1, 0, 0.5).normalized());
  land(run, makeBox({0.5, 0.25, 0.5}), Eigen::Translation3d(0, 0.62, 0) * Eigen::Isometry3d(turn), stiffness, speed);
}

/// A rigid ball falls on a soft one of 1 kg that lies on the floor.
void crush(Run& run, double stiffness, double mass, double speed) {
  constexpr double kRadius = 0.25;
  MeasuringWorld world(run);
  world.addFloor();
  SoftObject& body = world.addSoftOn(0.0, makeBall(), BodyOptions{stiffness});
  btRigidBody& ball = world.addSphere({0.1, 1.0 + kRadius + 0.02, 0}, kRadius, mass);
  ball.setLinearVelocity(btVector3(0, static_cast<btScalar>(-speed), 0));
  reportEnergy(run, world, body, [&](const Vector3d& p) {
    return std::min(p.y(), (p - toEigen(ball.getCenterOfMassPosition())).norm() - kRadius);
  });
}

/// Two kinematic plates close on a cube until it has half its width, and let go of it.
void squeeze(Run& run, double stiffness) {
  constexpr double kThickness = 0.2, kClosed = 0.25, kSpeed = 0.5, kSpeedBack = 5.0;
  MeasuringWorld world(run, Vector3d::Zero());
  SoftObject& body = world.addSoft(makeBox({0.5, 0.5, 0.5}), BodyOptions{stiffness}, Vector3d(0, 0, 0));
  const auto at = [&](int side, double inner) {
    return btTransform(btQuaternion::getIdentity(), toBullet(Vector3d(side * (inner + kThickness), 0, 0)));
  };
  double inner = 0.5 + 2.0 * kMargin, gap = HUGE_VAL;
  btRigidBody* plates[2];
  for (int k = 0; k < 2; ++k) {
    plates[k] = &world.makeKinematic(world.addBox(toEigen(at(2 * k - 1, inner).getOrigin()), {kThickness, 1, 1}));
  }
  const auto move = [&](double velocity) {
    inner += velocity * kStep;
    for (int k = 0; k < 2; ++k) plates[k]->setWorldTransform(at(2 * k - 1, inner));
    world.step();
    const bool opening = velocity > 0.0;
    if (!opening) lower(gap, body.gap([&](const Vector3d& p) { return inner - std::abs(p.x()); }));
  };
  while (inner > kClosed) move(-kSpeed);
  for (int k = 0; k < 24; ++k) move(0.0);
  const double stored = world.energy();
  double maximum = 0.0;
  for (int k = 0; k < 120; ++k) {
    move(kSpeedBack);
    raise(maximum, world.energy());
  }
  run.report("energy over its start", maximum / stored);
  run.report("least gap, S", gap);
}

}  // namespace

void addEnergyScenes(ContactScenes& scenes) {
  const auto add = [&](const std::string& name, const std::function<void(Run&)>& run) {
    // The energy stored in Bullet's material would need other formulas.
    scenes.push_back({"energy/" + name, run, {Kind::Surface, Kind::Nodes}});
  };
  for (const double k : {50.0, 500.0}) {
    const std::string end = "/k" + text(k);
    for (const double v : {2.0, 5.0, 10.0, 15.0}) {
      add("ball lands at " + text(v) + end, [=](Run& run) { landBall(run, k, v); });
      add("box lands at " + text(v) + end, [=](Run& run) { landBox(run, k, v); });
    }
    for (const double mass : {1.0, 10.0, 50.0}) {
      for (const double v : {2.0, 5.0, 10.0}) {
        add("crushed by " + text(mass) + "kg at " + text(v) + end, [=](Run& run) { crush(run, k, mass, v); });
      }
    }
    add("squeezed" + end, [=](Run& run) { squeeze(run, k); });
  }
}

}  // namespace tetskin::contact_demo
