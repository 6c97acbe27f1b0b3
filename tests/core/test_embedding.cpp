// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/embed_into.h"
#include "support/odd_meshes.h"

#include <tetskin/core/embedding.h>
#include <tetskin/core/src/base/embedding/embedding_data.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <limits>

namespace tetskin::test {
namespace {

using Points = std::vector<Eigen::Vector3d>;

TEST(Embed, CoincidentVerticesGetIdenticalBitsAndAreEmbeddedOnce) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  Points vertices = test::randomPoints(300, around(cage, 1.3), 19);
  Embedding embedding;
  const std::size_t once = embedInto(cage, viewOf(vertices), {}, embedding).candidates;
  const Points copy = vertices;
  vertices.insert(vertices.end(), copy.begin(), copy.end());
  const Fit report = embedInto(cage, viewOf(vertices), {}, embedding);
  EXPECT_EQ(report.coincident, 300u);
  EXPECT_EQ(report.candidates, once);
  const auto bindings = embedding.bindings();
  for (std::size_t v = 0; v < 300; ++v) {
    EXPECT_EQ(bindings[v].tet, bindings[v + 300].tet);
    EXPECT_EQ(bindings[v].weights, bindings[v + 300].weights);
    EXPECT_EQ(bindings[v].inside, bindings[v + 300].inside);
  }
}

TEST(Embed, WeightsSumToOne) {
  const TetMesh cage = test::randomTets(50, 0.5, 23);
  const Points vertices = test::randomPoints(2000, around(cage, 1.5), 24);
  const Embedding embedding = embed(cage, viewOf(vertices)).value();
  for (const VertexBinding& b : embedding.bindings()) {
    const double largest = std::max({std::abs(b.weights[0]), std::abs(b.weights[1]), std::abs(b.weights[2]), 1.0f});
    const double sum = static_cast<double>(b.weights[0]) + b.weights[1] + b.weights[2] + b.weights[3];
    EXPECT_NEAR(sum, 1.0, 4 * largest * std::numeric_limits<float>::epsilon());
  }
}

TEST(Embedding, RunsListEverySlotOnceInAscendingOrder) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  const Points vertices = test::randomPoints(777, around(cage, 1.2), 28);
  Embedding embedding;
  const Fit report = embedInto(cage, viewOf(vertices), {}, embedding);
  const auto& runs = dataOf(embedding).runs;
  ASSERT_GT(runs.size(), 1u);
  EXPECT_EQ(runs.front().firstSlot, 0u);
  EXPECT_EQ(runs.back().firstSlot, 777u);
  for (std::size_t r = 0; r + 1 < runs.size(); ++r) {
    EXPECT_LT(runs[r].firstSlot, runs[r + 1].firstSlot);
    if (r + 1 != dataOf(embedding).insideRunCount) {
      EXPECT_LT(runs[r].tet, runs[r + 1].tet);
    }
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(runs[r].nodes[k], cage.tets[runs[r].tet][k]);
  }
  EXPECT_EQ(runs[dataOf(embedding).insideRunCount].firstSlot, embedding.insideCount());
  std::vector<std::uint32_t> order = embedding.slotVertices();
  std::sort(order.begin(), order.end());
  for (std::uint32_t v = 0; v < order.size(); ++v) EXPECT_EQ(order[v], v);
  EXPECT_EQ(embedding.insideCount(), report.inside);
}

TEST(Embedding, MovedFromIsStillThere) {
  const TetMesh cage = test::singleTet();
  Embedding first = embed(cage, viewOf(Points{{0.1, 0.2, 0.3}})).value();
  const Embedding second = std::move(first);
  EXPECT_EQ(second.vertexCount(), 1u);
  EXPECT_FALSE(first.empty());  // NOLINT: its moved-from state
  EXPECT_TRUE(Embedding().empty());
}

TEST(Embedding, ClosestWeightsAreThoseOfTheClosestPoint) {
  const TetMesh cage = test::latticeCage(3, 3, 3, 0.3);
  const Points vertices = test::randomPoints(500, around(cage, 1.3), 29);
  const Embedding embedding = embed(cage, viewOf(vertices)).value();
  ASSERT_LT(embedding.insideCount(), 400u);
  const auto bindings = embedding.bindings();
  for (std::size_t slot = embedding.insideCount(); slot < embedding.vertexCount(); ++slot) {
    const std::size_t v = embedding.slotVertices()[slot];
    const TetCorners p = cornersOf(cage, cage.tets[bindings[v].tet]);
    Eigen::Vector3d closest = p[3];
    for (int k = 0; k < 3; ++k) {
      const double c = dataOf(embedding).closestWeights[static_cast<std::size_t>(k)][slot - embedding.insideCount()];
      EXPECT_GE(c, 0.0);
      closest += c * (p[k] - p[3]);
    }
    EXPECT_NEAR((vertices[v] - closest).norm(), distanceToTet(vertices[v], p, BarycentricMap(p)(vertices[v])), 1e-6);
    EXPECT_LE(barycentricDistance(BarycentricMap(p)(closest)), 1e-6);
  }
}

TEST(Embedding, IsDeterministic) {
  const TetMesh cage = test::randomTets(400, 0.3, 30);
  const Points vertices = test::randomPoints(1000, around(cage, 1.2), 31);
  Embedding first, second;
  ASSERT_TRUE(embedInto(cage, viewOf(vertices), {}, first).ok());
  ASSERT_TRUE(embedInto(cage, viewOf(vertices), {}, second).ok());
  const auto one = first.bindings(), two = second.bindings();
  for (std::size_t v = 0; v < one.size(); ++v) EXPECT_EQ(one[v].weights, two[v].weights);
  EXPECT_EQ(first.slotVertices(), second.slotVertices());
}

}  // namespace
}  // namespace tetskin::test
