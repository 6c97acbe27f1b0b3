// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/brute_force.h"
#include "support/embed_into.h"
#include "support/odd_meshes.h"

#include <tetskin/core/embedding.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/weld.h>
#include <tetskin/core/src/search/tet_search.h>

#include <limits>

namespace tetskin::test {
namespace {

using Points = std::vector<Eigen::Vector3d>;

const Box3 kSearchedBox(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());

/// Embeds under one rule and compares every vertex with brute force: the tet, the side, the weights and the extremes.
EmbedReport expectBruteForce(const TetMesh& cage, const Points& vertices, OutsideRule rule) {
  Embedding embedding;
  Fit report = embedInto(cage, viewOf(vertices), {rule}, embedding);
  EXPECT_TRUE(report.ok()) << report.status.message;
  const auto bindings = embedding.bindings();
  const auto expected = test::bruteForce(cage, vertices, rule);
  std::size_t inside = 0, reassigned = 0;
  double worstDistance = 0.0, largestWeight = 1.0;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    EXPECT_EQ(bindings[v].tet, expected[v].tet) << "vertex " << v;
    EXPECT_EQ(bindings[v].inside, expected[v].inside) << "vertex " << v;
    if (bindings[v].tet != expected[v].tet) break;
    const Eigen::Vector4d b = BarycentricMap(cornersOf(cage, cage.tets[expected[v].tet]))(vertices[v]);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(bindings[v].weights[k], static_cast<float>(b[k])) << "vertex " << v;
    inside += expected[v].inside;
    reassigned += expected[v].reassigned();
    if (expected[v].inside) continue;
    worstDistance = std::max(worstDistance, expected[v].distance);
    largestWeight = std::max(largestWeight, expected[v].weight);
  }
  EXPECT_EQ(report.inside, inside);
  EXPECT_EQ(report.outside, vertices.size() - inside);
  EXPECT_EQ(report.unbound, 0u);
  EXPECT_EQ(report.reassignedByWeight, reassigned);
  EXPECT_EQ(report.maxDistance, worstDistance);
  EXPECT_EQ(report.maxWeight, largestWeight);
  return report;
}

/// A quarter of the comparisons with brute force if sanitizers make these ten times slower.
constexpr std::size_t manageable(std::size_t count) {
#ifdef __SANITIZE_ADDRESS__
  return count / 4;
#else
  return count;
#endif
}

double candidatesPerVertex(const EmbedReport& report) {
  return static_cast<double>(report.candidates) / static_cast<double>(report.vertexCount);
}

/// Compares under both rules, with a limit on the number of tets tested per vertex.
void expectBruteForceUnderBothRules(const TetMesh& cage, const Points& vertices,
                                    double maxCandidates = std::numeric_limits<double>::infinity()) {
  for (const OutsideRule rule : {OutsideRule::Nearest, OutsideRule::Barycentric}) {
    const EmbedReport report = expectBruteForce(cage, vertices, rule);
    EXPECT_LE(candidatesPerVertex(report), maxCandidates) << "rule " << static_cast<int>(rule);
  }
}

TEST(Embed, MatchesBruteForceInALattice) {
  const TetMesh cage = test::latticeCage(8, 8, 8, 0.125);  // 3,072 tets
  expectBruteForceUnderBothRules(cage, test::randomPoints(manageable(3000), around(cage, 1.0), 1), 60);
}

TEST(Embed, MatchesBruteForceJustOutsideALattice) {
  const TetMesh cage = test::latticeCage(8, 8, 8, 0.125);
  expectBruteForceUnderBothRules(cage, test::randomPoints(manageable(2000), around(cage, 1.2), 2), 400);
}

TEST(Embed, MatchesBruteForceInRandomOverlappingTets) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const TetMesh cage = test::randomTets(300, 0.3, seed);
    expectBruteForceUnderBothRules(cage, test::randomPoints(400, around(cage, 1.3), seed + 50));
  }
}

TEST(Embed, MatchesBruteForceInACageThatOverlapsItself) {
  const TetMesh cage = test::overlappingCage();
  const Points vertices = test::randomPoints(1500, around(cage, 1.1), 3);
  expectBruteForceUnderBothRules(cage, vertices);
  const Fit report = embedInto(cage, viewOf(vertices));
  // Both lattices are unit cubes; about half of each overlaps the other.
  EXPECT_GT(report.overlapping, report.vertexCount / 4);
  EXPECT_LT(report.overlapping, report.inside);
}

