// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/allocation_count.h"
#include "support/odd_meshes.h"

#include <tetskin/core/mesh_skin.h>

#include <limits>

namespace tetskin {
namespace {

using FloatPoints = std::vector<Eigen::Vector3f>;

class PreviousPositions : public testing::Test {
 protected:
  /// The cage's nodes, moved by `step` and slightly sheared.
  FloatPoints nodesAt(int step) const {
    FloatPoints nodes;
    for (const Eigen::Vector3d& p : cage.nodes) {
      nodes.push_back((p + 0.1 * step * Eigen::Vector3d(1.0, p.z(), p.x() * p.y())).cast<float>());
    }
    return nodes;
  }
  void update(int step) {
    const FloatPoints nodes = nodesAt(step);
    ASSERT_EQ(skin.update(viewOf(nodes)), StatusCode::Ok);
  }
  static FloatPoints copyOf(PointView<const float> view) {
    FloatPoints points;
    for (std::size_t v = 0; v < view.size(); ++v) points.emplace_back(view[v][0], view[v][1], view[v][2]);
    return points;
  }

  TetMesh cage = test::latticeCage(3, 3, 3, 1.0 / 3.0);
  TriangleMesh mesh = test::sphere(20, 0.53, Eigen::Vector3d::Constant(0.5));
  SkinOptions options;
  MeshSkin<float> skin;
};

TEST_F(PreviousPositions, AreThoseOfTheUpdateBeforeToTheBit) {
  for (const VertexOrder order : {VertexOrder::Mesh, VertexOrder::Sorted}) {
    for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
      options.order = order;
      options.interpolation = interpolation;
      options.previousPositions = true;
      ASSERT_TRUE(skin.bind(cage, mesh, options).ok());
      EXPECT_EQ(copyOf(skin.previousPositions()), copyOf(skin.positions()));
      FloatPoints before = copyOf(skin.positions());
      for (int step = 1; step < 5; ++step) {
        update(step);
        EXPECT_EQ(copyOf(skin.previousPositions()), before);
        EXPECT_NE(copyOf(skin.positions()), before);
        before = copyOf(skin.positions());
      }
    }
  }
}

TEST_F(PreviousPositions, DoNotChangeTheCurrentOnes) {
  MeshSkin<float> plain;
  ASSERT_TRUE(plain.bind(cage, mesh, options).ok());
  options.previousPositions = true;
  ASSERT_TRUE(skin.bind(cage, mesh, options).ok());
  for (int step = 1; step < 4; ++step) {
    update(step);
    const FloatPoints nodes = nodesAt(step);
    ASSERT_EQ(plain.update(viewOf(nodes)), StatusCode::Ok);
    EXPECT_EQ(copyOf(skin.positions()), copyOf(plain.positions()));
  }
}

TEST_F(PreviousPositions, AreTheCurrentOnesWhileHeld) {
  options.previousPositions = true;
  ASSERT_TRUE(skin.bind(cage, mesh, options).ok());
  update(1);
  update(2);
  skin.clearMotion();
  const FloatPoints pinned = copyOf(skin.positions());
  EXPECT_EQ(copyOf(skin.previousPositions()), pinned);
  update(3);
  EXPECT_EQ(copyOf(skin.previousPositions()), pinned);
}

TEST_F(PreviousPositions, AreTheCurrentOnesAfterAFailedUpdate) {
  options.previousPositions = true;
  ASSERT_TRUE(skin.bind(cage, mesh, options).ok());
  update(1);
  const FloatPoints good = copyOf(skin.positions());
  FloatPoints nodes = nodesAt(2);
  nodes[7].y() = std::numeric_limits<float>::infinity();
  EXPECT_EQ(skin.update(viewOf(std::as_const(nodes))), StatusCode::NonFinite);
  EXPECT_EQ(skin.firstNonFiniteNode(), 7u);
  EXPECT_EQ(copyOf(skin.positions()), good);
  EXPECT_EQ(copyOf(skin.previousPositions()), good);
  update(2);
  EXPECT_EQ(copyOf(skin.previousPositions()), good);
}

TEST_F(PreviousPositions, CostNothingWhenNotAskedFor) {
  const auto bytesOf = [&](bool previous) {
    options.previousPositions = previous;
    MeshSkin<float> made;
    const std::size_t before = test::allocatedBytes();
    EXPECT_TRUE(made.bind(cage, mesh, options).ok());
    EXPECT_EQ(made.previousPositions().size(), previous ? mesh.vertexCount() : 0);
    const FloatPoints nodes = nodesAt(1);
    EXPECT_EQ(made.update(viewOf(nodes)), StatusCode::Ok);
    EXPECT_EQ(made.previousPositions().size(), previous ? mesh.vertexCount() : 0);
    return test::allocatedBytes() - before;
  };
  EXPECT_EQ(bytesOf(true) - bytesOf(false), 12 * mesh.vertexCount());
  EXPECT_TRUE(skin.previousPositions().empty());  // there are none while unbound
}

TEST_F(PreviousPositions, UpdatesAllocateNothing) {
  options.previousPositions = true;
  ASSERT_TRUE(skin.bind(cage, mesh, options).ok());
  const FloatPoints nodes = nodesAt(1);
  const std::size_t before = test::allocationCount();
  ASSERT_EQ(skin.update(viewOf(nodes)), StatusCode::Ok);
  EXPECT_EQ(test::allocationCount(), before);
}

TEST_F(PreviousPositions, AreNotKeptOfTheCallersBuffer) {
  FloatPoints target(mesh.vertexCount());
  options.previousPositions = true;
  options.target = viewOf(target);
  const Result<EmbedReport> report = skin.bind(cage, mesh, options);
  EXPECT_EQ(report.status().code, StatusCode::InvalidOption);
  EXPECT_NE(report.status().message.find("own array"), std::string::npos);
  EXPECT_FALSE(skin.bound());
}

}  // namespace
}  // namespace tetskin
