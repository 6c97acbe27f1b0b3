// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Contacts and anchors of nodes with rigid bodies, in scenes whose results can be checked by hand.
#include "recorded_forces.h"
#include "rigid_bodies.h"

namespace tetskin::test {
namespace {

std::unique_ptr<btCollisionShape> plate() {
  return std::make_unique<btBoxShape>(btVector3(btScalar(0.6), btScalar(0.05), btScalar(0.6)));
}

double distance(const btVector3& a, const btVector3& b) {
  return static_cast<double>((a - b).length());
}

TEST(SolverContacts, KeepMomentumAndAngularMomentum) {
  for (const double mass : {0.05, 1.0, 20.0}) {
    FlyingBlock item;
    Rigid rigid(item.world, ball(), static_cast<btScalar>(mass),
                btVector3(btScalar(0.25), btScalar(4.7), btScalar(0.1)));
    item.body().setVelocity(btVector3(0, -2, 0));
    const btVector3 momentum = momentumOf(item.body()), spin = spinOf(item.body());
    double lost = 0.0, lostSpin = 0.0, turned = 0.0;
    forEachSubstep(item.world, 60, [&] {
      lost = std::max(lost, distance(momentumOf(item.body()) + rigid.momentum(), momentum));
      lostSpin = std::max(lostSpin, distance(spinOf(item.body()) + rigid.spin(), spin));
      turned = std::max(turned, distance(spinOf(item.body()), spin));
      EXPECT_EQ(item.world.bodySolver().unconvergedSystems(), 0);
    });
    EXPECT_GT(turned, 0.01) << "they have met";
    EXPECT_LT(lost, 1e-5 * 2.0) << mass;
    EXPECT_LT(lostSpin, 1e-5 * 2.0 * 5.0) << mass << ", at five metres";
  }
}

/// Rounding in the stiffness of a body is not taken for the mass of a component, whichever it is.
TEST(SolverContacts, BringABodyOfManyStiffComponentsToRest) {
  for (const double modulus : {1e7, 1e9, 1e11}) {
    TetskinWorld world;
    SoftBodyOptions options;
    options.youngsModulus = modulus;
    options.margin = 0.02;
    const auto body = added(world, twoComponents(twoComponents(twoComponents(smallCageAbove(0.1)))), options);
    step(world, 60);
    double fastest = 0.0;
    for (int f = 0; f < 20; ++f) {
      step(world, 1);
      fastest = std::max(fastest, rmsSpeed(body->body()));
    }
    EXPECT_LT(fastest, 0.01) << modulus;
    EXPECT_NEAR(lowest(body->body()), 0.0, 0.03) << modulus;
  }
}

TEST(SolverContacts, HoldABodyOnAPlateThatLiesOnTheFloor) {
  for (const btScalar mass : {btScalar(0.1), btScalar(3)}) {
    FlyingBlock item(0.13);
    item.world.deformable().setGravity(btVector3(0, -10, 0));
    Rigid under(item.world, plate(), mass, btVector3(0, btScalar(0.05), 0));
    forEachSubstep(item.world, 240, [] {});
    double highest = 0.0, lowest = 1.0, fastest = 0.0;
    forEachSubstep(item.world, 24, [&] {
      highest = std::max(highest, under.height());
      lowest = std::min(lowest, under.height());
      fastest = std::max(fastest, test::rmsSpeed(item.body()));
    });
    EXPECT_GT(lowest, 0.05 - 0.001);
    EXPECT_LT(highest, 0.05 + 0.001);
    EXPECT_LT(fastest, 0.005);
    EXPECT_LT(under.body->getAngularVelocity().length(), 0.01);
  }
}

/// A bar of 1 kg and a box of 2 kg hang from four nodes and stretch the bar by (M + m / 2) g L / (E A).
TEST(SolverContacts, HangABoxByAnchorsAsFarAsByHand) {
  TetskinWorld world;
  TetMesh cage = shifted(latticeCage(1, 4, 1, 0.25), Eigen::Vector3d(-0.125, 2, -0.125));
  SoftBodyOptions options;
  options.youngsModulus = 2e4;
  options.poissonRatio = 0;
  options.stiffnessDamping = 0.08;
  options.pinned = [](const Eigen::Vector3d& p) { return p.y() > 2.99; };
  const auto bar = added(world, cage, options);
  btSoftBody& soft = bar->body();
  Rigid box(world, std::make_unique<btBoxShape>(btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2))), 2,
            btVector3(0, btScalar(1.8), 0));
  world.deformable().removeRigidBody(box.body.get());
  world.deformable().addRigidBody(box.body.get(), 2, 0);  // anchored, and in contact with nothing
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    if (soft.m_nodes[n].m_x.y() < btScalar(2.01)) soft.appendDeformableAnchor(n, box.body.get());
  }
  ASSERT_EQ(soft.m_deformableAnchors.size(), 4);
  forEachSubstep(world, 360, [] {});
  double mass = 0.0, moment = 0.0;  // of the bar's free nodes; the moment is about its top
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    const double m = soft.m_nodes[n].m_im > 0 ? 1.0 / static_cast<double>(soft.m_nodes[n].m_im) : 0.0;
    mass += m;
    moment += m * (3.0 - cage.nodes[static_cast<std::size_t>(n)].y());
  }
  EXPECT_NEAR(moment, 0.5, 0.1) << mass;
  const double byHand = (2.0 * 1.0 + moment) * 10.0 / (2e4 * 0.0625);
  EXPECT_NEAR(1.8 - box.height(), byHand, 0.01 * byHand);
  EXPECT_LT(box.body->getLinearVelocity().length(), 0.002);
  EXPECT_LT(box.body->getAngularVelocity().length(), 0.005);
  soft.m_deformableAnchors.clear();
}

