// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"
#include "support/two_plates.h"

#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <limits>

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

void expectFault(const Cage& cage, StatusCode code, const std::string& words) {
  const Status status = validateAttributes(cage);
  EXPECT_STREQ(toString(status.code), toString(code)) << status.message;
  EXPECT_NE(status.message.find(words), std::string::npos) << status.message;
}

TEST(Cage, OfAMeshOfTetsNothingElseIsKnown) {
  const Cage cage = test::latticeCage(2, 1, 1);
  EXPECT_TRUE(validateAttributes(cage).ok());
  EXPECT_TRUE(cage.checkMesh(test::sphere(4, 1.0, Vector3d::Zero())).ok());
  EXPECT_TRUE(cage.stiffnessScale().empty());
  EXPECT_FALSE(cage.hasDuplicates());
  EXPECT_FALSE(cage.meshHash);
}

TEST(Cage, WhatIsKnownOfItIsInOrder) {
  const Status status = validateAttributes(platesOfCopies().cage);
  EXPECT_TRUE(status.ok()) << status.message;
}

TEST(Cage, CheckFindsArraysOfWrongCounts) {
  const Cage good = platesOfCopies().cage;
  const StatusCode code = StatusCode::SizeMismatch;
  const std::string tets = std::to_string(good.mesh.tetCount()), nodes = std::to_string(good.mesh.nodeCount());
  Cage cage = good;
  cage.volumeFraction.pop_back();
  expectFault(cage, code, "volumeFraction for " + tets + " tets");
  (cage = good).stiffnessFactor.push_back(1.0);
  expectFault(cage, code, "stiffnessFactor for " + tets + " tets");
  (cage = good).masses.pop_back();
  expectFault(cage, code, "masses for " + nodes + " nodes");
  (cage = good).component.pop_back();
  expectFault(cage, code, "component for " + tets + " tets");
  (cage = good).sourceTet.push_back(0);
  expectFault(cage, code, "sourceTet for " + tets + " tets");
  (cage = good).fineVolumeFraction.pop_back();
  expectFault(cage, code, "small tets");
}

TEST(Cage, CheckFindsValuesThatMakeNoSense) {
  const Cage good = platesOfCopies().cage;
  const StatusCode code = StatusCode::InvalidOption;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinite = std::numeric_limits<double>::infinity();
  Cage cage;
  for (const double bad : {-0.1, 1.0001, kNan, kInfinite}) {
    (cage = good).volumeFraction[5] = bad;
    expectFault(cage, code, "volumeFraction[5] must be from 0 to 1");
  }
  for (const double bad : {-1.0, 0.0, kNan, kInfinite}) {
    (cage = good).stiffnessFactor[2] = bad;
    expectFault(cage, code, "stiffnessFactor[2] must be above 0");
    (cage = good).masses[3] = bad;
    expectFault(cage, code, "masses[3] must be above 0");
  }
  (cage = good).component[1] = -1;
  expectFault(cage, code, "component[1] must be 0 or more");
  (cage = good).sourceTet[4] = -7;
  expectFault(cage, code, "sourceTet[4] must be 0 or more");
  for (const int bad : {-1, static_cast<int>(good.mesh.tetCount())}) {
    (cage = good).vertexTets[9] = bad;
    expectFault(cage, StatusCode::IndexOutOfRange, "assigns tet " + std::to_string(bad) + " to vertex 9");
  }
}

