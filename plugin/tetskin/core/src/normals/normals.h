// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/skinning/quadratic_skinning.h>
#include <tetskin/core/src/skinning/skinning.h>

#include <array>
#include <cstdint>
#include <vector>

namespace tetskin {

/// Directions on the rest surface, prepared for the map's gradient G: it transforms normals by its cofactor matrix (not
/// its inverse transpose: no division, and the correct side when a tet is inverted), tangents by G itself. Immutable,
/// shared like an Embedding. Memory: 12 bytes per vertex.
class DirectionFactors {
 public:
  DirectionFactors() = default;
  /// cage       of the embedding, rest space
  /// normals    vertexCount unit vectors, rest space
  static DirectionFactors ofNormals(const TetMesh& cage, const Embedding& embedding,
                                    const std::vector<Eigen::Vector3d>& normals);
  /// tangents   vertexCount unit vectors, rest space, tangent to the surface
  static DirectionFactors ofTangents(const TetMesh& cage, const Embedding& embedding,
                                     const std::vector<Eigen::Vector3d>& tangents);

  bool areNormals() const { return normals_; }
  /// By slot, with the padding of the weights.
  const float* plane(int k) const { return planes_[static_cast<std::size_t>(k)].data(); }

 private:
  template <class Factor>
  DirectionFactors(const TetMesh& cage, const Embedding& embedding, bool normals, Factor&& factor);

  bool normals_ = true;
  std::array<std::vector<float>, 3> planes_;
};

/// Writes the current unit normal (or tangent) of every vertex, for a linear or a quadratic surface; outside, the
/// gradient is that of the closest point. If a direction has collapsed to zero, its memory keeps the old value, so the
/// caller's memory should initially hold unit vectors.
///
/// out              vertexCount x 3, caller-owned, any stride; world space
/// scratch          scratchSize(vertexCount) floats of the caller's, initially unit vectors, which nobody else writes;
///                  not needed if `out` is contiguous and in sorted order; without it, some is allocated, and `out` is
///                  read
/// Cost             O(vertexCount), no allocation
template <class Scalar>
void transformDirections(const Embedding& embedding, const DirectionFactors& factors, const Bends<Scalar>& bends,
                         const PackedNodes<Scalar>& nodes, PointView<float> out, VertexOrder order,
                         float* scratch = nullptr, ParallelFor* threads = nullptr);

}  // namespace tetskin
