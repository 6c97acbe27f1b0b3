// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "cage_checks.h"
#include "support/odd_meshes.h"

#include <tetskin/cage/src/fit/cage_quality.h>
#include <tetskin/cage/src/lattice/bcc_lattice.h>
#include <tetskin/cage/src/lattice/cage_joints.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <set>

namespace tetskin::test {
namespace {

using namespace cage_detail;

using Point = std::array<int, 3>;

std::array<Point, 4> cornersAt(const LatticeTet& tet) {
  std::array<Point, 4> corners = latticeTables().corners[tet.local];
  for (Point& p : corners) {
    for (int axis = 0; axis < 3; ++axis) p[axis] += 2 * tet.cube[axis];
  }
  return corners;
}

TetCorners positionsOf(const LatticeTet& tet) {
  TetCorners p;
  const std::array<Point, 4> corners = cornersAt(tet);
  for (int i = 0; i < 4; ++i) p[i] = Eigen::Vector3d(corners[i][0], corners[i][1], corners[i][2]);
  return p;
}

int sharedCorners(const LatticeTet& a, const LatticeTet& b) {
  int count = 0;
  const std::array<Point, 4> other = cornersAt(b);
  for (const Point& p : cornersAt(a)) count += static_cast<int>(std::count(other.begin(), other.end(), p));
  return count;
}

LatticeSet randomSet(double density, unsigned seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution keep(std::min(density, 1.0));
  LatticeSet set;
  for (int z = 0; z < 6; ++z) {
    for (int y = 0; y < 6; ++y) {
      for (int x = 0; x < 6; ++x) {
        for (int local = 0; local < kTetsPerCube; ++local) {
          if (keep(random)) set.add({{x, y, z}, local});
        }
      }
    }
  }
  return set;
}

std::string topologyFault(const LatticeSet& set) {
  return faultOfTopology(meshOf(set, LatticeFrame{}).mesh);
}

TEST(BccLattice, TetsAreCongruentAndPositive) {
  LatticeSet set;
  for (int local = 0; local < kTetsPerCube; ++local) {
    set.add({{0, 0, 0}, local});
    const TetCorners p = positionsOf({{0, 0, 0}, local});
    EXPECT_DOUBLE_EQ(signedVolume(p), kLatticeTetVolume);
    EXPECT_DOUBLE_EQ(tetSize(p), 2.0);
  }
  const DihedralRange range = dihedralRange(meshOf(set, LatticeFrame{}).mesh);
  EXPECT_NEAR(range.minDeg, 60.0, 1e-9);
  EXPECT_NEAR(range.maxDeg, 90.0, 1e-9);
}

TEST(BccLattice, LocatedTetHoldsThePoint) {
  for (const Eigen::Vector3d& p : randomPoints(20000, Box3(Eigen::Vector3d(-9, -9, -9), Eigen::Vector3d(9, 9, 9)), 5)) {
    EXPECT_LT(barycentricDistance(BarycentricMap(positionsOf(locate(p)))(p)), 1e-12);
  }
}

TEST(BccLattice, TetsLieBetweenTheirPlanes) {
  for (int local = 0; local < kTetsPerCube; ++local) {
    for (const Eigen::Vector3d& p : positionsOf({{0, 0, 0}, local})) {
      const std::array<double, 6> d = planeCoordinates(p);
      for (int i = 0; i < 6; ++i) {
        EXPECT_GE(d[i], latticeTables().floors[local][i]);
        EXPECT_LE(d[i], latticeTables().floors[local][i] + 2);
      }
    }
  }
}

TEST(BccLattice, NeighboursShareTheFaceOppositeToACorner) {
  for (int local = 0; local < kTetsPerCube; ++local) {
    const LatticeTet tet{{3, -2, 5}, local};
    for (int corner = 0; corner < 4; ++corner) {
      const LatticeTet next = tet.cube + latticeTables().neighbours[local][corner];
      EXPECT_EQ(sharedCorners(tet, next), 3);
      const std::array<Point, 4> other = cornersAt(next);
      EXPECT_EQ(std::count(other.begin(), other.end(), cornersAt(tet)[corner]), 0);
    }
  }
}

TEST(BccLattice, StarsHold24DistinctTetsAroundTheNode) {
  for (int kind = 0; kind < 2; ++kind) {
    std::set<std::array<int, 4>> seen;
    for (const LatticeStep& step : latticeTables().star[kind]) {
      const LatticeTet tet = Cube{0, 0, 0} + step;
      const std::array<Point, 4> corners = cornersAt(tet);
      EXPECT_EQ(std::count(corners.begin(), corners.end(), Point{kind, kind, kind}), 1);
      seen.insert({tet.cube[0], tet.cube[1], tet.cube[2], tet.local});
    }
    EXPECT_EQ(seen.size(), 24u);
  }
}

TEST(BccLattice, NodesOfATetAreItsCorners) {
  for (int local = 0; local < kTetsPerCube; ++local) {
    const LatticeTet tet{{-4, 7, 1}, local};
    const std::array<LatticeNode, 4> nodes = nodesOf(tet);
    for (int i = 0; i < 4; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(2 * nodes[i].cube[axis] + nodes[i].kind, cornersAt(tet)[i][axis]);
      }
    }
  }
}

TEST(LatticeSet, CountsEachTetOnceWhereverItLies) {
  LatticeSet set;
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < 1000; ++i) set.add({{i * 100003, -i * 7919, i}, i % kTetsPerCube});
  }
  EXPECT_EQ(set.tetCount(), 1000u);
  EXPECT_EQ(set.cubeCount(), 1000u);
  EXPECT_TRUE(set.contains({{500 * 100003, -500 * 7919, 500}, 500 % kTetsPerCube}));
  EXPECT_FALSE(set.contains({{500 * 100003, -500 * 7919, 500}, 501 % kTetsPerCube}));
  EXPECT_FALSE(set.contains({{1, 1, 1}, 0}));
}

