// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// One body's implicit step. From positions x and velocities v, which already have what gravity and others give them:
//   (M + alpha K) dv = dt f(x) - alpha K v,   alpha = dt (damping + dt),   v <- v + dv,   x <- x + dt v
// with f the corotated forces and K their stiffness at the rotations of x: a backward Euler step, of first order, which
// keeps linear and angular momentum.
//
// This work is based on:
//   David Baraff, Andrew Witkin, "Large Steps in Cloth Simulation", SIGGRAPH 1998, doi 10.1145/280814.280821
#pragma once

#include <tetskin/elastic/src/dynamics/conjugate_gradient.h>
#include <tetskin/elastic/src/tets/corotated_tets.h>

#include <optional>

namespace tetskin::elastic_detail {

template <class S>
class TETSKIN_ELASTIC_API BodyDynamics {
 public:
  /// rest  may be empty: a body without elasticity, of masses alone
  BodyDynamics(RestTets rest, std::size_t nodes);

  BlockMatrix<S>& matrix() { return matrix_; }
  const BlockMatrix<S>& matrix() const { return matrix_; }
  std::size_t nodeCount() const { return matrix_.nodeCount(); }

  /// From the next `prepare` on. By tet; `damping` in seconds.
  void setMaterial(const std::vector<LameOfTet>& lame);
  void setDamping(double damping) { damping_ = damping; }
  /// 0: held.
  void setMass(std::size_t node, S mass);

  /// A node's state, 4 scalars each, for the caller to fill before `prepare`.
  S* point(std::size_t node) { return &points_[4 * matrix_.slotOf(node)]; }
  S* velocity(std::size_t node) { return &velocities_[4 * matrix_.slotOf(node)]; }
  /// Elastic force on a node, of the last `prepare`.
  const S* force(std::size_t node) const { return &forces_[4 * matrix_.slotOf(node)]; }

  /// Forces alone.
  void prepareForces(ParallelFor* threads);
  /// Forces, and the matrix if it has to change.
  void prepare(double seconds, ParallelFor* threads);
  /// The right side of the step: of the matrix's residual, and of `startAgain`. The solution is 0.
  void start(double seconds, ParallelFor* threads);
  void rightSide(std::size_t node, S out[3]) const;
  /// residual = right side - A solution, of the solution as it is. Add what else acts to the residual.
  void startAgain(ParallelFor* threads);

  double alpha() const { return alpha_; }
  /// A times points, 4 scalars a slot; wide, and overwritten by the next call of anything here. `scratchPoints` may be
  /// filled for it.
  const S* times(const S* points, ParallelFor* threads = nullptr);
  S* scratchPoints() { return relative_.data(); }
  double energy(ParallelFor* threads);

  /// The solution becomes free of the linear and the angular momentum that internal forces cannot give, but a solve
  /// that is cut short does: of each part that shares no node with others; held at a node, of momentum about the node,
  /// held along a line, about the line.
  void removeMomentum();
  bool anyHeld() const { return held_ > 0; }

  std::optional<CorotatedTets<S>>& tets() { return tets_; }

 private:
  double alphaFor(double seconds) const;
  void findParts(const std::vector<Tet>& tets);

  BlockMatrix<S> matrix_;
  std::optional<CorotatedTets<S>> tets_;
  AlignedVector<S> points_, velocities_, relative_, forces_;  ///< by slot
  AlignedVector<S> rightSide_, image_;                        ///< wide
  double damping_ = 0.0, alpha_ = 0.0;
  bool changed_ = true;                ///< masses or material, since the last assembly
  std::size_t held_;                   ///< nodes
  std::vector<std::uint32_t> partOf_;  ///< by slot: which of the parts that share no node
  std::uint32_t parts_ = 0;
};

}  // namespace tetskin::elastic_detail
