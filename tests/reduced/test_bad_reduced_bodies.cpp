// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "reduced_test.h"

#include <tetskin/solver/deformable_world.h>

#include <limits>

namespace tetskin {
namespace {

using namespace test;

void expectError(World& world, const VibrationModes& modes, const Cage& cage, const ReducedBodyOptions& options,
                 StatusCode code, const char* says) {
  const int before = world.world->getSoftBodyArray().size();
  const auto body = ReducedBody::add(*world.world, modes, cage, options);
  ASSERT_FALSE(body.ok()) << says;
  EXPECT_EQ(body.status().code, code) << body.status().message;
  EXPECT_NE(body.status().message.find(says), std::string::npos) << body.status().message;
  EXPECT_EQ(world.world->getSoftBodyArray().size(), before);
}

TEST(BadReducedBodies, NeedTheReducedSolver) {
  World bullets(btVector3(0, -10, 0), std::make_unique<btDeformableBodySolver>());
  expectError(bullets, barModes(), barCage(), barOptions(), StatusCode::InvalidOption, "btReducedDeformableBodySolver");
  World ours(btVector3(0, -10, 0), std::make_unique<DeformableSolver>());
  expectError(ours, barModes(), barCage(), barOptions(), StatusCode::InvalidOption, "btReducedDeformableBodySolver");
}

TEST(BadReducedBodies, DoNotShareAWorldWithOthers) {
  World world;
  const auto plain = std::move(createSoftBody(barCage(), world.world->getWorldInfo())).value();
  world.world->addSoftBody(plain.get());
  expectError(world, barModes(), barCage(), barOptions(), StatusCode::InvalidOption, "soft body 0");
  world.world->removeSoftBody(plain.get());
  const auto first = added(world, barModes());
  EXPECT_NE(added(world, barModes()), nullptr);
}

TEST(BadReducedBodies, AreRefusedWithModesThatAreTooFastOrGoWithoutThem) {
  World world;
  ReducedBodyOptions options = barOptions();
  const std::vector<double> all = barModes().frequencies(*options.youngsModulus, options.density);
  // The tenth mode is just too fast.
  options.timeStep = 1.6 / all[9] * 1.0001;
  expectError(world, barModes(), barCage(), options, StatusCode::InvalidOption, "11 of 20 modes are too fast");
  options.skipFastModes = true;
  const auto body = added(world, barModes(), options);
  EXPECT_EQ(body->modeCount(), 9u);
  EXPECT_EQ(body->report().skippedModes, 11u);
  EXPECT_NEAR(body->report().maxFrequency, all[8], 1e-9);
  EXPECT_NE(body->report().describe().find("11 were left out"), std::string::npos);
  options.skipFastModes = false;
  options.modeCount = 9;
  EXPECT_EQ(added(world, barModes(), options)->modeCount(), 9u);
  options.modeCount.reset();
  options.skipFastModes = true;
  options.timeStep = 10.0;
  expectError(world, barModes(), barCage(), options, StatusCode::InvalidOption, "20 of 20");
}

TEST(BadReducedBodies, AtTheLimitAreStable) {
  World world(btVector3(0, 0, 0));
  ReducedBodyOptions options = barOptions();
  options.stiffnessDamping = 0.0;
  options.timeStep = Limits::kMaxOmegaDt / barModes().frequencies(*options.youngsModulus, options.density).back();
  const auto body = added(world, barModes(), options);
  for (int r = 0; r < body->body().m_nReduced; ++r) body->body().m_reducedVelocityBuffer[r] = btScalar(0.1);
  world.step(2000, options.timeStep);
  for (int r = 0; r < body->body().m_nReduced; ++r) EXPECT_LT(std::abs(body->body().m_reducedVelocity[r]), 0.25) << r;
}

TEST(BadReducedBodies, Options) {
  World world;
  const auto expectInvalid = [&](auto&& change, const char* says) {
    ReducedBodyOptions options = barOptions();
    change(options);
    expectError(world, barModes(), barCage(), options, StatusCode::InvalidOption, says);
  };
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinity = HUGE_VAL;
  expectInvalid([](auto& o) { o.modeCount = 0; }, "modes");
  expectInvalid([](auto& o) { o.density = 0.0; }, "mass");
  expectInvalid([](auto& o) { o.mass = 0.0; }, "mass");
  expectInvalid([](auto& o) { o.youngsModulus = 0.0; }, "stiffness");
  expectInvalid([](auto& o) { o.margin = -1.0; }, "margin");
  expectInvalid([](auto& o) { o.density = kNaN; }, "mass");
  expectInvalid([](auto& o) { o.stiffnessDamping = -1.0; }, "damping");
  expectInvalid([](auto& o) { o.youngsModulus = kInfinity; }, "stiffness");
  expectInvalid([](auto& o) { o.timeStep = 0.0; }, "time step");
  expectInvalid([](auto& o) { o.friction = -1.0; }, "friction");
  expectInvalid([](auto& o) { o.margin = kNaN; }, "margin");
}

TEST(BadReducedBodies, ModesAndCages) {
  World world;
  expectError(world, {}, barCage(), barOptions(), StatusCode::Empty, "no modes");
  VibrationModes torn = barModes();
  torn.shapes[3].pop_back();
  expectError(world, torn, barCage(), barOptions(), StatusCode::SizeMismatch, "shapes");
  expectError(world, barModes(), {}, barOptions(), StatusCode::Empty, "");
  Cage away = barCage();
  for (Eigen::Vector3d& node : away.mesh.nodes) node.y() += 2.0;
  expectError(world, barModes(), away, barOptions(), StatusCode::OutsideCage, "do not overlap with the cage");
  Cage flat = barCage();
  flat.mesh.tets.push_back({0, 1, 2, 3});
  expectError(world, barModes(), flat, barOptions(), StatusCode::Degenerate, "flat");
}

}  // namespace
}  // namespace tetskin
