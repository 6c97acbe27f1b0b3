// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A table of what an application may call between steps to change a world, of this library's and of Bullet's. Each run
// is recorded, and played again to the last bit. And a snapshot from before the call, restored, with the call once
// more, and one from after it go on to the same bits.
#include "replay/recorded_calls.h"

namespace tetskin::test {
namespace {

const btVector3 kAside(btScalar(0.3), btScalar(0.5), btScalar(0.1));

TEST(RecordedCalls, OfADeformableBody) {
  expectRepeats(
      {
          {"setPinned", [](CallScene& s, int k) { (void)s.ball->setPinned(3 + k); }},
          {"setPinned(false)", [](CallScene& s, int) { (void)s.bar->setPinned(0, false); }},
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
          {"setGravity", [](CallScene& s, int k) { (void)s.ball->setGravity(btVector3(btScalar(k + 1), 1, 0)); }},
          {"followWorldGravity",
           [](CallScene& s, int k) {
             if (k == 0) (void)s.ball->setGravity(btVector3(1, 1, 0));
             if (k == 1) s.ball->followWorldGravity();
           }},
          {"setYoungsModulus", [](CallScene& s, int) { (void)s.ball->setYoungsModulus(3 * s.ball->youngsModulus()); }},
          {"setPoissonRatio", [](CallScene& s, int) { (void)s.ball->setPoissonRatio(0.45); }},
          {"setStiffnessDamping", [](CallScene& s, int) { (void)s.ball->setStiffnessDamping(0.1); }},
          {"teleport",
           [](CallScene& s, int k) {
             const btTransform motion(btQuaternion(btVector3(0, 1, 0), btScalar(0.4)), btVector3(0, btScalar(k), 0));
             EXPECT_TRUE(s.ball->teleport(motion).ok());
           }},
          {"teleport what is pinned",
           [](CallScene& s, int) { EXPECT_TRUE(s.bar->teleport(placedAt(0.1, 0.05, 0)).ok()); }},
          {"reset", [](CallScene& s, int) { EXPECT_TRUE(s.ball->reset().ok()); }},
          {"removeFromWorld and addToWorld",
           [](CallScene& s, int) {
             s.ball->removeFromWorld();
             EXPECT_TRUE(s.ball->addToWorld(s.world).ok());
           },
           Kind::Structure},
          {"reset what is pinned", [](CallScene& s, int) { EXPECT_TRUE(s.bar->reset().ok()); }},
      },
      true);
}

TEST(RecordedCalls, OfBulletsSoftBody) {
  expectRepeats(
      {
          {"m_x", [](CallScene& s, int) { s.node(4).m_x += kAside / 10; }},
          {"m_x and m_q", [](CallScene& s, int) { s.node(4).m_q = s.node(4).m_x += kAside / 10; }},
          {"m_x of a pinned node", [](CallScene& s, int) { s.bar->body().m_nodes[0].m_x += kAside / 50; }},
          {"m_v", [](CallScene& s, int) { s.node(4).m_v += kAside; }},
          {"m_v and m_vn", [](CallScene& s, int) { s.node(4).m_vn = s.node(4).m_v += kAside; }},
          {"m_v of a pinned node", [](CallScene& s, int) { s.bar->body().m_nodes[0].m_v = kAside / 10; }},
          {"translate", [](CallScene& s, int) { s.softBall().translate(kAside); }},
          {"translate what is pinned", [](CallScene& s, int) { s.bar->body().translate(kAside / 10); }},
          {"rotate", [](CallScene& s, int) { s.softBall().rotate(btQuaternion(btVector3(0, 1, 0), btScalar(0.4))); }},
          {"scale",
           [](CallScene& s, int) { s.softBall().scale(btVector3(btScalar(1.1), btScalar(1.1), btScalar(1.1))); },
           Kind::Structure},
          {"transform", [](CallScene& s, int) { s.softBall().transform(placedAt(0.1, 0.4, 0)); }},
          {"addForce", [](CallScene& s, int) { s.softBall().addForce(100 * kAside); }, Kind::Unseen},
          {"addForce to a node", [](CallScene& s, int) { s.softBall().addForce(100 * kAside, 5); }, Kind::Unseen},
          {"addVelocity", [](CallScene& s, int) { s.softBall().addVelocity(kAside); }},
          {"addVelocity to a node", [](CallScene& s, int) { s.softBall().addVelocity(kAside, 5); }},
          {"setVelocity", [](CallScene& s, int) { s.softBall().setVelocity(kAside); }},
          {"setLinearVelocity", [](CallScene& s, int) { s.softBall().setLinearVelocity(kAside); }},
          {"setAngularVelocity", [](CallScene& s, int) { s.softBall().setAngularVelocity(3 * kAside); }},
          {"setZeroVelocity", [](CallScene& s, int) { s.softBall().setZeroVelocity(); }},
          {"setMass", [](CallScene& s, int) { s.softBall().setMass(6, 40); }},
          {"setMass 0", [](CallScene& s, int k) { s.softBall().setMass(6, btScalar(k == 0 ? 0 : 9)); }},
          {"setTotalMass", [](CallScene& s, int) { s.softBall().setTotalMass(500); }},
          {"setTotalDensity", [](CallScene& s, int) { s.softBall().setTotalDensity(700); }},
          {"setSelfCollision", [](CallScene& s, int) { s.softBall().setSelfCollision(true); }, Kind::Unseen},
          {"setWindVelocity", [](CallScene& s, int) { s.softBall().setWindVelocity(kAside); }, Kind::Unseen},
          {"collisions", [](CallScene& s, int) { s.softBall().m_cfg.collisions |= btSoftBody::fCollision::SDF_RDF; },
           Kind::Unseen},
          {"generateClusters", [](CallScene& s, int) { s.softBall().generateClusters(2); }, Kind::Refused},
          {"kDF", [](CallScene& s, int) { s.softBall().m_cfg.kDF = btScalar(0.1); }},
          {"drag", [](CallScene& s, int) { s.softBall().m_cfg.drag = btScalar(0.05); }},
          {"setGravityFactor", [](CallScene& s, int) { s.softBall().setGravityFactor(btScalar(0.5)); }},
          {"setFriction", [](CallScene& s, int) { s.softBall().setFriction(0); }, Kind::Unseen},
          {"margin", [](CallScene& s, int) { s.softBall().getCollisionShape()->setMargin(btScalar(0.05)); }},
          {"activation state",
           [](CallScene& s, int k) { s.softBall().forceActivationState(k == 0 ? ISLAND_SLEEPING : ACTIVE_TAG); }},
          {"DISABLE_SIMULATION", [](CallScene& s, int) { s.softBall().forceActivationState(DISABLE_SIMULATION); }},
          {"activate",
           [](CallScene& s, int k) { s.softBall().activate(), s.softBall().addVelocity(btScalar(k) * kAside); }},
          {"setIgnoreCollisionCheck", [](CallScene& s, int) { s.softBall().setIgnoreCollisionCheck(s.box, true); }},
          {"m_collisionDisabledObjects",
           [](CallScene& s, int k) {
             if (k == 0) s.softBall().m_collisionDisabledObjects.push_back(s.box);
           }},
          {"filter of the proxy",
           [](CallScene& s, int) { s.softBall().getBroadphaseHandle()->m_collisionFilterMask = 0; }},
          {"CF_NO_CONTACT_RESPONSE",
           [](CallScene& s, int) {
             s.softBall().setCollisionFlags(s.softBall().getCollisionFlags() |
                                            btCollisionObject::CF_NO_CONTACT_RESPONSE);
           }},
      },
      true);
}

TEST(RecordedCalls, OfRigidBodies) {
  expectRepeats(
      {
          {"applyCentralForce", [](CallScene& s, int) { s.box->activate(), s.box->applyCentralForce(20 * kAside); }},
          {"applyForce",
           [](CallScene& s, int) { s.box->activate(), s.box->applyForce(20 * kAside, btVector3(0, 0, 1)); }},
          {"applyTorque", [](CallScene& s, int) { s.box->activate(), s.box->applyTorque(5 * kAside); }},
          {"applyCentralImpulse", [](CallScene& s, int) { s.box->activate(), s.box->applyCentralImpulse(kAside); }},
          {"applyImpulse",
           [](CallScene& s, int) { s.box->activate(), s.box->applyImpulse(kAside, btVector3(0, 0, 1)); }},
          {"applyTorqueImpulse", [](CallScene& s, int) { s.box->activate(), s.box->applyTorqueImpulse(kAside / 10); }},
          {"clearForces",
           [](CallScene& s, int) {
             s.box->applyCentralForce(kAside), s.box->clearForces();
             s.box->activate(), s.box->setLinearVelocity(kAside);
           }},
          {"setLinearVelocity", [](CallScene& s, int) { s.box->activate(), s.box->setLinearVelocity(kAside); }},
          {"setAngularVelocity", [](CallScene& s, int) { s.box->activate(), s.box->setAngularVelocity(kAside); }},
          {"setWorldTransform", [](CallScene& s, int k) { s.box->setWorldTransform(placedAt(0, 1.3 + 0.1 * k, 0)); }},
          {"setCenterOfMassTransform",
           [](CallScene& s, int) { s.box->setCenterOfMassTransform(placedAt(0.1, 1.3, 0)); }},
          {"setInterpolationWorldTransform",
           [](CallScene& s, int) {
             s.box->setWorldTransform(placedAt(0.1, 1.3, 0));
             s.box->setInterpolationWorldTransform(placedAt(0.1, 1.3, 0));
             s.box->activate();
           }},
          {"proceedToTransform",
           [](CallScene& s, int) { s.box->activate(), s.box->proceedToTransform(placedAt(0.1, 1.3, 0)); }},
          {"translate", [](CallScene& s, int) { s.box->activate(), s.box->translate(kAside); }},
          {"setDamping", [](CallScene& s, int) { s.box->setDamping(btScalar(0.5), btScalar(0.5)); }},
          {"setMassProps",
           [](CallScene& s, int) { s.box->setMassProps(5, btVector3(1, 1, 1)), s.box->updateInertiaTensor(); }},
          {"setGravity", [](CallScene& s, int) { s.box->setGravity(kAside); }},
          {"setLinearFactor", [](CallScene& s, int) { s.box->setLinearFactor(btVector3(1, 0, 1)); }},
          {"setAngularFactor",
           [](CallScene& s, int) {
             s.door->setAngularFactor(btScalar(0.5)), s.door->activate(), s.door->setAngularVelocity(kAside);
           }},
          {"friction",
           [](CallScene& s, int) { s.rider->setFriction(0), s.rider->activate(), s.rider->setLinearVelocity(kAside); }},
          {"rolling and spinning friction",
           [](CallScene& s, int) {
             s.rider->setRollingFriction(1), s.rider->setSpinningFriction(1), s.rider->activate(),
                 s.rider->setAngularVelocity(kAside);
           }},
          {"restitution",
           [](CallScene& s, int) {
             s.rider->setRestitution(1), s.plate->setRestitution(1), s.rider->activate(),
                 s.rider->setLinearVelocity(-kAside);
           }},
          {"contact stiffness",
           [](CallScene& s, int) {
             s.rider->setContactStiffnessAndDamping(100, 1), s.rider->activate(), s.rider->setLinearVelocity(-kAside);
           }},
          {"anisotropic friction",
           [](CallScene& s, int) {
             s.rider->setAnisotropicFriction(btVector3(0, 1, 1)), s.rider->activate(),
                 s.rider->setLinearVelocity(kAside / 10);
           }},
          {"sleeping thresholds",
           [](CallScene& s, int k) {
             s.rider->setSleepingThresholds(100, 100), s.rider->activate(),
                 s.rider->setLinearVelocity(btScalar(k) * kAside);
           }},
          {"activation states",
           [](CallScene& s, int k) { s.box->forceActivationState(k == 0 ? DISABLE_SIMULATION : ACTIVE_TAG); }},
          {"ISLAND_SLEEPING", [](CallScene& s, int) { s.box->forceActivationState(ISLAND_SLEEPING); }},
          {"setDeactivationTime",
           [](CallScene& s, int k) {
             s.rider->activate(), s.rider->setDeactivationTime(5),
                 s.rider->setLinearVelocity(btScalar(k) * kAside / 100);
           }},
          {"becomes kinematic",
           [](CallScene& s, int k) {
             s.box->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
             s.box->setWorldTransform(placedAt(0, 1.2 + 0.01 * k, 0)), s.box->activate();
           }},
          {"CF_NO_CONTACT_RESPONSE",
           [](CallScene& s, int) {
             s.box->setCollisionFlags(s.box->getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE),
                 s.box->activate();
           }},
          {"continuous detection",
           [](CallScene& s, int) {
             s.rider->setCcdMotionThreshold(btScalar(0.01)), s.rider->setCcdSweptSphereRadius(btScalar(0.1)),
                 s.rider->activate(), s.rider->setLinearVelocity(-40 * kAside);
           }},
          {"setIgnoreCollisionCheck",
           [](CallScene& s, int) { s.rider->setIgnoreCollisionCheck(s.plate, true), s.rider->activate(); }},
          {"setFlags",
           [](CallScene& s, int) {
             s.box->setFlags(BT_DISABLE_WORLD_GRAVITY), s.box->setGravity(btVector3(0, 0, 0)), s.box->activate();
           }},
          {"a motion state, given",
           [](CallScene& s, int k) {
             s.boxState.setWorldTransform(placedAt(0, 1.3 + 0.05 * k, 0)), s.box->setMotionState(&s.boxState),
                 s.box->activate();
           }},
          {"the motion state of what is kinematic",
           [](CallScene& s, int k) {
             s.plateState.setWorldTransform(placedAt(-2 + 0.02 * (k + 1), 0.2, 3)), s.rider->activate();
           },
           Kind::Outside},
          {"moves what is kinematic, without a motion state",
           [](CallScene& s, int k) {
             s.plate->setMotionState(nullptr), s.plate->setWorldTransform(placedAt(-2 + 0.02 * (k + 1), 0.2, 3)),
                 s.rider->activate();
           },
           Kind::Outside},
          {"setCollisionShape", [](CallScene& s, int) { s.box->setCollisionShape(&s.sphereShape), s.box->activate(); },
           Kind::Structure},
          {"scaling of a shape",
           [](CallScene& s, int k) {
             s.boxShape.setLocalScaling(btVector3(1, btScalar(1.1 + 0.1 * k), 1)), s.box->activate();
           },
           Kind::Structure},
          {"margin of a shape",
           [](CallScene& s, int) {
             s.boxShape.setMargin(btScalar(0.1)), s.box->activate(), s.rider->activate(),
                 s.rider->setLinearVelocity(-kAside);
           },
           Kind::Structure},
          {"a child of a compound, moved",
           [](CallScene& s, int k) {
             s.compound.updateChildTransform(0, placedAt(-0.2 - 0.05 * k, 0, 0)), s.pile->activate();
           },
           Kind::Structure},
          {"a child of a compound, added",
           [](CallScene& s, int k) {
             s.compound.addChildShape(placedAt(0, 0, 0.2 + 0.1 * k), &s.sphereShape), s.pile->activate();
           },
           Kind::Refused},
          {"removed", [](CallScene& s, int k) { s.world.removeRigidBody(k == 0 ? s.box : s.rider); }, Kind::Structure},
          {"added", [](CallScene& s, int k) { s.rigid(s.sphereShape, 1, placedAt(0.1, 2 + k, 0)); }, Kind::Structure},
          {"removed and added with another filter",
           [](CallScene& s, int k) {
             s.world.removeRigidBody(s.box), s.world.addRigidBody(s.box, 1, k == 0 ? 0 : -1), s.box->activate();
           },
           Kind::Structure},
      },
      true);
}

TEST(RecordedCalls, OfJoints) {
  expectRepeats(
      {
          {"hinge: motor",
           [](CallScene& s, int k) { s.hinge->enableAngularMotor(true, btScalar(k + 1), 1), s.door->activate(); }},
          {"hinge: motor's target",
           [](CallScene& s, int) {
             s.hinge->enableMotor(true), s.hinge->setMaxMotorImpulse(1),
                 s.hinge->setMotorTarget(btScalar(0.3), kCallFrame), s.door->activate();
           }},
          {"hinge: limit",
           [](CallScene& s, int k) { s.hinge->setLimit(btScalar(0.1 + 0.1 * k), 1), s.door->activate(); }},
          {"hinge: setEnabled", [](CallScene& s, int) { s.hinge->setEnabled(false), s.door->activate(); }},
          {"hinge: breaking threshold",
           [](CallScene& s, int) { s.hinge->setBreakingImpulseThreshold(btScalar(1e-6)), s.door->activate(); }},
          {"hinge: setParam",
           [](CallScene& s, int) {
             s.hinge->setParam(BT_CONSTRAINT_ERP, btScalar(0.01)), s.hinge->setParam(BT_CONSTRAINT_CFM, btScalar(0.5)),
                 s.door->activate(), s.door->setLinearVelocity(kAside);
           }},
          {"hinge: iterations",
           [](CallScene& s, int) {
             s.hinge->setOverrideNumSolverIterations(1), s.door->activate(), s.door->setLinearVelocity(kAside),
                 s.door->setAngularVelocity(kAside);
           }},
          {"hinge: frames",
           [](CallScene& s, int) {
             s.hinge->setFrames(placedAt(0, 0.5, 0), s.hinge->getBFrame()), s.door->activate();
           }},
          {"slider: motor",
           [](CallScene& s, int k) {
             s.slider->setPoweredLinMotor(true), s.slider->setTargetLinMotorVelocity(btScalar(k + 1)),
                 s.slider->setMaxLinMotorForce(100);
           }},
          {"slider: limits",
           [](CallScene& s, int k) {
             s.slider->setLowerLinLimit(btScalar(0.1 * (k + 1))), s.slider->setUpperLinLimit(1);
           }},
          {"slider: softness",
           [](CallScene& s, int) {
             s.slider->setSoftnessOrthoLin(btScalar(0.1)), s.slider->setDampingDirLin(1),
                 s.cart->setLinearVelocity(kAside);
           }},
          {"six: motor",
           [](CallScene& s, int k) {
             s.six->enableMotor(5, true), s.six->setTargetVelocity(5, btScalar(k + 1)), s.six->setMaxMotorForce(5, 10),
                 s.six->setLimit(5, 1, -1), s.sixFrame->activate();
           }},
          {"six: servo",
           [](CallScene& s, int k) {
             s.six->setLimit(0, 1, -1), s.six->enableMotor(0, true), s.six->setServo(0, true),
                 s.six->setServoTarget(0, btScalar(0.1 * (k + 1))), s.six->setTargetVelocity(0, 1),
                 s.six->setMaxMotorForce(0, 100), s.sixFrame->activate();
           }},
          {"six: spring",
           [](CallScene& s, int k) {
             s.six->setLimit(1, 1, -1), s.six->enableSpring(1, true), s.six->setStiffness(1, btScalar(10 * (k + 1))),
                 s.six->setDamping(1, 1), s.six->setEquilibriumPoint(1, btScalar(0.1)), s.sixFrame->activate();
           }},
          {"six: limit",
           [](CallScene& s, int k) { s.six->setLimit(0, btScalar(0.1 * k), btScalar(0.2)), s.sixFrame->activate(); }},
          {"removed",
           [](CallScene& s, int k) {
             k == 0 ? s.world.removeConstraint(s.hinge.get()) : s.world.removeConstraint(s.slider.get());
             s.door->activate();
           },
           Kind::Structure},
          {"spring: setTarget",
           [](CallScene& s, int k) { (void)s.spring->setTarget(btVector3(0, btScalar(1 + 0.1 * k), 1)); }},
          {"spring: setStiffness",
           [](CallScene& s, int) { (void)s.spring->setStiffness(0.5), (void)s.spring->setTarget(kAside); }},
          {"spring: setMaxForce",
           [](CallScene& s, int) { (void)s.spring->setMaxForce(50), (void)s.spring->setTarget(kAside); }},
          {"spring: release", [](CallScene& s, int) { s.spring->release(), s.softBall().addVelocity(kAside); },
           Kind::Structure},
          {"weld: added",
           [](CallScene& s, int k) {
             k == 0 ? void(s.weld = SurfaceWeld::add(s.world, s.top, *s.box).value())
                    : s.softBall().addVelocity(kAside);
           },
           Kind::Structure},
          {"applyForce", [](CallScene& s, int) { (void)s.top.applyForce(300 * kAside, 5); }},
          {"applyImpulse", [](CallScene& s, int) { (void)s.top.applyImpulse(10 * kAside); }},
      },
      true);
}

TEST(RecordedCalls, OfContactsAndBodiesThatComeAndGo) {
  expectRepeats(
      {
          {"SurfaceContact, destroyed", [](CallScene& s, int) { s.ballContact.reset(), s.softBall().activate(); },
           Kind::Structure},
          {"SurfaceContact, added",
           [](CallScene& s, int k) {
             if (k == 0)
               s.secondContact =
                   SurfaceContact::add(s.world, s.second->body(), *smallBall().binding, smallBall().mesh).value();
           },
           Kind::Structure},
          {"SoftContacts: remove",
           [](CallScene& s, int) {
             s.contacts->remove(s.second->body()), s.softBall().addVelocity(kAside), s.softBall().activate();
           },
           Kind::Structure},
          {"SoftContacts: add",
           [](CallScene& s, int) {
             (void)s.contacts->add(s.bar->body(), CallScene::shapeOf(smallBar())), s.bar->body().activate(),
                 s.bar->body().addVelocity(kAside);
           },
           Kind::Structure},
          {"a body, added",
           [](CallScene& s, int k) {
             if (k == 0) s.extra = s.soft(smallBall(), {0.1, 2, 0}, nullptr);
           },
           Kind::Structure},
          {"a body, destroyed", [](CallScene& s, int k) { k == 0 ? s.second.reset() : s.bar.reset(); },
           Kind::Structure},
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
          {"setGravity", [](CallScene& s, int k) { s.world.setGravity(btVector3(btScalar(k), -5, 0)); }},
          {"shiftOrigin",
           [](CallScene& s, int k) {
             s.plateState.setWorldTransform(s.plate->getWorldTransform());  // a restored snapshot does not tell it
             EXPECT_TRUE(shiftOrigin(s.world, btVector3(btScalar(4 + k), 0, -8)).ok());
           },
           Kind::Outside},
          {"m_numIterations", [=](CallScene& s, int) { s.world.getSolverInfo().m_numIterations = 2, push(s); }},
          {"m_erp",
           [=](CallScene& s, int) {
             s.world.getSolverInfo().m_erp = s.world.getSolverInfo().m_erp2 = btScalar(0.9), push(s);
           }},
          {"m_splitImpulse", [=](CallScene& s, int) { s.world.getSolverInfo().m_splitImpulse = 0, push(s); }},
          {"m_solverMode",
           [=](CallScene& s, int) { s.world.getSolverInfo().m_solverMode |= SOLVER_RANDMIZE_ORDER, push(s); }},
          {"m_globalCfm", [=](CallScene& s, int) { s.world.getSolverInfo().m_globalCfm = btScalar(0.1), push(s); }},
          {"m_warmstartingFactor",
           [=](CallScene& s, int) { s.world.getSolverInfo().m_warmstartingFactor = 0, push(s); }},
          {"getDispatchInfo",
           [=](CallScene& s, int) { s.world.getDispatchInfo().m_allowedCcdPenetration = btScalar(0.2), push(s); }},
          {"m_enableSatConvex",
           [=](CallScene& s, int) { s.world.getDispatchInfo().m_enableSatConvex = true, push(s); }},
          {"setImplicit", [=](CallScene& s, int) { s.world.setImplicit(true), push(s); }},
          {"setLineSearch", [=](CallScene& s, int) { s.world.setLineSearch(true), push(s); }},
          {"setForceUpdateAllAabbs", [=](CallScene& s, int) { s.world.setForceUpdateAllAabbs(false), push(s); }},
          {"setLatencyMotionStateInterpolation",
           [=](CallScene& s, int) { s.world.setLatencyMotionStateInterpolation(false), push(s); }},
          {"setApplySpeculativeContactRestitution",
           [=](CallScene& s, int) { s.world.setApplySpeculativeContactRestitution(true), push(s); }},
          {"getWorldInfo",
           [=](CallScene& s, int) {
             s.world.getWorldInfo().air_density = 3, s.world.getWorldInfo().m_maxDisplacement = 1, push(s);
           }},
          {"clearForces", [=](CallScene& s, int) { s.box->applyCentralForce(kAside), s.world.clearForces(), push(s); }},
          {"applyGravity", [=](CallScene& s, int) { s.world.applyGravity(), s.box->activate(), push(s); }},
          {"setDeterministic", [=](CallScene& s, int) { s.world.deformableSolver().setDeterministic(true), push(s); },
           Kind::Structure},
          {"ForceRecord, added and destroyed",
           [=](CallScene& s, int k) {
             k == 0 ? void(s.record = ForceRecord::add(s.world).value()) : s.record.reset();
             push(s);
           }},
          {"setSynchronizeAllMotionStates",
           [=](CallScene& s, int) { s.world.setSynchronizeAllMotionStates(true), push(s); }},
          {"m_deformable_erp",
           [=](CallScene& s, int) { s.world.getSolverInfo().m_deformable_erp = btScalar(0.5), push(s); }},
          {"setNodeNormals", [=](CallScene& s, int) { s.world.deformableSolver().setNodeNormals(false), push(s); }},
          {"setRandSeed",
           [=](CallScene& s, int) {
             s.world.getSolverInfo().m_solverMode |= SOLVER_RANDMIZE_ORDER, s.world.constraintSolver().setRandSeed(77),
                 push(s);
           }},
          {"computeOverlappingPairs",
           [=](CallScene& s, int) { s.world.updateAabbs(), s.world.computeOverlappingPairs(), push(s); }},
          {"performDiscreteCollisionDetection",
           [=](CallScene& s, int) { s.world.performDiscreteCollisionDetection(), push(s); }},
      },
      true);
}

TEST(RecordedCalls, OfMultibodiesAndAnchors) {
  expectRepeats(
      {
          {"addBaseForce", [](CallScene& s, int) { s.arm->wakeUp(), s.arm->addBaseForce(20 * kAside); }},
          {"addBaseTorque", [](CallScene& s, int) { s.arm->wakeUp(), s.arm->addBaseTorque(5 * kAside); }},
          {"addLinkForce", [](CallScene& s, int) { s.arm->wakeUp(), s.arm->addLinkForce(1, 20 * kAside); }},
          {"addLinkTorque", [](CallScene& s, int) { s.arm->wakeUp(), s.arm->addLinkTorque(1, 5 * kAside); }},
          {"addJointTorque", [](CallScene& s, int) { s.arm->wakeUp(), s.arm->addJointTorque(0, 3); }},
          {"addJointTorqueMultiDof",
           [](CallScene& s, int) { s.arm->wakeUp(), s.arm->addJointTorqueMultiDof(1, 1, 3); }},
          {"setJointPos", [](CallScene& s, int k) { s.arm->wakeUp(), s.arm->setJointPos(0, btScalar(0.1 * (k + 1))); }},
          {"setJointVel", [](CallScene& s, int) { s.arm->wakeUp(), s.arm->setJointVel(0, 2); }},
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
          {"setBasePos", [](CallScene& s, int) { s.arm->wakeUp(), s.arm->setBasePos(s.arm->getBasePos() + kAside); }},
          {"setBaseVel", [](CallScene& s, int) { s.arm->wakeUp(), s.arm->setBaseVel(kAside); }},
          {"setBaseOmega", [](CallScene& s, int) { s.arm->wakeUp(), s.arm->setBaseOmega(kAside); }},
          {"setWorldToBaseRot",
           [](CallScene& s, int) { s.arm->wakeUp(), s.arm->setWorldToBaseRot(btQuaternion(btVector3(0, 1, 0), 1)); }},
          {"goToSleep", [](CallScene& s, int) { s.arm->goToSleep(); }, Kind::Unseen},
          {"clearVelocities", [](CallScene& s, int) { s.arm->wakeUp(), s.arm->clearVelocities(); }},
          {"damping",
           [](CallScene& s, int) {
             s.arm->wakeUp(), s.arm->setLinearDamping(btScalar(0.5)), s.arm->setAngularDamping(btScalar(0.5));
           }},
          {"link's mass and friction",
           [](CallScene& s, int) {
             s.arm->wakeUp(), s.arm->getLink(1).m_mass = 3, s.arm->getLink(0).m_jointFriction = 1;
           }},
          {"motor: velocity",
           [](CallScene& s, int k) { s.arm->wakeUp(), s.motor->setVelocityTarget(btScalar(-1 - k)); }},
          {"motor: position", [](CallScene& s, int) { s.arm->wakeUp(), s.motor->setPositionTarget(btScalar(0.4)); }},
          {"motor: maximum", [](CallScene& s, int) { s.arm->wakeUp(), s.motor->setMaxAppliedImpulse(1); }},
          {"limit", [](CallScene& s, int) { s.arm->wakeUp(), s.limit->setLowerBound(btScalar(0.2)); }},
          {"collider's friction",
           [](CallScene& s, int) { s.arm->wakeUp(), s.links[1]->setFriction(0), s.links[1]->setRestitution(1); }},
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
          {"anchor's object, moved",
           [](CallScene& s, int k) {
             s.spare->setWorldTransform(placedAt(3 - 0.1 * (k + 1), 0.25, 0)), s.spare->activate(),
                 s.second->body().activate();
           }},
          {"anchored body, pushed",
           [](CallScene& s, int) { s.second->body().activate(), s.second->body().addVelocity(kAside); }},
      },
      false);
}

}  // namespace
}  // namespace tetskin::test
