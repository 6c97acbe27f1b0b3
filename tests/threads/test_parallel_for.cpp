// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"
#include "support/shuffled_threads.h"
#include "support/smooth_maps.h"

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/exported/skin_binding.h>

#include <cstring>

namespace tetskin {
namespace {

TEST(RunTasks, CallsEachTaskOnce) {
  for (const std::size_t count : {0, 1, 2, 100}) {
    for (const int threadCount : {0, 1, 4}) {
      test::ShuffledThreads threads(threadCount);
      std::vector<std::atomic<int>> calls(count);
      runTasks(threadCount > 0 ? &threads : nullptr, count, [&](std::size_t k) { ++calls[k]; });
      for (const std::atomic<int>& c : calls) EXPECT_EQ(c, 1);
      EXPECT_EQ(threads.runs, threadCount > 0 && count > 1 ? 1 : 0);
    }
  }
}

template <class Point>
bool sameBits(PointView<Point> a, PointView<Point> b) {
  if (a.size() != b.size() || a.empty()) return false;
  return std::memcmp(a.data(), b.data(), a.size() * a.strideBytes()) == 0;
}

/// The mesh is so large that every stage is divided into several tasks.
class Threads : public testing::Test {
 protected:
  Threads() {
    mesh.tangents.assign(mesh.vertexCount(), {0.6f, 0.0f, 0.8f, 1.0f});
    moveNodes();
  }

  void moveNodes() {
    nodes.clear();
    const test::SmoothMap waves = test::smoothMaps(Eigen::Vector3d::Constant(0.5))[3];
    for (const Eigen::Vector3d& p : cage.mesh.nodes) nodes.push_back(waves.at(p).cast<float>());
  }

  void expectSameBitsForAnyNumber(Normals normals, VertexOrder order) {
    SkinOptions options;
    options.interpolation = Interpolation::Quadratic;
    options.normals = normals;
    options.order = order;
    MeshSkin<float> alone;
    const Result<EmbedReport> fit = alone.bind(cage, mesh, options);
    ASSERT_TRUE(fit.ok());
    ASSERT_GT(fit.value().inside, 40000u);
    ASSERT_GT(fit.value().outside, 10000u);
    ASSERT_GT(dataOf(*alone.binding()).quadratic->gradientCount(), 1024u);
    ASSERT_GT(dataOf(*alone.binding()).quadratic->edgeCount(), 8192u);
    ASSERT_EQ(alone.update(viewOf(std::as_const(nodes))), StatusCode::Ok);
    for (const int count : {1, 2, 3, 7}) {
      test::ShuffledThreads threads(count);
      InstanceOptions lent;
      lent.threads = &threads;
      MeshSkin<float> together;
      ASSERT_TRUE(together.bind(alone.binding(), viewOf(std::as_const(nodes)), lent).ok());
      const int before = threads.runs;
      ASSERT_EQ(together.update(viewOf(std::as_const(nodes))), StatusCode::Ok);
      // The runs are gradients, edges, positions, normals and tangents, or faces and normals; in the mesh's order, the
      // first three outputs are also reordered. Quadratic tets need no gradients.
      const int gradients = cage.quadraticTet.empty() ? 1 : 0;
      EXPECT_EQ(threads.runs - before, (order == VertexOrder::Mesh ? 7 : 4) + gradients);
      EXPECT_GE(threads.maxTasks, 4u);
      EXPECT_TRUE(sameBits(together.positions(), alone.positions())) << count;
      EXPECT_TRUE(sameBits(together.normals(), alone.normals())) << count;
      EXPECT_EQ(sameBits(together.tangents(), alone.tangents()), normals == Normals::Transformed) << count;
      EXPECT_EQ(together.bounds().min(), alone.bounds().min());
      EXPECT_EQ(together.bounds().max(), alone.bounds().max());
    }
  }

  Cage cage{test::latticeCage(16, 16, 16, 1.0 / 16.0)};
  TriangleMesh mesh = test::sphere(260, 0.52, Eigen::Vector3d::Constant(0.5));
  std::vector<Eigen::Vector3f> nodes;
};

TEST_F(Threads, SameBitsForAnyNumberWithTransformedNormals) {
  expectSameBitsForAnyNumber(Normals::Transformed, VertexOrder::Mesh);
}

TEST_F(Threads, SameBitsForAnyNumberInQuadraticTets) {
  cage = refineQuadratic(test::latticeCage(8, 8, 8, 1.0 / 8.0)).value();
  moveNodes();
  expectSameBitsForAnyNumber(Normals::Transformed, VertexOrder::Mesh);
}

TEST_F(Threads, SameBitsForAnyNumberWithRecomputedNormalsInSortedOrder) {
  expectSameBitsForAnyNumber(Normals::Recomputed, VertexOrder::Sorted);
}

}  // namespace
}  // namespace tetskin
