// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The common part of readers of scenes, glTF and assimp's formats: joins meshes placed by nodes into one.
#pragma once

#include <tetskin/core/mesh.h>

#include <array>
#include <string>
#include <vector>

namespace tetskin::io {

/// One mesh as placed by a node, in the scene's space.
struct ScenePart {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3f> normals;    ///< by vertex, of unit length or 0; or empty
  std::vector<Eigen::Vector2f> texcoords;  ///< by vertex; or empty
  std::vector<std::array<int, 3>> triangles;
  std::vector<TriangleGroup> groups;  ///< cover the triangles in order
};

/// Matrix of cofactors times the sign of the determinant: a positive multiple of the inverse transpose, as normals
/// need, which also exists for flattening transforms.
Eigen::Matrix3d normalMatrix(const Eigen::Matrix3d& m);

/// Joins parts into one mesh, as `loadMesh` describes: if only some have texture coordinates, the others get 0; if only
/// some have normals, the others get smooth ones. Parts are emptied.
/// Errors: Empty, NonFinite, UnsupportedFormat for too many vertices; those of `validate`.
Result<TriangleMesh> joinParts(const std::string& path, std::vector<ScenePart>& parts);

}  // namespace tetskin::io