TEST(LatticeMesh, WholeCubesFillSpaceWithoutGaps) {
  const LatticeSet set = randomSet(1.1, 0);
  const LatticeMesh lattice = meshOf(set, {Eigen::Vector3d(1, 2, 3), 0.25});
  EXPECT_TRUE(checkTetMesh(lattice.mesh).clean());
  EXPECT_NEAR(totalVolume(lattice.mesh), 216 * 8 * 0.25 * 0.25 * 0.25, 1e-9);
  std::size_t open = 0;
  for (const std::uint8_t faces : lattice.openFaces) {
    for (int corner = 0; corner < 4; ++corner) open += faces >> corner & 1;
  }
  EXPECT_EQ(open, boundaryFaces(lattice.mesh).size());
}

TEST(CageJoints, LeaveACleanSetAlone) {
  LatticeSet set = randomSet(1.1, 0);
  joinPinches(set);  // the outline of a set of whole cubes is ragged
  EXPECT_EQ(joinPinches(set), 0u);
  LatticeSet one;
  one.add({{0, 0, 0}, 3});
  EXPECT_EQ(joinPinches(one), 0u);
}

TEST(CageJoints, JoinTwoTetsThatShareANode) {
  LatticeSet set;
  const auto& star = latticeTables().star[0];
  set.add(Cube{0, 0, 0} + star[0]);
  for (const LatticeStep& step : star) {
    if (sharedCorners(Cube{0, 0, 0} + star[0], Cube{0, 0, 0} + step) != 1) continue;
    set.add(Cube{0, 0, 0} + step);
    break;
  }
  ASSERT_EQ(set.tetCount(), 2u);
  EXPECT_NE(topologyFault(set), "");
  EXPECT_GT(joinPinches(set), 0u);
  EXPECT_EQ(topologyFault(set), "");
}

TEST(CageJoints, MakeAnyRandomSetAManifold) {
  for (const double density : {0.02, 0.1, 0.3, 0.6, 0.9}) {
    for (unsigned seed = 0; seed < 5; ++seed) {
      LatticeSet set = randomSet(density, seed);
      EXPECT_NE(topologyFault(set), "") << "the test is too easy";
      joinPinches(set);
      EXPECT_EQ(topologyFault(set), "") << density << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace tetskin::test
