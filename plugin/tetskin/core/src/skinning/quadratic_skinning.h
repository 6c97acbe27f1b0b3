// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/embedding/embedding_data.h>
#include <tetskin/core/src/kernels/skinning_kernels.h>
#include <tetskin/core/src/skinning/skinning.h>

#include <cassert>
#include <vector>

namespace tetskin {

/// The rest-shape data for quadratic skinning: computed once, immutable, shared like an Embedding.
///
///     x(v) = sum_i b_i x_i + sum_{i<j} b_i b_j e_ij,   e_ij = (F_i - F_j) (X_j - X_i) / 2
///
/// with X rest and x current nodes (D. James, "Phong Deformation", 2020, doi 10.1145/3386569.3392371, written with one
/// vector per cage edge). The published node gradients F_i, averages of the tets' gradients, are not exact for
/// quadratic maps. These are, wherever the cage allows: least-squares fits of first and second derivatives over the
/// nearest nodes around node i, corrected so that every affine map is exact. Within quadratic tets the map is known:
/// the vectors of their edges come from the tets' own nodes, and x(v) is the tet's own map.
///
/// Memory: some 20 x 16 bytes per node that carries vertices (28 in double), 40 bytes per edge of such a tet, 64 of a
/// quadratic one.
template <class Scalar>
class QuadraticStencils {
 public:
  QuadraticStencils() = default;
  /// cage           usable, rest space; that of the embedding
  /// latticeTets    see CageNeighbours
  /// quadraticTets  of the cage
  /// Cost  some 20 to 50 microseconds per node that carries vertices
  QuadraticStencils(const TetMesh& cage, const Embedding& embedding, const std::vector<int>& latticeTets = {},
                    const std::vector<QuadraticTet>& quadraticTets = {});

  std::size_t gradientCount() const { return starts_.size() - 1; }
  std::size_t edgeCount() const { return restLengths_.size(); }
  /// The number of edges whose vectors come from gradients; those of quadratic tets come after them.
  std::size_t plainEdgeCount() const { return edgeGradients_.size() / 2; }
  /// The number of gradients in thin regions, and of those without a fit: see GradientStencil::Kind.
  std::size_t thinCount() const { return thinCount_; }
  std::size_t plainCount() const { return plainCount_; }

  /// By gradient: its node, ascending.
  const std::vector<std::uint32_t>& gradientNodes() const { return gradientNodes_; }
  /// By gradient, and the end: its first entry. An entry is a node and a factor: F = sum of x_node factor^T.
  const std::vector<std::uint32_t>& starts() const { return starts_; }
  const std::vector<std::uint32_t>& entryNodes() const { return entryNodes_; }
  const std::vector<Scalar>& entryFactors() const { return entryFactors_; }  ///< 3 per entry and one more, 1 / length
  const std::vector<std::uint32_t>& edgeGradients() const { return edgeGradients_; }  ///< 2 per plain edge
  /// By edge of a quadratic tet, and the end: its first entry. An entry is a node and a factor: e = sum of factor
  /// x_node.
  const std::vector<std::uint32_t>& bendStarts() const { return bendStarts_; }
  const std::vector<std::uint32_t>& bendNodes() const { return bendNodes_; }
  const std::vector<Scalar>& bendFactors() const { return bendFactors_; }
  /// 4 per edge: half the rest vector from its first node to its second, and the square of that half's length.
  const std::vector<Scalar>& halfRest() const { return halfRest_; }
  const std::vector<Scalar>& restLengths() const { return restLengths_; }
  /// 6 per run of the embedding: its edges (0,1) (0,2) (0,3) (1,2) (1,3) (2,3).
  const std::vector<std::uint32_t>& runEdges() const { return runEdges_; }

 private:
  void addGradients(const TetMesh& cage, const std::vector<int>& latticeTets, std::vector<std::uint32_t>& gradientOf);

