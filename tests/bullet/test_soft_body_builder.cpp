// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <tetskin/bullet/soft_body.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <set>

namespace tetskin {
namespace {

using Body = std::unique_ptr<btSoftBody>;

/// A body from the cage through Bullet's own reader.
Body fromVtkFile(const TetMesh& cage, btSoftBodyWorldInfo& info) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("tetskin_builder_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
                     ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".vtk");
  {
    std::ofstream file(path);
    file.precision(17);
    file << "# vtk DataFile Version 2.0\ncage\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << cage.nodeCount()
         << " double\n";
    for (const Eigen::Vector3d& p : cage.nodes) file << p.x() << " " << p.y() << " " << p.z() << "\n";
    file << "CELLS " << cage.tetCount() << " " << 5 * cage.tetCount() << "\n";
    for (const Tet& t : cage.tets) file << "4 " << t[0] << " " << t[1] << " " << t[2] << " " << t[3] << "\n";
    file << "CELL_TYPES " << cage.tetCount() << "\n";
    for (std::size_t t = 0; t < cage.tetCount(); ++t) file << "10\n";
  }
  testing::internal::CaptureStdout();  // Bullet's reader prints
  Body body(btSoftBodyHelpers::CreateFromVtkFile(info, path.string().c_str()));
  testing::internal::GetCapturedStdout();
  std::filesystem::remove(path);
  return body;
}

TetMesh wavyCage() {
  TetMesh cage = test::latticeCage(4, 3, 5, 0.25);
  for (Eigen::Vector3d& p : cage.nodes)
    p += 0.04 * Eigen::Vector3d(std::sin(9 * p.y()), std::sin(8 * p.z()), std::cos(7 * p.x()));
  return cage;
}

class BuilderAgainstBullet : public testing::Test {
 protected:
  BuilderAgainstBullet() : ours(createSoftBody(cage, info).value()), bullets(fromVtkFile(cage, info)) {}

  int indexIn(const Body& body, const btSoftBody::Node* node) const {
    return static_cast<int>(node - &body->m_nodes[0]);
  }

  TetMesh cage = wavyCage();
  btSoftBodyWorldInfo info;
  Body ours, bullets;
};

TEST_F(BuilderAgainstBullet, NodesAreTheSame) {
  ASSERT_EQ(ours->m_nodes.size(), bullets->m_nodes.size());
  for (int n = 0; n < ours->m_nodes.size(); ++n) {
    EXPECT_EQ(ours->m_nodes[n].m_x, bullets->m_nodes[n].m_x);
    EXPECT_EQ(ours->m_nodes[n].m_q, bullets->m_nodes[n].m_q);
    EXPECT_EQ(ours->m_X[n], bullets->m_X[n]);
    EXPECT_EQ(ours->m_nodes[n].index, bullets->m_nodes[n].index);
  }
}

TEST_F(BuilderAgainstBullet, LinksAreTheSameInTheSameOrder) {
  ASSERT_EQ(ours->m_links.size(), bullets->m_links.size());
  for (int l = 0; l < ours->m_links.size(); ++l) {
    for (int k = 0; k < 2; ++k) {
      EXPECT_EQ(indexIn(ours, ours->m_links[l].m_n[k]), indexIn(bullets, bullets->m_links[l].m_n[k]));
    }
    EXPECT_EQ(ours->m_links[l].m_rl, bullets->m_links[l].m_rl);
  }
}

TEST_F(BuilderAgainstBullet, FacesAreTheSameInTheSameOrder) {
  ASSERT_EQ(ours->m_faces.size(), bullets->m_faces.size());
  for (int f = 0; f < ours->m_faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(indexIn(ours, ours->m_faces[f].m_n[k]), indexIn(bullets, bullets->m_faces[f].m_n[k]));
    }
    EXPECT_EQ(ours->m_faces[f].m_ra, bullets->m_faces[f].m_ra);
  }
}

TEST_F(BuilderAgainstBullet, TetsVolumesAndInverseRestMatricesAreTheSame) {
  ASSERT_EQ(ours->m_tetras.size(), bullets->m_tetras.size());
  for (int t = 0; t < ours->m_tetras.size(); ++t) {
    const btSoftBody::Tetra &a = ours->m_tetras[t], &b = bullets->m_tetras[t];
    for (int k = 0; k < 4; ++k) EXPECT_EQ(indexIn(ours, a.m_n[k]), indexIn(bullets, b.m_n[k]));
    EXPECT_EQ(a.m_rv, b.m_rv);
    EXPECT_EQ(a.m_element_measure, b.m_element_measure);
    EXPECT_GT(a.m_element_measure, 0);
    for (int row = 0; row < 3; ++row) {
      EXPECT_EQ(a.m_Dm_inverse[row], b.m_Dm_inverse[row]);
      EXPECT_EQ(a.m_P_inv[row], b.m_P_inv[row]);
    }
  }
  EXPECT_EQ(ours->m_tetraScratches.size(), bullets->m_tetraScratches.size());
  EXPECT_EQ(ours->m_tetraScratchesTn.size(), bullets->m_tetraScratchesTn.size());
}

