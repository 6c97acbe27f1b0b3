// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/quadratic_skinning.h>
#include <tetskin/core/skinning.h>
#include <tetskin/core/triangle_mesh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace tetskin {

/// Where a skin's normals come from.
enum class Normals {
  None,         ///< nowhere: no memory, no time
  Transformed,  ///< the rest normals, carried by the gradient of the map: keeps all detail of authored normals
  Recomputed,   ///< the deformed triangles, weighted by area: also right where the surface folds within a tet
};

/// Normals that differ by more than this at one position make a hard edge. Below, they are a smooth normal's rounding,
/// or that of a file; a facet of a smooth surface turns more.
constexpr double kHardEdgeDegrees = 5.0;

/// The mesh's authored normals; where there are none, or one is not of unit length, those of its triangles, weighted by
/// area and smooth across coincident vertices. vertexCount unit vectors, of (0, 1, 0) for vertices without triangles.
std::vector<Eigen::Vector3d> restNormals(const TriangleMesh& mesh);

/// Directions on the rest surface, prepared to be carried by the map's gradient G: normals by its cofactor matrix (not
/// its inverse transpose: no division, and the right side out when a tet is inverted), tangents by G itself.
/// Immutable, shared like an Embedding. Memory: 12 bytes a vertex.
class DirectionFactors {
 public:
  DirectionFactors() = default;
  /// cage       of the embedding, rest space
  /// normals    vertexCount unit vectors, rest space
  static DirectionFactors ofNormals(const TetMesh& cage, const Embedding& embedding,
                                    const std::vector<Eigen::Vector3d>& normals);
  /// tangents   likewise, tangent to the surface
  static DirectionFactors ofTangents(const TetMesh& cage, const Embedding& embedding,
                                     const std::vector<Eigen::Vector3d>& tangents);

  bool areNormals() const { return normals_; }
  /// By slot, padded like the weights.
  const float* plane(int k) const { return planes_[static_cast<std::size_t>(k)].data(); }

 private:
  template <class Factor>
  DirectionFactors(const TetMesh& cage, const Embedding& embedding, bool normals, Factor&& factor);

  bool normals_ = true;
  std::array<std::vector<float>, 3> planes_;
};

/// Writes the current unit normal (or tangent) of every vertex, for a linear surface or a quadratic one; outside, the
/// gradient is that of the closest point. A direction that has collapsed to nothing leaves what is there, so the
/// caller's memory should hold unit vectors to begin with.
///
/// stencils, edges  those of the quadratic surface, updated for these nodes; null for the linear one
/// out              vertexCount x 3, caller-owned, any stride; world space
/// scratch          scratchSize(vertexCount) floats of the caller's, unit vectors to begin with, which nobody else
/// writes; not
///                  needed for `out` side by side in sorted order; without it, some is allocated, and `out` is read
/// movedRuns        as in SkinOutput
/// Cost             O(vertexCount), no allocation
template <class Scalar>
void transformDirections(const Embedding& embedding, const DirectionFactors& factors,
                         const QuadraticStencils<Scalar>* stencils, const EdgeVectors<Scalar>* edges,
                         const PackedNodes<Scalar>& nodes, PointView<float> out, VertexOrder order,
                         float* scratch = nullptr, ParallelFor* threads = nullptr,
                         const std::uint8_t* movedRuns = nullptr);

/// Which triangles make the normal of which vertices: vertices at one position share theirs, unless their rest normals
/// differ by more than an angle (a hard edge). Immutable, shared like an Embedding.
/// Memory: 12 bytes a triangle, 12 a corner, 8 a vertex at most.
class NormalTopology {
 public:
  NormalTopology() = default;
  /// places  by vertex, where it is written (its slot, for VertexOrder::Sorted); empty for the mesh's order
  NormalTopology(const TriangleMesh& mesh, const std::vector<std::uint32_t>& places,
                 double hardEdgeDegrees = kHardEdgeDegrees);

  std::size_t triangleCount() const { return triangles_.size() / 3; }
  std::size_t groupCount() const { return groupTriangles_.size() - 1; }
  const std::vector<std::uint32_t>& triangles() const { return triangles_; }            ///< 3 places a triangle
  const std::vector<std::uint32_t>& groupTriangles() const { return groupTriangles_; }  ///< by group, and one more
  const std::vector<std::uint32_t>& corners() const { return corners_; }                ///< triangles, group by group
  const std::vector<std::uint32_t>& groupPlaces() const { return groupPlaces_; }        ///< by group, and one more
  const std::vector<std::uint32_t>& places() const { return places_; }                  ///< places, group by group

 private:
  std::vector<std::uint32_t> triangles_;
  std::vector<std::uint32_t> groupTriangles_ = {0};
  std::vector<std::uint32_t> corners_;
  std::vector<std::uint32_t> groupPlaces_ = {0};
  std::vector<std::uint32_t> places_;
};

/// Writes the unit normals of the deformed triangles, weighted by area. Gathered per vertex in a fixed order, so that
/// the bits depend on no number of threads. Where all triangles have collapsed, what is there is left.
///
/// positions    vertexCount x 3, as just written
/// faceVectors  triangleCount x 4, scratch of the caller
/// Cost         O(triangleCount + vertexCount), no allocation
template <class Scalar>
void recomputeNormals(const NormalTopology& topology, PointView<const Scalar> positions,
                      std::vector<float>& faceVectors, PointView<float> out, ParallelFor* threads = nullptr);

}  // namespace tetskin
