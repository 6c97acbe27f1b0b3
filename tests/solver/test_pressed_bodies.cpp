// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Pressure and gas in a DeformableBody: with contact, sleep, impacts, and whatever else may happen to a body.
#include "deformable_test.h"
#include "support/hollow_sphere.h"
#include "support/rigids.h"

#include <tetskin/threads/thread_pool.h>

namespace tetskin::test {
namespace {

constexpr double kRadius = 0.5;

/// A balloon about this height, of a wall a tenth as thick as its radius.
TetMesh balloonAt(double height, int level = 2) {
  TetMesh cage = hollowSphere(0.9 * kRadius, kRadius, level, 1);
  for (Eigen::Vector3d& x : cage.nodes) x.y() += height;
  return cage;
}

SoftBodyOptions latex() {
  SoftBodyOptions options;
  options.mass = 1.0;
  options.youngsModulus = 1e6;
  options.stiffnessDamping = 0.005;
  return options;
}

void frames(EmptyWorld& world, int count, int substeps) {
  const btScalar dt = btScalar(1) / 60;
  for (int k = 0; k < count; ++k) world.deformable().stepSimulation(dt, substeps, dt / static_cast<btScalar>(substeps));
}

/// A heavy plate on a balloon, led vertically.
struct PlateOnBalloon : TetskinWorld {
  explicit PlateOnBalloon(double mass)
      : plate(deformable(), std::make_unique<btBoxShape>(btVector3(2, btScalar(0.1), 2)), btScalar(mass),
              btVector3(0, btScalar(2 * kRadius + 0.12), 0)) {
    SoftBodyOptions options = latex();
    options.youngsModulus = 1e5;
    options.stiffnessDamping = 0.05;
    balloon = added(*this, balloonAt(kRadius), options);
    plate->setAngularFactor(0);
    plate->setLinearFactor(btVector3(0, 1, 0));
  }
  Rigid plate;
  std::unique_ptr<DeformableBody> balloon;
};

TEST(PressedBodies, ABalloonUnderAPlateKeepsPressureTimesVolume) {
  double volumes[3];
  int at = 0;
  for (const int substeps : {1, 4, 16}) {
    PlateOnBalloon world(100);
    DeformableBody& balloon = *world.balloon;
    ASSERT_TRUE(balloon.setGas(4e3).ok());
    const double amount = 4e3 * balloon.volume();
    double least = balloon.volume();
    for (int k = 0; k < 240; ++k) {
      frames(world, 1, substeps);
      ASSERT_NEAR(balloon.pressure() * balloon.volume() / amount, 1.0, 1e-4) << substeps;
      least = std::min(least, balloon.volume());
    }
    EXPECT_LT(least, 0.97 * balloon.volume());
    EXPECT_GT(world.plate.height(), 1.2 * kRadius) << "it carries 1,000 N";
    EXPECT_LT(rmsSpeed(balloon.body()), 0.02);
    volumes[at++] = balloon.volume();
  }
  EXPECT_NEAR(volumes[0] / volumes[2], 1.0, 0.01);
  EXPECT_NEAR(volumes[1] / volumes[2], 1.0, 0.01);
}

TEST(PressedBodies, AGasThatIsHeldByTheAirOutsideCarriesMore) {
  const auto height = [](double gas, double outside) {
    PlateOnBalloon world(100);
    EXPECT_TRUE(world.balloon->setGas(gas, outside).ok());
    frames(world, 150, 4);
    return world.plate.height();
  };
  const double empty = height(0, 0), soft = height(1e3, 0), stiff = height(1e3, 101325);
  EXPECT_GT(soft, empty + 0.02);
  EXPECT_GT(stiff, soft + 0.02);
}

TEST(PressedBodies, ABodySleepsUnderPressureAndWakesWhenItChanges) {
  TetskinWorld world;
  const auto body = added(world, latticeCage(3, 3, 3, 0.2), latex());
  const auto sleeps = [&] {
    for (int k = 0; k < 400 && body->body().isActive(); ++k) frames(world, 1, 4);
    return !body->body().isActive();
  };
  ASSERT_TRUE(body->setPressure(2e4).ok());
  EXPECT_TRUE(sleeps());
  const double volume = body->volume();
  ASSERT_TRUE(body->setPressure(4e4).ok());
  EXPECT_TRUE(body->body().isActive());
  EXPECT_TRUE(sleeps());
  EXPECT_GT(body->volume(), 1.02 * volume);
  ASSERT_TRUE(body->setGas(3e4, 1e5).ok());
  EXPECT_TRUE(body->body().isActive());
  EXPECT_TRUE(sleeps());
  ASSERT_TRUE(body->setPressure(0).ok());
  EXPECT_TRUE(body->body().isActive());
  EXPECT_TRUE(sleeps());
  EXPECT_LT(body->volume(), volume);
}

TEST(PressedBodies, ABalloonUnderAPlateSleeps) {
  PlateOnBalloon world(100);
  ASSERT_TRUE(world.balloon->setGas(4e3).ok());
  for (int k = 0; k < 600 && world.balloon->body().isActive(); ++k) frames(world, 1, 4);
  EXPECT_FALSE(world.balloon->body().isActive());
}

TEST(PressedBodies, AFreeBodyKeepsItsMomentumAndItsPlace) {
  TetskinWorld world;
  world.deformable().setGravity(btVector3(0, 0, 0));
  const auto balloon = added(world, balloonAt(5), latex());
  ASSERT_TRUE(balloon->setGravity(btVector3(0, 0, 0)).ok());
  ASSERT_TRUE(balloon->setGas(2e4).ok());
  btSoftBody& body = balloon->body();
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btVector3 arm = body.m_nodes[n].m_x - btVector3(0, 5, 0);
    body.m_nodes[n].m_v = body.m_nodes[n].m_vn = btVector3(1, 0, 0) + btVector3(1, 3, 2).cross(arm);
  }
  const auto spin = [&] {
    btVector3 sum(0, 0, 0);
    const btVector3 centre = centreOf(body);
    for (int n = 0; n < body.m_nodes.size(); ++n) {
      sum += (body.m_nodes[n].m_x - centre).cross(body.m_nodes[n].m_v) / body.m_nodes[n].m_im;
    }
    return sum;
  };
  const btVector3 momentum = momentumOf(body), angular = spin();
  frames(world, 120, 4);
  EXPECT_LT((momentumOf(body) - momentum).length(), 1e-4 * momentum.length());
  EXPECT_LT((spin() - angular).length(), 2e-3 * angular.length());
}

/// A ball falls by 1 m: it comes back from an impact, with pressure, too, and with no more energy than it had.
TEST(PressedBodies, ABallReboundsNoHigherThanItFell) {
  for (const double pressure : {0.0, 5e3, 3e4}) {
    for (const int substeps : {1, 4, 16}) {
      TetskinWorld world;
      SoftBodyOptions options = latex();
      options.stiffnessDamping = 0.001;
      const auto ball = added(world, balloonAt(kRadius + 1, 1), options);
      ASSERT_TRUE(ball->setGas(pressure).ok());
      double highest = 0.0, start = 0.0;
      bool landed = false;
      for (int k = 0; k < 150; ++k) {
        frames(world, 1, substeps);
        const double y = static_cast<double>(centreOf(ball->body()).y());
        if (k == 0) start = y;
        landed |= lowest(ball->body()) < 0.05;
        if (landed && ball->body().m_nodes[0].m_v.y() > 0) highest = std::max(highest, y);
      }
      ASSERT_TRUE(landed);
      EXPECT_LT(highest, start) << pressure << " " << substeps;
      EXPECT_GT(highest, kRadius + 0.2) << pressure << " " << substeps;
    }
  }
}

TEST(PressedBodies, PressureStaysWithABodyThatLeavesReturnsIsPlacedOrReset) {
  TetskinWorld world;
  const auto balloon = added(world, balloonAt(3, 1), latex());
  ASSERT_TRUE(balloon->setGas(1e4, 1e5).ok());
  frames(world, 10, 4);
  const double volume = balloon->volume(), pressure = balloon->pressure();
  ASSERT_LT(pressure, 9.9e3);
  balloon->removeFromWorld();
  EXPECT_EQ(balloon->pressure(), pressure);
  ASSERT_TRUE(balloon->addToWorld(world.deformable()).ok());
  ASSERT_TRUE(balloon->teleport(placeAt(btVector3(100, 2, -50), btQuaternion(btVector3(1, 0, 0), 1))).ok());
  EXPECT_NEAR(balloon->volume() / volume, 1.0, 1e-5);
  ASSERT_TRUE(balloon->reset().ok());
  EXPECT_NEAR(balloon->pressure(), 1e4, 1.0);
  for (int n = 0; n < balloon->body().m_nodes.size(); ++n) {
    EXPECT_LT((balloon->body().m_nodes[n].m_v).length(), 1e-6);
  }
  frames(world, 10, 4);
  EXPECT_NEAR(balloon->volume() / volume, 1.0, 1e-3);
}

TEST(PressedBodies, AVisibleMeshIsWherePressureActs) {
  TetskinWorld world;
  const TetMesh cage = lifted(latticeCage(4, 4, 4, 0.5), 3);
  const auto body = added(world, cage, latex());
  EXPECT_NEAR(body->volume(), 8.0, 1e-4);
  TriangleMesh mesh = sphereOf(2);
  const auto place = [&](TriangleMesh& of, double radius) {
    for (Eigen::Vector3d& x : of.positions) x = radius * x + Eigen::Vector3d(1, 4, 1);
  };
  place(mesh, 0.8);
  const auto volumeOf = [&](const TriangleMesh& of) {
    const Embedding embedding = embed(Cage(cage), of).value();
    const Status status = body->setPressureSurface(of, embedding);
    EXPECT_TRUE(status.ok()) << status.message;
    return body->volume();
  };
  const double facets = volumeOf(mesh) / (0.8 * 0.8 * 0.8);
  EXPECT_NEAR(facets, 4.19, 0.4);
  // A hollow in it is what a gas fills. Its mesh faces inwards.
  TriangleMesh inner = sphereOf(2);
  place(inner, 0.4);
  for (const auto& [a, b, c] : inner.triangles) {
    const int first = static_cast<int>(mesh.vertexCount());
    mesh.triangles.push_back({a + first, c + first, b + first});
  }
  mesh.positions.insert(mesh.positions.end(), inner.positions.begin(), inner.positions.end());
  EXPECT_NEAR(volumeOf(mesh) / (0.4 * 0.4 * 0.4), facets, 1e-4);
  ASSERT_TRUE(body->setGas(1e5).ok());
  frames(world, 20, 4);
  EXPECT_GT(body->volume(), 1.01 * facets * 0.064);
  // Texture seams: each triangle has its own vertices.
  TriangleMesh split;
  for (const auto& triangle : mesh.triangles) {
    for (const int v : triangle) split.positions.push_back(mesh.positions[static_cast<std::size_t>(v)]);
    const int last = static_cast<int>(split.vertexCount());
    split.triangles.push_back({last - 3, last - 2, last - 1});
  }
  const double before = body->volume();
  EXPECT_NEAR(volumeOf(split) / before, 1.0, 1e-6);
  ASSERT_TRUE(body->setPressureSurface(TriangleMesh(), Embedding()).ok());
  EXPECT_GT(body->volume(), 4.0);
}

TEST(PressedBodies, AnotherSurfaceKeepsTheGasPressureAndTheBoundsOfAConstantOne) {
  TetskinWorld world;
  const TetMesh cage = lifted(latticeCage(4, 4, 4, 0.5), 3);
  TriangleMesh mesh = sphereOf(2);
  for (Eigen::Vector3d& x : mesh.positions) x = 0.2 * x + Eigen::Vector3d(1, 4, 1);
  const Embedding embedding = embed(Cage(cage), mesh).value();
  const auto body = added(world, cage, latex());
  ASSERT_TRUE(body->setGas(100, 1000).ok());
  ASSERT_TRUE(body->setPressureSurface(mesh, embedding).ok());
  EXPECT_NEAR(body->pressure(), 100, 1e-3);
  EXPECT_LT(body->volume(), 0.04);
  ASSERT_TRUE(body->setPressure(100).ok());
  ASSERT_TRUE(body->setPressureSurface(TriangleMesh(), Embedding()).ok());
  EXPECT_GT(body->volume(), 7.9);
  EXPECT_EQ(body->pressure(), 100) << "it has not burst";
}

TEST(PressedBodies, TheBoundaryOfTheTetsReplacesASurfaceThatWasPrepared) {
  for (const bool pressed : {false, true}) {
    TetskinWorld world;
    const TetMesh cage = lifted(latticeCage(4, 4, 4, 0.5), 3);
    TriangleMesh mesh = sphereOf(2);
    for (Eigen::Vector3d& x : mesh.positions) x = 0.2 * x + Eigen::Vector3d(1, 4, 1);
    const auto body = added(world, cage, latex());
    body->preparePressureSurface(std::make_shared<const TriangleMesh>(mesh), embed(Cage(cage), mesh).value());
    EXPECT_LT(body->volume(), 0.04);
    ASSERT_TRUE(body->setPressure(pressed ? 100 : 0).ok());
    ASSERT_TRUE(body->setPressureSurface(TriangleMesh(), Embedding()).ok());
    EXPECT_GT(body->volume(), 7.9);
  }
}

TEST(PressedBodies, ABodyThatIsScaledHasTheBoundsOfItsSize) {
  const TetMesh cage = lifted(latticeCage(3, 3, 3, 0.2), 50);
  TriangleMesh mesh = sphereOf(1);
  for (Eigen::Vector3d& x : mesh.positions) x = 0.25 * x + Eigen::Vector3d(0.3, 50.3, 0.3);
  const Embedding embedding = embed(Cage(cage), mesh).value();
  for (const int surface : {0, 1, 2}) {  // the tets', one that was set, and one that was prepared
    TetskinWorld world;
    const auto body = added(world, cage, latex());
    if (surface == 1) {
      ASSERT_TRUE(body->setPressureSurface(mesh, embedding).ok());
    }
    if (surface == 2) body->preparePressureSurface(std::make_shared<const TriangleMesh>(mesh), embedding);
    ASSERT_TRUE(body->setPressure(10).ok());
    frames(world, 2, 1);
    const double volume = body->volume();
    body->body().scale(btVector3(5, 5, 5));
    frames(world, 2, 1);
    EXPECT_NEAR(body->volume() / volume, 125, 1);
    EXPECT_EQ(body->pressure(), 10) << surface;
  }
}

TEST(PressedBodies, WhatCannotBeIsRefused) {
  TetskinWorld world;
  const auto body = added(world, balloonAt(3, 1), latex());
  ASSERT_TRUE(body->setPressure(100).ok());
  const auto refuses = [&](const Status& status, StatusCode code, const std::string& words) {
    EXPECT_EQ(status.code, code) << status.message;
    EXPECT_NE(status.message.find(words), std::string::npos) << status.message;
    EXPECT_EQ(body->pressure(), 100.0);
  };
  refuses(body->setPressure(std::nan("")), StatusCode::NonFinite, "not finite");
  refuses(body->setPressure(1e30), StatusCode::InvalidOption, "too large");
  refuses(body->setGas(-5), StatusCode::InvalidOption, "above 0");
  const TetMesh cage = balloonAt(3, 1);
  TriangleMesh open = sphereOf(1);
  for (Eigen::Vector3d& x : open.positions) x = 0.48 * x + Eigen::Vector3d(0, 3, 0);
  const Embedding embedding = embed(Cage(cage), open).value();
  TriangleMesh wrong = open;
  wrong.positions.pop_back();
  wrong.triangles.resize(3);
  refuses(body->setPressureSurface(wrong, embedding), StatusCode::SizeMismatch, "belong together");
  refuses(body->setPressureSurface(open, Embedding()), StatusCode::SizeMismatch, "belong together");
  open.triangles.pop_back();
  refuses(body->setPressureSurface(open, embedding), StatusCode::InvalidOption, "not closed");
  open.triangles.clear();
  refuses(body->setPressureSurface(open, embedding), StatusCode::InvalidOption, "encloses no volume");

  EmptyWorld bullets;
  SoftBodyOptions options = latex();
  options.forceModel = ForceModel::NeoHookean;
  options.youngsModulus = 1000;
  const auto other = added(bullets, smallCageAbove(3), options);
  EXPECT_EQ(other->setPressure(10).code, StatusCode::InvalidOption);
  EXPECT_EQ(other->pressure(), 0.0);
}

TEST(PressedBodies, StepsHaveTheSameBitsWithAnyThreads) {
  const auto after = [](std::size_t threads) {
    ThreadPool pool(std::max<std::size_t>(threads, 1));
    TetskinWorld world;
    world.bodySolver().setDeterministic(true);
    if (threads > 0) world.bodySolver().setThreads(&pool);
    const auto first = added(world, balloonAt(kRadius), latex()),
               second = added(world, balloonAt(3 * kRadius), latex());
    EXPECT_TRUE(first->setGas(5e3).ok());
    EXPECT_TRUE(second->setPressure(1e3).ok());
    frames(world, 30, 2);
    std::vector<btVector3> nodes = nodesOf(first->body());
    for (const btVector3& x : nodesOf(second->body())) nodes.push_back(x);
    return nodes;
  };
  EXPECT_EQ(after(0), after(3));
}

}  // namespace
}  // namespace tetskin::test