TEST(SoftBodyBuilder, ReorientsNegativeTets) {
  btSoftBodyWorldInfo info;
  TetMesh cage = test::latticeCage(1, 1, 1);
  std::swap(cage.tets[2][0], cage.tets[2][1]);
  const Body body(createSoftBody(cage, info).value());
  ASSERT_NE(body, nullptr);
  for (int t = 0; t < body->m_tetras.size(); ++t) EXPECT_GT(body->m_tetras[t].m_element_measure, 0);
}

TEST(SoftBodyBuilder, MassIsTheTotalAskedFor) {
  btSoftBodyWorldInfo info;
  const TetMesh cage = wavyCage();
  SoftBodyOptions options;
  options.mass = 3.5;
  const Body body(createSoftBody(cage, info, options).value());
  EXPECT_NEAR(body->getTotalMass(), 3.5, 1e-4);
  options.density = 1000;
  EXPECT_NEAR(Body(createSoftBody(cage, info, options).value())->getTotalMass(), 3.5, 1e-4) << "mass counts before it";
  const double volume = totalVolume(cage);
  options.mass.reset();
  EXPECT_NEAR(Body(createSoftBody(cage, info, options).value())->getTotalMass(), 1000 * volume, 0.1 * volume);
  EXPECT_NEAR(Body(createSoftBody(cage, info).value())->getTotalMass(), 100 * volume, 0.01 * volume);
}

TEST(SoftBodyBuilder, LumpedMassesAreAQuarterOfEachTet) {
  const TetMesh cage = test::latticeCage(2, 2, 2);
  const std::vector<double> masses = lumpedMasses(cage, 8.0);  // density 1
  EXPECT_NEAR(std::accumulate(masses.begin(), masses.end(), 0.0), 8.0, 1e-12);
  // The middle node of the mirrored lattice belongs to all 48 tets or to a third of them, but never to fewer than an
  // inner node of eight cubes: 8 cubes x 1/6 x at least 2 tets x 1/4.
  EXPECT_GE(masses[13], 8.0 / 6.0 * 2.0 / 4.0 - 1e-12);
}

TEST(SoftBodyBuilder, LightestNodeHasThreeTenthsOfTheMean) {
  TetMesh cage = test::latticeCage(3, 3, 3);
  // A sliver on top: its apex belongs to a tet of almost no volume.
  cage.nodes.emplace_back(0.5, 0.5, 3.001);
  const int apex = static_cast<int>(cage.nodeCount()) - 1;
  cage.tets.push_back({48, 49, 52, apex});
  ASSERT_EQ(repairTetMesh(cage).zeroVolume.count, 0u);
  const std::vector<double> masses = lumpedMasses(cage, 1.0);
  const double mean = 1.0 / static_cast<double>(masses.size());
  EXPECT_NEAR(*std::min_element(masses.begin(), masses.end()), 0.3 * mean, 0.1 * mean);
  EXPECT_EQ(masses[apex], *std::min_element(masses.begin(), masses.end()));
}

TEST(SoftBodyBuilder, MarginDefaultsToAFractionOfTheSize) {
  btSoftBodyWorldInfo info;
  const TetMesh cage = test::latticeCage(4, 2, 2, 2.5);  // 10 long
  EXPECT_NEAR(Body(createSoftBody(cage, info).value())->getCollisionShape()->getMargin(), 0.2, 1e-6);
  SoftBodyOptions options;
  options.margin = 0.0;
  EXPECT_EQ(Body(createSoftBody(cage, info, options).value())->getCollisionShape()->getMargin(), 0);
}

TEST(SoftBodyBuilder, PinnedNodesHaveInfiniteMass) {
  btSoftBodyWorldInfo info;
  const TetMesh cage = test::latticeCage(3, 1, 1);
  SoftBodyOptions options;
  options.pinned = [](const Eigen::Vector3d& p) { return p.x() < 0.1; };
  const Body body(createSoftBody(cage, info, options).value());
  for (int n = 0; n < body->m_nodes.size(); ++n) EXPECT_EQ(body->m_nodes[n].m_im == 0, cage.nodes[n].x() < 0.1);
}

