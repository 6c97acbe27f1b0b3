// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to quadratic skinning: the gradient at a node as a linear function of the positions of the nodes around it.
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/lists.h>

#include <cstdint>
#include <vector>

namespace tetskin {

/// F = sum over entries of x_node factor^T.
struct GradientStencil {
  enum class Kind {
    Full,   ///< exact for quadratic maps
    Thin,   ///< exact for affine maps; some second derivatives cannot be told apart
    Plain,  ///< the mean of the gradients of the tets around the node, weighted by volume; exact for affine maps
  };
  std::vector<std::uint32_t> nodes;
  std::vector<Eigen::Vector3d> factors;  ///< one per node, 1 / length
  Kind kind = Kind::Full;
};

/// Which nodes share an edge, and which tets share a node, over the tets that are not flat. Where duplicate tets branch
/// off, neighbours with the same position in several branches contribute nothing to a node's gradient, and are skipped.
class CageNeighbours {
 public:
  /// latticeTets  by tet: a number that duplicates share, see Cage; empty: there are none
  explicit CageNeighbours(const TetMesh& cage, const std::vector<int>& latticeTets = {});

  /// The stencil of one node, which must belong to a tet that is not flat. Cost: some fits with 9 unknowns.
  GradientStencil stencilOf(std::uint32_t node);

 private:
  void addRing(std::size_t from);
  void skipDuplicates(std::size_t from);
  std::vector<std::uint32_t> nearNeighbours() const;
  std::vector<Eigen::Vector3d> offsetsOf(const std::vector<std::uint32_t>& neighbours) const;
  GradientStencil plainStencil(std::uint32_t node) const;

  const TetMesh& cage_;
  Lists<> edges_;                        ///< by node: the nodes at the other ends of its edges
  Lists<> tets_;                         ///< by node: its tets
  std::vector<int> indexOf_;             ///< by node: a number that duplicates share; empty: there are none
  std::vector<std::uint32_t> found_;     ///< the node, followed by its rings
  std::vector<std::uint32_t> foundFor_;  ///< by node: the last node whose neighbours included it, plus 1
};

}  // namespace tetskin
