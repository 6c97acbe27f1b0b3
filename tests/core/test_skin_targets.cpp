// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A skin never reads back from the caller's memory: that memory may be mapped for writing only, and reading it may be a
// hundred times slower.
#include "support/embed_into.h"
#include "support/odd_meshes.h"
#include "support/smooth_maps.h"

#include <tetskin/core/mesh_skin.h>

#include <cstring>
#include <limits>

namespace tetskin {
namespace {

/// Overwrites the caller's memory between any two stages of an update, so that only the last stage's output remains.
class Forgetful : public ParallelFor {
 public:
  void run(std::size_t count, Task task) override {
    for (std::vector<float>* memory : all) {
      memory->assign(memory->size(), std::numeric_limits<float>::quiet_NaN());
    }
    ++stages;
    for (std::size_t k = 0; k < count; ++k) task(k);
  }

  std::vector<std::vector<float>*> all;
  int stages = 0;
};

/// The mesh is large enough that every stage is divided into several tasks and is therefore counted.
class SkinTargets : public testing::Test {
 protected:
  SkinTargets() {
    mesh.tangents.assign(mesh.vertexCount(), {0.6f, 0.0f, 0.8f, 1.0f});
    const test::SmoothMap waves = test::smoothMaps(Eigen::Vector3d::Constant(0.5))[3];
    for (const Eigen::Vector3d& p : cage.nodes) nodes.push_back(waves.at(p).cast<float>());
  }

  /// Points of `stride` scalars each, in the caller's memory.
  template <class Scalar>
  PointView<Scalar> points(std::vector<float>& memory, std::size_t stride) {
    memory.assign(mesh.vertexCount() * stride * (sizeof(Scalar) / sizeof(float)), 0.0f);
    caller.all.push_back(&memory);
    return {reinterpret_cast<Scalar*>(memory.data()), mesh.vertexCount(), stride * sizeof(Scalar)};
  }

  template <class Scalar>
  void expectDirectionsAsOfOwnMemory(Normals normals, VertexOrder order, std::size_t stride) {
    SCOPED_TRACE(testing::Message() << "order " << static_cast<int>(order) << ", stride " << stride);
    SkinOptions options;
    options.normals = normals;
    options.order = order;
    MeshSkin<float> own, skin;
    ASSERT_TRUE(own.bind(cage, mesh, options).ok());
    caller = {};
    std::vector<float> positions, directions, tangents;
    options.target = points<Scalar>(positions, stride);
    options.normalTarget = points<float>(directions, stride);
    options.tangentTarget = points<float>(tangents, stride);
    options.threads = &caller;
    ASSERT_TRUE(skin.bind(own.binding(), viewOf(std::as_const(nodes)), instanceOf(options)).ok());
    ASSERT_EQ(own.update(viewOf(std::as_const(nodes))), StatusCode::Ok);
    ASSERT_EQ(skin.update(viewOf(std::as_const(nodes))), StatusCode::Ok);
    ASSERT_GE(caller.stages, 2);
    const bool tangentsLast = !own.tangents().empty();
    const PointView<const float> expected = tangentsLast ? own.tangents() : own.normals();
    const PointView<float> last = tangentsLast ? options.tangentTarget : options.normalTarget;
    std::size_t different = 0;
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      different += std::memcmp(last[v], expected[v], 3 * sizeof(float)) != 0;
    }
    EXPECT_EQ(different, 0u);
  }

  TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  TriangleMesh mesh = test::sphere(200, 0.52, Eigen::Vector3d::Constant(0.5));
  std::vector<Eigen::Vector3f> nodes;
  Forgetful caller;
};

TEST_F(SkinTargets, AreNotReadForRecomputedNormals) {
  for (const VertexOrder order : {VertexOrder::Mesh, VertexOrder::Sorted}) {
    for (const std::size_t stride : {3, 8}) {
      expectDirectionsAsOfOwnMemory<float>(Normals::Recomputed, order, stride);
      expectDirectionsAsOfOwnMemory<double>(Normals::Recomputed, order, stride);
    }
  }
}

TEST_F(SkinTargets, AreNotReadForTransformedNormalsOrTangents) {
  for (const bool tangents : {true, false}) {
    if (!tangents) mesh.tangents.clear();
    for (const VertexOrder order : {VertexOrder::Mesh, VertexOrder::Sorted}) {
      for (const std::size_t stride : {3, 8}) {
        expectDirectionsAsOfOwnMemory<float>(Normals::Transformed, order, stride);
      }
    }
  }
}

}  // namespace
}  // namespace tetskin
