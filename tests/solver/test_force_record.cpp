// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Forces between bodies in contact at their nodes, as ForceRecord reports them.
#include "recorded_forces.h"
#include "rigid_bodies.h"

#include <LinearMath/btIDebugDraw.h>

namespace tetskin::test {
namespace {

/// The body's centre of mass.
btVector3 centroidOf(const btSoftBody& body) {
  btVector3 sum(0, 0, 0);
  for (int n = 0; n < body.m_nodes.size(); ++n) sum += body.m_nodes[n].m_x / body.m_nodes[n].m_im;
  return sum;
}

/// A block that rests on the floor and does not sleep.
struct RestingBlock {
  explicit RestingBlock(int frames = 240) {
    block->body().setActivationState(DISABLE_DEACTIVATION);
    step(world, frames);
  }
  AppliedForces onFloor() { return forces->forcesOn(floorOf(world)); }

  TetskinWorld world;
  std::unique_ptr<DeformableBody> block = added(world, smallCageAbove(0.03));
  std::unique_ptr<ForceRecord> forces = forcesIn(world);
};

// ---- statics

TEST(ForceRecord, AtRestTheSumOfForcesIsTheWeight) {
  RestingBlock at;
  const AppliedForces floor = at.onFloor();
  expectNear(floor.total().force, btVector3(0, -kWeight, 0), 1e-3 * kWeight);
  EXPECT_NEAR(floor.contact.force.y(), -kWeight, 1e-3 * kWeight);
  EXPECT_TRUE(isNothing({{}, {}, floor.joints, floor.anchors}));
  // The floor's centre is the origin of its frame, 1 below its surface.
  expectNear(floor.total().torque, btVector3(0.3, -0.5, 0.45).cross(btVector3(0, -kWeight, 0)), 0.01 * kWeight);
  const AppliedForces block = at.forces->forcesOn(at.block->body());
  expectNear(block.total().force, -floor.total().force, 1e-6);
  expectNear(block.total().torque, btVector3(0, 0, 0), 5e-3 * kWeight);
  const AppliedForces pair = at.forces->forcesBetween(floorOf(at.world), at.block->body());
  EXPECT_EQ(pair.total().force, floor.total().force);
  EXPECT_TRUE(isNothing(at.forces->forcesBetween(at.block->body(), at.block->body())));
}

TEST(ForceRecord, TwoSupportsShareTheWeightByTheLeverRule) {
  TetskinWorld world;
  TetMesh cage = shifted(latticeCage(10, 2, 2, 0.1), Eigen::Vector3d(-0.5, 2.01, -0.1));
  SoftBodyOptions stiff;
  stiff.relativeStiffness = 1000;
  // The bar is heavier at one end.
  for (const Eigen::Vector3d& p : cage.nodes) stiff.nodeMasses.push_back((1 + p.x()) / double(cage.nodeCount()));
  const auto bar = added(world, cage, stiff);
  bar->body().setActivationState(DISABLE_DEACTIVATION);
  const auto support = [] { return std::make_unique<btBoxShape>(btVector3(0.5, 0.5, 0.5)); };
  Rigid left(world, support(), 0, btVector3(-0.75, 1.48, 0)), right(world, support(), 0, btVector3(0.85, 1.48, 0));
  const auto forces = forcesIn(world);
  step(world, 240);
  // The position along the bar at which a support pushes, from its force and torque: the contact is at the bar's
  // underside.
  const btVector3 centre = centroidOf(bar->body());
  const auto arm = [&](const Rigid& under) {
    const Wrench on = forces->forcesOn(*under.body).total();
    const btVector3 origin = under.body->getWorldTransform().getOrigin();
    const double height = lowest(bar->body()) - static_cast<double>(origin.y());
    const double x = (static_cast<double>(on.torque.z()) + height * static_cast<double>(on.force.x())) /
                     static_cast<double>(on.force.y());
    return static_cast<double>(origin.x() - centre.x()) + x;
  };
  const double a = -arm(left), b = arm(right);
  EXPECT_GT(a, b + 0.09);
  const btVector3 onLeft = forces->forcesOn(*left.body).total().force,
                  onRight = forces->forcesOn(*right.body).total().force;
  EXPECT_NEAR(-onLeft.y(), kWeight * b / (a + b), 0.01 * kWeight * b / (a + b));
  EXPECT_NEAR(-onRight.y(), kWeight * a / (a + b), 0.01 * kWeight * a / (a + b));
  expectNear(onLeft + onRight, btVector3(0, -kWeight, 0), 1e-3 * kWeight);
}

TEST(ForceRecord, TellsAnchorsFromContacts) {
  TetskinWorld world;
  const auto block = added(world, smallCageAbove(3));
  btSoftBody& soft = block->body();
  soft.setActivationState(DISABLE_DEACTIVATION);
  Rigid hook(world, ball(), 0, btVector3(0.3, 6, 0.45));
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    if (soft.m_nodes[n].m_x.y() > btScalar(3.59)) soft.appendDeformableAnchor(n, hook.body.get());
  }
  const auto forces = forcesIn(world);
  step(world, 480);
  const AppliedForces onHook = forces->forcesOn(*hook.body);
  expectNear(onHook.anchors.force, btVector3(0, -kWeight, 0), 1e-3 * kWeight);
  expectNear(onHook.anchors.torque, btVector3(0, 0, 0), 0.01 * kWeight);
  EXPECT_TRUE(isNothing({onHook.contact, onHook.friction, onHook.joints, {}}));
}

// ---- dynamics

/// A block flies without gravity at a ball and hits it beside its centre.
TEST(ForceRecord, IsTheChangeOfMomentumOverAStepSimulation) {
  FlyingBlock flying(5.0);
  Rigid target(flying.world, ball(), 2, btVector3(0.2, 4.6, 0.1));
  const auto forces = forcesIn(flying.world);
  for (int n = 0; n < flying.body().m_nodes.size(); ++n) flying.body().m_nodes[n].m_v = btVector3(1, -4, 0);
  double pushed = 0, turned = 0;
  for (int f = 0; f < 60; ++f) {
    const btVector3 softBefore = momentumOf(flying.body()), rigidBefore = target.momentum();
    const btVector3 spinBefore = target.body->getAngularVelocity();
    step(flying.world, 1);
    const Wrench onRigid = forces->forcesOn(*target.body).total(), onSoft = forces->forcesOn(flying.body()).total();
    expectNear(onRigid.force / 60, target.momentum() - rigidBefore, 1e-4);
    expectNear(onSoft.force / 60, momentumOf(flying.body()) - softBefore, 1e-4);
    const btVector3 spin = target.body->getLocalInertia() * (target.body->getAngularVelocity() - spinBefore);
    expectNear(onRigid.torque / 60, spin, 1e-5);
    pushed = std::max(pushed, static_cast<double>(onRigid.force.length() / 60));
    turned = std::max(turned, static_cast<double>(onRigid.torque.length() / 60));
  }
  EXPECT_GT(pushed, 0.4);
  EXPECT_GT(turned, 1e-3);
}

TEST(ForceRecord, IsTheMeanOverAllSubstepsOfTheLastStepSimulation) {
  TetskinWorld world[2];
  std::unique_ptr<DeformableBody> block[2];
  std::unique_ptr<ForceRecord> forces[2];
  for (int k = 0; k < 2; ++k) {
    block[k] = added(world[k], smallCageAbove(0.1));
    block[k]->body().setActivationState(DISABLE_DEACTIVATION);  // the two would fall asleep in different substeps
    forces[k] = forcesIn(world[k]);
  }
  int met = 0;
  for (int f = 0; f < 60; ++f) {
    step(world[0], 1);
    btVector3 sum(0, 0, 0);
    forEachSubstep(world[1], 4, [&] { sum += forces[1]->forcesOn(floorOf(world[1])).total().force; });
    const btVector3 mean = forces[0]->forcesOn(floorOf(world[0])).total().force;
    expectNear(mean, sum / 4, 1e-4 * (1 + static_cast<double>(sum.length())));
    met += !mean.isZero();
  }
  EXPECT_GT(met, 20);
}

TEST(ForceRecord, TakesStepsOfOneSubstepOfAnyLength) {
  RestingBlock at(60);
  for (int f = 0; f < 60; ++f) at.world.deformable().stepSimulation(btScalar(1) / btScalar(200 + f), 0);
  expectNear(at.onFloor().total().force, btVector3(0, -kWeight, 0), 0.05 * kWeight);
}

// ---- events that change it, and events that do not

TEST(ForceRecord, IsNothingOnceAContactHasEnded) {
  RestingBlock at(60);
  ASSERT_FALSE(isNothing(at.onFloor()));
  at.block->body().translate(btVector3(0, 3, 0));
  step(at.world, 1);
  EXPECT_TRUE(isNothing(at.onFloor()));
  EXPECT_TRUE(isNothing(at.forces->forcesOn(at.block->body())));
}

TEST(ForceRecord, StaysAsItIsWhileABodySleeps) {
  RestingBlock at(0);
  at.block->body().forceActivationState(ACTIVE_TAG);
  for (int f = 0; f < 1200 && at.block->body().isActive(); ++f) step(at.world, 1);
  ASSERT_FALSE(at.block->body().isActive());
  const AppliedForces asleep = at.onFloor();
  expectNear(asleep.total().force, btVector3(0, -kWeight, 0), 0.01 * kWeight);
  step(at.world, 30);
  EXPECT_EQ(at.onFloor().total().force, asleep.total().force);
  EXPECT_EQ(at.onFloor().total().torque, asleep.total().torque);
  at.block->body().activate();
  at.block->body().translate(btVector3(0, 3, 0));
  step(at.world, 1);
  EXPECT_TRUE(isNothing(at.onFloor()));
}

TEST(ForceRecord, IsNotChangedByQueriesBetweenSteps) {
  IgnoredResults nothing;
  RestingBlock at(60), same(60);
  const btVector3 before = at.onFloor().total().force;
  for (btCollisionObject* object : {&floorOf(at.world), static_cast<btCollisionObject*>(&at.block->body())}) {
    at.world.world->contactTest(object, nothing);
  }
  at.world.world->contactPairTest(&floorOf(at.world), &at.block->body(), nothing);
  EXPECT_EQ(at.onFloor().total().force, before);
  step(at.world, 10);
  step(same.world, 10);
  EXPECT_EQ(at.onFloor().total().force, same.onFloor().total().force);
}

TEST(ForceRecord, TellsNothingOfWhatHasLeftTheWorld) {
  TetskinWorld world;
  const auto block = added(world, smallCageAbove(2.0));
  const auto forces = forcesIn(world);
  const auto table = [] { return std::make_unique<btBoxShape>(btVector3(1, 0.95, 1)); };
  auto under = std::make_unique<Rigid>(world, table(), 0, btVector3(0, 1, 0));
  step(world, 60);
  ASSERT_GT(forces->forcesOn(block->body()).total().force.y(), 0.5 * kWeight);
  world.deformable().removeRigidBody(under->body.get());
  EXPECT_TRUE(isNothing(forces->forcesOn(*under->body)));
  EXPECT_TRUE(isNothing(forces->forcesOn(block->body())));
  // The table is in the world again: it has not been touched yet, nor has another object at its address.
  world.deformable().addRigidBody(under->body.get());
  EXPECT_TRUE(isNothing(forces->forcesOn(*under->body)));
  step(world, 60);
  ASSERT_FALSE(isNothing(forces->forcesOn(*under->body)));
  under.reset();
  EXPECT_TRUE(isNothing(forces->forcesOn(block->body())));
  step(world, 1);
  EXPECT_TRUE(isNothing(forces->forcesOn(block->body())));
}

TEST(ForceRecord, OutlivesBodiesThatSleepOnEachOther) {
  TetskinWorld world;
  auto block = added(world, smallCageAbove(0.03));
  const auto forces = forcesIn(world);
  for (int f = 0; f < 1200 && block->body().isActive(); ++f) step(world, 1);
  ASSERT_FALSE(isNothing(forces->forcesOn(floorOf(world))));
  block.reset();
  EXPECT_TRUE(isNothing(forces->forcesOn(floorOf(world))));
  step(world, 2);
  EXPECT_TRUE(isNothing(forces->forcesOn(floorOf(world))));
}

TEST(ForceRecord, MayBeAskedForTwiceAndChangesNoStep) {
  TetskinWorld with, without;
  const auto a = added(with, smallCageAbove(0.2)), b = added(without, smallCageAbove(0.2));
  auto first = forcesIn(with);
  const auto second = forcesIn(with);
  step(with, 30);
  step(without, 30);
  EXPECT_EQ(first->forcesOn(floorOf(with)).total().force, second->forcesOn(floorOf(with)).total().force);
  EXPECT_FALSE(isNothing(second->forcesOn(floorOf(with))));
  first.reset();
  step(with, 30);
  step(without, 30);
  for (int n = 0; n < a->body().m_nodes.size(); ++n) EXPECT_EQ(a->body().m_nodes[n].m_x, b->body().m_nodes[n].m_x);
  EXPECT_FALSE(isNothing(second->forcesOn(floorOf(with))));
}

TEST(ForceRecord, NeedsTheLibrarysSolver) {
  EmptyWorld world;
  const Status status = ForceRecord::add(world.deformable()).status();
  EXPECT_EQ(status.code, StatusCode::InvalidOption);
  EXPECT_NE(status.message.find("DeformableSolver"), std::string::npos);
}

// ---- drawing

/// Keeps the drawn lines.
struct Drawer : btIDebugDraw {
  explicit Drawer(int drawn) : mode(drawn) {}
  struct Point {
    btVector3 at, normal;
  };
  void drawLine(const btVector3& from, const btVector3& to, const btVector3& colour) override {
    if (colour == getDefaultColors().m_contactPoint) arrows.push_back(to - from);
  }
  void drawContactPoint(const btVector3& at, const btVector3& normal, btScalar, int, const btVector3&) override {
    points.push_back({at, normal});
  }
  void reportErrorWarning(const char*) override {}
  void draw3dText(const btVector3&, const char*) override {}
  void setDebugMode(int to) override { mode = to; }
  int getDebugMode() const override { return mode; }

