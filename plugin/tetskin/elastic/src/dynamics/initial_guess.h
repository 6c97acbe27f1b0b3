// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Where a body's solve starts. The velocities before a step, with gravity, are far from its solution: in a body that is
// held, elastic forces cancel gravity, for which the conjugate gradient needs as many iterations as there are nodes
// between the free end and the support. The solutions of the last steps contain that answer.
//
// This work is based on:
//   Paul F. Fischer, "Projection Techniques for Iterative Solution of Ax = b with Successive Right-Hand Sides", Comput.
//   Methods Appl. Mech. Engrg. 163, 1998, doi 10.1016/S0045-7825(98)00012-7
#pragma once

#include <tetskin/core/src/base/state/state_stream.h>
#include <tetskin/elastic/src/dynamics/conjugate_gradient.h>

#include <array>

namespace tetskin::elastic_detail {

/// Adds to the start x0 of a solve the combination of directions that leaves the smallest error in the norm of A:
///   x = x0 + sum_k c_k d_k,   sum_k (d_i . A d_k) c_k = d_i . (b - A x0)
/// The directions are the last solution, its difference from x0, and its change in the step before, so that a body at
/// rest starts from its solution, and one that moves smoothly from an extrapolated one. Any history is safe: x0 is
/// among the combinations.
template <class S>
class InitialGuess {
 public:
  /// Keeps the solution of a step, in the wide layout, for the next two. Cost O(nodes)
  void remember(const BlockMatrix<S>& matrix);
  /// Replaces the matrix's solution x0, and its residual b - A x0. Pinned nodes keep x0. The solve must then reduce the
  /// remaining residual, in addition to the tolerance: otherwise an error that is small compared with the impulses of a
  /// step, such as the last of a body's sag, would never be removed. Does nothing if it is not used, or has no solution
  /// yet. Cost: three products, about as much as two iterations
  void improve(BlockMatrix<S>& matrix, SolveLimits& limits, ParallelFor* threads);

  /// Whether it is worth its cost, judged by the last solves.
  bool isUsed() const { return used_; }
  /// Call it after each solve.
  /// squared     squared norm of the residual at the start of the solve;  acting  of what acts, see SolveLimits
  /// iterations  that the solve took
  void learn(double squared, double acting, int iterations);

  /// The stored solutions, in the wide layout.
  std::array<AlignedVector<S>*, 2> known() { return {known_ > 0 ? &last_ : nullptr, known_ > 1 ? &before_ : nullptr}; }

  /// Writes or reads the state beside the matrix's solution, which is to be remembered.
  void serialize(StateStream& stream, BlockMatrix<S>& matrix);

 private:
  /// The ones named above.
  static constexpr std::size_t kDirections = 3;
  using Wide = AlignedVector<S>;
  using Factors = std::array<double, kDirections>;

  void addDirection(BlockMatrix<S>& matrix, const Wide& first, const S* second, ParallelFor* threads);
  Factors bestFactors(BlockMatrix<S>& matrix, ParallelFor* threads) const;

  Wide last_, before_;     ///< solutions of the last step, and of the one before it
  std::size_t known_ = 0;  ///< how many of these
  Wide start_;             ///< x0
  std::array<Wide, kDirections> directions_, images_;
  std::size_t count_ = 0;  ///< of directions
  bool used_ = false;
  bool improved_ = false;  ///< in this step
  int useless_ = 0;        ///< consecutive useless guesses
  int pause_ = 0;          ///< solves for which it is still not used
};

}  // namespace tetskin::elastic_detail
