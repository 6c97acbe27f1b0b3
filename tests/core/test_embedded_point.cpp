// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/carried_points.h"
#include "support/odd_meshes.h"
#include "support/smooth_maps.h"
#include "support/two_plates.h"

#include <tetskin/core/embedding.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

const Vector3d kBoxCentre = Vector3d::Constant(0.5);

/// Looks up vectors by node index, in an array of doubles.
template <class Scalar>
auto vectorsIn(const Points& vectors) {
  return [&vectors](int node) -> Eigen::Matrix<Scalar, 3, 1> {
    return vectors[static_cast<std::size_t>(node)].cast<Scalar>();
  };
}

/// Vertices in and around a cage that is jittered so that nothing is symmetric.
template <class Scalar>
class EmbeddedPoints : public testing::Test {
 protected:
  static constexpr double kRounding = sizeof(Scalar) == 4 ? 2e-6 : 2e-15;

  EmbeddedPoint<Scalar> at(std::size_t vertex) const { return carried.embedding.template at<Scalar>(vertex); }
  std::size_t vertexCount() const { return vertices.size(); }

  const TetMesh cage = jittered(latticeCage(3, 3, 3, 1.0 / 3.0), 0.08, 4);
  const Points vertices = randomPoints(400, around(cage, 1.4), 5);
  CarriedPoints<Scalar> carried{cage, vertices};
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(EmbeddedPoints, Scalars);

TYPED_TEST(EmbeddedPoints, AreWhereTheEmbeddingHasItsVertices) {
  const Points nodes = smoothMaps(kBoxCentre)[0](this->cage.nodes);
  this->carried.move(nodes);
  const Points expected = this->carried.linear();
  for (std::size_t v = 0; v < this->vertexCount(); ++v) {
    const auto position = this->at(v).position(vectorsIn<TypeParam>(nodes));
    EXPECT_LT((position.template cast<double>() - expected[v]).norm(), this->kRounding) << v;
  }
}

TYPED_TEST(EmbeddedPoints, AreTheBindingsOfTheirVertices) {
  std::size_t outside = 0;
  for (std::size_t v = 0; v < this->vertexCount(); ++v) {
    const EmbeddedPoint<TypeParam> point = this->at(v);
    const VertexBinding& binding = this->carried.bindings[v];
    EXPECT_EQ(point.tet, binding.tet);
    EXPECT_EQ(point.nodes, this->cage.tets[binding.tet]);
    EXPECT_EQ(point.inside, binding.inside);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(static_cast<float>(point.weights[k]), binding.weights[k]);
    EXPECT_EQ(point.weights[3], 1 - point.weights[0] - point.weights[1] - point.weights[2]);
    outside += !point.inside;
  }
  EXPECT_GT(outside, 100u);
  EXPECT_LT(outside, 350u);
}

TYPED_TEST(EmbeddedPoints, MoveByTheGradientsOfTheirPositions) {
  const Points velocities = randomPoints(this->cage.nodeCount(), {-kBoxCentre, kBoxCentre}, 6);
  const auto positions = vectorsIn<TypeParam>(this->cage.nodes);
  for (std::size_t v = 0; v < this->vertexCount(); v += 5) {
    const EmbeddedPoint<TypeParam> point = this->at(v);
    Vector3d velocity = Vector3d::Zero();  // the sum of each node's contribution, found by moving that node
    double reach = 0.0;
    for (std::size_t n = 0; n < this->cage.nodeCount(); ++n) {
      Points moved = this->cage.nodes;
      moved[n] += velocities[n];
      const Vector3d change =
          (point.position(vectorsIn<TypeParam>(moved)) - point.position(positions)).template cast<double>();
      velocity += change;
      reach = std::max(reach, change.norm());
    }
    const auto told = point.velocity(vectorsIn<TypeParam>(velocities));
    EXPECT_LT((told.template cast<double>() - velocity).norm(), 20 * this->kRounding * std::max(1.0, reach)) << v;
  }
}

TYPED_TEST(EmbeddedPoints, ClampToTheClosestPointOfTheirTet) {
  std::size_t moved = 0;
  for (std::size_t v = 0; v < this->vertexCount(); ++v) {
    const EmbeddedPoint<TypeParam> point = this->at(v);
    Vector3d closest = Vector3d::Zero();
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_GE(point.clampedWeights[k], 0) << v;
      sum += static_cast<double>(point.clampedWeights[k]);
      closest +=
          static_cast<double>(point.clampedWeights[k]) * this->cage.nodes[static_cast<std::size_t>(point.nodes[k])];
    }
    EXPECT_NEAR(sum, 1.0, 1e-6) << v;
    const Vector3d beyond = this->vertices[v] - closest;
    EXPECT_LT(beyond.norm(), point.inside ? 1e-6 : 2.0) << v;
    // The tet is convex: no part of it is nearer if none of its corners is on the vertex's side of the closest point.
    for (const int n : point.nodes) {
      EXPECT_LT(beyond.dot(this->cage.nodes[static_cast<std::size_t>(n)] - closest), 1e-6) << v;
    }
    moved += beyond.norm() > 0.05;
  }
  EXPECT_GT(moved, 100u);
}