TEST(Cage, CheckMeshKnowsTheMeshByItsCountAndPlaces) {
  const TwoPlates plates = platesOfCopies();
  EXPECT_TRUE(plates.cage.checkMesh(plates.mesh).ok());
  TriangleMesh longer = plates.mesh, moved = plates.mesh, turned = plates.mesh;
  longer.positions.push_back(Vector3d::Zero());
  Status status = plates.cage.checkMesh(longer);
  EXPECT_EQ(status.code, StatusCode::CageMismatch);
  EXPECT_NE(status.message.find("364 vertices, but this one has 365; build a cage"), std::string::npos)
      << status.message;
  moved.positions[17].y() += 1e-15;
  status = plates.cage.checkMesh(moved);
  EXPECT_EQ(status.code, StatusCode::CageMismatch);
  EXPECT_NE(status.message.find("other vertex positions, or another order of vertices; build"), std::string::npos)
      << status.message;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_TRUE(plates.cage.checkMesh(turned).ok());

  Cage unknowing = plates.cage;
  unknowing.meshHash.reset();
  EXPECT_TRUE(unknowing.checkMesh(moved).ok());
  unknowing.vertexTets.clear();
  EXPECT_TRUE(unknowing.checkMesh(longer).ok());
}

TEST(Cage, StiffnessIsFactorTimesFillButNeverNextToNothing) {
  Cage cage = test::latticeCage(1, 1, 1);
  cage.stiffnessFactor = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(cage.stiffnessScale(), cage.stiffnessFactor);
  cage.volumeFraction = {1.0, 0.5, 0.25, Limits::kMinVolumeFraction, 0.5 * Limits::kMinVolumeFraction, 0.0};
  EXPECT_EQ(cage.stiffnessScale(),
            (std::vector<double>{1, 1, 0.75, 4 * Limits::kMinVolumeFraction, 5 * Limits::kMinVolumeFraction,
                                 6 * Limits::kMinVolumeFraction}));
  cage.stiffnessFactor.clear();
  EXPECT_EQ(cage.stiffnessScale(), (std::vector<double>{1, 0.5, 0.25, Limits::kMinVolumeFraction,
                                                        Limits::kMinVolumeFraction, Limits::kMinVolumeFraction}));
}

TEST(Cage, ScalesMassesAsVolumes) {
  Cage cage = platesOfCopies().cage;
  const Cage before = cage;
  cage.scaleBy(2.0);
  for (std::size_t n = 0; n < cage.mesh.nodeCount(); ++n) {
    EXPECT_EQ(cage.mesh.nodes[n], 2.0 * before.mesh.nodes[n]);
    EXPECT_EQ(cage.masses[n], 8.0 * before.masses[n]);
  }
  EXPECT_EQ(cage.volumeFraction, before.volumeFraction);
  EXPECT_NEAR(totalVolume(cage.mesh), 8.0 * totalVolume(before.mesh), 1e-9);
}

TEST(Cage, IsSplitWhereALatticeTetHasTwoCopies) {
  EXPECT_TRUE(platesOfCopies().cage.hasDuplicates());
  EXPECT_TRUE(platesOfCopies(1.0).cage.hasDuplicates());
  EXPECT_FALSE(platesOfCopies(4.0).cage.hasDuplicates());
}

TEST(PositionsHash, DependsOnEveryPositionAndTheirOrder) {
  const std::vector<Vector3d> points = {{1, 2, 3}, {4, 5, 6}, {0, 8, 9}};
  const std::uint64_t hash = positionsHash(points);
  EXPECT_EQ(positionsHash(points), hash);
  for (std::size_t p = 0; p < 3; ++p) {
    for (int i = 0; i < 3; ++i) {
      auto other = points;
      other[p][i] = std::nextafter(other[p][i], 100.0);
      EXPECT_NE(positionsHash(other), hash) << p << " " << i;
    }
  }
  EXPECT_NE(positionsHash({points[1], points[0], points[2]}), hash);
  EXPECT_NE(positionsHash({points[0], points[1]}), hash);
  EXPECT_EQ(positionsHash({points[0], points[1], {-0.0, 8, 9}}), hash);
}

double distanceIn(const Cage& cage, int tet, const Vector3d& point) {
  return barycentricDistance(
      BarycentricMap(cornersOf(cage.mesh, cage.mesh.tets[static_cast<std::size_t>(tet)]))(point));
}

double smallestDistance(const Cage& cage, const Vector3d& point) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    smallest = std::min(smallest, distanceIn(cage, static_cast<int>(t), point));
  }
  return smallest;
}

