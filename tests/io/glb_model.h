// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A GLB as tinygltf reads it, the rules of glTF 2.0 that the Khronos validator checks, and the vertices that a player
// draws.
#pragma once

#include <tiny_gltf.h>
#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

namespace tetskin::test {

class GlbModel {
 public:
  /// Expects tinygltf to read the file without a word.
  explicit GlbModel(const std::string& path);

  const tinygltf::Model& model() const { return model_; }
  /// The number of keyframes; 0 without an animation.
  std::size_t frameCount() const;
  /// The numbers of an accessor, as doubles.
  std::vector<double> numbers(int accessor) const;
  /// The index of the node with this name; expects that there is exactly one.
  int node(const std::string& name) const;
  /// A player's drawing of a node's mesh in a frame: linear blend skinning, or the mesh in the node's place.
  std::vector<Eigen::Vector3d> positions(const std::string& name, std::size_t frame) const;
  /// The triangles of a node's mesh with their material's name, by primitive.
  std::vector<std::string> materials(const std::string& name) const;
  std::size_t triangleCount(const std::string& name) const;

  /// Expects what glTF 2.0 demands: alignment, bounds, unit normals and quaternions, weights that are not negative and
  /// sum to 1, joints without a weight 0, ascending times, indices in range, a forest of nodes.
  void expectValid() const;

 private:
  Eigen::Affine3d placeOf(std::size_t node, std::size_t frame) const;
  void expectValidAccessors() const;
  void expectValidMeshes() const;
  void expectValidNodes() const;
  void expectValidAnimations() const;

  tinygltf::Model model_;
  std::vector<int> parents_;
};

}  // namespace tetskin::test
