// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The conjugate gradient for one body on two levels: sweeps over its nodes, and the motions of groups of them. For
// slender and thin bodies, for which ConjugateGradient does not converge in time. Products are computed from strains,
// in double precision, and take several times as long.
//
// This work is based on:
//   J. M. Tang, R. Nabben, C. Vuik, Y. A. Erlangga, "Comparison of Two-Level Preconditioners Derived from Deflation,
//     Domain Decomposition and Multigrid Methods", J. Sci. Comput. 39, 2009, doi 10.1007/s10915-009-9272-6 (A-DEF2)
#pragma once

#include <tetskin/elastic/src/dynamics/group_motions.h>
#include <tetskin/elastic/src/matrix/block_matrix.h>

namespace tetskin::elastic_detail {

template <class S>
class TwoLevelGradient {
 public:
  TwoLevelGradient(const RestTets& rest, const BlockMatrix<S>& matrix);

  /// Continues from the matrix's solution, and leaves its residual there. Returns the number of iterations.
  /// matrix     as assembled from the source
  /// rightSide  in the wide layout
  /// points     positions, 3 scalars per slot
  /// target     squared norm of the residual, in the preconditioner's norm, at which it ends
  int solve(BlockMatrix<S>& matrix, const MatrixSource<S>& source, const S* rightSide,
            const std::vector<double>& points, double target, int maximum, ParallelFor* threads);

 private:
  using Vector = std::vector<double>;  ///< 3 scalars per slot

  void multiply(const Vector& velocities, Vector& impulses) const;
  double precondition(BlockMatrix<S>& matrix, ParallelFor* threads);
  void findResidual();
  bool advance(double& before);

  TetStiffness stiffness_;
  GroupMotions groups_;
  std::vector<double> masses_;  ///< by slot
  std::vector<std::uint32_t> outerSlots_;
  std::vector<double> outer_;  ///< see BlockMatrix::setOuter
  Vector right_, solution_, residual_, image_, step_, direction_;
  AlignedVector<S> impulses_, velocities_;  ///< in the wide layout
};

}  // namespace tetskin::elastic_detail
