// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace tetskin {

/// A run of consecutive triangles that share a name and a material.
struct TriangleGroup {
  std::string name;               ///< may be empty
  std::string material;           ///< the same
  std::size_t firstTriangle = 0;  ///< index of its first triangle
  std::size_t triangleCount = 0;  ///< how many follow from there
};

/// A unit tangent, and in w the sign of the bitangent. Four floats that no compiler flag aligns otherwise.
using Tangent = Eigen::Matrix<float, 4, 1, Eigen::DontAlign>;

/// A render mesh at rest. Vertices may coincide (texture seams), surfaces may be open, and several parts are fine.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> positions;     ///< vertexCount x 3, rest space, the file's own unit
  std::vector<std::array<int, 3>> triangles;  ///< triangleCount x 3 vertex indices, counter-clockwise from outside
  std::vector<Eigen::Vector3f> normals;       ///< authored unit normals, one a vertex; or empty
  std::vector<Tangent> tangents;              ///< one a vertex; or empty
  std::vector<Eigen::Vector2f> texcoords;     ///< texture coordinates, one a vertex; or empty
  std::vector<TriangleGroup> groups;          ///< cover all triangles in order; or empty: one group without a name

  std::size_t vertexCount() const { return positions.size(); }    ///< of `positions`
  std::size_t triangleCount() const { return triangles.size(); }  ///< of `triangles`
};

/// Most vertices: their indices are ints.
constexpr std::size_t kMostVertices = 0x7FFFFFFF;
/// Most triangles: the paths around vertices along which normals are computed take nine numbers a triangle at worst,
/// which are counted by 32 bits.
constexpr std::size_t kMostTriangles = 0xFFFFFFFFu / 9;

/// Ok if a mesh may have so many. Error: TooLarge
TETSKIN_CORE_API Status checkTriangleCounts(std::size_t vertices, std::size_t triangles);

/// Ok if the mesh has vertices, not too many, all finite, and every triangle names existing vertices. A mesh without
/// triangles (a point cloud) is fine. Cost O(vertexCount + triangleCount).
TETSKIN_CORE_API Status checkTriangleMesh(const TriangleMesh& mesh);

/// The mesh's authored normals; where there are none, or one is not of unit length, those of its triangles, weighted by
/// area and smooth across coincident vertices. vertexCount unit vectors, of (0, 1, 0) for vertices without triangles.
TETSKIN_CORE_API std::vector<Eigen::Vector3d> restNormals(const TriangleMesh& mesh);

}  // namespace tetskin
