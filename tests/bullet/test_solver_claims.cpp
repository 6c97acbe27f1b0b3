// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What the first page claims about bodies in DeformableSolver, in cases where it once failed. tetskin_stress runs all
// combinations.
#include <gtest/gtest.h>

#include <limits>

#include "deformable_test.h"

namespace tetskin {
namespace {

using test::added;
using test::TetskinWorld;
using Vector = Eigen::Vector3d;

TetMesh block(double size = 1.0) {
  TetMesh cage = test::latticeCage(3, 3, 3, size / 3.0);
  for (Vector& p : cage.nodes) p += Vector(-0.5 * size, 20.0, -0.5 * size);
  return cage;
}

double fastest(const btSoftBody& body) {
  double maximum = 0.0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const auto speed = static_cast<double>(body.m_nodes[n].m_v.length());
    maximum = std::isfinite(speed) ? std::max(maximum, speed) : HUGE_VAL;
  }
  return maximum;
}

double extent(const btSoftBody& body) {
  double maximum = 0.0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    maximum = std::max(maximum, static_cast<double>((body.m_nodes[n].m_x - body.m_nodes[0].m_x).length()));
  }
  return maximum;
}

void spin(btSoftBody& body, const btVector3& rate) {
  btVector3 centre(0, 0, 0);
  for (int n = 0; n < body.m_nodes.size(); ++n) centre += body.m_nodes[n].m_x / btScalar(body.m_nodes.size());
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    btSoftBody::Node& node = body.m_nodes[n];
    node.m_v = node.m_vn = rate.cross(node.m_x - centre);
  }
}

TEST(SolverClaims, ABodyThatIsRotatedByAnyAngleStaysAtRest) {
  for (const bool started : {false, true}) {
    for (const btVector3& axis : {btVector3(1, 0, 0), btVector3(0, 1, 0), btVector3(0, 0, 1), btVector3(1, 2, 3)}) {
      for (const double degrees : {90.0, 179.0, 179.9, 180.0}) {
        TetskinWorld world;
        const auto body = added(world, block());
        ASSERT_TRUE(body->setGravity(btVector3(0, 0, 0)).ok());
        if (started) test::step(world, 3);
        const btVector3 centroid(0, btScalar(20.5), 0);
        body->body().translate(-centroid);
        body->body().rotate(btQuaternion(axis.normalized(), static_cast<btScalar>(degrees * SIMD_PI / 180.0)));
        body->body().translate(centroid);
        test::step(world, 10);
        EXPECT_LT(fastest(body->body()), 0.02) << degrees << " " << axis.x() << axis.y() << axis.z();
      }
    }
  }
}

TEST(SolverClaims, StiffLightBodiesSpinInOnePiece) {
  for (const double youngsModulus : {1e8, 3e8, 1e9}) {
    for (const double rate : {0.1, 1.0, 10.0}) {
      TetskinWorld world;
      SoftBodyOptions options;
      options.mass = 1.0;
      options.youngsModulus = youngsModulus;
      const auto body = added(world, block(), options);
      ASSERT_TRUE(body->setGravity(btVector3(0, 0, 0)).ok());
      spin(body->body(), static_cast<btScalar>(rate) * btVector3(1, 2, 3).normalized());
      const double speed = fastest(body->body()), size = extent(body->body());
      test::step(world, 120);
      EXPECT_LT(fastest(body->body()), 1.05 * speed) << youngsModulus << " " << rate;
      EXPECT_GT(fastest(body->body()), 0.95 * speed) << youngsModulus << " " << rate;
      EXPECT_NEAR(extent(body->body()), size, 1e-3 * size) << youngsModulus << " " << rate;
    }
  }
}

TEST(SolverClaims, AFreeTwistedBodyGainsNoMomentum) {
  TetskinWorld world;
  const auto body = added(world, block());
  btSoftBody& soft = body->body();
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    btVector3& x = soft.m_nodes[n].m_x;
    x = btVector3(0, x.y(), 0) + (x - btVector3(0, x.y(), 0)).rotate(btVector3(0, 1, 0), btScalar(1.5) * (x.y() - 20));
  }
  constexpr int kFrames = 30;
  test::step(world, kFrames);
  btVector3 momentum(0, 0, 0), spin(0, 0, 0), centre(0, 0, 0);
  btScalar mass = 0;
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    const btScalar m = 1 / soft.m_nodes[n].m_im;
    momentum += m * soft.m_nodes[n].m_v;
    centre += m * soft.m_nodes[n].m_x;
    mass += m;
  }
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    spin += (soft.m_nodes[n].m_x - centre / mass).cross(soft.m_nodes[n].m_v) / soft.m_nodes[n].m_im;
  }
  const btVector3 fallen(0, btScalar(-10.0 * kFrames / 60.0), 0);
  EXPECT_LT((momentum / mass - fallen).length(), 1e-3);
  EXPECT_LT(spin.length(), 1e-3);
}

TEST(SolverClaims, WhatCannotWorkIsRefusedWithTheNumber) {
  TetskinWorld world;
  const auto body = added(world, block());
  const double before = body->youngsModulus();
  for (const double bad : {1e30, 1e18, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const Status status = body->setYoungsModulus(bad);
    EXPECT_EQ(status.code, StatusCode::InvalidOption) << bad;
    EXPECT_FALSE(status.message.empty());
    EXPECT_EQ(body->youngsModulus(), before);
  }
  EXPECT_NE(body->setYoungsModulus(1e30).message.find("1e+30"), std::string::npos);
  EXPECT_EQ(body->setStiffnessDamping(1e12).code, StatusCode::InvalidOption);
  const btScalar huge = btScalar(1e30), nan = std::numeric_limits<btScalar>::quiet_NaN();
  for (const btVector3& bad : {btVector3(0, huge, 0), btVector3(nan, 0, 0)}) {
    EXPECT_EQ(body->setGravity(bad).code, StatusCode::InvalidOption);
  }
  SoftBodyOptions options;
  options.youngsModulus = 1e25;
  EXPECT_EQ(DeformableBody::add(world.deformable(), block(), options).status().code, StatusCode::InvalidOption);
  EXPECT_EQ(world.deformable().getSoftBodyArray().size(), 1);
  test::step(world, 3);
  EXPECT_LT(fastest(body->body()), 1.0);
  world.deformable().setGravity(btVector3(nan, 0, 0));
  EXPECT_EQ(DeformableBody::add(world.deformable(), block()).status().code, StatusCode::InvalidOption);
}

TEST(SolverClaims, ABodyOfAnySizeWeighsWhatItsVolumeDoesAndSagsAlike) {
  TetskinWorld world;
  double sizes[] = {0.1, 1.0, 10.0};
  for (const double size : sizes) {
    const Result<std::unique_ptr<DeformableBody>> body = DeformableBody::add(world.deformable(), block(size));
    ASSERT_TRUE(body.ok());
    const double volume = size * size * size;
    EXPECT_NEAR(static_cast<double>(body.value()->body().getTotalMass()), 100.0 * volume, volume);
    EXPECT_NEAR(body.value()->youngsModulus(), 50.0 * 100.0 * 10.0 * size, size);
    EXPECT_NEAR(body.value()->relativeStiffness(), 50.0, 0.01);
    ASSERT_TRUE(body.value()->setYoungsModulus(500.0 * size).ok());
    EXPECT_NEAR(body.value()->relativeStiffness(), 0.5, 1e-3);
  }
}

}  // namespace
}  // namespace tetskin
