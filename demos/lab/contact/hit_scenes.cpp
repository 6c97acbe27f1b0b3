// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Free bodies that collide: the total momentum stays the same.
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <btBulletDynamicsCommon.h>

#include <memory>

#include "contact/scene_list.h"
#include "measure/measuring_world.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Vector3d;

const Vector3d kWeightless = Vector3d::Zero();
const Vector3d kBallStart(-0.75, 0.3, 0.05), kBallVelocity(5, 0, 0);
constexpr double kBallRadius = 0.15;

/// Seconds until all colliding bodies have separated.
constexpr double kUntilParted = 0.5;

/// A zone that surrounds the whole scene.
enum class Zone { None, Trigger, Ghost };

void addZone(MeasuringWorld& world, Zone zone) {
  constexpr double kHalf = 5.0;
  if (zone == Zone::Trigger) world.addTrigger(kHalf);
  if (zone == Zone::Ghost) world.addGhost(kHalf);
}

/// Nothing collides: the accuracy of the figures themselves.
void miss(Run& run, double stiffness) {
  MeasuringWorld world(run, kWeightless);
  world.addSoft(makeBall(), BodyOptions{stiffness}, kWeightless).push(Vector3d(1, 2, 3), Vector3d(1, -2, 0.5));
  btRigidBody& ball = world.addSphere({-3, 3, 0}, kBallRadius, 1);
  ball.setLinearVelocity(toBullet(-kBallVelocity));
  ball.setAngularVelocity(btVector3(1, 2, 3));
  reportConserved(run, world, kUntilParted);
}

/// A rigid ball hits a soft one of 1 kg off its centre.
void hit(Run& run, double stiffness, double mass, Zone zone) {
  MeasuringWorld world(run, kWeightless);
  addZone(world, zone);
  world.addSoft(makeBall(), BodyOptions{stiffness}, kWeightless);
  world.addSphere(kBallStart, kBallRadius, mass).setLinearVelocity(toBullet(kBallVelocity));
  reportConserved(run, world, kUntilParted);
}

/// A multibody without links hits the soft ball.
void hitByMultiBody(Run& run, double stiffness) {
  MeasuringWorld world(run, kWeightless);
  world.addSoft(makeBall(), BodyOptions{stiffness}, kWeightless);
  constexpr btScalar kMass = 1;
  auto shape = std::make_unique<btSphereShape>(static_cast<btScalar>(kBallRadius));
  btVector3 inertia;
  shape->calculateLocalInertia(kMass, inertia);
  auto body = std::make_unique<btMultiBody>(0, kMass, inertia, false, false);
  body->finalizeMultiDof();  // allocates the velocities
  body->setBasePos(toBullet(kBallStart));
  body->setBaseVel(toBullet(kBallVelocity));
  body->setLinearDamping(0);
  body->setAngularDamping(0);
  world.addMultiBody(std::move(body), -1, std::move(shape));
  reportConserved(run, world, kUntilParted);
}

/// A soft ball falls on a box that lies on a heavy one; all are free.
void onBoxes(Run& run, double stiffness) {
  MeasuringWorld world(run, kWeightless);
  world.addBox({0, -0.2, 0}, {1.5, 0.2, 1.5}, 20);
  world.addBox({0, 0.15, 0}, {0.4, 0.15, 0.4}, 1);
  world.addSoft(makeBall(), BodyOptions{stiffness}, Vector3d(0.2, 0.9, 0)).push(Vector3d(0, -3, 0));
  reportConserved(run, world, kUntilParted);
}

/// Two free boxes close on a soft one from both sides, out of line.
void betweenBoxes(Run& run, double stiffness, double mass, double otherMass) {
  MeasuringWorld world(run, kWeightless);
  world.addSoft(makeBox({0.5, 0.5, 0.5}), BodyOptions{stiffness}, kWeightless);
  const Vector3d half(0.2, 0.4, 0.4);
  world.addBox({-0.8, 0.1, 0}, half, mass).setLinearVelocity(btVector3(3, 0, 0));
  world.addBox({0.8, -0.1, 0}, half, otherMass).setLinearVelocity(btVector3(-2, 0, 0));
  reportConserved(run, world, kUntilParted);
}

}  // namespace

void addHitScenes(ContactScenes& scenes) {
  for (const double k : {50.0, 500.0}) {
    const std::string end = "/k" + text(k);
    scenes.push_back({"free flight" + end, [=](Run& run) { miss(run, k); }});
    const auto addHits = [&](const std::string& name, Zone zone, const std::vector<Kind>& kinds) {
      for (const double mass : {0.05, 1.0, 20.0}) {
        std::string full = name;
        full.append("/").append(text(mass)).append("kg").append(end);
        scenes.push_back({full, [=](Run& run) { hit(run, k, mass, zone); }, kinds});
      }
    };
    const std::vector<Kind> all = {Kind::Surface, Kind::Nodes, Kind::Bullet};
    addHits("hit", Zone::None, all);
    addHits("hit in trigger", Zone::Trigger, all);
    // Bullet's own search for nodes in a ghost leaves data of its solver unset: velocities then become NaN.
    addHits("hit in ghost", Zone::Ghost, {Kind::Surface});
    scenes.push_back({"hit by multibody/1kg" + end, [=](Run& run) { hitByMultiBody(run, k); }});
    scenes.push_back({"between/box on box" + end, [=](Run& run) { onBoxes(run, k); }});
    scenes.push_back({"between/two boxes/1 and 1kg" + end, [=](Run& run) { betweenBoxes(run, k, 1, 1); }});
    scenes.push_back({"between/two boxes/0.05 and 20kg" + end, [=](Run& run) { betweenBoxes(run, k, 0.05, 20); }});
  }
}

}  // namespace tetskin::contact_demo
