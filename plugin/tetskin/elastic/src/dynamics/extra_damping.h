// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Tets that are damped more than others of their body. The scheme's damping is the least of a body, d0; what tets have
// beside it is a part of the matrix,
//   A = M + alpha K + dt D,   D = sum of (d - d0) K over the tets
// which acts on new velocities alone: neither a history of impulses nor what a step carries on contains it.
#pragma once

#include <tetskin/elastic/src/matrix/block_matrix.h>
#include <tetskin/elastic/src/matrix/tet_stiffness.h>

#include <vector>

namespace tetskin::elastic_detail {

template <class S>
class ExtraDamping {
 public:
  ExtraDamping(const RestTets& rest, const BlockMatrix<S>& matrix);

  /// Cost O(T)
  /// source  of the matrix's assembly
  /// shares  by tet, linear ones first: the share that D has of its part of A - M
  void take(const MatrixSource<S>& source, const std::vector<double>& shares) { stiffness_.take(source, shares); }
  /// Takes dt D times velocities from impulses; both in the wide layout. Cost O(T)
  void takeFrom(AlignedVector<S>& impulses, const S* velocities);

 private:
  TetStiffness stiffness_;
  std::vector<double> velocities_, impulses_;  ///< 3 scalars per slot
};

}  // namespace tetskin::elastic_detail
