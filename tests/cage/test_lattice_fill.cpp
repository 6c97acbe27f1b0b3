// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The fill keeps exactly the tets that intersect the surface or lie inside.
#include "cage_models.h"
#include "support/odd_meshes.h"

#include <tetskin/cage/src/lattice/bcc_lattice.h>
#include <tetskin/cage/src/lattice/inside_fill.h>
#include <tetskin/cage/src/lattice/surface_cover.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

namespace tetskin::test {
namespace {

using test::kPi;

using namespace cage_detail;

constexpr std::size_t kNoLimit = 100'000'000;
const Eigen::Vector3d kZero = Eigen::Vector3d::Zero();
/// The origin lies away from round coordinates.
const Eigen::Vector3d kOrigin(0.0123, -0.0271, 0.0317);

LatticeSet touched(const TriangleMesh& mesh, double half) {
  LatticeSet set;
  EXPECT_TRUE(coverSurface(prepareSurface(mesh), {kOrigin, half}, kNoLimit, set));
  return set;
}

LatticeSet filled(const TriangleMesh& mesh, double half) {
  LatticeSet set = touched(mesh, half);
  const Surface surface = prepareSurface(mesh);
  EXPECT_TRUE(fillInside(surface, windingTreeOf(surface), {kOrigin, half}, kNoLimit, set));
  return set;
}

bool holds(const LatticeSet& set, double half, const Eigen::Vector3d& p) {
  return set.contains(locate(LatticeFrame{kOrigin, half}.toLattice(p)));
}

/// Least and greatest distance of a tet from the origin, in rest space.
std::array<double, 2> distances(const LatticeTet& tet, double half) {
  TetCorners p;
  double farthest = 0.0;
  for (int i = 0; i < 4; ++i) {
    const auto& c = latticeTables().corners[tet.local][i];
    p[i] = kOrigin + half * (cubeOrigin(tet.cube) + Eigen::Vector3d(c[0], c[1], c[2]));
    farthest = std::max(farthest, p[i].norm());
  }
  return {distanceToTet(kZero, p, BarycentricMap(p)(kZero)), farthest};
}

TEST(SurfaceCover, SphereTouchesExactlyTheTetsAcrossIt) {
  constexpr double kHalf = 0.11;
  const LatticeSet set = touched(unitSphere(60), kHalf);
  const double facets = 1.0 - std::cos(kPi / 60.0) + 1e-3;  // how far the triangles lie below the sphere
  for (int i = 0; i < 14 * 14 * 14 * kTetsPerCube; ++i) {
    const int cube = i / kTetsPerCube;
    const LatticeTet tet{{cube % 14 - 7, cube / 14 % 14 - 7, cube / 196 - 7}, i % kTetsPerCube};
    const auto [nearest, farthest] = distances(tet, kHalf);
    if (nearest > 1.0 + 1e-3 || farthest < 1.0 - facets) {
      EXPECT_FALSE(set.contains(tet));
    }
    if (nearest < 1.0 - facets && farthest > 1.0) {
      EXPECT_TRUE(set.contains(tet));
    }
  }
}

TEST(SurfaceCover, NoPointOfALargeTriangleIsMissed) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {10, 1, 2}, {3, 9, -4}};
  mesh.triangles = {{0, 1, 2}};
  const LatticeSet set = touched(mesh, 0.1);
  for (const Eigen::Vector3d& r : randomPoints(100000, Box3(kZero, Eigen::Vector3d::Ones()), 2)) {
    const double a = std::sqrt(r.x()), b = r.y() * a;
    const Eigen::Vector3d p = (1 - a) * mesh.positions[0] + (a - b) * mesh.positions[1] + b * mesh.positions[2];
    ASSERT_TRUE(holds(set, 0.1, p));
  }
}

TEST(SurfaceCover, SliversAndNeedlesAreNotLost) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {5, 1e-13, 0}, {2, 0, 1e-13}, {1, 1, 1}, {1, 1, 1 + 1e-9}, {4, 3, 2}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {0, 5, 5}};
  const LatticeSet set = touched(mesh, 0.05);
  for (int i = 0; i <= 1000; ++i) {
    const double s = i / 1000.0;
    ASSERT_TRUE(holds(set, 0.05, s * mesh.positions[1]));
    ASSERT_TRUE(holds(set, 0.05, mesh.positions[3] + s * (mesh.positions[5] - mesh.positions[3])));
    ASSERT_TRUE(holds(set, 0.05, s * mesh.positions[5]));
  }
}