/// A random point on each triangle.
std::vector<Vector3d> pointsOn(const TriangleMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::exponential_distribution<double> number(1.0);
  std::vector<Vector3d> points;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d w = Vector3d(number(random), number(random), number(random));
    points.push_back((w[0] * mesh.positions[a] + w[1] * mesh.positions[b] + w[2] * mesh.positions[c]) / w.sum());
  }
  return points;
}

/// A sphere in a lattice whose middle tets are left out, and the map from its vertices to tets.
struct HollowCage {
  Cage cage;
  TriangleMesh mesh = test::sphere(24, 1.6, Vector3d::Constant(2.0));

  HollowCage() {
    const TetMesh full = test::jittered(test::bodyCentredCage(8, 8, 8, 0.5), 0.08, 3);
    cage.mesh.nodes = full.nodes;
    for (const Tet& tet : full.tets) {
      const TetCorners p = cornersOf(full, tet);
      if (((p[0] + p[1] + p[2] + p[3]) / 4.0 - Vector3d::Constant(2.0)).norm() > 1.0) cage.mesh.tets.push_back(tet);
    }
    for (const VertexBinding& binding : embed(cage.mesh, viewOf(mesh.positions)).value().bindings()) {
      cage.vertexTets.push_back(binding.tet);
    }
  }
};

TEST(CageLocator, AgreesWithBruteForceWhereThereIsOneCopy) {
  const HollowCage hollow;
  const CageLocator locator(hollow.cage);
  const auto points = pointsOn(hollow.mesh, 1);
  for (std::size_t t = 0; t < points.size(); ++t) {
    const int tet = locator.locate(points[t], hollow.mesh.triangles[t]);
    ASSERT_GE(tet, 0);
    EXPECT_LE(distanceIn(hollow.cage, tet, points[t]), std::max(1e-12, smallestDistance(hollow.cage, points[t])));
  }
}

TEST(CageLocator, FindsItsWayAroundAHollowFromFarAway) {
  const HollowCage hollow;
  const CageLocator locator(hollow.cage);
  const auto points = pointsOn(hollow.mesh, 2);
  std::size_t found = 0;
  for (std::size_t t = 0; t < points.size(); ++t) {
    const int tet = locator.locate(points[t], hollow.mesh.triangles[(t + 500) % points.size()]);
    found += distanceIn(hollow.cage, tet, points[t]) <= 1e-12;
  }
  EXPECT_EQ(found, points.size());
}

TEST(CageLocator, FindsItsWayAcrossLargeTriangles) {
  Cage cage = test::jittered(test::latticeCage(12, 12, 12, 1.0 / 12), 0.02, 9);
  TriangleMesh mesh;
  mesh.positions = {{0.1, 0.1, 0.2}, {0.9, 0.15, 0.3}, {0.4, 0.85, 0.9}};
  for (int k = 0; k < 200; ++k) mesh.triangles.push_back({0, 1, 2});
  for (const VertexBinding& binding : embed(cage.mesh, viewOf(mesh.positions)).value().bindings()) {
    cage.vertexTets.push_back(binding.tet);
  }
  const CageLocator locator(cage);
  for (const Vector3d& point : pointsOn(mesh, 6)) {
    EXPECT_LE(distanceIn(cage, locator.locate(point, {0, 1, 2}), point), 1e-12);
    EXPECT_LE(distanceIn(cage, locator.locate(point, {0, 0, 0}), point), 1e-12);
  }
}

TEST(CageLocator, WithoutAMapGoesByThePlaceAlone) {
  HollowCage hollow;
  hollow.cage.vertexTets.clear();
  const CageLocator locator(hollow.cage);
  const std::array<int, 3> none = {-1, -1, -1};
  for (const Vector3d& point : test::randomPoints(60, Box3(Vector3d::Zero(), Vector3d::Constant(5.0)), 4)) {
    const double smallest = smallestDistance(hollow.cage, point);
    const double distance = distanceIn(hollow.cage, locator.locate(point, none), point);
    if (smallest > 1e-12) {
      EXPECT_EQ(distance, smallest);
    } else {
      EXPECT_LE(distance, 1e-12);
    }
  }
}