TEST(SoftBodyBuilder, HandlesAHundredThousandTetsInMemoryProportionalToThem) {
  btSoftBodyWorldInfo info;
  const TetMesh cage = test::latticeCage(26, 26, 25, 0.1);  // 101,400 tets; Bullet's own reader would take minutes
  const Body body(createSoftBody(cage, info).value());
  ASSERT_NE(body, nullptr);
  EXPECT_EQ(body->m_tetras.size(), 101400);
  std::set<std::pair<int, int>> links;
  for (int l = 0; l < body->m_links.size(); ++l) {
    const int a = static_cast<int>(body->m_links[l].m_n[0] - &body->m_nodes[0]);
    const int b = static_cast<int>(body->m_links[l].m_n[1] - &body->m_nodes[0]);
    links.insert({std::min(a, b), std::max(a, b)});
  }
  EXPECT_EQ(static_cast<int>(links.size()), body->m_links.size());
}

TEST(SoftBodyBuilder, RefusesBadCagesAndOptions) {
  btSoftBodyWorldInfo info;
  const auto fails = [&](const TetMesh& cage, const SoftBodyOptions& options, StatusCode code) {
    const Result<std::unique_ptr<btSoftBody>> result = createSoftBody(cage, info, options);
    EXPECT_EQ(result.status().code, code) << result.status().message;
    EXPECT_FALSE(result.status().message.empty());
  };
  const TetMesh good = test::latticeCage(1, 1, 1);
  fails({}, {}, StatusCode::Empty);
  TetMesh bad = good;
  bad.tets[1][2] = 77;
  fails(bad, {}, StatusCode::IndexOutOfRange);
  bad = good;
  bad.nodes[2].z() = std::numeric_limits<double>::infinity();
  fails(bad, {}, StatusCode::NonFinite);
  bad = good;
  bad.tets.push_back({0, 1, 2, 3});  // a flat tet among good ones
  fails(bad, {}, StatusCode::Degenerate);
  SoftBodyOptions none;
  none.density = 0;
  fails(good, none, StatusCode::InvalidOption);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinite = std::numeric_limits<double>::infinity();
  for (double SoftBodyOptions::*value :
       {&SoftBodyOptions::density, &SoftBodyOptions::friction, &SoftBodyOptions::restitution,
        &SoftBodyOptions::relativeStiffness, &SoftBodyOptions::stiffnessDamping, &SoftBodyOptions::timeStep,
        &SoftBodyOptions::poissonRatio, &SoftBodyOptions::solverTolerance}) {
    for (const double refused : {-1.0, kNaN, kInfinite}) {
      SoftBodyOptions options;
      options.*value = refused;
      fails(good, options, StatusCode::InvalidOption);
    }
  }
  for (std::optional<double> SoftBodyOptions::*value :
       {&SoftBodyOptions::mass, &SoftBodyOptions::youngsModulus, &SoftBodyOptions::margin}) {
    for (const double refused : {-1.0, kNaN, kInfinite}) {
      SoftBodyOptions options;
      options.*value = refused;
      fails(good, options, StatusCode::InvalidOption);
    }
  }
  for (const double refused : {-0.1, 1.1, kNaN}) {
    SoftBodyOptions options;
    options.restitution = refused;
    fails(good, options, StatusCode::InvalidOption);
  }
  SoftBodyOptions options;
  options.mass = 0.0;
  fails(good, options, StatusCode::InvalidOption);
  options = {};
  options.forceModel = static_cast<ForceModel>(99);
  fails(good, options, StatusCode::InvalidOption);
}

TEST(SoftBody, IsRefusedFarFromTheOriginForThatReason) {
  if (sizeof(btScalar) == sizeof(double)) return;  // a cage has no more digits
  btSoftBodyWorldInfo info;
  TetMesh cage = test::latticeCage(2, 2, 2, 0.1);
  for (Eigen::Vector3d& p : cage.nodes) p.x() += 1e8;
  const Status status = createSoftBody(cage, info).status();
  EXPECT_EQ(status.code, StatusCode::Degenerate);
  EXPECT_NE(status.message.find("nearer to the origin"), std::string::npos) << status.message;
}

TEST(SoftBody, IsRefusedWithAMassThatItsNumbersCannotCarry) {
  btSoftBodyWorldInfo info;
  SoftBodyOptions options;
  const double bound = sizeof(btScalar) == sizeof(double) ? 1e100 : 1e15;
  for (const double mass : {0.9 * bound, 1.1 / bound}) {
    options.mass = mass;
    EXPECT_TRUE(createSoftBody(test::latticeCage(2, 2, 2, 0.1), info, options).ok());
  }
  for (const double mass : {1.1 * bound, 0.9 / bound}) {
    options.mass = mass;
    EXPECT_EQ(createSoftBody(test::latticeCage(2, 2, 2, 0.1), info, options).status().code, StatusCode::InvalidOption);
  }
}

}  // namespace
}  // namespace tetskin
