// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/allocation_count.h"
#include "support/odd_meshes.h"

#include <gtest/gtest.h>
#include <tetskin/core/mesh_skin.h>

#include <limits>

namespace tetskin {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// One half of a cage is pinned, the other moves; the caller's buffer shows what an update has written.
class MovedPartsOfASkin : public testing::Test {
 protected:
  MovedPartsOfASkin() {
    options.bounds = false;
    options.skipStill = true;
    for (const Eigen::Vector3d& p : cage.nodes) rest.push_back(p.cast<float>());
  }

  bool isPinned(const Eigen::Vector3d& p) const { return p.x() < 0.51; }
  Points bent(float amount) const {
    Points nodes = rest;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!isPinned(cage.nodes[i])) nodes[i].z() += amount * (nodes[i].x() - 0.5f) * (nodes[i].x() - 0.5f);
    }
    return nodes;
  }
  void bind() {
    written.assign(mesh.vertexCount(), Eigen::Vector3f::Zero());
    options.target = viewOf(written);
    ASSERT_TRUE(skin.bind(cage, mesh, options).ok());
    SkinOptions all = options;
    all.skipStill = false;
    all.target = std::monostate();
    ASSERT_TRUE(whole.bind(cage, mesh, all).ok());
  }
  void update(const Points& nodes) {
    ASSERT_EQ(skin.update(viewOf(nodes)), nodes.size());
    ASSERT_EQ(whole.update(viewOf(nodes)), nodes.size());
  }
  void expectTheWholeSurface() const {
    for (std::size_t v = 0; v < written.size(); ++v) {
      EXPECT_LT((written[v] - Eigen::Map<const Eigen::Vector3f>(whole.positions()[v])).norm(), 1e-6f) << v;
      if (options.normals == Normals::None) continue;
      const Eigen::Map<const Eigen::Vector3f> a(skin.normals()[v]), b(whole.normals()[v]);
      EXPECT_LT((a - b).norm(), 1e-5f) << v;
    }
  }
  /// How many points an update writes, which are marked beforehand.
  std::size_t writtenBy(const Points& nodes) {
    const Eigen::Vector3f mark = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
    Points before = written;
    std::fill(written.begin(), written.end(), mark);
    update(nodes);
    std::size_t count = 0;
    for (std::size_t v = 0; v < written.size(); ++v) {
      if (written[v].array().isNaN().all()) {
        written[v] = before[v];
      } else {
        ++count;
      }
    }
    return count;
  }

  TetMesh cage = test::latticeCage(10, 3, 3, 0.1);
  TriangleMesh mesh = test::sphere(24, 0.45, Eigen::Vector3d(0.5, 0.15, 0.15));
  Points rest, written;
  SkinOptions options;
  MeshSkin<float> skin, whole;
};

TEST_F(MovedPartsOfASkin, GiveTheWholeSurface) {
  for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
    for (const Normals normals : {Normals::None, Normals::Transformed, Normals::Recomputed}) {
      for (const VertexOrder order : {VertexOrder::Mesh, VertexOrder::Sorted}) {
        options.interpolation = interpolation;
        options.normals = normals;
        options.order = order;
        bind();
        for (const float amount : {0.5f, 0.5f, -0.3f, 0.0f}) {
          update(bent(amount));
          expectTheWholeSurface();
        }
      }
    }
  }
}

TEST_F(MovedPartsOfASkin, AreExactlyTheVerticesOfTetsWithAMovedNode) {
  options.order = VertexOrder::Sorted;
  bind();
  const Points now = bent(0.5f);
  std::size_t expected = 0;
  for (const VertexBinding& b : skin.binding()->embedding.bindings()) {
    const Tet& tet = cage.tets[static_cast<std::size_t>(b.tet)];
    expected += std::any_of(tet.begin(), tet.end(), [&](int n) { return now[n] != rest[n]; });
  }
  EXPECT_EQ(writtenBy(now), expected);
  EXPECT_GT(expected, mesh.vertexCount() / 3);
  EXPECT_LT(expected, 2 * mesh.vertexCount() / 3);
  expectTheWholeSurface();
}

TEST_F(MovedPartsOfASkin, ReachAsFarAsGradientsDo) {
  options.order = VertexOrder::Sorted;
  bind();
  const std::size_t linear = writtenBy(bent(0.5f));
  options.interpolation = Interpolation::Quadratic;
  bind();
  const std::size_t quadratic = writtenBy(bent(0.5f));
  EXPECT_GT(quadratic, linear);
  EXPECT_LT(quadratic, mesh.vertexCount());
  expectTheWholeSurface();
}

TEST_F(MovedPartsOfASkin, AreNoneWhileNothingMovesAndAllAfterANewOrigin) {
  options.order = VertexOrder::Sorted;
  bind();
  update(bent(0.2f));
  EXPECT_EQ(writtenBy(bent(0.2f)), 0u);
  skin.setOrigin({1.0, 2.0, 3.0});
  whole.setOrigin({1.0, 2.0, 3.0});
  EXPECT_EQ(writtenBy(bent(0.2f)), mesh.vertexCount());
  expectTheWholeSurface();
  Points shifted = bent(0.2f);
  for (Eigen::Vector3f& p : shifted) p.x() += 1.0f;
  EXPECT_EQ(writtenBy(shifted), mesh.vertexCount());
}

TEST_F(MovedPartsOfASkin, AreComparedWithTheLastGoodNodes) {
  bind();
  Points bad = bent(0.5f);
  bad.back().x() = std::numeric_limits<float>::infinity();
  EXPECT_EQ(skin.update(viewOf(bad)), bad.size() - 1);
  update(bent(0.5f));
  expectTheWholeSurface();
}

TEST_F(MovedPartsOfASkin, AllocateNothing) {
  options.interpolation = Interpolation::Quadratic;
  options.normals = Normals::Transformed;
  bind();
  const Points now = bent(0.5f);
  const std::size_t before = test::allocationCount();
  EXPECT_EQ(skin.update(viewOf(now)), now.size());
  EXPECT_EQ(test::allocationCount(), before);
}

TEST_F(MovedPartsOfASkin, RefuseWhatNeedsAllPositions) {
  options.bounds = true;
  EXPECT_EQ(skin.bind(cage, mesh, options).status.code, StatusCode::InvalidOption);
  options.bounds = false;
  options.previousPositions = true;
  EXPECT_EQ(skin.bind(cage, mesh, options).status.code, StatusCode::InvalidOption);
}

}  // namespace
}  // namespace tetskin