TEST(Embed, SharedFacesAreNoOverlap) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  Points vertices = cage.nodes;
  for (const auto& e : uniqueEdges(cage)) vertices.push_back((cage.nodes[e[0]] + cage.nodes[e[1]]) / 2.0);
  EXPECT_EQ(embedInto(cage, viewOf(vertices)).overlapping, 0u);
}

TEST(Embed, VerticesOnSharedFacesEdgesAndNodesGoToTheLowestTet) {
  const TetMesh cage = test::latticeCage(3, 3, 3, 1.0 / 3.0);
  Points vertices = cage.nodes;
  for (const auto& e : uniqueEdges(cage)) vertices.push_back((cage.nodes[e[0]] + cage.nodes[e[1]]) / 2.0);
  for (const Tet& t : cage.tets) vertices.push_back((cage.nodes[t[0]] + cage.nodes[t[1]] + cage.nodes[t[2]]) / 3.0);
  expectBruteForceUnderBothRules(cage, vertices);
}

TEST(Embed, MatchesBruteForceAtTheDragonsSize) {
  const TetMesh cage = test::latticeCage(8, 8, 10, 0.2);  // 3,840 tets
  const Box3 box = around(cage, 1.0);
  // A closed surface of 30,000 vertices, most of it inside the cage and a little of it outside.
  TriangleMesh mesh = test::sphere(172, 0.51 * box.sizes().minCoeff(), box.center());
  ASSERT_GT(mesh.vertexCount(), 29000u);
  const Fit report = embedInto(cage, viewOf(mesh.positions));
  EXPECT_GT(report.outside, 100u);
  EXPECT_LT(candidatesPerVertex(report), 60.0);
  Points sample;  // brute force for all vertices would take a minute
  const std::size_t step = mesh.vertexCount() / manageable(2300);
  for (std::size_t v = 0; v < mesh.vertexCount(); v += step) sample.push_back(mesh.positions[v]);
  expectBruteForceUnderBothRules(cage, sample);
}

TEST(Embed, MatchesBruteForceWithClusteredVertices) {
  const TetMesh cage = test::latticeCage(6, 6, 6, 1.0 / 6.0);
  Points vertices = test::randomPoints(1500, {Eigen::Vector3d::Constant(0.51), Eigen::Vector3d::Constant(0.513)}, 4);
  const Points spread = test::randomPoints(100, around(cage, 1.1), 5);
  vertices.insert(vertices.end(), spread.begin(), spread.end());
  // All tets whose boxes contain the cluster test it, and no other tets do.
  expectBruteForceUnderBothRules(cage, vertices, 60);
}

TEST(Embed, MatchesBruteForceInAGradedCage) {
  const TetMesh cage = test::gradedCage();  // 6,000 tets, their sizes in a ratio of 1 to 300
  Points vertices = test::randomPoints(manageable(700), around(cage, 1.2), 6);
  const Points fine =
      test::randomPoints(manageable(700), {Eigen::Vector3d::Constant(-0.002), Eigen::Vector3d::Constant(0.03)}, 7);
  vertices.insert(vertices.end(), fine.begin(), fine.end());
  expectBruteForceUnderBothRules(cage, vertices, 2000);
}

TEST(Embed, MatchesBruteForceInOneTet) {
  const TetMesh cage = test::singleTet();
  expectBruteForceUnderBothRules(cage, test::randomPoints(500, around(cage, 3.0), 8));
}

TEST(Embed, MatchesBruteForceAtAnyDistanceOutside) {
  const TetMesh cage = test::latticeCage(5, 5, 5, 0.2);
  for (const double sizes : {1e-6, 0.1, 10.0, 10000.0}) {
    Points vertices;
    const Box3 box = boundingBox(cage.nodes);
    for (const Eigen::Vector3d& p : test::randomPoints(60, kSearchedBox, 9)) {
      for (int axis = 0; axis < 3; ++axis) {
        Eigen::Vector3d below = p, above = p;
        below[axis] = box.min()[axis] - 0.2 * sizes;
        above[axis] = box.max()[axis] + 0.2 * sizes;
        vertices.push_back(below);
        vertices.push_back(above);
      }
    }
    expectBruteForceUnderBothRules(cage, vertices);
  }
}

