// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The solve of a body that nothing touches: by the conjugate gradient, from a guess; where that does not come to an
// end, in two levels, for some steps from then on.
#pragma once

#include <tetskin/elastic/src/dynamics/conjugate_gradient.h>
#include <tetskin/elastic/src/dynamics/initial_guess.h>
#include <tetskin/elastic/src/dynamics/node_places.h>
#include <tetskin/elastic/src/dynamics/two_level_gradient.h>
#include <tetskin/elastic/src/tets/corotated_tets.h>

#include <array>
#include <memory>
#include <vector>

namespace tetskin::elastic_detail {

/// A y = b of one body.
template <class S>
struct LoneSystem {
  BlockMatrix<S>& matrix;  ///< as it was assembled; with the solution to begin with, and its residual
  CorotatedTets<S>& tets;
  const NodePlaces<S>& places;
  const AlignedVector<S>& rightSide;  ///< in the wide layout
  double alpha = 0.0, spread = 1.0;   ///< of the assembly
};

template <class S>
class LoneSolve {
 public:
  /// The matrix has the last step's solution, which is kept for the guess of this one.
  void beginStep(const BlockMatrix<S>& matrix);
  /// limits   with `acting`
  /// maximum  bound of the iterations; 0: the caller goes on
  /// Returns the number of iterations.
  int solve(const LoneSystem<S>& system, ConjugateGradient<S>& gradient, SolveLimits limits, int maximum,
            ParallelFor* threads);

  /// Takes what is known of former steps along a rotation, stored by rows.
  /// partOf  by slot
  void turn(const std::array<double, 9>& turn, const std::vector<std::uint32_t>& partOf);
  /// Writes or reads what is known beside the matrix's solution.
  void serialize(StateStream& stream, BlockMatrix<S>& matrix);

 private:
  int solveInTwoLevels(const LoneSystem<S>& system, ConjugateGradient<S>& gradient, SolveLimits limits,
                       ParallelFor* threads);

  InitialGuess<S> guess_;
  int twoLevelSolves_ = 0;  ///< number of solves in two levels until the conjugate gradient is tried alone again
  std::unique_ptr<TwoLevelGradient<S>> twoLevels_;  ///< null until it is used
};

}  // namespace tetskin::elastic_detail
