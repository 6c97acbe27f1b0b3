// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/types.h>

#include <cstdint>
#include <vector>

namespace tetskin {

/// The surrounding vertices that determine each vertex's normal. Vertices at one position share a normal, unless their
/// rest normals, whatever their lengths, differ by more than an angle (a hard edge); a rest normal that is zero or not
/// finite counts as absent, and makes no edge. A group of vertices that share a normal has a path around them, from
/// each of their triangles into the next. Immutable, shared like an Embedding.
/// Memory: some 40 bytes per vertex of a closed surface.
class NormalTopology {
 public:
  NormalTopology() = default;
  /// indices          by vertex: its index in the output (its slot, for VertexOrder::Sorted); empty for the mesh's
  ///                  order
  /// hardEdgeDegrees  not below 0; at 180 or more there are no hard edges
  NormalTopology(const TriangleMesh& mesh, const std::vector<std::uint32_t>& indices, double hardEdgeDegrees);

  std::size_t groupCount() const { return groupPositions_.size() - 1; }
  const std::vector<std::uint32_t>& groupPositions() const { return groupPositions_; }  ///< by group, and the end
  /// Indices in the output, group by group, ascending.
  const std::vector<std::uint32_t>& indices() const { return indices_; }
  const std::vector<std::uint32_t>& groupPaths() const { return groupPaths_; }  ///< by group, and the end
  /// Indices in the output, group by group. Two consecutive ones are the far side of a triangle, unless one of them is
  /// at the group's own position: the path then continues elsewhere.
  const std::vector<std::uint32_t>& paths() const { return paths_; }

 private:
  std::vector<std::uint32_t> groupPositions_ = {0};
  std::vector<std::uint32_t> indices_;
  std::vector<std::uint32_t> groupPaths_ = {0};
  std::vector<std::uint32_t> paths_;
};

/// Copies points to four scalars each; the last is meaningless.
/// points  vertexCount x 3, read
/// padded  vertexCount x 4
template <class Scalar>
void padPoints(PointView<const Scalar> points, std::vector<Scalar>& padded, ParallelFor* threads = nullptr);

/// Writes the unit normals of the deformed triangles, weighted by area: for a vertex at x, with p_i and p_i+1 the far
/// side of a triangle, the sum of (p_i - x) x (p_i+1 - x). Gathered per vertex in a fixed order, so the bits do not
/// depend on the number of threads. If all its triangles have collapsed, a vertex keeps the previous value.
///
/// padded  vertexCount x 4, current positions; those of vertices at one position in the mesh are the same
/// out     vertexCount x 3, caller-owned, any stride; never read
/// Cost    O(triangleCount + vertexCount), no allocation
template <class Scalar>
void recomputeNormals(const NormalTopology& topology, const std::vector<Scalar>& padded, PointView<float> out,
                      ParallelFor* threads = nullptr);

}  // namespace tetskin