  std::size_t thinCount_ = 0, plainCount_ = 0;
  std::vector<std::uint32_t> gradientNodes_;
  std::vector<std::uint32_t> starts_ = {0};
  std::vector<std::uint32_t> entryNodes_;
  std::vector<Scalar> entryFactors_;
  std::vector<std::uint32_t> edgeGradients_;
  std::vector<std::uint32_t> bendStarts_ = {0};
  std::vector<std::uint32_t> bendNodes_;
  std::vector<Scalar> bendFactors_;
  std::vector<Scalar> halfRest_;
  std::vector<Scalar> restLengths_;
  std::vector<std::uint32_t> runEdges_;
};

/// The nodes' current gradients.
template <class Scalar>
class NodeGradients {
 public:
  NodeGradients() = default;
  /// One gradient more than there are nodes with a gradient: the last one is always the identity.
  explicit NodeGradients(std::size_t count);

  /// Computes them for the current nodes. Cost O(nodes x neighbours), no allocation.
  void update(const QuadraticStencils<Scalar>& stencils, const PackedNodes<Scalar>& nodes,
              ParallelFor* threads = nullptr);

  std::size_t count() const { return gradients_.empty() ? 0 : gradients_.size() - 1; }
  /// kGradientStride scalars per gradient: its columns, of four scalars each.
  const Scalar* data() const { return gradients_.empty() ? nullptr : gradients_.front().columns; }

 private:
  /// A gradient takes one cache line, or two.
  struct alignas(64) Gradient {
    Scalar columns[kernels::kGradientStride] = {};
  };
  std::vector<Gradient> gradients_;
};

/// The cage's current edge vectors: each body has its own.
template <class Scalar>
class EdgeVectors {
 public:
  EdgeVectors() = default;
  explicit EdgeVectors(const QuadraticStencils<Scalar>& stencils);

  /// Computes them for the current nodes; gradients only if a plain edge needs them. No vector is longer than half its
  /// edge's rest length. Cost O(nodes x neighbours + edges), no allocation.
  void update(const QuadraticStencils<Scalar>& stencils, const PackedNodes<Scalar>& nodes,
              ParallelFor* threads = nullptr);

  /// 4 per edge: its vector, and its rest length
  const Scalar* data() const { return edges_.data(); }

 private:
  void bendByGradients(const QuadraticStencils<Scalar>& stencils, std::size_t first, std::size_t last);
  void bendByTets(const QuadraticStencils<Scalar>& stencils, const PackedNodes<Scalar>& nodes, std::size_t first,
                  std::size_t last);

  NodeGradients<Scalar> gradients_;
  std::vector<Scalar> edges_;
};

/// The data of a quadratic surface: its stencils, and edge vectors updated for the current nodes. Both null: the
/// surface is linear, x(v) = p3 + b0 (p0-p3) + b1 (p1-p3) + b2 (p2-p3).
template <class Scalar>
struct Bends {
  const QuadraticStencils<Scalar>* stencils = nullptr;
  const EdgeVectors<Scalar>* edges = nullptr;

  void addTo(kernels::Work<Scalar>& work) const {
    assert(!stencils == !edges);
    work.surface = stencils ? kernels::Surface::Quadratic : kernels::Surface::Linear;
    if (!stencils) return;
    work.edges = edges->data();
    work.runEdges = stencils->runEdges().data();
  }
};

/// Writes the current position of every vertex by the formula above; outside, the map is continued to first order from
/// the closest point of the tet.
///
/// embedding  shared, read only
/// nodes      nodeCount current positions, world space
/// bounds     if given, becomes the box of the written positions
/// threads    if given, lends its threads to large meshes
/// Cost       O(vertexCount), no allocation; cannot fail, sizes are asserted
template <class Scalar, class Out>
void skinPoints(const Embedding& embedding, const PackedNodes<Scalar>& nodes, const Bends<Scalar>& bends,
                const SkinOutput<Scalar, Out>& output, Box3* bounds = nullptr, ParallelFor* threads = nullptr);

}  // namespace tetskin