TYPED_TEST(EmbeddedPoints, ShareImpulsesOutByMomentum) {
  const Vector3d impulse(0.3, -1.1, 0.7);
  const Points start = randomPoints(this->cage.nodeCount(), {-kBoxCentre, kBoxCentre}, 7);
  const auto inverseMassOf = [](int node) { return TypeParam(0.5) + static_cast<TypeParam>(node % 5); };
  for (std::size_t v = 0; v < this->vertexCount(); v += 3) {
    const EmbeddedPoint<TypeParam> point = this->at(v);
    const Eigen::Matrix<TypeParam, 3, 1> given = impulse.template cast<TypeParam>();
    Points velocities = start;
    Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero(), where = Vector3d::Zero();
    double work = 0.0;
    std::size_t k = 0;
    point.applyImpulse(given, inverseMassOf, [&](int node, const Eigen::Matrix<TypeParam, 3, 1>& change) {
      const auto n = static_cast<std::size_t>(node);
      const double mass = 1.0 / static_cast<double>(inverseMassOf(node));
      const Vector3d before = velocities[n];
      velocities[n] += change.template cast<double>();
      const Vector3d momentum = mass * change.template cast<double>();
      linear += momentum;
      angular += this->cage.nodes[n].cross(momentum);
      work += 0.5 * mass * (velocities[n].squaredNorm() - before.squaredNorm());
      where += static_cast<double>(point.clampedWeights[k++]) * this->cage.nodes[n];
    });
    EXPECT_LT((linear - impulse).norm(), 1e-6) << v;
    EXPECT_LT((angular - where.cross(impulse)).norm(), 1e-6) << v;
    const Vector3d before = point.clampedVelocity(vectorsIn<TypeParam>(start)).template cast<double>();
    const Vector3d after = point.clampedVelocity(vectorsIn<TypeParam>(velocities)).template cast<double>();
    const auto inverse = static_cast<double>(point.inverseMass(inverseMassOf));
    EXPECT_LT((after - before - inverse * impulse).norm(), 5e-6) << v;
    EXPECT_NEAR(work, 0.5 * (before + after).dot(impulse), 1e-5) << v;
  }
}

TYPED_TEST(EmbeddedPoints, PushNoNodeThatIsPinned) {
  const EmbeddedPoint<TypeParam> point = this->at(0);
  const auto pinned = [&](int node) { return node == point.nodes[1]; };
  const auto inverseMassOf = [&](int node) { return static_cast<TypeParam>(pinned(node) ? 0 : 2); };
  std::size_t pushed = 0;
  const Eigen::Matrix<TypeParam, 3, 1> impulse(1, 2, 3);
  point.applyImpulse(impulse, inverseMassOf, [&](int node, const Eigen::Matrix<TypeParam, 3, 1>& change) {
    EXPECT_EQ(change.norm() == 0, pinned(node) || point.clampedWeights[pushed] == 0);
    ++pushed;
  });
  EXPECT_EQ(pushed, 4u);
  EXPECT_EQ(point.inverseMass([](int) { return TypeParam(0); }), 0);
}