/// A block falls onto a box.
struct Landing {
  Landing() : item(0.35), box(item.world, plate(), btScalar(0.5), btVector3(btScalar(0.1), btScalar(0.05), 0)) {
    item.world.deformable().setGravity(btVector3(0, -10, 0));
  }
  void step() {
    forEachSubstep(item.world, 1, [] {});
  }
  /// Positions of the nodes, followed by the box.
  std::vector<btVector3> positions() {
    std::vector<btVector3> all = nodesOf(item.body());
    all.push_back(box.body->getWorldTransform().getOrigin());
    for (int k = 0; k < 3; ++k) all.push_back(box.body->getWorldTransform().getBasis()[k]);
    return all;
  }

  FlyingBlock item;
  Rigid box;
};

TEST(SolverContacts, InATriggerHaveTheSameBits) {
  const auto positionsWith = [](bool trigger) {
    Landing scene;
    std::unique_ptr<Rigid> around;
    if (trigger) {
      around = std::make_unique<Rigid>(scene.item.world, std::make_unique<btBoxShape>(btVector3(5, 5, 5)), 0,
                                       btVector3(0, 0, 0));
      around->body->setCollisionFlags(around->body->getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
    }
    for (int k = 0; k < 120; ++k) scene.step();
    return scene.positions();
  };
  const auto without = positionsWith(false);
  EXPECT_LT(without[0].y(), 0.2) << "it has landed";
  EXPECT_EQ(positionsWith(true), without);
}

TEST(SolverContacts, OfTwoWorldsDoNotKnowEachOther) {
  const auto alone = [] {
    Landing scene;
    for (int k = 0; k < 100; ++k) scene.step();
    return scene.positions();
  }();
  Landing first;
  auto second = std::make_unique<Landing>();
  for (int k = 0; k < 100; ++k) {
    first.step();
    if (k < 60) second->step();
    if (k == 60) second.reset();
  }
  EXPECT_EQ(first.positions(), alone);
}

/// A block of 1 kg lies on a plate of 1 kg that a motor holds level, 0.6 m from its hinge: 12 Nm, 0.05 Nms per step.
TEST(SolverContacts, AreHeldByAHingeAsFarAsItsMotorCan) {
  for (const double maximum : {0.2, 0.02}) {
    FlyingBlock item(0.57);
    item.world.deformable().setGravity(btVector3(0, -10, 0));
    Rigid lever(item.world, plate(), 1, btVector3(0, btScalar(0.5), 0));
    const btVector3 pivot(btScalar(-0.6), 0, 0);
    btHingeConstraint hinge(*lever.body, pivot, btVector3(0, 0, 1));
    hinge.enableAngularMotor(true, 0, static_cast<btScalar>(maximum));
    item.world.deformable().addConstraint(&hinge);
    double apart = 0.0;
    forEachSubstep(item.world, 100, [&] {
      apart = std::max(apart,
                       distance(lever.body->getWorldTransform() * pivot, btVector3(btScalar(-0.6), btScalar(0.5), 0)));
    });
    if (maximum > 0.05) {
      EXPECT_NEAR(lever.height(), 0.5, 0.002);
      EXPECT_GT(test::lowest(item.body()), 0.54);
      EXPECT_LT(test::rmsSpeed(item.body()), 0.02);
    } else {
      EXPECT_LT(lever.height(), 0.4) << "more than it can";
    }
    EXPECT_LT(apart, 0.003) << "it stays on its hinge";
    item.world.deformable().removeConstraint(&hinge);
  }
}

/// A plate on a vertical slider above a block of 1 kg and 0.9 m, which lies on the floor.
struct SliderPress {
  explicit SliderPress(btScalar mass) : plate(block.world, test::plate(), mass, btVector3(0, 1, 0)) {
    block.world.deformable().setGravity(btVector3(0, -10, 0));
    block.body().setActivationState(DISABLE_DEACTIVATION);
    slider.setLowerLinLimit(-1);
    slider.setUpperLinLimit(1);
    block.world.deformable().addConstraint(&slider);
  }
  ~SliderPress() { block.world.deformable().removeConstraint(&slider); }
  void run(int frames, int substeps) {
    const btScalar frame = btScalar(1) / btScalar(60);
    for (int k = 0; k < frames; ++k) {
      block.world.deformable().stepSimulation(frame, substeps, frame / static_cast<btScalar>(substeps));
    }
  }
  /// Newtons on the floor.
  double onFloor() { return -static_cast<double>(forces->forcesOn(test::floorOf(block.world)).total().force.y()); }

  FlyingBlock block{0.02};
  std::unique_ptr<ForceRecord> forces = test::forcesIn(block.world);
  Rigid plate;
  btSliderConstraint slider{*plate.body, btTransform(btQuaternion(btVector3(0, 0, 1), SIMD_HALF_PI)), true};
};

/// It rests then, and the floor carries both weights and the motor's largest force, whatever the substeps are.
TEST(SolverContacts, ArePressedByAMotorNoMoreThanItMay) {
  for (const double force : {0.0, 10.0, 40.0}) {
    for (const int substeps : {2, 8}) {
      SliderPress press(1);
      press.slider.setPoweredLinMotor(true);
      press.slider.setMaxLinMotorForce(static_cast<btScalar>(force));
      press.slider.setTargetLinMotorVelocity(-1);
      press.run(300, substeps);
      EXPECT_NEAR(press.onFloor(), 20.0 + force, 0.02 * (20.0 + force)) << force << " N, " << substeps << " substeps";
      EXPECT_LT(press.plate.body->getLinearVelocity().length(), 0.002);
    }
  }
}

/// The same by a joint of six degrees of freedom, several of whose rows are bounded, and whose axes are turned.
TEST(SolverContacts, ArePressedByAMotorOfSeveralNoMoreThanItMay) {
  SliderPress press(1);
  press.block.world.deformable().removeConstraint(&press.slider);
  const btTransform turned(btQuaternion(btVector3(0, 0, 1), SIMD_HALF_PI));  // its x is up
  btGeneric6DofConstraint joint(*press.plate.body, turned, true);
  joint.setLinearLowerLimit(btVector3(1, 0, 0));  // free along x, as the lower limit is above the upper one
  joint.setLinearUpperLimit(btVector3(-1, 0, 0));
  joint.setAngularLowerLimit(btVector3(0, 0, 0));
  joint.setAngularUpperLimit(btVector3(0, 0, 0));
  btTranslationalLimitMotor& motor = *joint.getTranslationalLimitMotor();
  motor.m_enableMotor[0] = true;
  motor.m_maxMotorForce[0] = 30;
  press.block.world.deformable().addConstraint(&joint);
  double carried[2];
  for (const int k : {0, 1}) {
    motor.m_targetVelocity[0] = k == 0 ? btScalar(1) : btScalar(-1);  // of the world, seen from the plate
    press.run(240, 4);
    carried[k] = press.onFloor();
    if (k == 0) motor.m_maxMotorForce[0] = 5;  // then it pulls, too weakly to lift
  }
  press.block.world.deformable().removeConstraint(&joint);
  press.block.world.deformable().addConstraint(&press.slider);
  EXPECT_NEAR(carried[0], 20.0 + 30.0, 1.0);
  EXPECT_NEAR(carried[1], 20.0 - 5.0, 0.3);
}

/// A motor that holds its place against a block, and against gravity, as long as it may.
TEST(SolverContacts, AreHeldByAMotorThatHasForceLeft) {
  SliderPress press(1);
  press.run(240, 4);
  const double height = press.plate.height();
  press.slider.setPoweredLinMotor(true);
  press.slider.setMaxLinMotorForce(1000);
  press.slider.setTargetLinMotorVelocity(0);
  press.run(60, 4);
  EXPECT_NEAR(press.plate.height(), height, 1e-3);
}

/// Heavy plates lie on the stop of their slider, 3 cm below the block's top: the block takes a part of the weight off
/// the stop, the same of each, and lifts none.
TEST(SolverContacts, TakeOffAStopWhatTheyPushAndNoMore) {
  double onBlock[2];
  for (const int k : {0, 1}) {
    SliderPress press(k == 0 ? btScalar(50) : btScalar(400));
    press.slider.setLowerLinLimit(btScalar(-0.08));
    press.run(300, 4);
    EXPECT_NEAR(press.plate.height(), 0.92, 0.001);
    // Bullet's stop is there only while it is overstepped: no more than a fraction of what gravity adds in a step.
    EXPECT_LT(press.plate.body->getLinearVelocity().length(), 0.25 * 10.0 / 240.0);
    onBlock[k] = press.onFloor() - 10.0;
  }
  EXPECT_GT(onBlock[0], 20.0);
  EXPECT_NEAR(onBlock[0], onBlock[1], 0.01 * onBlock[1]);
}

}  // namespace
}  // namespace tetskin::test
