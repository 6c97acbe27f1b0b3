// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// An engine's drawing with a palette of bones: plain linear blend skinning, in double.
#pragma once

#include <gtest/gtest.h>
#include <tetskin/core/bone_palette.h>

#include <utility>
#include <vector>

namespace tetskin::test {

using Bone = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;
using BlendedBone = Eigen::Matrix<double, 3, 4>;

/// The bones for these nodes, which must be usable.
template <class Scalar>
std::vector<Bone> bonesFor(BonePalette<Scalar>& palette, const std::vector<Eigen::Vector3d>& positions) {
  std::vector<Eigen::Matrix<Scalar, 3, 1>> nodes;
  for (const Eigen::Vector3d& p : positions) nodes.push_back(p.cast<Scalar>());
  std::vector<Bone> bones(palette.boneCount());
  EXPECT_EQ(palette.layout(), BoneLayout::Rows);
  EXPECT_EQ(palette.update(viewOf(std::as_const(nodes)), {bones.front().data(), bones.size()}), StatusCode::Ok);
  return bones;
}

/// Sum of a vertex's bones, by its weights.
inline BlendedBone blended(const SkinnedMesh& mesh, std::size_t vertex, const std::vector<Bone>& bones) {
  BlendedBone sum = BlendedBone::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    sum += static_cast<double>(mesh.weights[vertex][k]) * bones[mesh.bones[vertex][k]].cast<double>();
  }
  return sum;
}

inline std::vector<Eigen::Vector3d> drawnBy(const std::vector<Bone>& bones, const SkinnedMesh& mesh,
                                            const std::vector<Eigen::Vector3d>& rest) {
  std::vector<Eigen::Vector3d> drawn;
  for (std::size_t v = 0; v < rest.size(); ++v) drawn.push_back(blended(mesh, v, bones) * rest[v].homogeneous());
  return drawn;
}

/// The normal by the inverse transpose of the sum of the bones' left parts.
inline Eigen::Vector3d normalBy(const std::vector<Bone>& bones, const SkinnedMesh& mesh, std::size_t vertex,
                                const Eigen::Vector3d& rest) {
  const Eigen::Matrix3d sum = blended(mesh, vertex, bones).leftCols<3>();
  return (sum.inverse().transpose() * rest).normalized();
}

}  // namespace tetskin::test
