// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The content of a GLB, as plain data.
#pragma once

#include <tetskin/io/animation.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tetskin::io {

/// A material, with a white one-pixel texture on meshes that have texture coordinates: without a texture, these would
/// count as unused, and tools would remove them.
struct GlbMaterial : SurfaceMaterial {
  bool textured = false;
};

/// The triangles of one material.
struct GlbPart {
  std::size_t material = 0;            ///< index in GlbScene::materials
  std::vector<std::uint32_t> corners;  ///< 3 vertices per triangle
};

struct GlbMesh {
  std::string name;
  std::vector<float> positions;       ///< 3 per vertex
  std::vector<float> normals;         ///< 3 per vertex, of unit length; or empty
  std::vector<float> texcoords;       ///< 2 per vertex, the origin at the upper left; or empty
  std::vector<std::uint16_t> joints;  ///< 4 per vertex; empty for a rigid mesh
  std::vector<float> weights;         ///< 4 per vertex, none negative, sum 1; or empty
  std::vector<float> inverseBinds;    ///< 16 per joint, by columns; or empty
  std::vector<GlbPart> parts;         ///< at least one, none without triangles
};

/// A node, and its values in each frame; those of the first frame are also the node's own.
struct GlbNode {
  std::string name;
  std::vector<std::size_t> children;
  int mesh = -1, skin = -1;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< of a node that does not move
  std::vector<float> translations;                        ///< 3 per frame; or empty
  std::vector<float> rotations;                           ///< 4 per frame, x y z w, of unit length; or empty
  std::vector<float> scales;                              ///< 3 per frame; or empty
};

/// The joints of one body, which share the inverse bind matrices of its mesh.
struct GlbSkin {
  std::size_t mesh = 0;
  std::vector<std::size_t> joints;  ///< nodes
};

struct GlbScene {
  std::vector<GlbMaterial> materials;
  std::vector<GlbMesh> meshes;
  std::vector<GlbNode> nodes;
  std::vector<std::size_t> roots;  ///< nodes without a parent
  std::vector<GlbSkin> skins;
  std::vector<float> times;                          ///< seconds, by frame
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< all positions are relative to it; stored in the scene's extras
};

/// Largest size of a GLB, whose header states it in 32 bits.
constexpr double kMaxGlbBytes = 4294967295.0;

/// The bytes of the scene's file, without the text that describes them.
double binaryBytes(const GlbScene& scene);

/// The file of a scene. Empty if this build has no tinygltf.
std::string glbBytes(const GlbScene& scene);

}  // namespace tetskin::io
