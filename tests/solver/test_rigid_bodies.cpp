// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Rigid bodies in a DeformableWorld move as in Bullet's plain world: a table of an application's actions on them.
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btPoint2PointConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSliderConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletDynamics/Vehicle/btRaycastVehicle.h>
#include <btBulletCollisionCommon.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>

#include <stdexcept>

#include "deformable_test.h"
#include "support/rigids.h"

namespace tetskin::test {
namespace {

btVector3 along(int axis, double length) {
  btVector3 vector(0, 0, 0);
  vector[axis] = static_cast<btScalar>(length);
  return vector;
}
btVector3 cube(double half) {
  return btVector3(1, 1, 1) * static_cast<btScalar>(half);
}

/// Rigid bodies in a world, which are removed with it.
class PlainScene : public Rigids {
 public:
  PlainScene(btMultiBodyDynamicsWorld& inWorld, int substepsPerFrame)
      : Rigids(inWorld), world(inWorld), substeps_(substepsPerFrame) {
    world.setGravity(along(1, -9.81));
  }

  btRigidBody& box(double mass, const btVector3& at, const btVector3& half = cube(0.1)) {
    return add(shape<btBoxShape>(half), mass, at);
  }
  /// It never falls asleep.
  btRigidBody& awake(double mass, const btVector3& at, const btVector3& half = cube(0.1)) {
    btRigidBody& body = box(mass, at, half);
    body.setActivationState(DISABLE_DEACTIVATION);
    return body;
  }
  /// Of 2 kg, in space.
  btRigidBody& floating() {
    world.setGravity(btVector3(0, 0, 0));
    return awake(2, btVector3(0, 0, 0));
  }
  btRigidBody& ball(double mass, const btVector3& at) {
    btRigidBody& body = add(shape<btSphereShape>(btScalar(0.1)), mass, at);
    body.setActivationState(DISABLE_DEACTIVATION);
    return body;
  }
  btRigidBody& floor() { return add(shape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0, cube(0)); }
  void run(
      int frames, const std::function<void()>& before = [] {}) {
    for (int frame = 0; frame < frames; ++frame) {
      before();
      world.stepSimulation(btScalar(1) / 60, substeps_, step());
    }
  }
  btScalar step() const { return btScalar(1) / 60 / static_cast<btScalar>(substeps_); }

  btMultiBodyDynamicsWorld& world;

 private:
  int substeps_;
};

/// The base is fixed, or free; its link turns about z, half a metre beside it.
class Arm {
 public:
  Arm(PlainScene& scene, bool fixed) : body(1, fixed ? 0 : 1, cube(0.1), fixed, false), world_(scene.world) {
    body.setupRevolute(0, 1, cube(0.1), -1, btQuaternion::getIdentity(), along(2, 1), cube(0), along(0, 0.5), false);
    body.finalizeMultiDof();
    body.setBaseWorldTransform(btTransform::getIdentity());
    body.setLinearDamping(0);
    body.setAngularDamping(0);
    body.setCanSleep(false);
    for (btMultiBodyLinkCollider* collider : {&base_, &link_}) {
      collider->setCollisionShape(&shape_);
      world_.addCollisionObject(collider, 1, 0);
    }
    body.setBaseCollider(&base_);
    body.getLink(0).m_collider = &link_;
    world_.addMultiBody(&body);
  }
  ~Arm() {
    world_.removeMultiBody(&body);
    world_.removeCollisionObject(&base_);
    world_.removeCollisionObject(&link_);
  }
  btMultiBody body;