/// Expects every point of a plate to be found in a tet of that plate's own copy.
void expectOwnCopies(const TwoPlates& plates) {
  const CageLocator locator(plates.cage);
  const auto points = pointsOn(plates.mesh, 5);
  for (std::size_t t = 0; t < points.size(); ++t) {
    const bool upper = plates.upper(static_cast<std::size_t>(plates.mesh.triangles[t][0]));
    const int tet = locator.locate(points[t], plates.mesh.triangles[t]);
    EXPECT_LE(distanceIn(plates.cage, tet, points[t]), 1e-12);
    const auto lattice = static_cast<std::size_t>(plates.cage.sourceTet[static_cast<std::size_t>(tet)]);
    const bool copied = std::count(plates.cage.sourceTet.begin(), plates.cage.sourceTet.end(), lattice) > 1;
    EXPECT_EQ(static_cast<std::size_t>(tet) >= plates.latticeTets, upper && copied) << "triangle " << t;
    EXPECT_EQ(plates.cage.locate(points[t], plates.mesh.triangles[t]), tet);
  }
}

TEST(CageLocator, FindsTheCopyThatTheTriangleIsIn) {
  expectOwnCopies(platesOfCopies());
}

TEST(CageLocator, FindsTheCopyWhereTheyBranchOff) {
  expectOwnCopies(platesOfCopies(1.0));
}

TEST(CageLocator, PointsBesideAPlateStayWithIt) {
  const TwoPlates plates = platesOfCopies();
  const CageLocator locator(plates.cage);
  for (std::size_t v = 0; v < plates.mesh.vertexCount(); v += 5) {
    const auto vertex = static_cast<int>(v);
    const Vector3d within = plates.mesh.positions[v] + Vector3d(0, plates.upper(v) ? -0.25 : 0.25, 0);
    const Vector3d outside = plates.mesh.positions[v] + Vector3d(0, plates.upper(v) ? 0.7 : -0.7, 0);
    for (const Vector3d& point : {within, outside}) {
      const int tet = locator.locate(point, {vertex, vertex, vertex});
      EXPECT_EQ(static_cast<std::size_t>(tet) >= plates.latticeTets, plates.upper(v));
      EXPECT_LE(distanceIn(plates.cage, tet, point), smallestDistance(plates.cage, point) + 1e-12);
    }
  }
}

TEST(CageLocator, PassesFlatTets) {
  TwoPlates plates = platesOfCopies();
  Cage& cage = plates.cage;
  const Tet whole = cage.mesh.tets[static_cast<std::size_t>(cage.vertexTets[0])];
  cage.vertexTets[0] = static_cast<int>(cage.mesh.tetCount());
  cage.mesh.tets.push_back({whole[0], whole[1], whole[2], whole[2]});
  const int tet = CageLocator(cage).locate(plates.mesh.positions[0], {0, 0, 0});
  EXPECT_LE(distanceIn(cage, tet, plates.mesh.positions[0]), 0.0);
  EXPECT_LT(static_cast<std::size_t>(tet), plates.latticeTets);
}

TEST(CageLocator, Moves) {
  const TwoPlates plates = platesOfCopies();
  CageLocator first(plates.cage);
  const int tet = first.locate(plates.mesh.positions[7], {7, 7, 7});
  CageLocator second = std::move(first);
  EXPECT_EQ(first.locate(plates.mesh.positions[7], {7, 7, 7}), -1);  // NOLINT: moved from
  EXPECT_EQ(second.locate(plates.mesh.positions[7], {7, 7, 7}), tet);
  first = std::move(second);
  EXPECT_EQ(first.locate(plates.mesh.positions[7], {7, 7, 7}), tet);
  EXPECT_EQ(tet, plates.cage.vertexTets[7]);
}

}  // namespace
}  // namespace tetskin::test
