// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// An application's own body, with Bullet's own forces, in a world where bodies of this library come and go.
#include "deformable_test.h"

#include <tetskin/solver/src/base/body_forces.h>

namespace tetskin::test {

using namespace bullet_detail;

namespace {

/// The application's own body, with its own gravity and material, added through Bullet's interface.
class OwnBody {
 public:
  explicit OwnBody(btDeformableMultiBodyDynamicsWorld& world, double height = 20.0)
      : body_(createSoftBody(smallCageAbove(height), world.getWorldInfo(), test::oneKilogram()).value()),
        world_(world) {
    world.addSoftBody(body_.get());
    world.addForce(body_.get(), &gravity);
    world.addForce(body_.get(), &elasticity);
  }
  ~OwnBody() {
    world_.removeForce(body_.get(), &gravity);
    world_.removeForce(body_.get(), &elasticity);
    world_.removeSoftBody(body_.get());
  }

  /// The acceleration downwards in world units per second squared over this many frames; for a body in free fall,
  /// whatever its material.
  double fallsAt(EmptyWorld& world, int frames = 12) {
    const auto speed = [&] {
      double sum = 0.0;
      for (int n = 0; n < body_->m_nodes.size(); ++n) sum -= static_cast<double>(body_->m_nodes[n].m_v.y());
      return sum / body_->m_nodes.size();
    };
    const double before = speed();
    step(world, frames);
    return (speed() - before) * 60.0 / frames;
  }

  btDeformableGravityForce gravity{btVector3(0, btScalar(-1.6), 0)};
  btDeformableNeoHookeanForce elasticity{400, 600, btScalar(0.05)};