TEST(Embed, AFewFarVerticesCostNextToNothing) {
  const TetMesh cage = test::latticeCage(8, 8, 8, 0.125);
  Points vertices = test::randomPoints(20000, around(cage, 0.99), 10);
  const std::size_t without = embedInto(cage, viewOf(vertices)).candidates;
  vertices.emplace_back(1250, 0, 0);  // 10,000 tet sizes away
  vertices.emplace_back(0, -1250, 3);
  const std::size_t with = embedInto(cage, viewOf(vertices)).candidates;
  EXPECT_LT(with, without + without / 10);
}

TEST(Embed, MatchesBruteForceAtHugeAndNegativeOffsets) {
  const TetMesh unit = test::latticeCage(5, 5, 5, 0.2);
  for (const Eigen::Vector3d& offset : {Eigen::Vector3d(1e6, 1e6, 1e6), Eigen::Vector3d(-1e6, 3, -5e5)}) {
    TetMesh cage = unit;
    cage.nodes = test::scaledAndMoved(unit.nodes, 1.0, offset);
    const Points vertices = test::scaledAndMoved(test::randomPoints(800, around(unit, 1.2), 11), 1.0, offset);
    expectBruteForceUnderBothRules(cage, vertices, 400);
  }
}

TEST(Embed, MatchesBruteForceAtExtremeScalesFarFromTheOrigin) {
  const TetMesh unit = test::latticeCage(3, 3, 3, 1.0 / 3.0);
  for (const double scale : {1e-12, 1e12}) {
    for (const double sizes : {0.0, 5e5}) {
      const Eigen::Vector3d offset = scale * sizes * Eigen::Vector3d(1.0, -1.0, 0.5);
      TetMesh cage = unit;
      cage.nodes = test::scaledAndMoved(unit.nodes, scale, offset);
      expectBruteForceUnderBothRules(
          cage, test::scaledAndMoved(test::randomPoints(400, around(unit, 1.2), 33), scale, offset), 400);
    }
  }
}

TEST(Embed, MatchesBruteForceInNeedlesAndSlivers) {
  for (const Eigen::Vector3d& squeeze : {Eigen::Vector3d(1, 1e-4, 1e-4), Eigen::Vector3d(1, 1, 3e-8)}) {
    TetMesh cage = test::latticeCage(3, 3, 3, 1.0 / 3.0);
    for (Eigen::Vector3d& p : cage.nodes) p = p.cwiseProduct(squeeze);
    Points vertices = test::randomPoints(400, around(cage, 1.3), 34);
    vertices.insert(vertices.end(), cage.nodes.begin(), cage.nodes.end());
    const Points wide = test::randomPoints(100, kSearchedBox, 35);
    vertices.insert(vertices.end(), wide.begin(), wide.end());
    expectBruteForceUnderBothRules(cage, vertices);
  }
}

TEST(Embed, ScaleChangesNoDecision) {
  const TetMesh unit = test::randomTets(200, 0.4, 21);
  const Points vertices = test::randomPoints(500, around(unit, 1.3), 22);
  Embedding embedding;
  const Fit first = embedInto(unit, viewOf(vertices), {}, embedding);
  const auto expected = embedding.bindings();
  for (const double scale : {0x1p-20, 0x1p20}) {  // powers of two: exact
    TetMesh cage = unit;
    cage.nodes = test::scaledAndMoved(unit.nodes, scale, Eigen::Vector3d::Zero());
    const Points scaled = test::scaledAndMoved(vertices, scale, Eigen::Vector3d::Zero());
    EXPECT_EQ(embedInto(cage, viewOf(scaled), {}, embedding).candidates, first.candidates);
    const auto bindings = embedding.bindings();
    for (std::size_t v = 0; v < vertices.size(); ++v) EXPECT_EQ(bindings[v].tet, expected[v].tet);
  }
}

TEST(Embed, MatchesBruteForceWithFloatVerticesFarFromTheOrigin) {
  // At a distance of 1,000 times the cage's size, floats still resolve the mesh: their spacing is 6e-5.
  TetMesh cage = test::latticeCage(5, 5, 5, 0.2);
  cage.nodes = test::scaledAndMoved(cage.nodes, 1.0, Eigen::Vector3d::Constant(1000.0));
  std::vector<Eigen::Vector3f> vertices;
  Points exact;
  for (const Eigen::Vector3d& p : test::randomPoints(600, around(cage, 1.2), 13)) {
    vertices.push_back(p.cast<float>());
    exact.push_back(vertices.back().cast<double>());
  }
  for (const OutsideRule rule : {OutsideRule::Nearest, OutsideRule::Barycentric}) {
    Embedding embedding;
    ASSERT_TRUE(embedInto(cage, viewOf(std::as_const(vertices)), {rule}, embedding).ok());
    const auto bindings = embedding.bindings();
    const auto expected = test::bruteForce(cage, exact, rule);
    for (std::size_t v = 0; v < exact.size(); ++v) EXPECT_EQ(bindings[v].tet, expected[v].tet);
  }
}

