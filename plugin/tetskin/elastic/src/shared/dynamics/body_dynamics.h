// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// One body's implicit step. From positions x and velocities v, which already have what gravity and others give them:
//   v0, x0 = x + dt v0: as the body would move if it were rigid, see part_motion.h
//   (M + alpha K) y = dt f(x0) + M (v - v0),   alpha = dt (damping + dt)
//   v <- v0 + y,   x <- x + dt v
// with f the corotated forces and K their stiffness at the rotations of x0: a backward Euler step, of first order,
// which keeps linear and angular momentum. Only what deviates from rigid motion is solved for. A step that solves for
// all of the velocity takes turning by an angle of phi for a strain of phi^2 / 2, and for more where K is of older
// rotations: stiff bodies explode by it.
//
// This work is based on:
//   David Baraff, Andrew Witkin, "Large Steps in Cloth Simulation", SIGGRAPH 1998, doi 10.1145/280814.280821
#pragma once

#include <tetskin/elastic/src/dynamics/conjugate_gradient.h>
#include <tetskin/elastic/src/dynamics/part_motion.h>
#include <tetskin/elastic/src/tets/corotated_tets.h>

#include <array>
#include <functional>
#include <optional>

namespace tetskin::elastic_detail {

template <class S>
class TETSKIN_ELASTIC_API BodyDynamics {
 public:
  static constexpr std::size_t kRigidMotions = 6;

  /// rest  may be empty: a body without elasticity, of masses alone
  BodyDynamics(RestTets rest, std::size_t nodes);

  BlockMatrix<S>& matrix() { return matrix_; }
  const BlockMatrix<S>& matrix() const { return matrix_; }
  std::size_t nodeCount() const { return matrix_.nodeCount(); }

  /// From the next `prepare` on. By tet; `damping` in seconds.
  void setMaterial(const std::vector<Lame>& lame);
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

  /// The beginning of a step: the rigid motion, forces at the points as it moves them, the matrix if it has to change.
  /// `velocity` is that of the rigid motion from here on.
  void predict(double seconds, ParallelFor* threads);
  /// After `predict`: the right side of the step, which is of the matrix's residual and of `startAgain`, too. The
  /// solution, a velocity beside the rigid motion's, has its start: of a soft body what it was, of a stiff one 0.
  void start(double seconds, ParallelFor* threads);
  /// The same without the residual: `startAgain` follows.
  void startLater(double seconds);
  /// The square of the error in the solution, in the norm of the masses, that matters no more than a relative one in
  /// the residual: above 0 for stiff bodies, whose residual begins at what rounding leaves.
  double squaredDeviation() const { return squaredDeviation_; }
  /// Of the last `predict`.
  bool isStiff() const { return stiff_; }
  /// dt (dt + damping) times the sum of V (2 mu + lambda) over the least inertia, of the last `predict`: how much
  /// faster deformations are taken back than a step lasts.
  double stiffnessNumber() const { return stiffnessNumber_; }
  /// The square of the solution's norm, by masses.
  double squaredSolution() const;
  /// The solution if no force acted, wide: what the velocities that the step began with, all else that acts included,
  /// are beside the rigid motion.
  const S* deviation() const { return began_.data(); }
  /// The same of how the solution differs from the velocities that the step began with, all else that acts included.
  double squaredChange() const;
  /// The square of the solution's norm by the matrix, as `startAgain` has found it.
  double squaredByMatrix() const;
  /// Velocities that hardly change a position, by its last digits.
  double roundingSpeed(double seconds) const;
  /// By how much a unit impulse on the part of this node changes the velocity of a point there, both in a direction,
  /// as far as the part moves as one. World space, of the last `predict`.
  double rigidCompliance(std::size_t node, const std::array<double, 3>& point,
                         const std::array<double, 3>& direction) const;
  void rightSide(std::size_t node, S out[3]) const;
  /// residual = right side - A solution, of the solution as it is. Add what else acts to the residual.
  void startAgain(ParallelFor* threads);

  double alpha() const { return alpha_; }
  /// A times points, 4 scalars a slot; wide, and overwritten by the next call of anything here. `scratchPoints` may be
  /// filled for it.
  const S* times(const S* points, ParallelFor* threads = nullptr);
  S* scratchPoints() { return relative_.data(); }
  double energy(ParallelFor* threads);

  /// The rigid motions of a part as its forces are taken at: kRigidMotions velocities, 4 scalars a slot. False, and
  /// nothing written, where something of the part is held, or it has no mass.
  bool rigidMotions(std::size_t part, AlignedVector<S> (&motions)[kRigidMotions]) const;
  std::size_t partCount() const { return motions_.size(); }
  /// The solution becomes the rigid motion that has its momentum, of each part as far as it is not held.
  void keepRigidPart();
  /// The solution loses the linear and the angular momentum that internal forces cannot give, but a solve that is cut
  /// short does: see `PartMotion::excess`.
  /// impulse  of a node, by what else has acted on it in the step; none: nothing has
  void removeMomentum(const std::function<std::array<double, 3>(std::size_t node)>& impulse = {});
  /// Where something else than elasticity has turned a part in this step, the solution has that turn as the chord of a
  /// rotation: a stiff body would be stretched by a straight one. Nothing changes for soft bodies, which hardly feel
  /// it.
  void bendTurns(double seconds);
  bool anyHeld() const { return held_ > 0; }

  std::optional<CorotatedTets<S>>& tets() { return tets_; }

 private:
  double alphaFor(double seconds) const;
  void findParts(const std::vector<Tet>& tets);
  void findMotions(double seconds);
  void moveRigidly(double seconds);
  void assembleIfNeeded(double seconds, double turnShare, ParallelFor* threads);
  double allowedTurn() const;
  std::vector<PartMomentum> momentaNow() const;

  BlockMatrix<S> matrix_;
  std::optional<CorotatedTets<S>> tets_;
  AlignedVector<S> points_, moved_, velocities_, relative_, forces_;  ///< by slot; moved_: x0, less where its part is
  AlignedVector<S> rightSide_, image_;                                ///< wide
  AlignedVector<S> began_;                                            ///< wide: the solution if no force acted
  double damping_ = 0.0, alpha_ = 0.0;
  bool stiff_ = false;
  double stiffnessNumber_ = 0.0;
  bool changed_ = true;                ///< masses or material, since the last assembly
  std::size_t held_;                   ///< nodes
  std::vector<std::uint32_t> partOf_;  ///< by slot: which of the parts that share no node
  std::vector<PartMotion> motions_;    ///< by part, of the last `predict`
  std::vector<double> stiffness_;      ///< by part: sum of V (2 mu + lambda) over its tets
  double stiffnessOverInertia_ =
      0.0;  ///< of the part where it is most: with dt^2, how much turning is taken for strain
  double squaredDeviation_ = 0.0;
};

}  // namespace tetskin::elastic_detail
