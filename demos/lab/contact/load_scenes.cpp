// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Soft bodies on top of rigid ones that lie on the ground, and under them.
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <memory>

#include "contact/scene_list.h"
#include "measure/extremes.h"
#include "measure/measuring_world.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Vector3d;

double lowestCorner(const btRigidBody& box, const Vector3d& half) {
  double lowest = HUGE_VAL;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    lower(lowest, toEigen(box.getWorldTransform() * toBullet(sign.cwiseProduct(half))).y());
  }
  return lowest;
}

/// A soft ball at 3 S/s hits a plate with a tenth of its mass that lies on the floor.
void plate(Run& run, double stiffness) {
  MeasuringWorld world(run);
  world.addFloor();
  const Vector3d half(0.5, 0.15, 0.5);
  const btRigidBody& plate = world.addBox({0, half.y(), 0}, half, 0.1);
  world.simulate(0.5);
  const double before = lowestCorner(plate, half);
  world.addSoft(makeBall(), BodyOptions{stiffness}, Vector3d(0.2, 0.85, 0)).push(Vector3d(0, -3, 0));
  double lowest = HUGE_VAL;
  world.simulate(0.5, [&] { lower(lowest, lowestCorner(plate, half)); });
  run.report("sinks, S", before - lowest);
}

constexpr double kHeavyMass = 10.0, kHeavyStiffness = 500.0;
const Vector3d kHeavyHalf(0.4, 0.15, 0.4);

SoftObject& addCube(MeasuringWorld& world, double height) {
  return world.addSoftOn(height, makeBox({0.5, 0.5, 0.5}), BodyOptions{kHeavyStiffness});
}

/// Two seconds to come to rest, and one of measurement.
void reportRest(Run& run, MeasuringWorld& world, SoftObject& cube, const btCollisionObject& heavy,
                const std::function<double()>& speedOfBox) {
  const btVector3 start = heavy.getWorldTransform().getOrigin();
  world.simulate(2);
  double box = 0.0, soft = 0.0;
  world.simulate(1, [&] {
    raise(box, speedOfBox());
    raise(soft, cube.fastest());
  });
  run.report("box's speed, S/s", box);
  run.report("fastest node, S/s", soft);
  run.report("box displacement, S", toEigen(heavy.getWorldTransform().getOrigin() - start).norm());
}

void reportRest(Run& run, MeasuringWorld& world, SoftObject& cube, const btRigidBody& heavy) {
  reportRest(run, world, cube, heavy, [&] { return toEigen(heavy.getLinearVelocity()).norm(); });
}

/// The height at which a box lies on the cube, or at which its hinge is.
double boxHeight() {
  return 1.0 + 2.0 * kMargin + kHeavyHalf.y();
}

void heavyOnTop(Run& run, bool inTrigger) {
  MeasuringWorld world(run);
  if (inTrigger) world.addTrigger(5.0);
  world.addFloor();
  SoftObject& cube = addCube(world, 0.0);
  reportRest(run, world, cube, world.addBox({0, boxHeight(), 0}, kHeavyHalf, kHeavyMass));
}

void heavyBelow(Run& run) {
  MeasuringWorld world(run);
  world.addFloor();
  const Vector3d half(0.7, 0.15, 0.7);
  const btRigidBody& box = world.addBox({0, half.y(), 0}, half, kHeavyMass);
  SoftObject& cube = addCube(world, 2.0 * half.y());
  reportRest(run, world, cube, box);
}

/// The box is a lid, on a hinge at some distance at its own height. A motor that keeps it still carries a tenth of its
/// weight.
constexpr double kHingeArm = 1.2;

void heavyOnHinge(Run& run) {
  MeasuringWorld world(run);
  world.addFloor();
  SoftObject& cube = addCube(world, 0.0);
  btRigidBody& box = world.addBox({0, boxHeight(), 0}, kHeavyHalf, kHeavyMass);
  auto hinge = std::make_unique<btHingeConstraint>(box, btVector3(btScalar(-kHingeArm), 0, 0), btVector3(0, 0, 1));
  hinge->enableAngularMotor(true, 0, static_cast<btScalar>(0.1 * kHeavyMass * scenes::kEarth * kHingeArm * kStep));
  world.addConstraint(std::move(hinge));
  reportRest(run, world, cube, box);
}

void heavyAsLink(Run& run) {
  MeasuringWorld world(run);
  world.addFloor();
  SoftObject& cube = addCube(world, 0.0);
  const auto mass = static_cast<btScalar>(kHeavyMass);
  auto shape = std::make_unique<btBoxShape>(toBullet(kHeavyHalf));
  btVector3 inertia;
  shape->calculateLocalInertia(mass, inertia);
  auto lid = std::make_unique<btMultiBody>(1, 0, btVector3(1, 1, 1), true, false);
  lid->setBasePos(toBullet(Vector3d(-kHingeArm, boxHeight(), 0)));
  lid->setupRevolute(0, mass, inertia, -1, btQuaternion::getIdentity(), btVector3(0, 0, 1), btVector3(0, 0, 0),
                     btVector3(btScalar(kHingeArm), 0, 0), true);
  lid->finalizeMultiDof();
  const btMultiBody& added = world.addMultiBody(std::move(lid), 0, std::move(shape));
  reportRest(run, world, cube, *added.getLink(0).m_collider,
             [&] { return std::abs(static_cast<double>(added.getJointVel(0))) * kHingeArm; });
}

}  // namespace

void addLoadScenes(ContactScenes& scenes) {
  for (const double k : {50.0, 500.0}) {
    scenes.push_back({"plate/k" + text(k), [=](Run& run) { plate(run, k); }});
  }
  scenes.push_back({"heavy/on top", [](Run& run) { heavyOnTop(run, false); }});
  scenes.push_back({"heavy/on top in trigger", [](Run& run) { heavyOnTop(run, true); }});
  scenes.push_back({"heavy/below", heavyBelow});
  scenes.push_back({"heavy/on a hinge", heavyOnHinge});
  scenes.push_back({"heavy/link", heavyAsLink});
}

}  // namespace tetskin::contact_demo