TEST(SurfaceCover, StopsAtTheLimit) {
  LatticeSet set;
  EXPECT_FALSE(coverSurface(prepareSurface(boxMesh({1000, 1000, 1000})), {kOrigin, 1e-3}, 1000, set));
  EXPECT_LT(set.tetCount(), 1100u);
}

TEST(InsideFill, SphereIsFilled) {
  const LatticeSet set = filled(unitSphere(30), 0.05);
  for (const Eigen::Vector3d& p : randomPoints(20000, Box3(-Eigen::Vector3d::Ones(), Eigen::Vector3d::Ones()), 4)) {
    if (p.norm() < 0.99) {
      ASSERT_TRUE(holds(set, 0.05, p));
    }
    if (p.norm() > 1.1) {
      ASSERT_FALSE(holds(set, 0.05, p));
    }
  }
}

TEST(InsideFill, HoleOfATorusStaysOpen) {
  const LatticeSet set = filled(torusMesh(48), 0.05);
  EXPECT_FALSE(holds(set, 0.05, kZero));
  EXPECT_TRUE(holds(set, 0.05, {1, 0, 0}));
  EXPECT_TRUE(holds(set, 0.05, {-1, 0.05, 0.1}));
}

TEST(InsideFill, BowlsAndBunniesAreFilledUpToTheirRims) {
  const LatticeSet half = filled(openSphereMesh(30, kPi / 2), 0.1);
  EXPECT_TRUE(holds(half, 0.1, {0, 0, 0.3}));
  EXPECT_FALSE(holds(half, 0.1, {0, 0, -0.3}));
  // The mesh is open at the bottom, with a hole much wider than a tet.
  const LatticeSet most = filled(openSphereMesh(30, 0.8 * kPi), 0.1);
  EXPECT_TRUE(holds(most, 0.1, kZero));
  EXPECT_TRUE(holds(most, 0.1, {0, 0, -0.6}));
  EXPECT_FALSE(holds(most, 0.1, {0, 0, -1.2}));
  EXPECT_EQ(filled(invertedMesh(openSphereMesh(30, 0.8 * kPi)), 0.1).tetCount(), most.tetCount());
}

TEST(InsideFill, CavityStaysEmptyAndNestedPartIsFilled) {
  const TriangleMesh inner = sphere(20, 0.6, kZero);
  EXPECT_FALSE(holds(filled(joined(unitSphere(20), invertedMesh(inner)), 0.05), 0.05, kZero));
  EXPECT_TRUE(holds(filled(joined(unitSphere(20), inner), 0.05), 0.05, kZero));
}

TEST(InsideFill, PocketOfAirIsNotInside) {
  // A thick open shell: if its mouth is narrower than a tet, intersected tets enclose the air in it, which nevertheless
  // is outside.
  TriangleMesh shell =
      joined(openSphereMesh(40, 0.97 * kPi), invertedMesh(transformed(openSphereMesh(40, 0.97 * kPi), 0.7, kZero)));
  const int rim = 1 + 39 * 80, other = static_cast<int>(shell.vertexCount() / 2);
  for (int s = 0; s < 80; ++s) {
    const int a = rim + s, b = rim + (s + 1) % 80;
    shell.triangles.push_back({a, other + a, other + b});
    shell.triangles.push_back({a, other + b, b});
  }
  ASSERT_EQ(prepareSurface(shell).openEdges, 0u);
  const LatticeSet set = filled(shell, 0.15);
  EXPECT_FALSE(holds(set, 0.15, kZero));
  EXPECT_TRUE(holds(set, 0.15, {0.85, 0, 0}));
}

TEST(InsideFill, OrientationAndDoublingMakeNoDifference) {
  const TriangleMesh mesh = figurineMesh(24);
  const std::size_t count = filled(mesh, 0.1).tetCount();
  EXPECT_EQ(filled(invertedMesh(mesh), 0.1).tetCount(), count);
  EXPECT_EQ(filled(shuffledOrientation(mesh), 0.1).tetCount(), count);
  EXPECT_EQ(filled(unwelded(mesh), 0.1).tetCount(), count);
  EXPECT_EQ(filled(joined(mesh, invertedMesh(mesh)), 0.1).tetCount(), count);
}

TEST(InsideFill, SoupThatCannotBeWeldedIsFilledAllTheSame) {
  TriangleMesh mesh = shuffledOrientation(unwelded(unitSphere(24)));
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) mesh.positions[v] *= 1.0 + 1e-7 * static_cast<double>(v % 7);
  EXPECT_TRUE(holds(filled(mesh, 0.1), 0.1, kZero));
}

}  // namespace
}  // namespace tetskin::test
