// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A table of calls of this library and of Bullet by which an application may change a world between steps. Each run is
// recorded, and played again to the last bit. And a snapshot from before the call, restored, with the call once more,
// and one from after it go on to the same bits.
#include "replay/recorded_calls.h"

namespace tetskin::test {
namespace {

/// A call, named by its text.
#define CALL_THAT_IS(kind, ...)                                                           \
  Call {                                                                                  \
#__VA_ARGS__, [=](CallScene & s, [[maybe_unused]] int k) { __VA_ARGS__; }, Kind::kind \
  }
#define CALL(...) CALL_THAT_IS(Change, __VA_ARGS__)

const btVector3 kAside(btScalar(0.3), btScalar(0.5), btScalar(0.1));

Plasticity clay(int k) {
  Plasticity plasticity;
  plasticity.yieldStress = 300.0 * (k + 1);
  return plasticity;
}

std::vector<double> stiffened(const btSoftBody& body) {
  std::vector<double> factors(static_cast<std::size_t>(body.m_tetras.size()), 1.0);
  factors[0] = 2.0;
  return factors;
}

TEST(RecordedCalls, OfADeformableBody) {
  expectRepeats(
      {
          CALL((void)s.ball->setPinned(3 + k)),
          CALL((void)s.bar->setPinned(0, false)),
          {"setPinnedPosition",
           [](CallScene& s, int k) {
             for (int n = 0; n < s.bar->body().m_nodes.size(); ++n) {
               if (!s.bar->isPinned(n)) continue;
               const btVector3 at = s.bar->body().m_nodes[n].m_x;
               (void)s.bar->setPinnedPosition(n, at + btVector3(0, btScalar(0.001 * (k + 1)), 0));
             }
           }},
          {"pinned, led and released",
           [](CallScene& s, int k) {
             (void)s.ball->setPinned(2, k == 0);
             if (k == 0) (void)s.ball->setPinnedPosition(2, s.node(2).m_x + kAside / 10);
           }},
          CALL((void)s.ball->setGravity(btVector3(btScalar(k + 1), 1, 0))),
          {"followWorldGravity",
           [](CallScene& s, int k) {
             if (k == 0) (void)s.ball->setGravity(btVector3(1, 1, 0));
             if (k == 1) s.ball->followWorldGravity();
           }},
          CALL((void)s.ball->setYoungsModulus(3 * s.ball->youngsModulus())),
          CALL((void)s.ball->setPressure(500)),
          CALL((void)s.ball->setGas(300, 1e3)),
          CALL(EXPECT_TRUE(s.ball->setPlasticity(clay(k)).ok())),
          CALL(EXPECT_TRUE(s.ball->setGrowth(1.0 + 0.02 * (k + 1)).ok())),
          CALL(EXPECT_TRUE(s.ball->setStiffnessScale(stiffened(s.softBall())).ok())),
          CALL((void)s.ball->setPoissonRatio(0.45)),
          CALL((void)s.ball->setStiffnessDamping(0.1)),
          {"teleport",
           [](CallScene& s, int k) {
             const btTransform motion(btQuaternion(btVector3(0, 1, 0), btScalar(0.4)), btVector3(0, btScalar(k), 0));
             EXPECT_TRUE(s.ball->teleport(motion).ok());
           }},
          CALL(EXPECT_TRUE(s.bar->teleport(placedAt(0.1, 0.05, 0)).ok())),
          CALL(EXPECT_TRUE(s.ball->reset().ok())),
          {"removeFromWorld and addToWorld",
           [](CallScene& s, int) {
             s.ball->removeFromWorld();
             EXPECT_TRUE(s.ball->addToWorld(s.world).ok());
           },
           Kind::Structure},
          CALL(EXPECT_TRUE(s.bar->reset().ok())),
      },
      true);
}

TEST(RecordedCalls, OfBulletsSoftBody) {
  expectRepeats(
      {
          CALL(s.node(4).m_x += kAside / 10),
          CALL(s.node(4).m_q = s.node(4).m_x += kAside / 10),
          CALL(s.bar->body().m_nodes[0].m_x += kAside / 50),
          CALL(s.node(4).m_v += kAside),
          CALL(s.node(4).m_vn = s.node(4).m_v += kAside),
          CALL(s.bar->body().m_nodes[0].m_v = kAside / 10),
          CALL(s.softBall().translate(kAside)),
          CALL(s.bar->body().translate(kAside / 10)),
          CALL(s.softBall().rotate(btQuaternion(btVector3(0, 1, 0), btScalar(0.4)))),
          CALL_THAT_IS(Structure, s.softBall().scale(btVector3(btScalar(1.1), btScalar(1.1), btScalar(1.1)))),
          CALL(s.softBall().transform(placedAt(0.1, 0.4, 0))),
          CALL_THAT_IS(Unseen, s.softBall().addForce(100 * kAside)),
          CALL_THAT_IS(Unseen, s.softBall().addForce(100 * kAside, 5)),
          CALL(s.softBall().addVelocity(kAside)),
          CALL(s.softBall().addVelocity(kAside, 5)),
          CALL(s.softBall().setVelocity(kAside)),
          CALL(s.softBall().setLinearVelocity(kAside)),
          CALL(s.softBall().setAngularVelocity(3 * kAside)),
          CALL(s.softBall().setZeroVelocity()),
          CALL(s.softBall().setMass(6, 40)),
          CALL(s.softBall().setMass(6, btScalar(k == 0 ? 0 : 9))),
          CALL(s.softBall().setTotalMass(500)),
          CALL(s.softBall().setTotalDensity(700)),
          CALL_THAT_IS(Unseen, s.softBall().setSelfCollision(true)),
          CALL_THAT_IS(Unseen, s.softBall().setWindVelocity(kAside)),
          CALL_THAT_IS(Unseen, s.softBall().m_cfg.collisions |= btSoftBody::fCollision::SDF_RDF),
          CALL_THAT_IS(Refused, s.softBall().generateClusters(2)),
          CALL(s.softBall().m_cfg.kDF = btScalar(0.1)),
          CALL(s.softBall().m_cfg.drag = btScalar(0.05)),
          CALL(s.softBall().setGravityFactor(btScalar(0.5))),
          CALL_THAT_IS(Unseen, s.softBall().setFriction(0)),
          CALL(s.softBall().getCollisionShape()->setMargin(btScalar(0.05))),
          CALL(s.softBall().forceActivationState(k == 0 ? ISLAND_SLEEPING : ACTIVE_TAG)),
          CALL(s.softBall().forceActivationState(DISABLE_SIMULATION)),
          CALL(s.softBall().activate(), s.softBall().addVelocity(btScalar(k) * kAside)),
          CALL(s.softBall().setIgnoreCollisionCheck(s.box, true)),
          {"m_collisionDisabledObjects",
           [](CallScene& s, int k) {
             if (k == 0) s.softBall().m_collisionDisabledObjects.push_back(s.box);
           }},
          CALL(s.softBall().getBroadphaseHandle()->m_collisionFilterMask = 0),
          CALL(s.softBall().setCollisionFlags(s.softBall().getCollisionFlags() |
                                              btCollisionObject::CF_NO_CONTACT_RESPONSE)),
      },
      true);
}

TEST(RecordedCalls, OfRigidBodies) {
  expectRepeats(
      {
          CALL(s.box->activate(), s.box->applyCentralForce(20 * kAside)),
          CALL(s.box->activate(), s.box->applyForce(20 * kAside, btVector3(0, 0, 1))),
          CALL(s.box->activate(), s.box->applyTorque(5 * kAside)),
          CALL(s.box->activate(), s.box->applyCentralImpulse(kAside)),
          CALL(s.box->activate(), s.box->applyImpulse(kAside, btVector3(0, 0, 1))),
          CALL(s.box->activate(), s.box->applyTorqueImpulse(kAside / 10)),
          {"clearForces",
           [](CallScene& s, int) {
             s.box->applyCentralForce(kAside), s.box->clearForces();
             s.box->activate(), s.box->setLinearVelocity(kAside);
           }},
          CALL(s.box->activate(), s.box->setLinearVelocity(kAside)),
          CALL(s.box->activate(), s.box->setAngularVelocity(kAside)),
          CALL(s.box->setWorldTransform(placedAt(0, 1.3 + 0.1 * k, 0))),
          CALL(s.box->setCenterOfMassTransform(placedAt(0.1, 1.3, 0))),
          {"setInterpolationWorldTransform",
           [](CallScene& s, int) {
             s.box->setWorldTransform(placedAt(0.1, 1.3, 0));
             s.box->setInterpolationWorldTransform(placedAt(0.1, 1.3, 0));
             s.box->activate();
           }},
          CALL(s.box->activate(), s.box->proceedToTransform(placedAt(0.1, 1.3, 0))),
          CALL(s.box->activate(), s.box->translate(kAside)),
          CALL(s.box->setDamping(btScalar(0.5), btScalar(0.5))),
          CALL(s.box->setMassProps(5, btVector3(1, 1, 1)), s.box->updateInertiaTensor()),
          CALL(s.box->setGravity(kAside)),
          CALL(s.box->setLinearFactor(btVector3(1, 0, 1))),
          CALL(s.door->setAngularFactor(btScalar(0.5)), s.door->activate(), s.door->setAngularVelocity(kAside)),
          CALL(s.rider->setFriction(0), s.rider->activate(), s.rider->setLinearVelocity(kAside)),
          CALL(s.rider->setRollingFriction(1), s.rider->setSpinningFriction(1), s.rider->activate(),
               s.rider->setAngularVelocity(kAside)),
          CALL(s.rider->setRestitution(1), s.plate->setRestitution(1), s.rider->activate(),
               s.rider->setLinearVelocity(-kAside)),
          CALL(s.rider->setContactStiffnessAndDamping(100, 1), s.rider->activate(),
               s.rider->setLinearVelocity(-kAside)),
          CALL(s.rider->setAnisotropicFriction(btVector3(0, 1, 1)), s.rider->activate(),
               s.rider->setLinearVelocity(kAside / 10)),
          CALL(s.rider->setSleepingThresholds(100, 100), s.rider->activate(),
               s.rider->setLinearVelocity(btScalar(k) * kAside)),
          CALL(s.box->forceActivationState(k == 0 ? DISABLE_SIMULATION : ACTIVE_TAG)),
          CALL(s.box->forceActivationState(ISLAND_SLEEPING)),
          CALL(s.rider->activate(), s.rider->setDeactivationTime(5),
               s.rider->setLinearVelocity(btScalar(k) * kAside / 100)),
          {"becomes kinematic",
           [](CallScene& s, int k) {
             s.box->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
             s.box->setWorldTransform(placedAt(0, 1.2 + 0.01 * k, 0)), s.box->activate();
           }},
          CALL(s.box->setCollisionFlags(s.box->getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE),
               s.box->activate()),
          CALL(s.rider->setCcdMotionThreshold(btScalar(0.01)), s.rider->setCcdSweptSphereRadius(btScalar(0.1)),
               s.rider->activate(), s.rider->setLinearVelocity(-40 * kAside)),
          CALL(s.rider->setIgnoreCollisionCheck(s.plate, true), s.rider->activate()),
          CALL(s.box->setFlags(BT_DISABLE_WORLD_GRAVITY), s.box->setGravity(btVector3(0, 0, 0)), s.box->activate()),
          CALL(s.boxState.setWorldTransform(placedAt(0, 1.3 + 0.05 * k, 0)), s.box->setMotionState(&s.boxState),
               s.box->activate()),
          CALL_THAT_IS(Outside, s.plateState.setWorldTransform(placedAt(-2 + 0.02 * (k + 1), 0.2, 3)),
                       s.rider->activate()),
          CALL_THAT_IS(Outside, s.plate->setMotionState(nullptr),
                       s.plate->setWorldTransform(placedAt(-2 + 0.02 * (k + 1), 0.2, 3)), s.rider->activate()),
          CALL_THAT_IS(Structure, s.box->setCollisionShape(&s.sphereShape), s.box->activate()),
          CALL_THAT_IS(Structure, s.boxShape.setLocalScaling(btVector3(1, btScalar(1.1 + 0.1 * k), 1)),
                       s.box->activate()),
          CALL_THAT_IS(Structure, s.boxShape.setMargin(btScalar(0.1)), s.box->activate(), s.rider->activate(),
                       s.rider->setLinearVelocity(-kAside)),
          CALL_THAT_IS(Structure, s.compound.updateChildTransform(0, placedAt(-0.2 - 0.05 * k, 0, 0)),
                       s.pile->activate()),
          CALL_THAT_IS(Refused, s.compound.addChildShape(placedAt(0, 0, 0.2 + 0.1 * k), &s.sphereShape),
                       s.pile->activate()),
          CALL_THAT_IS(Structure, s.world.removeRigidBody(k == 0 ? s.box : s.rider)),
          CALL_THAT_IS(Structure, s.rigid(s.sphereShape, 1, placedAt(0.1, 2 + k, 0))),
          CALL_THAT_IS(Structure, s.world.removeRigidBody(s.box), s.world.addRigidBody(s.box, 1, k == 0 ? 0 : -1),
                       s.box->activate()),
      },
      true);
}

TEST(RecordedCalls, OfJoints) {
  expectRepeats(
      {
          CALL(s.hinge->enableAngularMotor(true, btScalar(k + 1), 1), s.door->activate()),
          CALL(s.hinge->enableMotor(true), s.hinge->setMaxMotorImpulse(1),
               s.hinge->setMotorTarget(btScalar(0.3), kCallFrame), s.door->activate()),
          CALL(s.hinge->setLimit(btScalar(0.1 + 0.1 * k), 1), s.door->activate()),
          CALL(s.hinge->setEnabled(false), s.door->activate()),
          CALL(s.hinge->setBreakingImpulseThreshold(btScalar(1e-6)), s.door->activate()),
          CALL(s.hinge->setParam(BT_CONSTRAINT_ERP, btScalar(0.01)),
               s.hinge->setParam(BT_CONSTRAINT_CFM, btScalar(0.5)), s.door->activate(),
               s.door->setLinearVelocity(kAside)),
          CALL(s.hinge->setOverrideNumSolverIterations(1), s.door->activate(), s.door->setLinearVelocity(kAside),
               s.door->setAngularVelocity(kAside)),
          CALL(s.hinge->setFrames(placedAt(0, 0.5, 0), s.hinge->getBFrame()), s.door->activate()),
          CALL(s.slider->setPoweredLinMotor(true), s.slider->setTargetLinMotorVelocity(btScalar(k + 1)),
               s.slider->setMaxLinMotorForce(100)),
          CALL(s.slider->setLowerLinLimit(btScalar(0.1 * (k + 1))), s.slider->setUpperLinLimit(1)),
          CALL(s.slider->setSoftnessOrthoLin(btScalar(0.1)), s.slider->setDampingDirLin(1),
               s.cart->setLinearVelocity(kAside)),
          CALL(s.six->enableMotor(5, true), s.six->setTargetVelocity(5, btScalar(k + 1)),
               s.six->setMaxMotorForce(5, 10), s.six->setLimit(5, 1, -1), s.sixFrame->activate()),
          CALL(s.six->setLimit(0, 1, -1), s.six->enableMotor(0, true), s.six->setServo(0, true),
               s.six->setServoTarget(0, btScalar(0.1 * (k + 1))), s.six->setTargetVelocity(0, 1),
               s.six->setMaxMotorForce(0, 100), s.sixFrame->activate()),
          CALL(s.six->setLimit(1, 1, -1), s.six->enableSpring(1, true), s.six->setStiffness(1, btScalar(10 * (k + 1))),
               s.six->setDamping(1, 1), s.six->setEquilibriumPoint(1, btScalar(0.1)), s.sixFrame->activate()),
          CALL(s.six->setLimit(0, btScalar(0.1 * k), btScalar(0.2)), s.sixFrame->activate()),
          {"removed",
           [](CallScene& s, int k) {
             k == 0 ? s.world.removeConstraint(s.hinge.get()) : s.world.removeConstraint(s.slider.get());
             s.door->activate();
           },
           Kind::Structure},
          CALL((void)s.spring->setTarget(btVector3(0, btScalar(1 + 0.1 * k), 1))),
          CALL((void)s.spring->setStiffness(0.5), (void)s.spring->setTarget(kAside)),
          CALL((void)s.spring->setMaxForce(50), (void)s.spring->setTarget(kAside)),
          CALL_THAT_IS(Structure, s.spring->release(), s.softBall().addVelocity(kAside)),
          CALL_THAT_IS(Structure, k == 0 ? void(s.weld = SurfaceWeld::add(s.world, s.top, *s.box).value())
                                         : s.softBall().addVelocity(kAside)),
          CALL((void)s.top.applyForce(300 * kAside, 5)),
          CALL((void)s.top.applyImpulse(10 * kAside)),
      },
      true);
}

TEST(RecordedCalls, OfContactsAndBodiesThatComeAndGo) {
  expectRepeats(
      {
          CALL_THAT_IS(Structure, s.ballContact.reset(), s.softBall().activate()),
          {"SurfaceContact, added",
           [](CallScene& s, int k) {
             if (k == 0)
               s.secondContact =
                   SurfaceContact::add(s.world, s.second->body(), *smallBall().binding, smallBall().mesh).value();
           },
           Kind::Structure},
          CALL_THAT_IS(Structure, s.contacts->remove(s.second->body()), s.softBall().addVelocity(kAside),
                       s.softBall().activate()),
          CALL_THAT_IS(Structure, (void)s.contacts->add(s.bar->body(), CallScene::shapeOf(smallBar())),
                       s.bar->body().activate(), s.bar->body().addVelocity(kAside)),
          {"a body, added",
           [](CallScene& s, int k) {
             if (k == 0) s.extra = s.soft(smallBall(), {0.1, 2, 0}, nullptr);
           },
           Kind::Structure},
          CALL_THAT_IS(Structure, k == 0 ? s.second.reset() : s.bar.reset()),
          {"a body, added and destroyed",
           [](CallScene& s, int k) {
             k == 0 ? void(s.extra = s.soft(smallBall(), {0.1, 2, 0}, nullptr)) : s.extra.reset();
             s.softBall().activate();
           },
           Kind::Structure},
      },
      true);
}

TEST(RecordedCalls, OfTheWorld) {
  const auto push = [](CallScene& s) {
    s.rider->activate(), s.rider->setLinearVelocity(-kAside), s.softBall().activate(),
        s.softBall().addVelocity(-kAside);
  };
  expectRepeats(
      {
          CALL(s.world.setGravity(btVector3(btScalar(k), -5, 0))),
          {"shiftOrigin",
           [](CallScene& s, int k) {
             s.plateState.setWorldTransform(s.plate->getWorldTransform());  // a restored snapshot does not contain it
             EXPECT_TRUE(shiftOrigin(s.world, btVector3(btScalar(4 + k), 0, -8)).ok());
           },
           Kind::Outside},
          CALL(s.world.getSolverInfo().m_numIterations = 2, push(s)),
          CALL(s.world.getSolverInfo().m_erp = s.world.getSolverInfo().m_erp2 = btScalar(0.9), push(s)),
          CALL(s.world.getSolverInfo().m_splitImpulse = 0, push(s)),
          CALL(s.world.getSolverInfo().m_solverMode |= SOLVER_RANDMIZE_ORDER, push(s)),
          CALL(s.world.getSolverInfo().m_globalCfm = btScalar(0.1), push(s)),
          CALL(s.world.getSolverInfo().m_warmstartingFactor = 0, push(s)),
          CALL(s.world.getDispatchInfo().m_allowedCcdPenetration = btScalar(0.2), push(s)),
          CALL(s.world.getDispatchInfo().m_enableSatConvex = true, push(s)),
          CALL(s.world.setImplicit(true), push(s)),
          CALL(s.world.setLineSearch(true), push(s)),
          CALL(s.world.setForceUpdateAllAabbs(false), push(s)),
          CALL(s.world.setLatencyMotionStateInterpolation(false), push(s)),
          CALL(s.world.setApplySpeculativeContactRestitution(true), push(s)),
          CALL(s.world.getWorldInfo().air_density = 3, s.world.getWorldInfo().m_maxDisplacement = 1, push(s)),
          CALL(s.box->applyCentralForce(kAside), s.world.clearForces(), push(s)),
          CALL(s.world.applyGravity(), s.box->activate(), push(s)),
          CALL_THAT_IS(Structure, s.world.deformableSolver().setDeterministic(true), push(s)),
          {"ForceRecord, added and destroyed",
           [=](CallScene& s, int k) {
             k == 0 ? void(s.record = ForceRecord::add(s.world).value()) : s.record.reset();
             push(s);
           }},
          CALL(s.world.setSynchronizeAllMotionStates(true), push(s)),
          CALL(s.world.getSolverInfo().m_deformable_erp = btScalar(0.5), push(s)),
          CALL(s.world.deformableSolver().setNodeNormals(false), push(s)),
          CALL(s.world.getSolverInfo().m_solverMode |= SOLVER_RANDMIZE_ORDER,
               s.world.constraintSolver().setRandSeed(77), push(s)),
          CALL(s.world.updateAabbs(), s.world.computeOverlappingPairs(), push(s)),
          CALL(s.world.performDiscreteCollisionDetection(), push(s)),
      },
      true);
}

TEST(RecordedCalls, OfMultibodiesAndAnchors) {
  expectRepeats(
      {
          CALL(s.arm->wakeUp(), s.arm->addBaseForce(20 * kAside)),
          CALL(s.arm->wakeUp(), s.arm->addBaseTorque(5 * kAside)),
          CALL(s.arm->wakeUp(), s.arm->addLinkForce(1, 20 * kAside)),
          CALL(s.arm->wakeUp(), s.arm->addLinkTorque(1, 5 * kAside)),
          CALL(s.arm->wakeUp(), s.arm->addJointTorque(0, 3)),
          CALL(s.arm->wakeUp(), s.arm->addJointTorqueMultiDof(1, 1, 3)),
          CALL(s.arm->wakeUp(), s.arm->setJointPos(0, btScalar(0.1 * (k + 1)))),
          CALL(s.arm->wakeUp(), s.arm->setJointVel(0, 2)),
          {"setJointVelMultiDof",
           [](CallScene& s, int) {
             const btScalar v[3] = {1, 2, 3};
             s.arm->wakeUp(), s.arm->setJointVelMultiDof(1, v);
           }},
          {"setJointPosMultiDof",
           [](CallScene& s, int) {
             const btScalar q[4] = {0, btScalar(0.6), 0, btScalar(0.8)};
             s.arm->wakeUp(), s.arm->setJointPosMultiDof(1, q);
           }},
          CALL(s.arm->wakeUp(), s.arm->setBasePos(s.arm->getBasePos() + kAside)),
          CALL(s.arm->wakeUp(), s.arm->setBaseVel(kAside)),
          CALL(s.arm->wakeUp(), s.arm->setBaseOmega(kAside)),
          CALL(s.arm->wakeUp(), s.arm->setWorldToBaseRot(btQuaternion(btVector3(0, 1, 0), 1))),
          CALL_THAT_IS(Unseen, s.arm->goToSleep()),
          CALL(s.arm->wakeUp(), s.arm->clearVelocities()),
          CALL(s.arm->wakeUp(), s.arm->setLinearDamping(btScalar(0.5)), s.arm->setAngularDamping(btScalar(0.5))),
          CALL(s.arm->wakeUp(), s.arm->getLink(1).m_mass = 3, s.arm->getLink(0).m_jointFriction = 1),
          CALL(s.arm->wakeUp(), s.motor->setVelocityTarget(btScalar(-1 - k))),
          CALL(s.arm->wakeUp(), s.motor->setPositionTarget(btScalar(0.4))),
          CALL(s.arm->wakeUp(), s.motor->setMaxAppliedImpulse(1)),
          CALL(s.arm->wakeUp(), s.limit->setLowerBound(btScalar(0.2))),
          CALL(s.arm->wakeUp(), s.links[1]->setFriction(0), s.links[1]->setRestitution(1)),
          {"joint, removed",
           [](CallScene& s, int k) {
             s.arm->wakeUp();
             if (k == 0) s.world.removeMultiBodyConstraint(s.motor);
           },
           Kind::Structure},
          {"anchor, added",
           [](CallScene& s, int k) {
             s.second->body().activate();
             if (k == 0) s.second->body().appendDeformableAnchor(5, s.spare);
           },
           Kind::Structure},
          CALL(s.spare->setWorldTransform(placedAt(3 - 0.1 * (k + 1), 0.25, 0)), s.spare->activate(),
               s.second->body().activate()),
          CALL(s.second->body().activate(), s.second->body().addVelocity(kAside)),
      },
      false);
}

}  // namespace
}  // namespace tetskin::test