 private:
  btMultiBodyDynamicsWorld& world_;
  btBoxShape shape_{cube(0.1)};
  btMultiBodyLinkCollider base_{&body, -1}, link_{&body, 0};
};

/// How high a ball of this restitution rises after it has fallen from 1 m.
btScalar rebound(PlainScene& scene, double restitution) {
  scene.floor().setRestitution(1);
  btRigidBody& ball = scene.ball(1, along(1, 1));
  ball.setRestitution(static_cast<btScalar>(restitution));
  btScalar top = 0;
  bool hasHit = false;
  scene.run(90, [&] {
    hasHit |= ball.getLinearVelocity().y() > btScalar(0.1);
    if (hasHit) top = std::max(top, ball.getWorldTransform().getOrigin().y());
  });
  return top;
}

/// The spin about the middle axis of a box that tumbles.
btScalar tumbling(PlainScene& scene, int flags) {
  scene.world.setGravity(btVector3(0, 0, 0));
  btRigidBody& body = scene.awake(2, cube(0), btVector3(btScalar(0.1), btScalar(0.2), btScalar(0.4)));
  body.setFlags(flags);
  body.setAngularVelocity(btVector3(1, 5, 1));
  scene.run(30);
  return body.getAngularVelocity().y();
}

btRigidBody& hanging(PlainScene& scene, const btVector3& pivot) {
  btRigidBody& body = scene.awake(1, cube(0));
  scene.join<btHingeConstraint>(body, pivot, along(2, 1));
  return body;
}

/// The pull at which a joint breaks that is to hold 12 N.
btScalar breakingForce(PlainScene& scene) {
  btRigidBody& body = scene.awake(1, cube(0));
  btTypedConstraint& joint = scene.join<btPoint2PointConstraint>(body, cube(0));
  joint.setBreakingImpulseThreshold(12 * scene.step());
  btScalar force = 0, last = 0;
  scene.run(40, [&] {
    if (joint.isEnabled()) last = force;
    force += btScalar(0.1);
    body.applyCentralForce(btVector3(0, -force, 0));
  });
  return last;
}

btScalar feedback(PlainScene& scene) {
  btRigidBody& body = scene.awake(1, cube(0));
  btTypedConstraint& joint = scene.join<btPoint2PointConstraint>(body, cube(0));
  btJointFeedback told;
  joint.setJointFeedback(&told);
  scene.run(30, [&] { body.applyCentralForce(along(1, -3)); });
  joint.setJointFeedback(nullptr);
  return told.m_appliedForceBodyA.y();
}

btScalar springSag(PlainScene& scene) {
  btRigidBody& body = scene.awake(1, cube(0));
  auto& spring = scene.join<btGeneric6DofSpring2Constraint>(body, btTransform::getIdentity());
  for (int axis = 0; axis < 3; ++axis) spring.setLimit(axis, 1, -1);
  for (int axis = 3; axis < 6; ++axis) spring.setLimit(axis, 0, 0);
  spring.enableSpring(1, true);
  spring.setStiffness(1, 100);
  spring.setDamping(1, 5);
  spring.setEquilibriumPoint();
  scene.run(120);
  return body.getWorldTransform().getOrigin().y();
}

btScalar sliderSpeed(PlainScene& scene) {
  btRigidBody& body = scene.awake(1, cube(0));
  auto& slider = scene.join<btSliderConstraint>(body, btTransform::getIdentity(), true);
  slider.setPoweredLinMotor(true);
  slider.setTargetLinMotorVelocity(2);
  slider.setMaxLinMotorForce(30);
  slider.setLowerLinLimit(-1);
  slider.setUpperLinLimit(1);
  scene.run(4);
  return body.getLinearVelocity().x();
}

btScalar motorSpeed(PlainScene& scene) {
  Arm arm(scene, true);
  btMultiBodyJointMotor motor(&arm.body, 0, 3, btScalar(0.05));
  scene.world.addMultiBodyConstraint(&motor);
  scene.run(20);
  scene.world.removeMultiBodyConstraint(&motor);
  return arm.body.getJointVel(0);
}

btScalar drivenCar(PlainScene& scene) {
  scene.floor();
  btRigidBody& chassis = scene.awake(100, along(1, 0.7), btVector3(btScalar(0.5), btScalar(0.2), 1));
  btDefaultVehicleRaycaster rays(&scene.world);
  btRaycastVehicle::btVehicleTuning tuning;
  tuning.m_suspensionStiffness = 20;
  btRaycastVehicle car(tuning, &chassis, &rays);
  car.setCoordinateSystem(0, 1, 2);
  for (int k = 0; k < 4; ++k) {
    const btVector3 at(btScalar(k & 1 ? 0.5 : -0.5), 0, btScalar(k & 2 ? 1 : -1));
    car.addWheel(at, along(1, -1), along(0, -1), btScalar(0.3), btScalar(0.3), tuning, k < 2);
  }
  scene.world.addVehicle(&car);
  scene.run(60, [&] {
    for (int k = 0; k < 4; ++k) car.applyEngineForce(50, k);
  });
  scene.world.removeVehicle(&car);
  return chassis.getLinearVelocity().z();
}

/// A tick callback that pushes the body of the world's user data.
void push(btDynamicsWorld* world, btScalar) {
  static_cast<btRigidBody*>(world->getWorldUserInfo())->applyCentralForce(along(0, 1));
}

struct RigidCase {
  const char* what;
  std::function<btScalar(PlainScene&)> number;
};

const std::vector<RigidCase>& rigidCases() {
  static const std::vector<RigidCase> all{
      {"a central force",
       [](PlainScene& s) {
         btRigidBody& body = s.floating();
         s.run(60, [&] { body.applyCentralForce(along(0, 10)); });
         EXPECT_NEAR(body.getLinearVelocity().x(), 5, 1e-4);
         return body.getLinearVelocity().x();
       }},
      {"the way under a force",
       [](PlainScene& s) {
         btRigidBody& body = s.floating();
         s.run(30, [&] { body.applyCentralForce(along(0, 10)); });
         return body.getWorldTransform().getOrigin().x();
       }},
      {"a force equal to the weight",
       [](PlainScene& s) {
         btRigidBody& body = s.awake(2, cube(0));
         s.run(60, [&] { body.applyCentralForce(along(1, 2 * 9.81)); });
         EXPECT_NEAR(body.getWorldTransform().getOrigin().y(), 0, 1e-4);
         return 1 + body.getWorldTransform().getOrigin().y();
       }},
      {"a force at a point",
       [](PlainScene& s) {
         btRigidBody& body = s.floating();
         s.run(10, [&] { body.applyForce(along(0, 1), along(1, 0.1)); });
         return body.getAngularVelocity().z();
       }},
      {"a torque",
       [](PlainScene& s) {
         btRigidBody& body = s.floating();
         s.run(10, [&] { body.applyTorque(along(0, 0.1)); });
         return body.getAngularVelocity().x();
       }},
      {"a torque by an angular factor",
       [](PlainScene& s) {
         btRigidBody& body = s.floating();
         body.setAngularFactor(btVector3(btScalar(0.5), 1, 1));
         s.run(10, [&] { body.applyTorque(along(0, 0.1)); });
         return body.getAngularVelocity().x();
       }},
      {"impulses",
       [](PlainScene& s) {
         btRigidBody& body = s.floating();
         s.run(10, [&] {
           body.applyCentralImpulse(along(0, 0.1));
           body.applyTorqueImpulse(along(1, 0.01));
         });
         return body.getLinearVelocity().x() + body.getAngularVelocity().y();
       }},
      {"a force in a callback before each step",
       [](PlainScene& s) {
         btRigidBody& body = s.floating();
         s.world.setInternalTickCallback(push, &body, true);
         s.run(60);
         s.world.setInternalTickCallback(nullptr, nullptr, true);
         return body.getLinearVelocity().x();
       }},
      {"a force on another mass",
       [](PlainScene& s) {
         btRigidBody& body = s.floating();
         s.run(10, [&] { body.applyCentralForce(along(0, 10)); });
         body.setMassProps(4, cube(0.1));
         body.updateInertiaTensor();
         s.run(10, [&] { body.applyCentralForce(along(0, 10)); });
         return body.getLinearVelocity().x();
       }},
      {"a force on a body without simulation",
       [](PlainScene& s) {
         btRigidBody& body = s.floating();
         body.forceActivationState(DISABLE_SIMULATION);
         s.run(30, [&] { body.applyCentralForce(along(0, 20)); });
         EXPECT_EQ(body.getLinearVelocity().x(), 0);
         return body.getLinearVelocity().x();
       }},
      {"a force on a sleeper",
       [](PlainScene& s) {
         s.floor();
         btRigidBody& body = s.box(1, along(1, 0.1));
         s.run(150);
         EXPECT_FALSE(body.isActive());
         s.run(10, [&] { body.applyCentralForce(along(0, 20)); });
         body.activate();
         s.run(1);
         return body.getLinearVelocity().x();
       }},
      {"fall",
       [](PlainScene& s) {
         btRigidBody& body = s.box(2, cube(0));
         s.run(30);
         return body.getLinearVelocity().y() + body.getWorldTransform().getOrigin().y();
       }},
      {"fall by a linear factor",
       [](PlainScene& s) {
         btRigidBody& body = s.box(2, cube(0));
         body.setLinearFactor(btVector3(1, btScalar(0.5), 1));
         s.run(30);
         return body.getLinearVelocity().y();
       }},
      {"a gravity of its own",
       [](PlainScene& s) {
         btRigidBody& body = s.box(2, cube(0));
         body.setGravity(along(0, 1));
         s.run(30);
         return body.getLinearVelocity().x();
       }},
      {"gravity of the world that changes",
       [](PlainScene& s) {
         btRigidBody& body = s.box(2, cube(0));
         s.run(10);
         s.world.setGravity(along(0, 1));
         s.run(20);
         return body.getLinearVelocity().x() + body.getLinearVelocity().y();
       }},
      {"damped fall and spin",
       [](PlainScene& s) {
         btRigidBody& body = s.box(2, cube(0));
         body.setDamping(btScalar(0.5), btScalar(0.4));
         body.setAngularVelocity(along(0, 3));
         s.run(60);
         return body.getLinearVelocity().y() + body.getAngularVelocity().x();
       }},
      {"a spin of five turns per frame",
       [](PlainScene& s) {
         btRigidBody& body = s.floating();
         body.setAngularVelocity(along(2, 300));
         s.run(6);
         return body.getAngularVelocity().z();
       }},
      {"tumbling without gyroscopic forces", [](PlainScene& s) { return tumbling(s, 0); }},
      {"tumbling, explicit", [](PlainScene& s) { return tumbling(s, BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT); }},
      {"tumbling, implicit", [](PlainScene& s) { return tumbling(s, BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY); }},
      {"a rebound", [](PlainScene& s) { return rebound(s, 0.5); }},
      {"a full rebound", [](PlainScene& s) { return rebound(s, 1); }},
      {"a box that slides",
       [](PlainScene& s) {
         s.floor();
         btRigidBody& body = s.box(1, along(1, 0.1));
         body.setLinearVelocity(along(0, 2));
         s.run(60);
         return body.getWorldTransform().getOrigin().x();
       }},
      {"a box that is pushed",
       [](PlainScene& s) {
         s.floor();
         btRigidBody& body = s.awake(1, along(1, 0.1));
         s.run(60, [&] { body.applyCentralForce(along(0, 4)); });
         return body.getLinearVelocity().x();
       }},
      {"a ball that rolls",
       [](PlainScene& s) {
         s.floor().setRollingFriction(btScalar(0.1));
         btRigidBody& ball = s.ball(1, along(1, 0.1));
         ball.setRollingFriction(btScalar(0.1));
         ball.setLinearVelocity(along(0, 2));
         s.run(60);
         return ball.getWorldTransform().getOrigin().x();
       }},
      {"a contact with stiffness and damping",
       [](PlainScene& s) {
         s.floor();
         btRigidBody& body = s.awake(1, along(1, 0.1));
         body.setContactStiffnessAndDamping(500, 20);
         s.run(120);
         return body.getWorldTransform().getOrigin().y();
       }},
      {"a box that leaves the floor that it is in",
       [](PlainScene& s) {
         s.floor();
         btRigidBody& body = s.awake(1, along(1, 0.05));
         s.run(10);
         return body.getWorldTransform().getOrigin().y();
       }},
      {"a bullet",
       [](PlainScene& s) {
         s.world.setGravity(btVector3(0, 0, 0));
         s.box(0, along(0, 2), btVector3(btScalar(0.01), 1, 1));
         btRigidBody& ball = s.ball(1, cube(0));
         ball.setCcdMotionThreshold(btScalar(0.1));
         ball.setCcdSweptSphereRadius(btScalar(0.08));
         ball.setLinearVelocity(along(0, 100));
         s.run(10);
         return ball.getWorldTransform().getOrigin().x();
       }},
      {"frames until it sleeps",
       [](PlainScene& s) {
         s.floor();
         const btRigidBody& body = s.box(1, along(1, 0.1));
         int frames = 0;
         for (; frames < 200 && body.isActive(); ++frames) s.run(1);
         return static_cast<btScalar>(frames);
       }},
      {"a motor",
       [](PlainScene& s) {
         btRigidBody& body = s.floating();
         s.join<btHingeConstraint>(body, cube(0), along(2, 1)).enableAngularMotor(true, 5, btScalar(0.002));
         s.run(8);
         return body.getAngularVelocity().z();
       }},
      {"a pendulum that is pushed",
       [](PlainScene& s) {
         btRigidBody& body = hanging(s, along(0, -1));
         s.run(20, [&] { body.applyCentralForce(along(1, 5)); });
         return body.getWorldTransform().getOrigin().y();
       }},
      {"a slider's motor", sliderSpeed},
      {"the force at which a joint breaks", breakingForce},
      {"the force that a joint tells", feedback},
      {"the sag of a spring joint", springSag},
      {"an arm that falls",
       [](PlainScene& s) {
         Arm arm(s, false);
         s.run(20, [&] { arm.body.addBaseForce(along(0, 1)); });
         return arm.body.getBaseVel().x() + arm.body.getBaseVel().y();
       }},
      {"forces on an arm's link",
       [](PlainScene& s) {
         Arm arm(s, true);
         s.run(20, [&] {
           arm.body.addLinkForce(0, along(1, 2));
           arm.body.addLinkTorque(0, along(2, 1));
           arm.body.addJointTorque(0, btScalar(0.5));
         });
         return arm.body.getJointVel(0);
       }},
      {"an arm's motor", motorSpeed},
      {"a vehicle", drivenCar},
  };
  return all;
}

btScalar inPlainWorld(const RigidCase& row, int substeps) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  PlainScene scene(world, substeps);
  return row.number(scene);
}

TEST(RigidBodies, MoveAsInBulletsPlainWorld) {
  for (const int substeps : {1, 4}) {
    for (const RigidCase& row : rigidCases()) {
      SCOPED_TRACE(row.what);
      const btScalar plain = inPlainWorld(row, substeps);
      for (const bool deterministic : {false, true}) {
        DeformableWorldOptions options;
        options.deterministic = deterministic;
        tetskin::DeformableWorld world(options);
        PlainScene scene(world, substeps);
        EXPECT_NEAR(row.number(scene), plain, 2e-4 * std::abs(plain) + 1e-6) << substeps << " substeps";
      }
    }
  }
}

TEST(RigidBodies, TakeForcesTwiceOnlyWhereBulletsDeformableWorldIsAskedFor) {
  DeformableWorldOptions options;
  options.rigidForces = RigidForceModel::DeformableWorld;
  tetskin::DeformableWorld world(options);
  PlainScene scene(world, 4);
  btRigidBody& body = scene.floating();
  scene.run(60, [&] { body.applyCentralForce(along(0, 10)); });
  EXPECT_NEAR(body.getLinearVelocity().x(), 10, 1e-3);
}

/// As the force record reports: the plate's weight and the force that pushes it.
TEST(RigidBodies, PressOnASoftBodyByTheForceThatPushesThem) {
  tetskin::DeformableWorld world;
  PlainScene scene(world, 4);
  scene.floor();
  const auto body = DeformableBody::add(world, smallCageAbove(btScalar(0.01))).value();
  btVector3 low, high;
  body->body().getAabb(low, high);
  const btVector3 middle = (low + high) / 2;
  btRigidBody& plate =
      scene.awake(1, btVector3(middle.x(), high.y() + btScalar(0.06), middle.z()), btVector3(1, btScalar(0.05), 1));
  plate.setAngularFactor(0);
  const auto record = ForceRecord::add(world).value();
  scene.run(240, [&] { plate.applyCentralForce(along(1, -2)); });
  EXPECT_NEAR(record->forcesOn(plate).contact.force.y(), 2 + 9.81, 0.05);
}

/// A world divides its steps for a soft body of a millimetre: a motor's impulse, and that at which a joint breaks, are
/// of the application's step all the same.
TEST(RigidBodies, HaveTheSameLimitsWhereAStepIsDivided) {
  btScalar speeds[2];
  for (const bool divided : {false, true}) {
    tetskin::DeformableWorld world;
    PlainScene scene(world, 1);
    btRigidBody& body = scene.floating();
    auto& hinge = scene.join<btHingeConstraint>(body, cube(0), along(2, 1));
    hinge.enableAngularMotor(true, 5, btScalar(0.002));
    auto& glue = scene.join<btPoint2PointConstraint>(scene.awake(1, along(0, 5)), cube(0));
    glue.setBreakingImpulseThreshold(btScalar(0.1));
    world.setGravity(along(1, -5));  // on the glue: an impulse of 0.083
    body.setGravity(cube(0));
    std::unique_ptr<DeformableBody> crumb;
    if (divided) {
      TetMesh small = smallCageAbove(0);
      for (Eigen::Vector3d& p : small.nodes) p = 0.001 * p + Eigen::Vector3d(0, 50, 0);
      crumb = DeformableBody::add(world, small).value();
    }
    EXPECT_EQ(world.stepSimulation(btScalar(1) / 60, 0) > 1, divided);
    scene.run(7);
    speeds[divided] = body.getAngularVelocity().z();
    EXPECT_EQ(hinge.getMaxMotorImpulse(), btScalar(0.002));
    EXPECT_TRUE(glue.isEnabled());
    EXPECT_EQ(glue.getBreakingImpulseThreshold(), btScalar(0.1));
  }
  EXPECT_GT(std::abs(speeds[0]), 0.1);
  EXPECT_NEAR(speeds[1], speeds[0], 0.01 * std::abs(speeds[0]));
}

/// Gravity, which a step adds to the forces, has left them again.
TEST(RigidBodies, KeepTheirForcesIfAnExceptionEndsAStep) {
  tetskin::DeformableWorld world;
  PlainScene scene(world, 1);
  const btRigidBody& body = scene.box(1, cube(0));
  world.setInternalTickCallback([](btDynamicsWorld*, btScalar) { throw std::runtime_error("within a step"); });
  EXPECT_THROW(scene.run(1), std::runtime_error);
  world.setInternalTickCallback(nullptr);
  EXPECT_NEAR(body.getTotalForce().length(), 0, 1e-5);
  const btScalar before = body.getLinearVelocity().y();
  scene.run(1);
  EXPECT_NEAR(body.getLinearVelocity().y() - before, -9.81 / 60, 1e-5);
}

struct Visitor {
  PlainScene* scene;
  btRigidBody* leaves;
  btRigidBody* comes;
};

/// The tick callback of a deformable world is called between prediction and solve.
TEST(RigidBodies, MayLeaveAndComeWhileAStepIsUnderWay) {
  tetskin::DeformableWorld world;
  PlainScene scene(world, 1);
  btRigidBody &first = scene.box(1, cube(0)), &second = scene.box(1, along(0, 2)), &third = scene.box(1, along(0, 4));
  world.removeRigidBody(&third);
  Visitor visitor{&scene, &first, &third};
  world.setInternalTickCallback(
      [](btDynamicsWorld* inWorld, btScalar) {
        auto& now = *static_cast<Visitor*>(inWorld->getWorldUserInfo());
        if (!now.scene) return;
        inWorld->removeRigidBody(now.leaves);
        inWorld->addRigidBody(now.comes);
        now.scene = nullptr;
      },
      &visitor);
  scene.run(10);
  world.setInternalTickCallback(nullptr);
  const btScalar step = btScalar(-9.81) / 60;
  EXPECT_NEAR(second.getLinearVelocity().y(), 10 * step, 1e-5);
  EXPECT_NEAR(third.getLinearVelocity().y(), 9 * step, 1e-5);
  EXPECT_NEAR(second.getTotalForce().length(), 0, 1e-6);
  world.addRigidBody(&first);
  scene.run(1);
  EXPECT_NEAR(second.getLinearVelocity().y(), 11 * step, 1e-5);
}

}  // namespace
}  // namespace tetskin::test
