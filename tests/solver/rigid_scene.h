// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A world of rigid bodies of all kinds, for tests of rigid motion and of snapshots, and the state that they compare.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/solver/deformable_world.h>

#include <memory>
#include <vector>

#include "support/rigids.h"

namespace tetskin::test {

struct HasWorld {
  tetskin::DeformableWorld world;
};

/// Owns the objects in its world.
class RigidScene : public HasWorld, public Rigids {
 public:
  RigidScene() : Rigids(world) {}
  ~RigidScene() {
    for (auto& joint : linkJoints_) world.removeMultiBodyConstraint(joint.get());
    for (auto& body : multibodies) world.removeMultiBody(body.get());
    for (auto& collider : colliders_) world.removeCollisionObject(collider.get());
  }

  void addFloor() { add(shape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0, btVector3(0, 0, 0)); }
  void addStack(int count) {
    auto& box = shape<btBoxShape>(btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2)));
    for (int k = 0; k < count; ++k) {
      add(box, 1,
          btVector3(btScalar(0.41 * (k % 5) + 0.03 * (k % 3)), btScalar(0.2 + 0.45 * (k / 5)),
                    btScalar(0.02 * (k % 7))));
    }
  }
  void addKinds();
  void addJoints();
  void addArm();

  void step(int frames = 1) {
    for (int k = 0; k < frames; ++k) world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 120);
  }
  std::vector<std::unique_ptr<btTriangleMesh>> meshes_;
  std::vector<std::unique_ptr<btMultiBody>> multibodies;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> linkJoints_;
  btMultiBodyJointMotor* motor = nullptr;
};

/// Balls, capsules, cylinders, hulls, compounds that touch compounds, on a mesh; a kinematic plate; a sleeping body.
inline void RigidScene::addKinds() {
  const btScalar s = btScalar(0.2);
  auto mesh = std::make_unique<btTriangleMesh>();
  const btVector3 corner[4] = {{2, 0, -2}, {8, btScalar(0.3), -2}, {8, btScalar(0.1), 4}, {2, btScalar(0.2), 4}};
  mesh->addTriangle(corner[0], corner[2], corner[1]);
  mesh->addTriangle(corner[0], corner[3], corner[2]);
  add(shape<btBvhTriangleMeshShape>(mesh.get(), true), 0, btVector3(0, 0, 0));
  meshes_.push_back(std::move(mesh));
  auto& hull = shape<btConvexHullShape>();
  for (int k = 0; k < 12; ++k) {
    hull.addPoint(btVector3(s * btCos(btScalar(k)), s * btSin(btScalar(2 * k)), s * btSin(btScalar(k) + 1)));
  }
  auto& ball = shape<btSphereShape>(s);
  auto& box = shape<btBoxShape>(btVector3(s, s, s));
  auto& compound = shape<btCompoundShape>();
  compound.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(-s, 0, 0)), &ball);
  compound.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(2 * s, 0, 0)), &box);
  compound.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(0, 2 * s, 0)), &hull);
  auto& flat = shape<btCompoundShape>(false);
  flat.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(-s, 0, 0)), &hull);
  flat.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(s, 0, 0)), &ball);
  btCollisionShape* const kinds[] = {&ball,
                                     &shape<btCapsuleShape>(s, s),
                                     &shape<btCylinderShape>(btVector3(s, s, s)),
                                     &hull,
                                     &compound,
                                     &compound,
                                     &flat,
                                     &flat,
                                     &box,
                                     &ball};
  for (int k = 0; k < 30; ++k) {
    add(*kinds[k % 10], btScalar(1 + k % 3),
        btVector3(btScalar(3.5 + 0.55 * (k % 5)), btScalar(0.6 + 0.5 * (k / 5)), btScalar(0.5 * (k % 3))));
  }
  btRigidBody& plate = add(shape<btBoxShape>(btVector3(1, btScalar(0.1), 1)), 0, btVector3(-3, btScalar(0.5), 0));
  plate.setCollisionFlags(plate.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  plate.setActivationState(DISABLE_DEACTIVATION);
  add(box, 1, btVector3(-3, btScalar(0.85), 0));
  add(ball, 1, btVector3(btScalar(-2.6), btScalar(1.2), 0));
}

