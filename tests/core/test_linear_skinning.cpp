// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/embed_into.h"
#include "support/odd_meshes.h"

#include <tetskin/core/src/skinning/linear_skinning.h>

#include <limits>

namespace tetskin {
namespace {

/// Both precisions of nodes, combined with both precisions of output.
template <class Types>
class LinearSkinning : public testing::Test {
 public:
  using NodeScalar = typename Types::first_type;
  using OutScalar = typename Types::second_type;
  using Nodes = std::vector<Eigen::Matrix<NodeScalar, 3, 1>>;
  using Surface = std::vector<Eigen::Matrix<OutScalar, 3, 1>>;
  using Output = SkinOutput<NodeScalar, OutScalar>;

  LinearSkinning() : cage(test::latticeCage(4, 4, 4, 0.25)) {
    vertices = test::randomPoints(1000, {Eigen::Vector3d::Constant(-0.2), Eigen::Vector3d::Constant(1.2)}, 41);
    const Fit report = embedInto(cage, viewOf(std::as_const(vertices)), {}, embedding);
    EXPECT_TRUE(report.ok());
    EXPECT_GT(report.outside, 100u);
  }

  static Nodes nodesFrom(const std::vector<Eigen::Vector3d>& positions) {
    Nodes nodes;
    for (const Eigen::Vector3d& p : positions) nodes.push_back(p.cast<NodeScalar>());
    return nodes;
  }

  Surface skin(const Nodes& nodes,
               const Eigen::Matrix<NodeScalar, 3, 1>& origin = Eigen::Matrix<NodeScalar, 3, 1>::Zero()) {
    PackedNodes<NodeScalar> packed(nodes.size());
    EXPECT_EQ(packed.pack(viewOf(nodes)), nodes.size());
    Surface surface(embedding.vertexCount());
    scratch.resize(scratchSize(surface.size()));
    skinLinear(embedding, packed, Output{viewOf(surface), VertexOrder::Mesh, origin, scratch.data()}, &bounds);
    return surface;
  }

  /// A few rounding errors of the coarser of the two types, for values up to about `size`.
  static double tolerance(double size) {
    const double epsilon =
        std::max<double>(std::numeric_limits<NodeScalar>::epsilon(), std::numeric_limits<OutScalar>::epsilon());
    return size * std::max(8 * epsilon, 4.0 * std::numeric_limits<float>::epsilon());  // weights are float
  }

  TetMesh cage;
  std::vector<Eigen::Vector3d> vertices;
  Embedding embedding;
  Box3 bounds;
  std::vector<NodeScalar> scratch;
};

using Precisions = testing::Types<std::pair<float, float>, std::pair<float, double>, std::pair<double, float>,
                                  std::pair<double, double>>;
TYPED_TEST_SUITE(LinearSkinning, Precisions);

TYPED_TEST(LinearSkinning, ReproducesRestInsideAndOutside) {
  const auto surface = this->skin(this->nodesFrom(this->cage.nodes));
  for (std::size_t v = 0; v < surface.size(); ++v) {
    EXPECT_LT((surface[v].template cast<double>() - this->vertices[v]).norm(), this->tolerance(2.0));
  }
}

TYPED_TEST(LinearSkinning, ReproducesEveryAffineMap) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const auto numbers = test::randomPoints(4, {Eigen::Vector3d::Constant(-2), Eigen::Vector3d::Constant(2)}, seed);
    Eigen::Matrix3d linear;
    linear << numbers[0], numbers[1], numbers[2];
    std::vector<Eigen::Vector3d> moved = this->cage.nodes;
    for (Eigen::Vector3d& p : moved) p = linear * p + numbers[3];
    const auto surface = this->skin(this->nodesFrom(moved));
    for (std::size_t v = 0; v < surface.size(); ++v) {
      const Eigen::Vector3d expected = linear * this->vertices[v] + numbers[3];
      EXPECT_LT((surface[v].template cast<double>() - expected).norm(), this->tolerance(12.0));
    }
  }
}

TYPED_TEST(LinearSkinning, FollowsTheNodesOfTheTet) {
  std::vector<Eigen::Vector3d> bent = this->cage.nodes;
  for (Eigen::Vector3d& p : bent) p += 0.3 * Eigen::Vector3d(std::sin(5 * p.y()), p.x() * p.z(), std::cos(4 * p.x()));
  const auto surface = this->skin(this->nodesFrom(bent));
  const auto bindings = this->embedding.bindings();
  for (std::size_t v = 0; v < surface.size(); ++v) {
    Eigen::Vector3d expected = Eigen::Vector3d::Zero();
    const Tet& tet = this->cage.tets[bindings[v].tet];
    for (int k = 0; k < 4; ++k) expected += static_cast<double>(bindings[v].weights[k]) * bent[tet[k]];
    EXPECT_LT((surface[v].template cast<double>() - expected).norm(), this->tolerance(4.0));
  }
}