TEST(EmbeddedPointsInFloat, KeepTheirDigitsFarFromTheOrigin) {
  const TetMesh cage = jittered(latticeCage(3, 3, 3, 1.0 / 3.0), 0.08, 4);
  const Points vertices = randomPoints(400, around(cage, 1.4), 5);
  const Embedding embedding = embed(cage, viewOf(vertices)).value();
  const Vector3d far(4096, 4096, 4096);
  Points nodes;
  for (const Vector3d& p : cage.nodes) nodes.push_back((p + far).cast<float>().cast<double>());
  double worst = 0.0, worstOfSums = 0.0;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const EmbeddedPoint<float> point = embedding.at<float>(v);
    const Vector3d exact = embedding.at(v).position(vectorsIn<double>(nodes));
    const Vector3d position = point.position(vectorsIn<float>(nodes)).cast<double>();
    // The plain weighted sum, without taking differences.
    const Vector3d sum = point.velocity(vectorsIn<float>(nodes)).cast<double>();
    worst = std::max(worst, (position - exact).norm());
    worstOfSums = std::max(worstOfSums, (sum - exact).norm());
  }
  EXPECT_LT(worst, 5e-4);  // the spacing of floats at this distance
  EXPECT_GT(worstOfSums, 2.0 * worst);
}

TEST(EmbeddingAt, IsByVertexWhateverTheOrderOfTheSkin) {
  const TetMesh cage = latticeCage(3, 3, 3, 1.0 / 3.0);
  const TriangleMesh mesh = sphere(14, 0.53, kBoxCentre);
  const Points nodes = smoothMaps(kBoxCentre)[1](cage.nodes);
  for (const VertexOrder order : {VertexOrder::Mesh, VertexOrder::Sorted}) {
    SkinOptions options;
    options.order = order;
    MeshSkin<double> skin;
    ASSERT_TRUE(skin.bind(cage, mesh, options).ok());
    ASSERT_EQ(skin.update(viewOf(nodes)), StatusCode::Ok);
    const Embedding& embedding = skin.binding()->embedding();
    ASSERT_GT(embedding.insideCount(), 0u);
    ASSERT_LT(embedding.insideCount(), mesh.vertexCount());
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      const std::size_t index = order == VertexOrder::Mesh ? v : embedding.vertexSlots()[v];
      const Vector3d position = embedding.at(v).position(vectorsIn<double>(nodes));
      const double* drawn = skin.positions()[index];
      EXPECT_LT((position - Vector3d(drawn[0], drawn[1], drawn[2])).norm(), 1e-14) << v;
    }
  }
}

TEST(EmbeddingAt, KnowsWhichCopyOfATetCarriesAVertex) {
  const TwoPlates plates = platesOfCopies();
  const Embedding embedding = embed(plates.cage, plates.mesh).value();
  std::size_t upper = 0;
  for (std::size_t v = 0; v < plates.mesh.vertexCount(); ++v) {
    const EmbeddedPoint<double> point = embedding.at(v);
    EXPECT_EQ(point.tet, plates.cage.vertexTets[v]) << v;
    EXPECT_EQ(point.nodes, plates.cage.mesh.tets[static_cast<std::size_t>(point.tet)]) << v;
    const Vector3d position = point.position(vectorsIn<double>(plates.cage.mesh.nodes));
    EXPECT_LT((position - plates.mesh.positions[v]).norm(), 1e-6) << v;
    upper += static_cast<std::size_t>(point.tet) >= plates.latticeTets;
  }
  EXPECT_EQ(upper, plates.mesh.vertexCount() - plates.plateVertices);
}

TEST(EmbeddingAt, OfALoadedEmbeddingIsThatOfTheSavedOne) {
  const TetMesh cage = latticeCage(2, 2, 2, 0.5);
  const Points vertices = randomPoints(200, around(cage, 1.3), 8);
  const Embedding made = embed(cage, viewOf(vertices)).value();
  const std::vector<unsigned char> bytes = made.save(cage);
  const Embedding loaded = Embedding::load(bytes.data(), bytes.size(), cage).value();
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const EmbeddedPoint<double> a = made.at(v), b = loaded.at(v);
    EXPECT_EQ(std::tie(a.nodes, a.weights, a.clampedWeights, a.tet, a.inside),
              std::tie(b.nodes, b.weights, b.clampedWeights, b.tet, b.inside));
  }
}

}  // namespace
}  // namespace tetskin::test
