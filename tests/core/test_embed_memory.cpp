// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/allocation_count.h"
#include "support/embed_into.h"
#include "support/odd_meshes.h"

#include <tetskin/core/embedding.h>

namespace tetskin {
namespace {

/// The peak memory of an embedding in bytes per vertex, including the result.
template <class Scalar>
double peakPerVertex(const TetMesh& cage, const std::vector<Eigen::Matrix<Scalar, 3, 1>>& vertices, OutsideRule rule) {
  Embedding embedding;
  const std::size_t before = test::allocatedBytes();
  test::resetPeak();
  EXPECT_TRUE(embedInto(cage, viewOf(vertices), {rule}, embedding).ok());
  return static_cast<double>(test::peakBytes() - before) / static_cast<double>(vertices.size());
}

constexpr double kMaxBytes = 64.0;

TEST(EmbedMemory, IsBoundedPerVertexInside) {
  const TetMesh cage = test::latticeCage(14, 14, 14, 1.0 / 14);  // 16,464 tets: 24 vertices per tet
  const auto vertices =
      test::randomPoints(400000, {Eigen::Vector3d::Constant(0.001), Eigen::Vector3d::Constant(0.999)}, 41);
  EXPECT_LE(peakPerVertex(cage, vertices, OutsideRule::Nearest), kMaxBytes);
}

TEST(EmbedMemory, NeedsNoCopyOfFloatVertices) {
  const TetMesh cage = test::latticeCage(14, 14, 14, 1.0 / 14);
  std::vector<Eigen::Vector3f> vertices;
  for (const Eigen::Vector3d& p :
       test::randomPoints(400000, {Eigen::Vector3d::Constant(0.001), Eigen::Vector3d::Constant(0.999)}, 42)) {
    vertices.push_back(p.cast<float>());
  }
  EXPECT_LE(peakPerVertex(cage, vertices, OutsideRule::Nearest), kMaxBytes);
}

TEST(EmbedMemory, IsBoundedPerVertexOutside) {
  const TetMesh cage = test::latticeCage(3, 3, 3, 0.1);
  const auto vertices =
      test::randomPoints(400000, {Eigen::Vector3d(0.0, 0.31, 0.0), Eigen::Vector3d(0.3, 0.33, 0.3)}, 43);
  for (const OutsideRule rule : {OutsideRule::Nearest, OutsideRule::Barycentric}) {
    EXPECT_LE(peakPerVertex(cage, vertices, rule), kMaxBytes) << "rule " << static_cast<int>(rule);
  }
}

#ifndef __SANITIZE_ADDRESS__  // takes a minute with this sanitizer
TEST(EmbedMemory, IsBoundedPerVertexRescued) {
  const TetMesh cage = test::thinLayerCage(0.001);  // the nearest tets carry none of these vertices
  const auto vertices =
      test::randomPoints(600000, {Eigen::Vector3d(0.0, 0.52, 0.0), Eigen::Vector3d(1.0, 0.55, 1.0)}, 45);
  EXPECT_LE(peakPerVertex(cage, vertices, OutsideRule::Nearest), kMaxBytes);
}
#endif

TEST(EmbedMemory, IsBoundedPerVertexWhereManyCoincide) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  auto vertices = test::randomPoints(300000, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}, 44);
  for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = vertices[v % 1000];
  EXPECT_LE(peakPerVertex(cage, vertices, OutsideRule::Nearest), kMaxBytes);
}

}  // namespace
}  // namespace tetskin
