// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Tet meshes and triangle meshes, as flat arrays.
#pragma once

#include <tetskin/core/types.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace tetskin {

/// Which tet carries a vertex that lies in no tet. The rule does not affect vertices inside the cage.
enum class OutsideRule {
  Nearest,      ///< the closest tet, except slivers: a thin layer of tets keeps the vertices just above it
  Barycentric,  ///< the tet of smallest barycentric distance, as in the "Ten Minute Physics" tutorial and in Bullet
};

/// Four node indices. A tet is positive if node 3 lies on the side of triangle (0, 1, 2) towards which (p1-p0) x
/// (p2-p0) points.
using Tet = std::array<int, 4>;

/// A tet mesh at rest, as flat arrays. Nothing is checked on construction: see `validate`, `checkTetMesh` and
/// `repairTetMesh`.
struct TetMesh {
  std::vector<Eigen::Vector3d> nodes;  ///< nodeCount x 3, rest space
  std::vector<Tet> tets;               ///< tetCount x 4 node indices

  std::size_t nodeCount() const { return nodes.size(); }  ///< number of nodes
  std::size_t tetCount() const { return tets.size(); }    ///< number of tets
};

/// The faults of a tet mesh: how many there are of each kind, and where the first one is (undefined if the count is 0).
/// The first two kinds make a mesh unusable. The others are tolerated, unless every tet repeats a node or has no
/// volume.
struct TETSKIN_CORE_API TetMeshReport {
  /// One kind of fault.
  struct Fault {
    std::size_t count = 0;  ///< number of tets (or nodes) with this fault
    std::size_t first = 0;  ///< index of the first tet (or node) with it
  };
  Fault indexOutOfRange;    ///< tets that name a node that does not exist
  Fault nonFiniteNodes;     ///< nodes with a coordinate that is not finite
  Fault repeatedNode;       ///< tets that name one node twice
  Fault zeroVolume;         ///< tets whose six-fold volume is below 1e-9 of their longest edge cubed
  Fault negativeVolume;     ///< tets with the orientation reversed
  Fault duplicateTets;      ///< tets that name the same four nodes as an earlier one
  Fault unreferencedNodes;  ///< nodes that no tet names

  /// True if no count is above 0.
  bool clean() const;
  /// The faults in words, one per line; empty if clean.
  std::string describe() const;
};

/// Counts the faults of a mesh. Cost O(T log T) for T tets.
TETSKIN_CORE_API TetMeshReport checkTetMesh(const TetMesh& mesh);

/// Checks that a mesh can be used: it has tets, not too many, all indices exist, all coordinates are finite, and at
/// least one tet has volume. Cost O(N + T) for N nodes and T tets; allocates nothing.
/// Errors: Empty, TooLarge, IndexOutOfRange, NonFinite, Degenerate.
TETSKIN_CORE_API Status validate(const TetMesh& mesh);

/// Reverses the orientation of negative tets by exchanging their last two nodes. Returns the report of the mesh before
/// the repair. A mesh with indices out of range or nodes that are not finite is left untouched. Cost O(T log T) for T
/// tets.
TETSKIN_CORE_API TetMeshReport repairTetMesh(TetMesh& mesh);

/// Sum of the tets' volumes, regardless of orientation, in cubed units of the nodes. Indices must be in range.
TETSKIN_CORE_API double totalVolume(const TetMesh& mesh);

/// The distinct edges, each as (a, b) in the direction of the tet that names it first, in order of first appearance:
/// (0,1) (1,2) (2,0) (0,3) (1,3) (2,3) of tet 0, then of tet 1, ... Cost O(T log T) for T tets. Indices must be in
/// range.
TETSKIN_CORE_API std::vector<std::array<int, 2>> uniqueEdges(const TetMesh& mesh);

/// The boundary: the faces that belong to an odd number of tets, oriented outwards on positive tets and sorted by their
/// sorted node indices. Cost O(T log T) for T tets. Indices must be in range.
TETSKIN_CORE_API std::vector<std::array<int, 3>> boundaryFaces(const TetMesh& mesh);

/// A run of consecutive triangles that share a name and a material.
struct TriangleGroup {
  std::string name;               ///< may be empty
  std::string material;           ///< may be empty
  std::size_t firstTriangle = 0;  ///< index of its first triangle
  std::size_t triangleCount = 0;  ///< number of triangles
};

/// A unit tangent, and in w the sign of the bitangent. Four floats without alignment requirements, whatever the
/// compiler flags.
using Tangent = Eigen::Matrix<float, 4, 1, Eigen::DontAlign>;

/// A render mesh at rest. Vertices may coincide (texture seams), surfaces may be open, and there may be several
/// components.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> positions;     ///< vertexCount x 3, rest space, the file's own unit
  std::vector<std::array<int, 3>> triangles;  ///< triangleCount x 3 vertex indices, counter-clockwise from outside
  std::vector<Eigen::Vector3f> normals;       ///< vertexCount authored unit normals, rest space; or empty
  std::vector<Tangent> tangents;              ///< vertexCount tangents, rest space; or empty
  std::vector<Eigen::Vector2f> texcoords;     ///< vertexCount texture coordinates; or empty
  std::vector<TriangleGroup> groups;          ///< cover all triangles in order; or empty: one group without a name

  std::size_t vertexCount() const { return positions.size(); }    ///< number of vertices
  std::size_t triangleCount() const { return triangles.size(); }  ///< number of triangles
};

/// Checks that the mesh has vertices, not too many, all finite, and that every triangle names existing vertices. A mesh
/// without triangles (a point cloud) is valid. Cost O(vertexCount + triangleCount).
/// Errors: Empty, TooLarge, NonFinite, IndexOutOfRange.
TETSKIN_CORE_API Status validate(const TriangleMesh& mesh);

/// vertexCount unit normals in rest space: the mesh's authored normals. If there are none, or one is not of unit
/// length, the normals of its triangles, weighted by area and smooth across coincident vertices. Vertices without
/// triangles get (0, 1, 0).
TETSKIN_CORE_API std::vector<Eigen::Vector3d> restNormals(const TriangleMesh& mesh);

}  // namespace tetskin