TYPED_TEST(LinearSkinning, BoundsAreThoseOfTheSurface) {
  const auto surface = this->skin(this->nodesFrom(this->cage.nodes));
  const Box3 expected = boundingBox(viewOf(surface));
  EXPECT_LT((this->bounds.min() - expected.min()).norm(), this->tolerance(2.0));
  EXPECT_LT((this->bounds.max() - expected.max()).norm(), this->tolerance(2.0));
  EXPECT_LT(this->bounds.min().x(), 0.0);  // extrapolated vertices reach beyond the nodes
}

TYPED_TEST(LinearSkinning, IsNoWorseThanTwiceTheNodesRoundingFarFromTheOrigin) {
  using Scalar = typename TestFixture::NodeScalar;
  const auto near = this->skin(this->nodesFrom(this->cage.nodes));
  const Eigen::Vector3d offset(1e5 + 0.137, -1e5 + 0.291, 1e5 - 0.717);
  const auto farNodes = this->nodesFrom(test::scaledAndMoved(this->cage.nodes, 1.0, offset));
  double nodeRounding = 0.0;
  for (std::size_t n = 0; n < farNodes.size(); ++n) {
    const Eigen::Vector3d error = farNodes[n].template cast<double>() - this->cage.nodes[n] - offset;
    nodeRounding = std::max(nodeRounding, error.cwiseAbs().maxCoeff());
  }
  nodeRounding = std::max(nodeRounding, 0.25 * 1e5 * std::numeric_limits<Scalar>::epsilon());
  // The output is local, so that only the rounding of the nodes is left and not that of the output type.
  const Eigen::Matrix<Scalar, 3, 1> origin = offset.cast<Scalar>();
  const auto surface = this->skin(farNodes, origin);
  const auto bindings = this->embedding.bindings();
  const Eigen::Vector3d originError = origin.template cast<double>() - offset;
  for (std::size_t v = 0; v < surface.size(); ++v) {
    if (!bindings[v].inside) continue;  // extrapolation multiplies the nodes' errors by its weights
    const Eigen::Vector3d error = surface[v].template cast<double>() + originError - near[v].template cast<double>();
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 2.0 * nodeRounding + this->tolerance(1.0));
  }
}

TYPED_TEST(LinearSkinning, WorldOutputFarFromTheOriginIsRoundedOnce) {
  using Scalar = typename TestFixture::NodeScalar;
  using Out = typename TestFixture::OutScalar;
  const double distance = 1e5;
  const double half =
      0.5 * distance * std::max<double>(std::numeric_limits<Scalar>::epsilon(), std::numeric_limits<Out>::epsilon());
  const Eigen::Vector3d offset = Eigen::Vector3d::Constant(distance + 0.3711);
  const auto surface = this->skin(this->nodesFrom(test::scaledAndMoved(this->cage.nodes, 1.0, offset)));
  const auto bindings = this->embedding.bindings();
  for (std::size_t v = 0; v < surface.size(); ++v) {
    if (!bindings[v].inside) continue;
    const Eigen::Vector3d error = surface[v].template cast<double>() - offset - this->vertices[v];
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 2.0 * half + this->tolerance(1.0));
  }
}

TYPED_TEST(LinearSkinning, CoincidentVerticesStayTogetherToTheLastBit) {
  std::vector<Eigen::Vector3d> doubled = this->vertices;
  doubled.insert(doubled.end(), this->vertices.begin(), this->vertices.end());
  ASSERT_TRUE(embedInto(this->cage, viewOf(std::as_const(doubled)), {}, this->embedding).ok());
  std::vector<Eigen::Vector3d> bent = this->cage.nodes;
  for (Eigen::Vector3d& p : bent) p += 0.2 * Eigen::Vector3d(std::sin(7 * p.z()), std::cos(3 * p.x()), p.x() * p.y());
  const auto surface = this->skin(this->nodesFrom(bent));
  const std::size_t half = this->vertices.size();
  for (std::size_t v = 0; v < half; ++v) EXPECT_EQ(surface[v], surface[v + half]);
}

TYPED_TEST(LinearSkinning, WritesOnlyThePositionsOfAnInterleavedBuffer) {
  using Out = typename TestFixture::OutScalar;
  struct Vertex {
    Out before;
    Out position[3];
    Out after[2];
  };
  const auto nodes = this->nodesFrom(this->cage.nodes);
  const auto expected = this->skin(nodes);
  std::vector<Vertex> buffer(this->vertices.size(), Vertex{7, {0, 0, 0}, {8, 9}});
  PackedNodes<typename TestFixture::NodeScalar> packed(nodes.size());
  ASSERT_EQ(packed.pack(viewOf(nodes)), nodes.size());
  typename TestFixture::Output output;
  output.points = PointView<Out>(buffer[0].position, buffer.size(), sizeof(Vertex));
  output.scratch = this->scratch.data();
  skinLinear(this->embedding, packed, output);
  for (std::size_t v = 0; v < buffer.size(); ++v) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(buffer[v].position[k], expected[v][k]);
    EXPECT_EQ(buffer[v].before, Out(7));
    EXPECT_EQ(buffer[v].after[0], Out(8));
    EXPECT_EQ(buffer[v].after[1], Out(9));
  }
}