inline void RigidScene::addJoints() {
  auto& box = shape<btBoxShape>(btVector3(btScalar(0.1), btScalar(0.2), btScalar(0.1)));
  const auto pair = [&](int k) {
    btRigidBody& a = add(box, 1, btVector3(btScalar(k), 3, -4));
    return std::pair<btRigidBody&, btRigidBody&>(a, add(box, 1, btVector3(btScalar(k), btScalar(2.5), -4)));
  };
  const auto frame = [](btScalar y) { return btTransform(btQuaternion(0, 0, btScalar(0.3)), btVector3(0, y, 0)); };
  const btTransform low = frame(btScalar(-0.25)), high = frame(btScalar(0.25));
  const btVector3 pivotA(0, btScalar(-0.25), 0), pivotB(0, btScalar(0.25), 0);
  int at = 0;
  {
    auto [a, b] = pair(at++);
    join<btPoint2PointConstraint>(a, b, pivotA, pivotB);
    join<btPoint2PointConstraint>(a, btVector3(0, btScalar(0.25), 0));
  }
  {
    auto [a, b] = pair(at++);
    auto& hinge = join<btHingeConstraint>(a, b, low, high);
    hinge.enableAngularMotor(true, 2, btScalar(0.05));
    hinge.setLimit(-1, 1);
    auto& turns = join<btHingeAccumulatedAngleConstraint>(a, high);
    turns.setBreakingImpulseThreshold(1000);
  }
  {
    auto [a, b] = pair(at++);
    auto& slider = join<btSliderConstraint>(a, b, low, high, true);
    slider.setPoweredLinMotor(true);
    slider.setTargetLinMotorVelocity(1);
    slider.setMaxLinMotorForce(3);
    slider.setLowerLinLimit(btScalar(-0.3));
    slider.setUpperLinLimit(btScalar(0.3));
  }
  {
    auto [a, b] = pair(at++);
    auto& cone = join<btConeTwistConstraint>(a, b, low, high);
    cone.setLimit(btScalar(0.4), btScalar(0.3), btScalar(0.2));
    cone.enableMotor(true);
    cone.setMaxMotorImpulse(btScalar(0.02));
    cone.setMotorTarget(btQuaternion(btScalar(0.1), btScalar(0.2), 0));
  }
  {
    auto [a, b] = pair(at++);
    auto& six = join<btGeneric6DofConstraint>(a, b, low, high, true);
    six.setAngularLowerLimit(btVector3(btScalar(-0.5), 0, 0));
    six.setAngularUpperLimit(btVector3(btScalar(0.5), 0, 0));
    six.getRotationalLimitMotor(0)->m_enableMotor = true;
    six.getRotationalLimitMotor(0)->m_targetVelocity = 1;
  }
  {
    auto [a, b] = pair(at++);
    auto& spring = join<btGeneric6DofSpringConstraint>(a, b, low, high, true);
    spring.setLinearLowerLimit(btVector3(0, btScalar(-0.5), 0));
    spring.setLinearUpperLimit(btVector3(0, btScalar(0.5), 0));
    spring.enableSpring(1, true);
    spring.setStiffness(1, 40);
  }
  {
    auto [a, b] = pair(at++);
    auto& spring = join<btGeneric6DofSpring2Constraint>(a, b, low, high);
    spring.setLinearLowerLimit(btVector3(0, btScalar(-0.5), 0));
    spring.setLinearUpperLimit(btVector3(0, btScalar(0.5), 0));
    spring.enableSpring(1, true);
    spring.setStiffness(1, 40);
  }
  {
    auto [a, b] = pair(at++);
    join<btFixedConstraint>(a, b, low, high);
    join<btGearConstraint>(a, b, btVector3(1, 0, 0), btVector3(0, 1, 0), btScalar(2));
  }
  {
    auto [a, b] = pair(at++);
    btVector3 anchor(btScalar(at - 1), btScalar(2.75), -4), x(1, 0, 0), z(0, 0, 1);
    join<btUniversalConstraint>(a, b, anchor, x, z);
  }
  {
    auto [a, b] = pair(at++);
    btVector3 anchor(btScalar(at - 1), btScalar(2.75), -4), x(1, 0, 0), y(0, 1, 0);
    join<btHinge2Constraint>(a, b, anchor, y, x);
  }
}

/// An arm of three links that hangs from a fixed base and falls to the floor, with a motor and a limit.
inline void RigidScene::addArm() {
  auto& box = shape<btBoxShape>(btVector3(btScalar(0.1), btScalar(0.3), btScalar(0.1)));
  btVector3 inertia;
  box.calculateLocalInertia(1, inertia);
  auto made = std::make_unique<btMultiBody>(3, btScalar(1), inertia, true, true);
  btMultiBody& arm = *made;
  const btVector3 down(0, btScalar(-0.3), 0);
  arm.setBasePos(btVector3(-6, btScalar(2.2), 0));
  arm.setupRevolute(0, 1, inertia, -1, btQuaternion(0, 0, btScalar(0.5)), btVector3(0, 0, 1), down, down, true);
  arm.setupSpherical(1, 1, inertia, 0, btQuaternion::getIdentity(), down, down, true);
  arm.setupRevolute(2, 1, inertia, 1, btQuaternion::getIdentity(), btVector3(1, 0, 0), down, down, true);
  arm.finalizeMultiDof();
  arm.setJointVel(2, 3);
  world.addMultiBody(&arm);
  multibodies.push_back(std::move(made));
  for (int link = 0; link < 3; ++link) {
    auto collider = std::make_unique<btMultiBodyLinkCollider>(&arm, link);
    collider->setCollisionShape(&box);
    world.addCollisionObject(collider.get(), 1, -1);
    arm.getLink(link).m_collider = collider.get();
    colliders_.push_back(std::move(collider));
  }
  btAlignedObjectArray<btQuaternion> turns;
  btAlignedObjectArray<btVector3> places;
  arm.forwardKinematics(turns, places);
  arm.updateCollisionObjectWorldTransforms(turns, places);
  auto drive = std::make_unique<btMultiBodyJointMotor>(&arm, 0, btScalar(1), btScalar(0.05));
  motor = drive.get();
  linkJoints_.push_back(std::move(drive));
  linkJoints_.push_back(std::make_unique<btMultiBodyJointLimitConstraint>(&arm, 2, btScalar(-0.5), btScalar(0.5)));
  for (auto& joint : linkJoints_) world.addMultiBodyConstraint(joint.get());
  add(box, 1, btVector3(btScalar(-5.9), btScalar(0.4), 0));
}

}  // namespace tetskin::test
