// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/brute_force.h"
#include "support/embed_into.h"
#include "support/odd_meshes.h"

#include <tetskin/core/embedding.h>
#include <tetskin/core/src/skinning/quadratic_skinning.h>

#include <algorithm>
#include <cmath>

namespace tetskin {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kCube = 0.25;
constexpr double kGapFrom = 1.0, kGapTo = 1.2;

/// Two legs, x in [0, 1] and [1.2, 2.2], y in [0, 4], z in [0, 0.5]; above y = 3.5 they may be joined.
TetMesh legs(bool joined) {
  TetMesh cage = test::latticeCage(9, 16, 2, kCube);
  for (Eigen::Vector3d& p : cage.nodes) {
    if (p.x() > 1.1) p.x() += kGapTo - kGapFrom - kCube;
  }
  const auto inGap = [&](const Tet& tet) {
    double x = 0.0, y = 0.0;
    for (const int n : tet) {
      x += 0.25 * cage.nodes[n].x();
      y += 0.25 * cage.nodes[n].y();
    }
    return x > kGapFrom && x < kGapTo && (!joined || y < 3.5);
  };
  cage.tets.erase(std::remove_if(cage.tets.begin(), cage.tets.end(), inGap), cage.tets.end());
  return cage;
}

/// A sheet at z = 0.25 with a column of vertices at each x, for y in [0.5, 2.75].
TriangleMesh sheet(const std::vector<double>& xs) {
  TriangleMesh mesh;
  const int columns = static_cast<int>(xs.size());
  constexpr int kRows = 10;
  for (int row = 0; row < kRows; ++row) {
    for (const double x : xs) mesh.positions.emplace_back(x, 0.5 + 0.25 * row, 0.25);
  }
  for (int row = 0; row + 1 < kRows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const int a = row * columns + column;
      mesh.triangles.push_back({a, a + 1, a + columns});
      mesh.triangles.push_back({a + 1, a + columns + 1, a + columns});
    }
  }
  return mesh;
}

/// A sheet that sticks out of the left leg: its last two columns are closer to the right leg.
TriangleMesh pokingOut() {
  return sheet({0.5, 0.7, 0.9, 1.12, 1.17});
}

std::size_t inRightLeg(const TetMesh& cage, const Embedding& embedding) {
  const auto bindings = embedding.bindings();
  return static_cast<std::size_t>(std::count_if(bindings.begin(), bindings.end(), [&](const VertexBinding& b) {
    return cage.nodes[cage.tets[b.tet][0]].x() > 1.1;
  }));
}

TEST(OutsideNeighbours, VerticesThatPokeTowardsAnotherPartStayWithTheirOwn) {
  for (const bool joined : {false, true}) {
    const TetMesh cage = legs(joined);
    const TriangleMesh mesh = pokingOut();
    Embedding embedding;
    const Fit alone = embedInto(cage, viewOf(mesh.positions), {}, embedding);
    EXPECT_EQ(inRightLeg(cage, embedding), 20u);  // without triangles, each vertex is bound to the nearest tet
    EXPECT_EQ(alone.reassignedByConnectivity, 0u);
    const Fit report = embedInto(cage, mesh, {}, embedding);
    EXPECT_EQ(inRightLeg(cage, embedding), 0u) << joined;
    EXPECT_EQ(report.reassignedByConnectivity, 20u);
    EXPECT_EQ(report.outside, 20u);
    EXPECT_NEAR(report.maxDistance, 0.08, 1e-12);  // distance from the cage, not from the vertex's own leg

    // The right leg moves by 1 along z.
    Points nodes = cage.nodes;
    for (Eigen::Vector3d& p : nodes) {
      if (p.x() > 1.1 && p.y() < 3.4) p += Eigen::Vector3d(0, 0, 1);
    }
    PackedNodes<double> packed(nodes.size());
    ASSERT_EQ(packed.pack(viewOf(std::as_const(nodes))), nodes.size());
    Points surface(mesh.vertexCount());
    skinPoints(embedding, packed, {}, SkinOutput<double, double>{viewOf(surface)});
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) EXPECT_LT((surface[v] - mesh.positions[v]).norm(), 1e-6);
  }
}

