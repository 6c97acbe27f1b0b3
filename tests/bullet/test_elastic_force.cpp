// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The force by itself, in worlds with Bullet's own solver.
#include "deformable_test.h"

#include <tetskin/bullet/elastic_force.h>

#include <cmath>

namespace tetskin {
namespace {

using test::cageAbove;
using test::EmptyWorld;
using test::lowest;
using test::rmsSpeed;
using test::smallCageAbove;
using test::step;

/// A body with Bullet's gravity, added by Bullet's means.
class OwnBody {
 public:
  explicit OwnBody(EmptyWorld& ofWorld, const TetMesh& cage) : world(ofWorld.deformable()) {
    body = makeSoftBody(cage, world.getWorldInfo()).value();
    world.addSoftBody(body.get());
    world.addForce(body.get(), &gravity);
  }
  ~OwnBody() {
    world.removeForce(body.get(), &gravity);
    world.removeSoftBody(body.get());
  }

  btDeformableMultiBodyDynamicsWorld& world;
  btDeformableGravityForce gravity{btVector3(0, -10, 0)};
  std::unique_ptr<btSoftBody> body;
};

struct Settings {
  const char* name;
  bool implicit, lineSearch, projection;
};
void PrintTo(const Settings& settings, std::ostream* out) {
  *out << settings.name;
}

class ElasticForceIn : public testing::TestWithParam<Settings> {};

TEST_P(ElasticForceIn, LandsAndRests) {
  EmptyWorld world;
  world.deformable().setImplicit(GetParam().implicit);
  world.deformable().setLineSearch(GetParam().lineSearch);
  world.deformable().setUseProjection(GetParam().projection);
  ElasticForce force({800.0, 0.3, 0.05});
  OwnBody own(world, cageAbove(0.3));
  ASSERT_TRUE(force.addTo(world.deformable(), *own.body).ok());
  const int tets = own.body->m_tetras.size();
  step(world, 12);
  EXPECT_EQ(own.body->m_tetras.size(), tets);
  EXPECT_NEAR(static_cast<double>(own.body->m_nodes[0].m_v.y()), -2.0, 0.02);
  step(world, 228);
  EXPECT_LT(rmsSpeed(*own.body), 0.1);
  EXPECT_GT(lowest(*own.body), -0.03);
  EXPECT_LT(lowest(*own.body), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Worlds, ElasticForceIn,
                         testing::Values(Settings{"Explicit", false, false, true},
                                         Settings{"Implicit", true, false, true},
                                         Settings{"LineSearch", true, true, true},
                                         Settings{"Multipliers", false, false, false}),
                         [](const auto& instance) { return std::string(instance.param.name); });

/// What Bullet asks for is what it says it is: the differential that of the forces, the forces those of the energy.
TEST(ElasticForce, IsTheGradientOfItsEnergy) {
  EmptyWorld world;
  world.deformable().setImplicit(true);
  ElasticForce force({500.0, 0.3, 0.0});
  OwnBody own(world, smallCageAbove(5));
  ASSERT_TRUE(force.addTo(world.deformable(), *own.body).ok());
  step(world, 1);
  btSoftBody& body = *own.body;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const auto k = btScalar(n);
    body.m_nodes[n].m_v.setZero();
    body.m_nodes[n].m_q = body.m_nodes[n].m_x + btScalar(0.02) * btVector3(btSin(7 * k), btSin(5 * k), btSin(3 * k));
  }
  btAlignedObjectArray<btVector3> forces;
  forces.resize(body.m_nodes.size(), btVector3(0, 0, 0));
  force.addScaledForces(1, forces);
  constexpr btScalar kStep = btScalar(2e-3);
  for (const int n : {0, 7, 20}) {
    for (int k = 0; k < 3; ++k) {
      btScalar& x = body.m_nodes[n].m_q[k];
      const btScalar before = x;
      x = before + kStep;
      const double above = force.totalElasticEnergy(0);
      x = before - kStep;
      const double below = force.totalElasticEnergy(0);
      x = before;
      const double slope = (above - below) / (2.0 * static_cast<double>(kStep));
      EXPECT_NEAR(static_cast<double>(forces[n][k]), -slope, 0.01 * std::abs(slope) + 0.05) << n << " " << k;
    }
  }
}

TEST(ElasticForce, TellsTheEnergyWhoeverSolvesAndAskingChangesNothing) {
  test::TetskinWorld asked, left;
  EmptyWorld bullets;
  const auto a = test::added(asked, cageAbove(0.2)), b = test::added(left, cageAbove(0.2)),
             c = test::added(bullets, cageAbove(0.2));
  double most = 0.0, mostInBullets = 0.0;
  for (int f = 0; f < 40; ++f) {
    for (EmptyWorld* world : {static_cast<EmptyWorld*>(&asked), static_cast<EmptyWorld*>(&left), &bullets}) {
      step(*world, 1);
    }
    most = std::max(most, test::elasticEnergyIn(asked));
    mostInBullets = std::max(mostInBullets, test::elasticEnergyIn(bullets));
    for (int n = 0; n < a->body().m_nodes.size(); ++n) {
      ASSERT_EQ(a->body().m_nodes[n].m_x, b->body().m_nodes[n].m_x) << f;
    }
  }
  EXPECT_GT(most, 0.1);
  EXPECT_NEAR(most, mostInBullets, 0.1 * most);
}

/// Bullet's addForce gives a second body to the first object of a type.
TEST(ElasticForce, HasSeveralBodies) {
  EmptyWorld world;
  ElasticForce force({800.0, 0.3, 0.05}), other({1e5, 0.3, 0.05});
  OwnBody first(world, cageAbove(0.2)), second(world, cageAbove(3)), third(world, smallCageAbove(6));
  world.deformable().addForce(first.body.get(), &force);
  world.deformable().addForce(second.body.get(), &other);
  ASSERT_TRUE(other.addTo(world.deformable(), *third.body).ok());
  EXPECT_EQ(force.m_softBodies.size(), 2);
  EXPECT_EQ(other.m_softBodies.size(), 1);
  step(world, 200);
  for (const OwnBody* own : {&first, &second, &third}) {
    EXPECT_TRUE(std::isfinite(rmsSpeed(*own->body)));
    EXPECT_GT(lowest(*own->body), -0.05);
  }
}

TEST(ElasticForce, FollowsABodyThatIsScaled) {
  EmptyWorld world;
  ElasticForce force({800.0, 0.3, 0.05});
  OwnBody own(world, smallCageAbove(50));
  ASSERT_TRUE(force.addTo(world.deformable(), *own.body).ok());
  step(world, 2);
  btVector3 low, high;
  own.body->scale(btVector3(2, 2, 2));
  own.body->getAabb(low, high);
  step(world, 40);
  const auto extent = [&] {
    btVector3 a(1e9f, 1e9f, 1e9f), b = -a;
    for (int n = 0; n < own.body->m_nodes.size(); ++n) {
      a.setMin(own.body->m_nodes[n].m_x);
      b.setMax(own.body->m_nodes[n].m_x);
    }
    return static_cast<double>((b - a).z());
  };
  EXPECT_NEAR(extent(), 2 * 0.9, 0.01);
}

/// The tets that are kept from Bullet for a while are there whenever an application looks.
TEST(ElasticForce, LeavesTheBodysTetsToBeSeen) {
  EmptyWorld world;
  ElasticForce force({800.0, 0.3, 0.05});
  OwnBody own(world, smallCageAbove(5)), other(world, smallCageAbove(9));
  ASSERT_TRUE(force.addTo(world.deformable(), *own.body).ok());
  const int tets = own.body->m_tetras.size();
  struct Seen {
    const btSoftBody* body;
    int fewest;
  } seen{own.body.get(), tets};
  world.deformable().setWorldUserInfo(&seen);
  const auto look = [](btDynamicsWorld* in, btScalar) {
    auto& s = *static_cast<Seen*>(in->getWorldUserInfo());
    s.fewest = std::min(s.fewest, s.body->m_tetras.size());
  };
  world.deformable().setInternalTickCallback(look, &seen, true);
  world.deformable().setInternalTickCallback(look, &seen, false);
  step(world, 3);
  EXPECT_EQ(seen.fewest, tets);
  world.deformable().removeSoftBody(other.body.get());
  EXPECT_EQ(own.body->m_tetras.size(), tets);
  step(world, 1);
  EXPECT_EQ(own.body->m_tetras.size(), tets);
}

TEST(ElasticForce, RefusesWhatMakesNoSense) {
  EmptyWorld world;
  OwnBody own(world, smallCageAbove(5));
  const auto code = [&](const ElasticMaterial& material) {
    ElasticForce force(material);
    return force.addTo(world.deformable(), *own.body).code;
  };
  const double nan = std::nan("");
  for (const ElasticMaterial& bad :
       {ElasticMaterial{0.0}, ElasticMaterial{-1.0}, ElasticMaterial{nan}, ElasticMaterial{HUGE_VAL},
        ElasticMaterial{1e3, 0.5}, ElasticMaterial{1e3, -0.1}, ElasticMaterial{1e3, nan},
        ElasticMaterial{1e3, 0.3, -1.0}, ElasticMaterial{1e3, 0.3, nan}}) {
    EXPECT_EQ(code(bad), StatusCode::InvalidOption);
  }
  ElasticForce force({1e3});
  EXPECT_EQ(force.addTo(world.deformable(), *own.body, {1.0}).code, StatusCode::SizeMismatch);
  EXPECT_EQ(force.setLimits({1.0, 10}).code, StatusCode::InvalidOption);
  EXPECT_EQ(force.setLimits({0.1, 0}).code, StatusCode::InvalidOption);
  EXPECT_EQ(force.setStiffnessScale(*own.body, {}).code, StatusCode::IndexOutOfRange);
  const auto outside = makeSoftBody(smallCageAbove(5), world.deformable().getWorldInfo()).value();
  EXPECT_EQ(force.addTo(world.deformable(), *outside).code, StatusCode::InvalidOption);
  EXPECT_EQ(force.m_softBodies.size(), 0);
  EXPECT_EQ(force.setMaterial({-1.0}).code, StatusCode::InvalidOption);
  EXPECT_EQ(force.material().youngsModulus, 1e3);
}

}  // namespace
}  // namespace tetskin
