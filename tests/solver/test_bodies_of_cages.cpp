// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies made from cages that carry volume fractions, stiffness factors and masses, and from cages with duplicate
// elements.
#include "deformable_test.h"
#include "support/two_plates.h"

#include <tetskin/core/embedding.h>

#include <numeric>

namespace tetskin::test {
namespace {

constexpr double kDensity = 7.0;

/// The cage of two plates with all its data, high above the floor.
Cage plates(double joinedUntil = -1.0) {
  Cage cage = test::platesOfCopies(joinedUntil).cage;
  for (Eigen::Vector3d& p : cage.mesh.nodes) p.y() += 20.0;
  return cage;
}

SoftBodyOptions dense(ForceModel model = ForceModel::Corotated) {
  SoftBodyOptions options;
  options.density = kDensity;
  options.forceModel = model;
  return options;
}

std::unique_ptr<DeformableBody> addedCage(EmptyWorld& world, const Cage& cage, const SoftBodyOptions& options) {
  Result<std::unique_ptr<DeformableBody>> body = DeformableBody::add(world.deformable(), cage, options);
  EXPECT_TRUE(body.ok()) << body.status().message;
  return std::move(body).value();
}

std::vector<double> massesOf(const btSoftBody& body) {
  std::vector<double> masses;
  for (int n = 0; n < body.m_nodes.size(); ++n) masses.push_back(1.0 / static_cast<double>(body.m_nodes[n].m_im));
  return masses;
}

TEST(BodiesOfCages, HaveItsMassesTimesTheDensity) {
  const Cage cage = plates();
  TetskinWorld world;
  const std::vector<double> masses = massesOf(addedCage(world, cage, dense())->body());
  ASSERT_EQ(masses.size(), cage.mesh.nodeCount());
  for (std::size_t n = 0; n < masses.size(); ++n) EXPECT_NEAR(masses[n] / (kDensity * cage.masses[n]), 1.0, 1e-6);
}

TEST(BodiesOfCages, AreByDefaultAsStiffAsTheirPaintedDensityIsHigh) {
  Cage plain(latticeCage(3, 3, 3));
  plain.volumeFraction.assign(plain.mesh.tetCount(), 0.5);
  plain.masses.assign(plain.mesh.nodeCount(), 0.5 * 27.0 / static_cast<double>(plain.mesh.nodeCount()));
  TetskinWorld world;
  const auto stiffness = [&](const Cage& cage) { return addedCage(world, cage, dense())->youngsModulus(); };
  const auto painted = [&](Cage cage, double density) {
    cage.paintedDensity.assign(cage.mesh.tetCount(), density);
    for (double& mass : cage.masses) mass *= density;
    return cage;
  };
  EXPECT_NEAR(stiffness(painted(plain, 1.5)) / stiffness(plain), 1.5, 1e-4);
  EXPECT_NEAR(stiffness(painted(plain, 4.0)) / stiffness(plain), 4.0, 1e-4);
}

TEST(BodiesOfCages, DistributeAGivenMassAsItsMasses) {
  const Cage cage = plates();
  SoftBodyOptions options;
  options.mass = 3.0;
  TetskinWorld world;
  const std::vector<double> masses = massesOf(addedCage(world, cage, options)->body());
  EXPECT_NEAR(std::accumulate(masses.begin(), masses.end(), 0.0), 3.0, 1e-5);
  EXPECT_NEAR(masses[1] / masses[0], cage.masses[1] / cage.masses[0], 1e-5);
}

/// The nodes' positions after some steps.
std::vector<btVector3> fallen(const Cage& cage, const SoftBodyOptions& options) {
  TetskinWorld world;
  const auto body = addedCage(world, cage, options);
  for (int n = 0; n < body->body().m_nodes.size(); ++n) {
    body->body().m_nodes[n].m_v += btVector3(btScalar(n % 3), btScalar(n % 5), 0);
  }
  test::step(world, 10);
  return nodesOf(body->body());
}

class ModelsOfCages : public testing::TestWithParam<ForceModel> {};
INSTANTIATE_TEST_SUITE_P(BodiesOfCages, ModelsOfCages,
                         testing::Values(ForceModel::Corotated, ForceModel::NeoHookean, ForceModel::LinearElasticity));

TEST_P(ModelsOfCages, MoveAsIfItsValuesWereGivenByHand) {
  const Cage cage = plates(1.0);
  SoftBodyOptions options = dense(GetParam());
  options.youngsModulus = 500.0;
  const auto known = fallen(cage, options);
  for (const double mass : cage.masses) options.nodeMasses.push_back(kDensity * mass);
  const auto plain = fallen(TetMesh(cage.mesh), options);
  options.stiffnessScale = cage.stiffnessScale();
  const auto byHand = fallen(TetMesh(cage.mesh), options);
  ASSERT_EQ(known.size(), byHand.size());
  bool same = true, sameWithoutStiffness = true;
  for (std::size_t n = 0; n < known.size(); ++n) {
    same &= known[n] == byHand[n];
    sameWithoutStiffness &= known[n] == plain[n];
  }
  EXPECT_TRUE(same);
  EXPECT_FALSE(sameWithoutStiffness);
}

TEST(BodiesOfCages, GiveBulletsForcesTheStiffnessAsTheMeasureOfATet) {
  const Cage cage = plates();
  const std::vector<double> scale = cage.stiffnessScale();
  for (const ForceModel model : {ForceModel::NeoHookean, ForceModel::LinearElasticity, ForceModel::Corotated}) {
    btSoftBodyWorldInfo info;
    const auto known = createSoftBody(cage, info, dense(model)).value();
    const auto plain = createSoftBody(TetMesh(cage.mesh), info, dense(model)).value();
    for (int t = 0; t < known->m_tetras.size(); ++t) {
      const double ratio =
          static_cast<double>(known->m_tetras[t].m_element_measure / plain->m_tetras[t].m_element_measure);
      const double wanted = model == ForceModel::Corotated ? 1.0 : scale[static_cast<std::size_t>(t)];
      EXPECT_NEAR(ratio / wanted, 1.0, 1e-5) << t;
    }
  }
}

TEST(BodiesOfCages, OfMassAndSpringsTakeAFilledCageButNoStiffness) {
  const Cage cage = plates();
  btSoftBodyWorldInfo info;
  SoftBodyOptions options = dense(ForceModel::MassSpring);
  EXPECT_TRUE(withCageDefaults(cage, options).stiffnessScale.empty());
  const auto made = createSoftBody(cage, info, options);
  ASSERT_TRUE(made.ok()) << made.status().message;
  EXPECT_NEAR(massesOf(*made.value())[3] / (kDensity * cage.masses[3]), 1.0, 1e-6);
  options.stiffnessScale = cage.stiffnessScale();
  EXPECT_EQ(createSoftBody(cage, info, options).status().code, StatusCode::InvalidOption);
}

TEST(BodiesOfCages, LeaveGivenOptionsAlone) {
  const Cage cage = plates();
  SoftBodyOptions options = dense();
  options.nodeMasses.assign(cage.mesh.nodeCount(), 0.25);
  options.stiffnessScale.assign(cage.mesh.tetCount(), 0.75);
  const SoftBodyOptions with = withCageDefaults(cage, options);
  EXPECT_EQ(with.nodeMasses, options.nodeMasses);
  EXPECT_EQ(with.stiffnessScale, options.stiffnessScale);
  EXPECT_EQ(with.density, kDensity);
  const SoftBodyOptions plain = withCageDefaults(TetMesh(cage.mesh), dense());
  EXPECT_TRUE(plain.nodeMasses.empty() && plain.stiffnessScale.empty());
}

TEST(BodiesOfCages, RefuseACageThatMakesNoSense) {
  Cage cage = plates();
  cage.stiffnessFactor[2] = 0.0;
  TetskinWorld world;
  EXPECT_EQ(DeformableBody::add(world.deformable(), cage, dense()).status().code, StatusCode::InvalidOption);
  cage = plates();
  cage.masses.pop_back();
  EXPECT_EQ(DeformableBody::add(world.deformable(), cage, dense()).status().code, StatusCode::SizeMismatch);
  EXPECT_EQ(world.deformable().getSoftBodyArray().size(), 0);
}

/// How far the outermost sheets of two plates separate at the ends where they are pulled apart; the other ends are
/// pinned.
double opening(Cage cage, const test::TwoPlates& item) {
  const std::vector<VertexBinding> bindings = embed(cage, item.mesh).value().bindings();
  for (Eigen::Vector3d& p : cage.mesh.nodes) p.y() += 20.0;
  SoftBodyOptions options;
  options.nodeMasses.assign(cage.mesh.nodeCount(), 0.1);
  options.stiffnessScale.assign(cage.mesh.tetCount(), 1.0);
  options.youngsModulus = 200.0;
  options.stiffnessDamping = 0.05;
  options.pinned = [](const Eigen::Vector3d& p) { return p.x() < 0.1; };
  TetskinWorld world;
  const auto body = addedCage(world, cage, options);
  EXPECT_TRUE(body->setGravity(btVector3(0, 0, 0)).ok());

  const std::size_t lower = item.plateVertices / 2 - 4,
                    upper = item.mesh.vertexCount() - 4;  // middle of the ends
  const auto height = [&](std::size_t vertex) {
    btScalar y = 0;
    for (int k = 0; k < 4; ++k) {
      y += bindings[vertex].weights[k] * body->body().m_nodes[cage.mesh.tets[bindings[vertex].tet][k]].m_x.y();
    }
    return static_cast<double>(y);
  };
  const double before = height(upper) - height(lower);
  EXPECT_NEAR(before, 0.3, 1e-4);
  constexpr btScalar kStep = btScalar(1) / 240, kPull = 2;
  for (int s = 0; s < 480; ++s) {
    for (const auto& [vertex, force] : {std::pair{upper, kPull}, std::pair{lower, -kPull}}) {
      for (int k = 0; k < 4; ++k) {
        btSoftBody::Node& node = body->body().m_nodes[cage.mesh.tets[bindings[vertex].tet][k]];
        node.m_v += btVector3(0, kStep * force * bindings[vertex].weights[k] * node.m_im, 0);
      }
    }
    world.deformable().stepSimulation(kStep, 1, kStep);
  }
  return height(upper) - height(lower) - before;
}

TEST(BodiesOfCages, OpenWhereTheirPartsArePulledApart) {
  const test::TwoPlates jaw = test::platesOfCopies(1.0);
  const double open = opening(jaw.cage, jaw), fused = opening(test::latticeCage(4, 1, 2), jaw);
  EXPECT_GT(open, 0.1);
  EXPECT_GT(open, 2.0 * std::abs(fused));
}

}  // namespace
}  // namespace tetskin::test