TEST(OutsideNeighbours, OtherVerticesAreBoundAsIfAlone) {
  const TetMesh cage = legs(true);
  // Sticks out on all sides, but hardly to the right.
  const TriangleMesh mesh = test::sphere(24, 0.56, {0.5, 2.0, 0.25});
  Embedding embedding;
  const Fit report = embedInto(cage, mesh, {}, embedding);
  EXPECT_GT(report.outside, 100u);
  EXPECT_EQ(report.reassignedByConnectivity, 0u);
  const auto brute = test::bruteForce(cage, mesh.positions, OutsideRule::Nearest);
  const auto bindings = embedding.bindings();
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) EXPECT_EQ(bindings[v].tet, brute[v].tet);
}

/// The last cubes of the left leg are a tenth of a cube thick: a vertex beyond them is five times as far away.
TEST(OutsideNeighbours, AThinTetOfTheirOwnGivesWayToOneThatCarriesThemBetter) {
  TetMesh cage = legs(false);
  for (Eigen::Vector3d& p : cage.nodes) {
    if (p.x() == 3.0 * kCube) p.x() = 0.98;
  }
  Embedding embedding;
  EXPECT_GT(embedInto(cage, sheet({0.5, 0.7, 0.9, 1.11}), {}, embedding).reassignedByConnectivity, 0u);
  EXPECT_EQ(inRightLeg(cage, embedding), 0u);
  for (const VertexBinding& b : embedding.bindings()) {
    for (const float weight : b.weights) EXPECT_LE(std::abs(weight), 4.0f);
  }
}

TEST(OutsideNeighbours, ANearestTetThatIsMuchNearerThanTheirOwnIsTaken) {
  const TetMesh cage = legs(false);
  TriangleMesh mesh;
  mesh.positions = {{0.3, 2.0, 0.2}, {0.3, 2.2, 0.2}, {2.0, 2.0, 0.55}, {0.9, 2.1, 0.6}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  Embedding embedding;
  const Fit report = embedInto(cage, mesh, {}, embedding);
  EXPECT_EQ(report.outside, 2u);
  EXPECT_EQ(report.reassignedByConnectivity, 0u);
  EXPECT_EQ(inRightLeg(cage, embedding), 1u);  // vertex 2, more than a leg's width away from its own leg
}

TEST(OutsideNeighbours, APieceWithNoVertexInsideStaysWhereItIsNearest) {
  const TetMesh cage = legs(false);
  const TriangleMesh mesh = sheet({1.12, 1.17});
  Embedding embedding;
  const Fit report = embedInto(cage, mesh, {}, embedding);
  EXPECT_EQ(report.reassignedByConnectivity, 0u);
  EXPECT_EQ(inRightLeg(cage, embedding), mesh.vertexCount());
}

TEST(OutsideNeighbours, TheBarycentricRuleIsLeftPure) {
  const TetMesh cage = legs(false);
  const TriangleMesh mesh = pokingOut();
  Embedding embedding;
  const Fit report = embedInto(cage, mesh, {OutsideRule::Barycentric}, embedding);
  EXPECT_EQ(report.reassignedByConnectivity, 0u);
  EXPECT_EQ(inRightLeg(cage, embedding), 20u);
  const auto brute = test::bruteForce(cage, mesh.positions, OutsideRule::Barycentric);
  const auto bindings = embedding.bindings();
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) EXPECT_EQ(bindings[v].tet, brute[v].tet);
}

/// Every triangle has separate vertices, which are connected by their positions.
TEST(OutsideNeighbours, SeamsChangeTogether) {
  const TetMesh cage = legs(true);
  const TriangleMesh whole = pokingOut();
  TriangleMesh cut;
  for (const auto& t : whole.triangles) {
    for (const int v : t) cut.positions.push_back(whole.positions[v]);
    const int last = static_cast<int>(cut.vertexCount());
    cut.triangles.push_back({last - 3, last - 2, last - 1});
  }
  Embedding embedding, expected;
  ASSERT_TRUE(embedInto(cage, cut, {}, embedding).ok());
  ASSERT_TRUE(embedInto(cage, whole, {}, expected).ok());
  const auto bindings = embedding.bindings(), wholes = expected.bindings();
  for (std::size_t t = 0; t < whole.triangleCount(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexBinding &one = bindings[3 * t + k], &other = wholes[whole.triangles[t][k]];
      EXPECT_EQ(one.tet, other.tet);
      EXPECT_EQ(one.weights, other.weights);
      EXPECT_EQ(one.inside, other.inside);
    }
  }
}

}  // namespace
}  // namespace tetskin