TEST(Embed, MatchesBruteForceWithATableForcedToCollide) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  const Points vertices = test::randomPoints(500, around(cage, 1.2), 14);
  for (const OutsideRule rule : {OutsideRule::Nearest, OutsideRule::Barycentric}) {
    const auto expected = test::bruteForce(cage, vertices, rule);
    for (const std::size_t tableSize : {1, 4, 32}) {
      const TetSearch search =
          findTets(SearchCage(cage), viewOf(vertices), weldCoincident(viewOf(vertices)), rule, tableSize);
      for (std::size_t v = 0; v < vertices.size(); ++v) {
        ASSERT_EQ(search.tetOf[v], expected[v].inside ? expected[v].tet : ~expected[v].tet);
      }
    }
  }
}

TEST(Embed, SearchTestsFewCandidatesOfManyTets) {
  const TetMesh cage = test::latticeCage(20, 20, 20, 0.05);  // 48,000 tets
  const Points vertices = test::randomPoints(30000, around(cage, 1.0), 15);
  EXPECT_LT(candidatesPerVertex(embedInto(cage, viewOf(vertices))), 60.0);
}

TEST(Embed, SearchStaysLinearWhenTheCageIsFinerThanTheMesh) {
  const TetMesh cage = test::latticeCage(20, 20, 20, 0.05);
  const Points vertices = test::randomPoints(200, around(cage, 1.0), 16);
  const Fit report = embedInto(cage, viewOf(vertices));
  EXPECT_LT(report.candidates, 10 * cage.tetCount());
}

TEST(Embed, NearestRuleKeepsVerticesOnAThinLayer) {
  // The barycentric distance is a distance divided by an altitude: it favours the big tets below the layer.
  const TetMesh cage = test::thinLayerCage(0.02);
  Points vertices;
  for (const Eigen::Vector3d& p : test::randomPoints(400, kSearchedBox, 17)) vertices.emplace_back(p.x(), 0.57, p.z());
  const auto onLayer = [&](OutsideRule rule) {
    Embedding embedding;
    EXPECT_TRUE(embedInto(cage, viewOf(vertices), {rule}, embedding).ok());
    std::size_t count = 0;
    for (const VertexBinding& b : embedding.bindings()) {
      const Tet& t = cage.tets[b.tet];
      count += std::all_of(t.begin(), t.end(), [&](int n) { return cage.nodes[n].y() > 0.49; });
    }
    return count;
  };
  EXPECT_EQ(onLayer(OutsideRule::Nearest), 400u);
  EXPECT_EQ(onLayer(OutsideRule::Barycentric), 0u);
  expectBruteForceUnderBothRules(cage, vertices);
}

TEST(Embed, FlatTetsAreCountedAndNeverUsed) {
  TetMesh cage = test::latticeCage(2, 2, 2, 0.5);
  const int n = static_cast<int>(cage.nodeCount());
  for (const Eigen::Vector3d& p : Points{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}, {1, 1, 2}}) cage.nodes.push_back(p);
  cage.tets.insert(cage.tets.begin(), {n, n + 1, n + 2, n + 3});
  cage.tets.push_back({0, 1, 1, 2});
  const Points vertices{{0.5, 0.5, 2.0}, {0.2, 0.3, 0.4}};  // the first lies in the flat tet's plane
  expectBruteForceUnderBothRules(cage, vertices);
  Embedding embedding;
  EXPECT_EQ(embedInto(cage, viewOf(vertices), {}, embedding).flatTets, 2u);
  for (const VertexBinding& b : embedding.bindings()) EXPECT_NE(b.tet, 0);
}

TEST(Embed, OrientationOfTheTetsDoesNotMatter) {
  TetMesh cage = test::latticeCage(3, 3, 3, 1.0 / 3.0);
  for (std::size_t t = 0; t < cage.tetCount(); t += 2) std::swap(cage.tets[t][0], cage.tets[t][1]);
  expectBruteForceUnderBothRules(cage, test::randomPoints(400, around(cage, 1.2), 18));
}

}  // namespace
}  // namespace tetskin::test