  int mode;
  std::vector<Point> points;
  std::vector<btVector3> arrows;
};

TEST(ForceRecord, DrawsPointsNormalsAndForces) {
  RestingBlock at(120);
  Drawer drawer(btIDebugDraw::DBG_DrawContactPoints | btIDebugDraw::DBG_DrawNormals);
  at.world.deformable().setDebugDrawer(&drawer);
  step(at.world, 1);
  at.world.deformable().debugDrawWorld();
  ASSERT_GE(drawer.points.size(), 3U);
  ASSERT_EQ(drawer.arrows.size(), drawer.points.size());
  btVector3 sum(0, 0, 0);
  for (std::size_t k = 0; k < drawer.points.size(); ++k) {
    EXPECT_NEAR(drawer.points[k].at.y(), 0.01, 0.02);
    expectNear(drawer.points[k].normal, btVector3(0, 1, 0), 1e-5);
    sum += drawer.arrows[k];
  }
  // The sum is the weight, drawn as long as the body's longest side.
  const btVector3 size = at.block->body().m_bounds[1] - at.block->body().m_bounds[0];
  EXPECT_NEAR(sum.y(), size[size.maxAxis()], 0.01);
  drawer.points.clear();
  drawer.mode = btIDebugDraw::DBG_DrawNormals;
  at.world.deformable().debugDrawWorld();
  EXPECT_TRUE(drawer.points.empty());
  drawer.mode |= btIDebugDraw::DBG_DrawContactPoints;
  at.block.reset();
  at.world.deformable().debugDrawWorld();
  EXPECT_TRUE(drawer.points.empty());
  at.world.deformable().setDebugDrawer(nullptr);
}

}  // namespace
}  // namespace tetskin::test
