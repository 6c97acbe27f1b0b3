// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/skinning/moved_parts.h>

#include <algorithm>

namespace tetskin {

template <class Scalar>
MovedParts<Scalar>::MovedParts(const Embedding& embedding, const QuadraticStencils<Scalar>* stencils)
    : last_(embedding.nodeCount()),
      nodes_(embedding.nodeCount()),
      gradients_(stencils ? stencils->gradientCount() : 0),
      edges_(stencils ? stencils->edgeCount() : 0),
      runs_(embedding.runs().size() - 1) {}

template <class Scalar>
bool MovedParts<Scalar>::update(const Embedding& embedding, const QuadraticStencils<Scalar>* stencils,
                                PointView<const Scalar> nodes) {
  assert(nodes.size() == last_.size());
  std::size_t moved = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Eigen::Matrix<Scalar, 3, 1> now(nodes[i][0], nodes[i][1], nodes[i][2]);
    nodes_[i] = now != last_[i];
    moved += nodes_[i];
    last_[i] = now;
  }
  if (!known_) moved = nodes.size();
  known_ = true;
  someStill_ = moved < nodes.size();
  if (!someStill_ || moved == 0) return moved > 0;
  if (stencils) {
    findRuns(*stencils);
  } else {
    findRuns(embedding);
  }
  return true;
}

/// A point of a linear surface depends on the nodes of its tet.
template <class Scalar>
void MovedParts<Scalar>::findRuns(const Embedding& embedding) {
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const int* n = embedding.runs()[r].nodes;
    runs_[r] = nodes_[n[0]] | nodes_[n[1]] | nodes_[n[2]] | nodes_[n[3]];
  }
}

/// A point of a quadratic surface depends on the gradients at the nodes of its tet too, and those on the nodes of their
/// stencils, their own among them.
template <class Scalar>
void MovedParts<Scalar>::findRuns(const QuadraticStencils<Scalar>& stencils) {
  for (std::size_t g = 0; g < gradients_.size(); ++g) {
    const auto begin = stencils.entryNodes().begin() + stencils.starts()[g];
    const auto end = stencils.entryNodes().begin() + stencils.starts()[g + 1];
    gradients_[g] = std::any_of(begin, end, [this](std::uint32_t node) { return nodes_[node] != 0; });
  }
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const std::uint32_t* ends = &stencils.edgeGradients()[2 * e];
    edges_[e] = gradients_[ends[0]] | gradients_[ends[1]];
  }
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const std::uint32_t* edges = &stencils.runEdges()[6 * r];
    runs_[r] = std::any_of(edges, edges + 6, [this](std::uint32_t edge) { return edges_[edge] != 0; });
  }
}

template class MovedParts<float>;
template class MovedParts<double>;

}  // namespace tetskin
