// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/mesh/quadratic_assembly.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>

#include <chrono>
#include <limits>
#include <numeric>
#include <set>

namespace tetskin {
namespace {

Cage refined(const TetMesh& mesh) {
  const Result<Cage> cage = refineQuadratic(mesh);
  EXPECT_TRUE(cage.ok()) << cage.status().message;
  return cage.value();
}

/// The tets in another order, each with its nodes in another order; the nodes with other numbers.
Cage shuffled(const Cage& cage, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<int> nodeAt(cage.mesh.nodeCount()), tetAt(cage.mesh.tetCount()), numberOf(cage.mesh.nodeCount());
  std::iota(nodeAt.begin(), nodeAt.end(), 0);
  std::iota(tetAt.begin(), tetAt.end(), 0);
  std::shuffle(nodeAt.begin(), nodeAt.end(), random);
  std::shuffle(tetAt.begin(), tetAt.end(), random);
  Cage mixed;
  for (std::size_t n = 0; n < nodeAt.size(); ++n) {
    mixed.mesh.nodes.push_back(cage.mesh.nodes[nodeAt[n]]);
    numberOf[nodeAt[n]] = static_cast<int>(n);
  }
  for (const int t : tetAt) {
    Tet tet = cage.mesh.tets[t];
    std::shuffle(tet.begin(), tet.end(), random);
    for (int& node : tet) node = numberOf[node];
    mixed.mesh.tets.push_back(tet);
    if (!cage.quadraticTet.empty()) mixed.quadraticTet.push_back(cage.quadraticTet[t]);
  }
  return mixed;
}

std::set<std::set<std::array<double, 3>>> cornerSets(const Cage& cage) {
  std::set<std::set<std::array<double, 3>>> sets;
  const auto tets = quadraticTets(cage);
  EXPECT_TRUE(tets.ok()) << tets.status().message;
  for (const QuadraticTet& tet : tets.value()) {
    std::set<std::array<double, 3>> corners;
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector3d& p = cage.mesh.nodes[tet.nodes[k]];
      corners.insert({p.x(), p.y(), p.z()});
    }
    sets.insert(corners);
  }
  return sets;
}

void expectSound(const Cage& cage) {
  const auto tets = quadraticTets(cage);
  ASSERT_TRUE(tets.ok()) << tets.status().message;
  for (std::size_t k = 0; k < tets.value().size(); ++k) {
    const QuadraticTet& tet = tets.value()[k];
    const auto at = [&](std::size_t n) { return cage.mesh.nodes[tet.nodes[n]]; };
    EXPECT_GT(signedVolume({at(0), at(1), at(2), at(3)}), 0.0);
    for (std::size_t e = 0; e < 6; ++e) {
      EXPECT_TRUE(isMidpoint(cage.mesh, tet.nodes[4 + e], tet.nodes[kTetEdges[e][0]], tet.nodes[kTetEdges[e][1]]));
    }
    EXPECT_TRUE(std::is_sorted(tet.tets.begin(), tet.tets.end()));
    for (const int t : tet.tets) EXPECT_EQ(cage.quadraticTet[t], static_cast<int>(k));
  }
}

TEST(QuadraticTets, OfASingleTetHasItsCornersAndTheMiddlesOfItsEdges) {
  const TetMesh mesh = test::singleTet();
  const Cage cage = refined(mesh);
  EXPECT_EQ(cage.mesh.nodeCount(), 10u);
  EXPECT_EQ(cage.quadraticTet, std::vector<int>(8, 0));
  const std::vector<QuadraticTet> tets = quadraticTets(cage).value();
  ASSERT_EQ(tets.size(), 1u);
  EXPECT_EQ(tets[0].tets, (std::array<int, 8>{0, 1, 2, 3, 4, 5, 6, 7}));
  std::set<int> corners(tets[0].nodes.begin(), tets[0].nodes.begin() + 4);
  EXPECT_EQ(corners, (std::set<int>{0, 1, 2, 3}));
  expectSound(cage);
  EXPECT_TRUE(validate(cage).ok());
}

/// Masses and fractions of a cage that its body does not fill.
TEST(QuadraticTets, HaveTheMassOfTheCageAndTheFractionsOfTheirParts) {
  Cage cage(test::singleTet());
  cage.volumeFraction = {0.25};
  for (std::size_t k = 0; k < kFineTets; ++k) cage.fineVolumeFraction.push_back(k < kFineTets / 4 ? 255 : 0);
  cage.masses = {1, 2, 3, 4};
  cage.stiffnessFactor = {0.5};
  const Cage quadratic = refineQuadratic(cage).value();
  EXPECT_TRUE(validate(quadratic).ok());
  EXPECT_EQ(quadratic.volumeFraction, (std::vector<double>{1, 1, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(quadratic.fineVolumeFraction.size(), 8 * kFineTets);
  EXPECT_EQ(std::count(quadratic.fineVolumeFraction.begin(), quadratic.fineVolumeFraction.end(), 255), 128);
  EXPECT_NEAR(std::accumulate(quadratic.masses.begin(), quadratic.masses.end(), 0.0), 10.0, 1e-12);
  EXPECT_TRUE(quadratic.stiffnessFactor.empty());
  cage.fineVolumeFraction.clear();
  EXPECT_EQ(refineQuadratic(cage).value().volumeFraction, std::vector<double>(8, 0.25));
  cage.masses.pop_back();
  EXPECT_EQ(refineQuadratic(cage).status().code, StatusCode::SizeMismatch);
}

TEST(QuadraticTets, ANodeThatNoTetUsesHasMassToo) {
  Cage cage(test::singleTet());
  cage.mesh.nodes.push_back({5, 5, 5});
  cage.masses = {1, 2, 3, 4, 5};
  const Cage quadratic = refineQuadratic(cage).value();
  EXPECT_TRUE(validate(quadratic).ok()) << validate(quadratic).message;
  EXPECT_NEAR(std::accumulate(quadratic.masses.begin(), quadratic.masses.end(), 0.0), 15.0, 1e-12);
}

TEST(QuadraticTets, AreNotMadeOfDuplicates) {
  Cage cage(test::singleTet());
  cage.mesh.tets.push_back(cage.mesh.tets[0]);
  cage.sourceTet = {0, 0};
  ASSERT_TRUE(cage.hasDuplicates());
  EXPECT_EQ(refineQuadratic(cage).status().code, StatusCode::InvalidOption);
}

TEST(QuadraticTets, NeighboursShareTheMidpointsOfTheirFace) {
  const Cage cage = refined({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, {{0, 1, 2, 3}, {1, 2, 3, 4}}});
  EXPECT_EQ(cage.mesh.nodeCount(), 5u + 9u);
  const std::vector<QuadraticTet> tets = quadraticTets(cage).value();
  ASSERT_EQ(tets.size(), 2u);
  const std::set<int> one(tets[0].nodes.begin(), tets[0].nodes.end());
  const auto shared =
      std::count_if(tets[1].nodes.begin(), tets[1].nodes.end(), [&](int n) { return one.count(n) > 0; });
  EXPECT_EQ(shared, 6);
}

TEST(QuadraticTets, DoNotDependOnTheOrderOfTetsAndNodes) {
  for (const test::LatticeKind& kind : test::latticeKinds()) {
    const TetMesh coarse = kind.make(2);
    const Cage cage = refined(coarse), mixed = shuffled(cage, 5);
    EXPECT_EQ(quadraticTets(cage).value().size(), coarse.tetCount());
    EXPECT_EQ(cornerSets(mixed), cornerSets(cage)) << kind.name;
    expectSound(cage);
    expectSound(mixed);
  }
}

TEST(QuadraticTets, OfNegativeTetsArePositive) {
  TetMesh mesh = test::singleTet();
  std::swap(mesh.tets[0][2], mesh.tets[0][3]);
  Cage cage = refined(mesh);
  expectSound(cage);
  for (const Tet& tet : cage.mesh.tets) EXPECT_GT(signedVolume(cornersOf(cage.mesh, tet)), 0.0);
  for (Tet& tet : cage.mesh.tets) std::swap(tet[0], tet[1]);
  expectSound(cage);
}

TEST(QuadraticTets, AreRecognisedAroundEveryDiagonal) {
  // Each of the three is the shortest in one of these boxes.
  std::set<std::set<int>> diagonals;
  for (int axis = 0; axis < 3; ++axis) {
    TetMesh mesh{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2, 3}}};
    for (Eigen::Vector3d& p : mesh.nodes) p[axis] *= 0.5;
    const Cage cage = refined(mesh);
    expectSound(cage);
    std::vector<int> uses(cage.mesh.nodeCount(), 0);
    for (const Tet& tet : cage.mesh.tets) {
      for (const int node : tet) ++uses[node];
    }
    std::set<int> ends;
    for (std::size_t n = 0; n < uses.size(); ++n) {
      if (uses[n] == 6) ends.insert(static_cast<int>(n));
    }
    EXPECT_EQ(ends.size(), 2u);
    diagonals.insert(ends);
  }
  EXPECT_EQ(diagonals.size(), 3u);
}

TEST(QuadraticTets, OthersStayLinear) {
  Cage cage = refined(test::latticeCage(1, 1, 1));
  const Cage whole = cage;
  for (int& number : cage.quadraticTet) number = number < 2 ? number : -1;
  EXPECT_EQ(quadraticTets(cage).value().size(), 2u);
  EXPECT_TRUE(validate(cage).ok());
  cage.quadraticTet.assign(cage.mesh.tetCount(), -1);
  EXPECT_TRUE(quadraticTets(cage).value().empty());
  cage.quadraticTet.clear();
  EXPECT_TRUE(quadraticTets(cage).value().empty());
}

void expectRefused(const Cage& cage, const char* words, StatusCode code = StatusCode::InvalidOption) {
  const auto tets = quadraticTets(cage);
  ASSERT_FALSE(tets.ok()) << words;
  EXPECT_EQ(tets.status().code, code);
  EXPECT_NE(tets.status().message.find(words), std::string::npos) << tets.status().message;
  EXPECT_EQ(validate(cage).message, tets.status().message);
}

TEST(QuadraticTets, WrongNumbersAreRefused) {
  const Cage sound = refined(test::latticeCage(1, 1, 1));
  Cage cage = sound;
  cage.quadraticTet.pop_back();
  expectRefused(cage, "47 quadraticTet for 48 tets", StatusCode::SizeMismatch);
  for (const int bad : {-2, 6, 1 << 30, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
    cage = sound;
    cage.quadraticTet[17] = bad;
    expectRefused(cage, "quadraticTet[17]");
  }
  cage = sound;
  cage.quadraticTet[8] = -1;
  expectRefused(cage, "is 1 for 7 tets, the first of which is tet 9");
  cage.quadraticTet[8] = 2;
  expectRefused(cage, "is 1 for 7 tets");
  cage = sound;
  for (int& number : cage.quadraticTet) number = number == 3 ? -1 : number;
  expectRefused(cage, "is 3 for 0 tets; number quadratic tets from 0 on");
  cage = sound;
  std::swap(cage.quadraticTet[8], cage.quadraticTet[16]);
  expectRefused(cage, "is 1 for 8 tets, the first of which is tet 9");
}

TEST(QuadraticTets, NodesAwayFromTheMiddlesAreRefused) {
  const Cage sound = refined(test::singleTet());
  for (int node = 4; node < 10; ++node) {
    Cage cage = sound;
    cage.mesh.nodes[node] += 1e-3 * Eigen::Vector3d(1, -1, 1);
    expectRefused(cage, "the middles of its edges");
    cage = sound;
    cage.mesh.nodes[node] += 1e-6 * Eigen::Vector3d(1, -1, 1);
    EXPECT_TRUE(quadraticTets(cage).ok()) << "rounding of a file";
    cage.mesh.nodes[node].x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(quadraticTets(cage).ok());
  }
}

TEST(QuadraticTets, EightTetsThatAreNotThoseOfOneAreRefused) {
  const Cage sound = refined(test::singleTet());
  for (int a = 0; a < 8; ++a) {
    for (int b = 0; b < 8; ++b) {
      if (a == b) continue;
      Cage cage = sound;
      cage.mesh.tets[a] = cage.mesh.tets[b];
      EXPECT_FALSE(quadraticTets(cage).ok()) << a << " twice " << b;
    }
    for (int k = 0; k < 4; ++k) {
      for (int node = 0; node < 10; ++node) {
        Cage cage = sound;
        if (cage.mesh.tets[a][k] == node) continue;
        cage.mesh.tets[a][k] = node;
        EXPECT_FALSE(quadraticTets(cage).ok()) << "tet " << a << ", node " << k << " is " << node;
      }
    }
  }
  Cage flat = sound;
  for (Eigen::Vector3d& p : flat.mesh.nodes) p.z() = 0.0;
  EXPECT_FALSE(quadraticTets(flat).ok());
  // Two opposite ones of the four around the diagonal, twice each: every node has its share of tets.
  Cage pairs = sound;
  pairs.mesh.tets[5] = pairs.mesh.tets[4];
  pairs.mesh.tets[7] = pairs.mesh.tets[6];
  EXPECT_FALSE(quadraticTets(pairs).ok());
}

TEST(RefineQuadratic, KeepsTheNodesInFrontAndTheVolume) {
  const TetMesh mesh = test::jittered(test::bodyCentredCage(2, 2, 2), 0.2, 4);
  const Cage cage = refined(mesh);
  ASSERT_EQ(cage.mesh.tetCount(), 8 * mesh.tetCount());
  EXPECT_TRUE(std::equal(mesh.nodes.begin(), mesh.nodes.end(), cage.mesh.nodes.begin()));
  EXPECT_NEAR(totalVolume(cage.mesh), totalVolume(mesh), 1e-12);
  EXPECT_EQ(cage.mesh.nodeCount(), mesh.nodeCount() + uniqueEdges(mesh).size());
}

TEST(RefineQuadratic, RefusesWhatHasNoVolume) {
  EXPECT_EQ(refineQuadratic({}).status().code, StatusCode::Empty);
  TetMesh mesh = test::latticeCage(1, 1, 1);
  mesh.tets.push_back({0, 1, 2, 3});  // in a plane
  EXPECT_EQ(refineQuadratic(mesh).status().code, StatusCode::Degenerate);
  mesh.tets.back() = {0, 0, 1, 2};
  EXPECT_EQ(refineQuadratic(mesh).status().code, StatusCode::Degenerate);
  mesh.tets.back() = {0, 1, 2, 8};
  EXPECT_EQ(refineQuadratic(mesh).status().code, StatusCode::IndexOutOfRange);
}

}  // namespace
}  // namespace tetskin