TYPED_TEST(LinearSkinning, SortedOrderIsThatOfTheSlots) {
  using Out = typename TestFixture::OutScalar;
  std::vector<Eigen::Vector3d> bent = this->cage.nodes;
  for (Eigen::Vector3d& p : bent) p += 0.2 * Eigen::Vector3d(std::sin(7 * p.z()), std::cos(3 * p.x()), p.x() * p.y());
  const auto nodes = this->nodesFrom(bent);
  const auto expected = this->skin(nodes);
  const Box3 expectedBounds = this->bounds;
  PackedNodes<typename TestFixture::NodeScalar> packed(nodes.size());
  ASSERT_EQ(packed.pack(viewOf(nodes)), nodes.size());
  // Points side by side and points with gaps are written in different ways. Nothing beyond the last point is written.
  for (const std::size_t step : {1, 2}) {
    using Point = Eigen::Matrix<Out, 3, 1>;
    const std::size_t count = this->embedding.vertexCount();
    std::vector<Point> points(step * count + 20, Point::Constant(-77));
    Box3 sortedBounds;
    typename TestFixture::Output output;
    output.points = PointView<Out>(points.front().data(), count, step * sizeof(Point));
    output.order = VertexOrder::Sorted;
    output.scratch = this->scratch.data();
    skinLinear(this->embedding, packed, output, &sortedBounds);
    for (std::size_t slot = 0; slot < count; ++slot) {
      EXPECT_EQ(points[step * slot], expected[this->embedding.slotVertices()[slot]]);
    }
    for (std::size_t k = step * count; k < points.size(); ++k) EXPECT_EQ(points[k], Point::Constant(-77));
    EXPECT_EQ(sortedBounds.min(), expectedBounds.min());
    EXPECT_EQ(sortedBounds.max(), expectedBounds.max());
  }
}

TEST(PackedNodes, ReadsAnyStrideAndNamesTheFirstNodeThatIsNotFinite) {
  struct Node {
    char other[40];
    float position[4];
  };
  std::vector<Node> nodes(3);
  for (int n = 0; n < 3; ++n) {
    for (int k = 0; k < 4; ++k) nodes[n].position[k] = static_cast<float>(10 * n + k);
  }
  PackedNodes<float> packed(3);
  const PointView<const float> view(nodes[0].position, 3, sizeof(Node));
  EXPECT_EQ(packed.pack(view), 3u);
  EXPECT_EQ(packed.mean(), Eigen::Vector3f(10, 11, 12));
  EXPECT_EQ(Eigen::Vector4f(packed.data() + 8), Eigen::Vector4f(10, 10, 10, 0));
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    nodes[1].position[2] = bad;
    EXPECT_EQ(packed.pack(view), 1u);
  }
}

/// It reads four numbers at a time: the fourth may be anything, and behind the last node it may not even exist.
TEST(PackedNodes, TakeNothingFromBehindAPosition) {
  for (const std::size_t count : {1u, 2u, 3u, 4u, 7u}) {
    for (const std::size_t stride : {3u, 4u, 5u}) {
      std::vector<float> memory(stride * (count - 1) + 3, std::numeric_limits<float>::quiet_NaN());
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (std::size_t n = 0; n < count; ++n) {
        for (std::size_t k = 0; k < 3; ++k) memory[stride * n + k] = static_cast<float>(n * n + k);
        sum += Eigen::Map<const Eigen::Vector3f>(memory.data() + stride * n);
      }
      PackedNodes<float> packed(count);
      EXPECT_EQ(packed.pack(PointView<const float>(memory.data(), count, stride * sizeof(float))), count);
      EXPECT_LT((packed.mean() - sum / static_cast<float>(count)).norm(), 1e-6f);
      for (std::size_t n = 0; n < count; ++n) {
        const Eigen::Vector3f p = packed.mean() + Eigen::Map<const Eigen::Vector3f>(packed.data() + 4 * n);
        EXPECT_LT((p - Eigen::Map<const Eigen::Vector3f>(memory.data() + stride * n)).norm(), 1e-5f);
        EXPECT_EQ(packed.data()[4 * n + 3], 0.0f);
      }
    }
  }
}

}  // namespace
}  // namespace tetskin
