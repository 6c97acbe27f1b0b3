// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Tets that are damped more than others of their body. The scheme's damping is the least of a body, d0; what tets have
// beside it is a part of the matrix,
//   A = M + alpha K + dt D,   D = sum of (d - d0) K over the tets
// which acts on new velocities alone: neither a history of impulses nor what a step carries on contains it.
#pragma once

#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <vector>

namespace tetskin::elastic_detail {

/// The damping of a body's tets, seconds.
struct DampingParts {
  double least = 0.0, mean = 0.0;
  std::vector<double> more;  ///< beside the least, by tet of the cage; empty: all have the same
};

/// factors  of `damping` by tet of the cage, 0 or more; empty: 1
DampingParts dampingParts(double damping, const std::vector<double>& factors);

template <class S>
class ExtraDamping {
 public:
  ExtraDamping(const RestTets& rest, std::size_t nodes) : matrix_(nodes, rest) {}

  /// Cost O(T)
  /// corners  of the matrix's assembly;  ratio, spread  see BlockMatrix::assemble
  /// shares   by tet, linear ones first: the share that D has of its part of A - M
  void take(const RestTets& rest, const S* corners, S ratio, S spread, const std::vector<double>& shares,
            ParallelFor* threads);
  void setDeterministic(bool on) { matrix_.setDeterministic(on); }
  /// Takes dt D times velocities from impulses; both in the wide layout. Cost that of a product with the matrix
  void takeFrom(AlignedVector<S>& impulses, const S* velocities, ParallelFor* threads);

 private:
  BlockMatrix<S> matrix_;               ///< dt D: all masses are 0
  AlignedVector<S> corners_;            ///< see RestTets
  AlignedVector<S> points_, products_;  ///< by slot; in the wide layout
};

}  // namespace tetskin::elastic_detail