 private:
  std::unique_ptr<btSoftBody> body_;
  btDeformableMultiBodyDynamicsWorld& world_;
};

double fallsAt(EmptyWorld& world, const DeformableBody& body, int frames = 12) {
  const auto speed = [&] {
    double sum = 0.0;
    for (int n = 0; n < body.body().m_nodes.size(); ++n) sum -= static_cast<double>(body.body().m_nodes[n].m_v.y());
    return sum / body.body().m_nodes.size();
  };
  const double before = speed();
  step(world, frames);
  return (speed() - before) * 60.0 / frames;
}

ForceList& forcesOf(EmptyWorld& world) {
  return *static_cast<btDeformableBodySolver*>(world.softSolver.get())->getLagrangianForceArray();
}

/// Bullet's solver in explicit worlds, Bullet's solver in implicit worlds, where it uses one gravity for all bodies,
/// and the library's solver.
enum class Kind { Explicit, Implicit, Tetskin };

const char* toString(Kind kind) {
  return kind == Kind::Explicit ? "Explicit" : kind == Kind::Implicit ? "Implicit" : "Tetskin";
}

std::unique_ptr<EmptyWorld> worldOf(Kind kind) {
  auto world = test::worldFor(kind == Kind::Tetskin ? ForceModel::Corotated : ForceModel::NeoHookean);
  world->deformable().setImplicit(kind == Kind::Implicit);
  return world;
}

SoftBodyOptions optionsOf(Kind kind) {
  SoftBodyOptions options;
  if (kind != Kind::Tetskin) options.forceModel = ForceModel::NeoHookean;
  return options;
}

class ForeignForces : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Worlds, ForeignForces, testing::Values(Kind::Explicit, Kind::Implicit, Kind::Tetskin),
                         [](const auto& instance) { return std::string(toString(instance.param)); });

TEST_P(ForeignForces, OfABodyAddedBeforeOursAreItsOwn) {
  const auto made = worldOf(GetParam());
  EmptyWorld& world = *made;
  OwnBody own(world.deformable());
  auto ours = added(world, smallCageAbove(20), optionsOf(GetParam()));
  EXPECT_NEAR(own.fallsAt(world), 1.6, 0.01);
  EXPECT_NEAR(fallsAt(world, *ours), 10.0, 0.05);
  ours.reset();
  EXPECT_NEAR(own.fallsAt(world), 1.6, 0.01);
  EXPECT_EQ(forcesOf(world).size(), 2);
}

TEST_P(ForeignForces, DoNotJoinOursBetweenARemovalAndTheNextStep) {
  const auto made = worldOf(GetParam());
  EmptyWorld& world = *made;
  auto first = added(world, smallCageAbove(20), optionsOf(GetParam()));
  auto second = added(world, smallCageAbove(40), optionsOf(GetParam()));
  step(world, 2);
  second.reset();
  OwnBody own(world.deformable());
  EXPECT_EQ(own.gravity.m_softBodies.size(), 1);
  EXPECT_NEAR(own.fallsAt(world), 1.6, 0.01);
  EXPECT_NEAR(fallsAt(world, *first), 10.0, 0.05);
}

TEST_P(ForeignForces, OfAnotherBodyGoWithoutHarm) {
  const auto made = worldOf(GetParam());
  EmptyWorld& world = *made;
  auto ours = added(world, smallCageAbove(20), optionsOf(GetParam()));
  {
    OwnBody own(world.deformable());
    step(world, 2);
  }
  EXPECT_EQ(forcesOf(world).size(), 2);
  EXPECT_NEAR(fallsAt(world, *ours), 10.0, 0.05);
}

TEST_P(ForeignForces, AndOursMayEachHaveAGravityOfTheirOwn) {
  const auto made = worldOf(GetParam());
  EmptyWorld& world = *made;
  auto mars = added(world, smallCageAbove(20), optionsOf(GetParam()));
  auto earth = added(world, smallCageAbove(40), optionsOf(GetParam()));
  EXPECT_TRUE(mars->setGravity(btVector3(0, btScalar(-3.7), 0)).ok());
  EXPECT_NEAR(fallsAt(world, *mars), 3.7, 0.02);
  EXPECT_NEAR(fallsAt(world, *earth), 10.0, 0.05);
  OwnBody own(world.deformable(), 60);
  EXPECT_NEAR(fallsAt(world, *mars), 3.7, 0.02);
  EXPECT_NEAR(fallsAt(world, *earth), 10.0, 0.05);
  EXPECT_NEAR(own.fallsAt(world), 1.6, 0.01);
}

TEST_P(ForeignForces, AreLeftAloneWhenTheApplicationTakesOurBodyOut) {
  const auto made = worldOf(GetParam());
  EmptyWorld& world = *made;
  auto ours = added(world, smallCageAbove(20), optionsOf(GetParam()));
  OwnBody own(world.deformable());
  step(world, 2);
  world.deformable().removeSoftBody(&ours->body());
  EXPECT_NEAR(own.fallsAt(world), 1.6, 0.01);
  ours.reset();
  EXPECT_NEAR(own.fallsAt(world), 1.6, 0.01);
  ours = added(world, smallCageAbove(40), optionsOf(GetParam()));
  EXPECT_EQ(forcesOf(world).size(), 4);  // no stale entries are left
  EXPECT_NEAR(fallsAt(world, *ours), 10.0, 0.05);
}

TEST(ForeignForces, HaveAMaterialOfTheirOwn) {
  // A beam pinned at one end; the library's body beside it has a hundredth of its stiffness.
  const auto tip = [](bool besideOurs) {
    test::TetskinWorld world;
    TetMesh beam = lifted(test::latticeCage(8, 2, 2, 0.25), 20);
    SoftBodyOptions options;
    options.pinned = [](const Eigen::Vector3d& p) { return p.x() < 0.1; };
    options.youngsModulus = 60;
    std::unique_ptr<DeformableBody> ours;
    if (besideOurs) ours = added(world, beam, options);
    for (Eigen::Vector3d& p : beam.nodes) p.z() += 3;
    const std::unique_ptr<btSoftBody> own(createSoftBody(beam, world.deformable().getWorldInfo(), options).value());
    btDeformableGravityForce gravity(btVector3(0, -10, 0));
    btDeformableNeoHookeanForce elasticity(2400, 3600, btScalar(0.05));
    world.deformable().addSoftBody(own.get());
    world.deformable().addForce(own.get(), &gravity);
    world.deformable().addForce(own.get(), &elasticity);
    step(world, 40);
    const double y = test::lowest(*own);
    world.deformable().removeForce(own.get(), &gravity);
    world.deformable().removeForce(own.get(), &elasticity);
    world.deformable().removeSoftBody(own.get());
    return y;
  };
  EXPECT_NEAR(tip(true), tip(false), 0.005);  // one iterative solve serves all bodies of a world
}

/// An error in them would recur in each step.
TEST(ForeignForces, OnABodyOfOursAreSolvedForCloselyWhateverItsTolerance) {
  const auto moved = [](double tolerance) {
    test::TetskinWorld world;
    TetMesh beam = test::latticeCage(8, 2, 2, 0.25);
    for (Eigen::Vector3d& p : beam.nodes) p.y() += 20;
    SoftBodyOptions options;
    options.pinned = [](const Eigen::Vector3d& p) { return p.x() < 0.1; };
    options.youngsModulus = 600;
    options.solverTolerance = tolerance;
    const auto ours = added(world, beam, options);
    btDeformableNeoHookeanForce more(400, 600, btScalar(0.05));
    world.deformable().addForce(&ours->body(), &more);
    step(world, 20);
    world.deformable().removeForce(&ours->body(), &more);
    return static_cast<double>(test::lowest(ours->body()));
  };
  const double closely = moved(1e-6);
  EXPECT_LT(closely, 19.9);
  EXPECT_NEAR(moved(1e-2), closely, 2e-5);
}

TEST(DeformableBody, MayOutliveItsWorld) {
  std::unique_ptr<DeformableBody> body;
  {
    test::TetskinWorld world;
    body = added(world, smallCageAbove(1));
    step(world, 2);
  }
  EXPECT_GT(body->body().m_nodes.size(), 0);
  body.reset();
}

}  // namespace
}  // namespace tetskin::test
