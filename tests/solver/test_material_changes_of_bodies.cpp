// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Plastic flow, growth and muscles of bodies in a world. The laws themselves: see elastic/test_material_changes.cpp.
#include "deformable_test.h"
#include "support/bars.h"
#include "support/rigids.h"

namespace tetskin::test {
namespace {

constexpr double kStiff = 2e5;

/// Dimensions in metres; the density is 1000.
std::unique_ptr<DeformableBody> block(EmptyWorld& world, const Cage& cage, double damping = 0.002) {
  SoftBodyOptions options;
  options.youngsModulus = kStiff;
  options.stiffnessDamping = damping;
  options.density = 1000.0;
  Result<std::unique_ptr<DeformableBody>> body = DeformableBody::add(world.deformable(), cage, options);
  EXPECT_TRUE(body.ok()) << body.status().message;
  return std::move(body).value();
}

/// A cube of 0.4 m above the ground at y = 0.
Cage cubeAt(double height) {
  Cage cage;
  cage.mesh = makeBox({4, 4, 4}, Eigen::Vector3d(0.4, 0.4, 0.4));
  for (Eigen::Vector3d& p : cage.mesh.nodes) p.y() += height;
  return cage;
}

double heightOf(const btSoftBody& body) {
  double high = -HUGE_VAL;
  for (int n = 0; n < body.m_nodes.size(); ++n) high = std::max<double>(high, body.m_nodes[n].m_x.y());
  return high - lowest(body);
}

Plasticity clay() {
  Plasticity plasticity;
  plasticity.yieldStress = 0.02 * kStiff;
  return plasticity;
}

struct Fallen {
  double height = 0.0, rebound = 0.0;
  bool asleep = false;
};

/// Drops a cube, with an initial speed.
Fallen dropped(bool isClay, double speed, int substeps) {
  TetskinWorld world;
  const auto cube = block(world, cubeAt(0.02));
  if (isClay) {
    EXPECT_TRUE(cube->setPlasticity(clay()).ok());
  }
  btSoftBody& body = cube->body();
  for (int n = 0; n < body.m_nodes.size(); ++n) body.m_nodes[n].m_v = btVector3(0, -static_cast<btScalar>(speed), 0);
  Fallen result;
  double lowestCentre = HUGE_VAL;
  for (int frame = 0; frame < 180; ++frame) {
    world.deformable().stepSimulation(btScalar(1) / 60, substeps, btScalar(1) / (60 * static_cast<btScalar>(substeps)));
    const double centre = static_cast<double>(centreOf(body).y());
    if (centre < lowestCentre) result.rebound = 0.0;
    lowestCentre = std::min(lowestCentre, centre);
    result.rebound = std::max(result.rebound, centre - lowestCentre);
  }
  result.height = heightOf(body);
  result.asleep = !body.isActive();
  return result;
}

/// Height to which a cube of 2e5 Pa is pressed by a box on it, in contact.
double pressedTo(const ElasticLaw& law, double mass) {
  TetskinWorld world;
  const auto cube = block(world, cubeAt(0.0), 0.02);
  EXPECT_TRUE(cube->setElasticLaw(law).ok());
  const Rigid weight(world.deformable(), std::make_unique<btBoxShape>(btVector3(0.5, 0.1, 0.5)),
                     static_cast<btScalar>(mass), btVector3(0.2, 0.52, 0.2));
  weight.body->setLinearFactor(btVector3(0, 1, 0));  // on a guide: it would tilt, and slide off
  weight.body->setAngularFactor(0);
  for (int frame = 0; frame < 300; ++frame) world.deformable().stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
  return heightOf(cube->body());
}

TEST(MaterialChangesOfBodies, WhatStiffensIsPressedLess) {
  const double mass = 0.6 * kStiff * 0.16 / 9.81;  // a linear law without friction: pressed by 60 %
  // By the laws' energies, without friction and the cube's own weight, which is 3 % of the box's.
  const std::pair<ElasticLaw, double> laws[] = {
      {ElasticLaw(), 0.4}, {ElasticLaw::neoHookean(), 0.574}, {ElasticLaw::yeoh(0.5, 0.2), 0.617}};
  for (const auto& [law, pressed] : laws) EXPECT_NEAR(pressedTo(law, mass), 0.4 * pressed, 0.009);
}

TEST(MaterialChangesOfBodies, ClayKeepsItsDentAndHardlyRebounds) {
  for (const double speed : {2.0, 4.0, 6.0}) {
    const Fallen elastic = dropped(false, speed, 4), plastic = dropped(true, speed, 4), fine = dropped(true, speed, 16);
    EXPECT_GT(elastic.height, 0.38) << speed;
    EXPECT_LT(plastic.height, 0.37) << speed;
    EXPECT_NEAR(plastic.height, fine.height, 0.05 * (0.4 - fine.height) + 0.002) << speed;
    EXPECT_LT(plastic.rebound, 0.25 * elastic.rebound) << speed;
    EXPECT_NEAR(plastic.rebound, fine.rebound, 0.012) << speed;
    EXPECT_TRUE(plastic.asleep) << speed;
  }
}

TEST(MaterialChangesOfBodies, ABodyThatChangesWakesAndSleepsAgain) {
  TetskinWorld world;
  const auto cube = block(world, cubeAt(0.001), 0.02);
  step(world, 120);
  ASSERT_FALSE(cube->body().isActive());
  const double before = heightOf(cube->body());
  ASSERT_TRUE(cube->setGrowth(1.2).ok());
  EXPECT_TRUE(cube->body().isActive());
  step(world, 240);
  EXPECT_NEAR(heightOf(cube->body()) / before, 1.2, 0.01);
  EXPECT_FALSE(cube->body().isActive());
  Muscle muscle;
  for (int t = 0; t < cube->body().m_tetras.size(); ++t) muscle.tets.push_back(t);
  muscle.fibres = {Eigen::Vector3d(0, 1, 0)};
  muscle.stress = 0.2 * kStiff;
  ASSERT_TRUE(cube->addMuscle(muscle).ok());
  ASSERT_TRUE(cube->setActivation(0, 1.0).ok());
  EXPECT_EQ(cube->activation(0), 1.0);
  EXPECT_TRUE(cube->body().isActive());
  step(world, 240);
  const double w = 0.4 / (1.0 + std::sqrt(1.0 + 8.0 * 0.3 * 0.2));
  EXPECT_NEAR(heightOf(cube->body()) / before, 1.2 / (1.0 + w), 0.02);
  EXPECT_FALSE(cube->body().isActive());
  ASSERT_TRUE(cube->setPlasticity(clay()).ok());
  EXPECT_TRUE(cube->body().isActive());
  step(world, 120);
  ASSERT_TRUE(cube->resetPlasticFlow().ok());
  EXPECT_TRUE(cube->body().isActive());
}

TEST(MaterialChangesOfBodies, ABodySagsAsMuchMoreAsItsTetsAreSofter) {
  TetskinWorld world;
  const auto cube = block(world, cubeAt(0.001), 0.02);
  step(world, 120);
  ASSERT_FALSE(cube->body().isActive());
  const double sag = 0.4 - heightOf(cube->body());
  const std::vector<double> soft(static_cast<std::size_t>(cube->body().m_tetras.size()), 0.25);
  ASSERT_TRUE(cube->setStiffnessScale(soft).ok());
  EXPECT_TRUE(cube->body().isActive());
  step(world, 240);
  EXPECT_NEAR((0.4 - heightOf(cube->body())) / sag, 4.0, 0.2);
  EXPECT_FALSE(cube->body().isActive());
  ASSERT_TRUE(cube->setYoungsModulus(4.0 * kStiff).ok());
  step(world, 240);
  EXPECT_NEAR((0.4 - heightOf(cube->body())) / sag, 1.0, 0.05);
  ASSERT_TRUE(cube->reset().ok());
  step(world, 240);
  EXPECT_NEAR((0.4 - heightOf(cube->body())) / sag, 1.0, 0.05) << "a reset keeps what is set";
}

/// Thrown at the ground, what is damped by half of its tets bounces less high than what is not, and higher than what
/// all is; painted all over it is that damping, to the bit.
TEST(MaterialChangesOfBodies, DampingByTetCountsInImpacts) {
  const auto bounce = [](double damping, double lower, double upper) {
    Cage cage = cubeAt(0.02);
    for (const Tet& tet : cage.mesh.tets) {
      double y = -0.02;
      for (const int n : tet) y += 0.25 * cage.mesh.nodes[static_cast<std::size_t>(n)].y();
      cage.paintedDamping.push_back(y < 0.2 ? lower : upper);
    }
    TetskinWorld world;
    const auto cube = block(world, cage, damping);
    for (int n = 0; n < cube->body().m_nodes.size(); ++n) cube->body().m_nodes[n].m_v = btVector3(0, -3, 0);
    double highest = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
      step(world, 1);
      if (frame > 10) highest = std::max(highest, static_cast<double>(centreOf(cube->body()).y()));
    }
    return highest;
  };
  const double none = bounce(0.01, 0.0, 0.0), half = bounce(0.01, 0.0, 2.0), all = bounce(0.01, 2.0, 2.0);
  EXPECT_GT(none, half);
  EXPECT_GT(half, all);
  EXPECT_EQ(bounce(0.01, 2.0, 2.0), bounce(0.02, 1.0, 1.0));
}

TEST(MaterialChangesOfBodies, AMuscleThatFollowsItsLengthLetsItsBodySleep) {
  TetskinWorld world;
  const auto cube = block(world, cubeAt(0.001), 0.02);
  step(world, 120);
  const double before = heightOf(cube->body());
  Muscle muscle;
  for (int t = 0; t < cube->body().m_tetras.size(); ++t) muscle.tets.push_back(t);
  muscle.fibres = {Eigen::Vector3d(0, 1, 0)};
  muscle.stress = kStiff;
  muscle.lengthFactors = {{0.5, 0.0}, {1.0, 1.0}};
  ASSERT_TRUE(cube->addMuscle(muscle).ok());
  for (int frame = 1; frame <= 30; ++frame) {
    ASSERT_TRUE(cube->setActivation(0, frame / 30.0).ok());
    step(world, 1);
  }
  step(world, 240);
  EXPECT_NEAR(heightOf(cube->body()) / before, 2.0 / 3.0, 0.02) << "1 - s = 2 (s - 0.5)";
  EXPECT_FALSE(cube->body().isActive());
}

TEST(MaterialChangesOfBodies, WhatIsSetSurvivesAResetAndWhatHasFlowedDoesNot) {
  TetskinWorld world;
  const auto cube = block(world, cubeAt(0.02));
  ASSERT_TRUE(cube->setPlasticity(clay()).ok());
  const auto drop = [&] {
    btSoftBody& body = cube->body();
    for (int n = 0; n < body.m_nodes.size(); ++n) body.m_nodes[n].m_v = btVector3(0, -5, 0);
    step(world, 60);
    return nodesOf(body);
  };
  const std::vector<btVector3> first = drop();
  const std::vector<double> strains = cube->plasticStrains();
  EXPECT_GT(*std::max_element(strains.begin(), strains.end()), 0.05);
  ASSERT_TRUE(cube->reset().ok());
  for (const double strain : cube->plasticStrains()) EXPECT_EQ(strain, 0.0);
  EXPECT_EQ(drop(), first);
}

/// A bar that hangs, with all of its mass at its lower end, and is a muscle: at its rest length it carries its stress
/// times its area.
TEST(MaterialChangesOfBodies, AMuscleLiftsWhatItsStressTimesItsAreaSays) {
  constexpr double kStress = 0.1 * kStiff, kArea = 0.01, kGravity = 9.8;
  const TetMesh bar = lifted(makeBox({2, 10, 2}, Eigen::Vector3d(0.1, 0.5, 0.1)), 20.0);
  for (const double load : {0.9, 1.0, 1.1}) {
    TetskinWorld world;
    world.deformable().setGravity(btVector3(0, -static_cast<btScalar>(kGravity), 0));
    SoftBodyOptions options;
    options.youngsModulus = kStiff;
    options.stiffnessDamping = 0.05;
    options.pinned = [](const Eigen::Vector3d& p) { return p.y() > 20.5 - 1e-6; };
    const auto body = added(world, bar, options);
    const double mass = load * kStress * kArea / kGravity;
    for (int n = 0; n < body->body().m_nodes.size(); ++n) {
      if (body->isPinned(n)) continue;
      const bool isLow = bar.nodes[static_cast<std::size_t>(n)].y() < 20.0 + 1e-6;
      body->body().setMass(n, static_cast<btScalar>(isLow ? mass / 9.0 : 1e-5));
    }
    Muscle muscle;
    for (int t = 0; t < body->body().m_tetras.size(); ++t) muscle.tets.push_back(t);
    muscle.fibres = {Eigen::Vector3d(0, 1, 0)};
    muscle.stress = kStress;
    ASSERT_TRUE(body->addMuscle(muscle).ok());
    ASSERT_TRUE(body->setActivation(0, 1.0).ok());
    step(world, 300);
    double longer = 0.0;
    for (int n = 0; n < body->body().m_nodes.size(); ++n) {
      const double rest = bar.nodes[static_cast<std::size_t>(n)].y();
      if (rest < 20.0 + 1e-6) longer += (rest - static_cast<double>(body->body().m_nodes[n].m_x.y())) / 9.0;
    }
    const double w = 0.2 / (1.0 + std::sqrt(1.0 + 8.0 * 0.3 * 0.1));
    const double stiffer = (1.0 + w) * (1.0 + 0.6 * w), perLoad = kStress / kStiff * 0.5 / stiffer;
    EXPECT_NEAR(longer / perLoad, load - 1.0, 0.03) << load;
  }
}

/// What is set later counts the fibres that are there; too few factors are named before what they would do.
TEST(MaterialChangesOfBodies, FibresAndPaintedDampingCountForTheStiffestBody) {
  TetskinWorld world;
  Cage cage = cubeAt(0.0);
  cage.paintedDamping.assign(cage.mesh.tetCount(), 2.0);
  const auto body = block(world, cage, 0.0);
  const double most = (sizeof(btScalar) == sizeof(float) ? 1e12 : 1e16) * 1000.0 * 0.4 * 0.4;
  const auto refused = [](const Status& status, const std::string& named) {
    EXPECT_FALSE(status.ok());
    EXPECT_NE(status.message.find(named), std::string::npos) << status.message;
  };
  refused(body->setDampingScale({1.0}), "1 values for " + std::to_string(cage.mesh.tetCount()) + " tets");
  ASSERT_TRUE(body->setYoungsModulus(0.6 * most).ok());
  Fibres fibres;
  fibres.tets = {7};
  fibres.directions = {Eigen::Vector3d(1, 0, 0)};
  fibres.stiffness = 0.6 * most;
  refused(body->addFibres(fibres), "with these fibres");
  ASSERT_TRUE(body->setYoungsModulus(0.3 * most).ok());
  ASSERT_TRUE(body->addFibres(fibres).ok());
  refused(body->setYoungsModulus(0.6 * most), "with these fibres");
  refused(body->setStiffnessScale(std::vector<double>(cage.mesh.tetCount(), 1.2)), "with these fibres");
  EXPECT_DOUBLE_EQ(body->youngsModulus(), 0.3 * most);
}

TEST(MaterialChangesOfBodies, OtherForceModelsRefuseThem) {
  EmptyWorld world;
  SoftBodyOptions options;
  options.forceModel = ForceModel::NeoHookean;
  const auto body = added(world, smallCageAbove(1.0), options);
  Muscle muscle;
  muscle.tets = {0};
  muscle.fibres = {Eigen::Vector3d(1, 0, 0)};
  for (const Status& status : {body->setPlasticity(clay()), body->setGrowth(1.1), body->addMuscle(muscle).status(),
                               body->setStiffnessScale({})}) {
    EXPECT_EQ(status.code, StatusCode::InvalidOption);
    EXPECT_NE(status.message.find("Corotated"), std::string::npos) << status.message;
  }
  EXPECT_FALSE(body->endPlasticity().ok());
  EXPECT_FALSE(body->resetPlasticFlow().ok());
  EXPECT_EQ(body->activation(0), 0.0);
  for (const double strain : body->plasticStrains()) EXPECT_EQ(strain, 0.0);
}

}  // namespace
}  // namespace tetskin::test
