// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// One body's implicit step. It begins with positions x and velocities v that include gravity and other impulses:
//   v0, x0 = x + dt v0: as the body would move if it were rigid, see component_motion.h
//   (M + alpha K) y = dt f(x0) + M (v - v0) + ...   with alpha and what follows by time_scheme.h
//   v <- v0 + y,   x <- x + dt v
// with f the corotated forces and K their stiffness at the rotations of x0, which keeps linear and angular momentum.
// Velocities belong to the middle of a step, positions to its end. Only the deviation from rigid motion is solved for.
// A step that solves for the whole velocity takes a rotation by an angle of phi for a strain of phi^2 / 2, and for more
// if K has older rotations, which makes stiff bodies explode.
//
// This work is based on:
//   David Baraff, Andrew Witkin, "Large Steps in Cloth Simulation", SIGGRAPH 1998, doi 10.1145/280814.280821
#pragma once

#include <tetskin/elastic/src/dynamics/component_motion.h>
#include <tetskin/elastic/src/dynamics/conjugate_gradient.h>
#include <tetskin/elastic/src/dynamics/impulse_history.h>
#include <tetskin/elastic/src/dynamics/initial_guess.h>
#include <tetskin/elastic/src/dynamics/node_places.h>
#include <tetskin/elastic/src/dynamics/two_level_gradient.h>
#include <tetskin/elastic/src/tets/corotated_tets.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>

namespace tetskin::elastic_detail {

/// A point of a body where something resists a change of its velocity.
template <class S>
struct HeldPoint {
  const int* nodes = nullptr;
  const S* weights = nullptr;
  std::size_t nodeCount = 0;
  std::array<double, 9> stiffness{};  ///< symmetric: impulse on the body per change of velocity, opposite to it
  std::array<double, 3> change{};     ///< result: change of the point's velocity
};

template <class S>
class TETSKIN_ELASTIC_API BodyDynamics {
 public:
  /// Three translations and three rotations.
  static constexpr std::size_t kRigidMotions = 6, kTranslations = 3;

  /// rest  may be empty: a body without elasticity, which has masses only
  BodyDynamics(RestTets rest, std::size_t nodes);
  BodyDynamics(BodyDynamics&&) noexcept = default;  // parts of it refer to others

  BlockMatrix<S>& matrix() { return matrix_; }
  const BlockMatrix<S>& matrix() const { return matrix_; }
  std::size_t nodeCount() const { return matrix_.nodeCount(); }

  /// Takes effect at the next `predict`.
  void setMaterial(const Lame& lame);
  /// damping  seconds
  void setDamping(double damping);
  /// Whether each step has the same bits on every processor; see `elasticInUse`.
  void setDeterministic(bool on);
  /// pressed  something outside may hold the body flat: its flat tets are then damped, so that they come to rest
  void setPressed(bool pressed) { pressed_ = pressed; }
  /// Whether the body had contacts in the step before. It then takes some of backward Euler's steps: see time_scheme.h.
  void setTouched(bool touched);
  /// Call it after `start` or `startLater` where the body turns out to have contacts in this step, which becomes one of
  /// a touched body. `restart` must follow before `solve`.
  void beTouched(double seconds, ParallelFor* threads);
  /// The first step is half a step of velocities, as they are known at its beginning and belong to its middle from then
  /// on; each takes half of the lengths of the step before and of its own. Otherwise each takes its own length, as
  /// Bullet's rigid bodies do: a body of the same velocity then stays beside them.
  void setStaggered(bool staggered) { staggered_ = staggered; }
  /// True if each component has a pinned node.
  bool isHeld() const;
  /// The length of the last step; 0: there was none.
  double lastSeconds() const { return lastSeconds_; }
  void setLastSeconds(double seconds) { lastSeconds_ = seconds; }
  /// Share of a step's length for which forces act in it: 1, except of staggered velocities.
  double forceShare(double seconds) const;
  /// mass  0: the node is pinned
  void setMass(std::size_t node, S mass);

  /// A node's state, 4 scalars each, which the caller fills before `predict`. Where the point is what `advance` has
  /// returned, the node's own position has more digits.
  S* point(std::size_t node) { return &points_[4 * matrix_.slotOf(node)]; }
  S* velocity(std::size_t node) { return &velocities_[4 * matrix_.slotOf(node)]; }
  /// The elastic force on a node, of the last `probeForces` or `predict`.
  const S* force(std::size_t node) const { return &forces_[4 * matrix_.slotOf(node)]; }

  /// A node's position, 4 scalars, for `probeForces` and `probeEnergy`: they leave the state as it is, and the
  /// positions undefined. The caller fills all of them between steps.
  S* probe(std::size_t node) { return &moved_[4 * matrix_.slotOf(node)]; }
  void probeForces(ParallelFor* threads);
  double probeEnergy(ParallelFor* threads);

  /// Moves a node by a velocity at the end of a step, and returns its point.
  const S* advance(std::size_t node, double seconds, const S* by) {
    const std::size_t slot = matrix_.slotOf(node);
    places_.advance(slot, seconds, by);
    places_.round(slot, &points_[4 * slot]);
    return &points_[4 * slot];
  }

  /// Takes the body and all that it remembers along a rigid motion, a rotation about the origin and a translation: the
  /// next step goes on from the last one there. Points and velocities are the caller's: see `rounded`.
  /// turn  a matrix by rows;  turns  false: it is that of no rotation
  void carry(bool turns, const std::array<double, 9>& turn, const std::array<double, 3>& by);
  /// True if this is the node's position, rounded.
  bool isAt(std::size_t node, const S* point) const;
  /// The node's position, rounded: 3 scalars.
  void rounded(std::size_t node, S* point) const { places_.round(matrix_.slotOf(node), point); }

  /// The node's position minus its point.
  void remainder(std::size_t node, S* out) const {
    const std::size_t slot = matrix_.slotOf(node);
    const double* x = places_.at(slot);
    for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<S>(x[k] - static_cast<double>(points_[4 * slot + k]));
  }

  /// True if the node is where the last step has brought it, and as fast, except for invisible differences.
  bool continues(std::size_t node, const S* point, const S* velocity) const;
  /// True if the last step is remembered for the next one.
  bool remembers() const { return history_.isKnown(); }
  /// Call it before `predict` where the body has not come here by its last step.
  void forget() { history_.forget(); }
  /// Call it when nothing but `solve` has changed the solution, for the next step to be of second order.
  void remember(double seconds);
  /// The same if other forces and joints have changed the solution, too. A touched body remembers nothing.
  void rememberAmongOthers(double seconds, ParallelFor* threads);
  /// True if the last `predict` has begun a step of second order.
  bool isSecondOrder() const { return secondOrder_; }

  /// The beginning of a step: computes the rigid motion, the forces at the points that it reaches, and the matrix if it
  /// must change. From here on, `velocity` is that of the rigid motion.
  void predict(double seconds, ParallelFor* threads);
  /// Call it after `predict`: computes the right side of the step, which the matrix's residual and `restart` use.
  /// The solution is a velocity relative to the rigid motion; it begins with its last value for a soft body, and with 0
  /// for a stiff one.
  void start(ParallelFor* threads);
  /// Like `start`, but without the residual: `restart` must follow before `solve`.
  void startLater();
  /// Call it after `start` or `restart`: solves for the body alone, in at most `iterations` rounds. What acts are the
  /// elastic impulses, and what has changed velocities since the last step: at rest, both are those of the weight.
  /// Where the conjugate gradient does not come to an end, it is solved in two levels, for some steps from then on.
  /// Returns the number of iterations.
  /// limits  `acting` is replaced
  int solve(ConjugateGradient<S>& gradient, SolveLimits limits, int maximum, ParallelFor* threads);
  /// The square of the norm of what acts, see SolveLimits, of the last `start`.
  double squaredActing(ParallelFor* threads);
  /// The square of the norm of impulses that change all velocities by this speed.
  double squaredImpulses(double speed) const { return speed * speed * unitImpulses_; }
  /// True if the body counted as stiff in the last `predict`.
  bool isStiff() const { return stiff_; }
  /// The stiffness factor of the last `predict`: dt (dt + damping) times the sum of V (2 mu + lambda) over the least
  /// inertia. It is the squared ratio of a step to the time in which a deformation recedes.
  double stiffnessNumber() const { return stiffnessNumber_; }
  /// The square of the solution's norm with respect to the masses.
  double squaredSolution() const;
  /// The solution without elastic forces, in the wide layout: the velocities at the beginning of the step, including
  /// everything else that acts, relative to the rigid motion.
  const S* deviation() const { return began_.data(); }
  /// The square of the norm, with respect to the masses, of the solution's difference to the velocities at the
  /// beginning of the step, everything else that acts included.
  double squaredChange() const;
  /// The square of the solution's norm with respect to the matrix, as `restart` has computed it.
  double squaredByMatrix() const;
  /// A speed that hardly changes a displacement within the step, because of rounding.
  double roundingSpeed(double seconds) const;
  /// The change of velocity per unit impulse, both at a point and in a direction, if the node's component moves as a
  /// rigid body. World space, of the last `predict`.
  double rigidCompliance(std::size_t node, const std::array<double, 3>& point,
                         const std::array<double, 3>& direction) const;
  void rightSide(std::size_t node, S out[3]) const;
  /// Computes residual = right side - A solution for the current solution. The caller adds other forces to the
  /// residual.
  void restart(ParallelFor* threads);

  double alpha() const { return alpha_; }
  /// What alpha would be over what it is, if the last step had this length, by backward Euler's scheme.
  double alphaRatio(double seconds) const {
    const double now = lastSeconds_ * (lastSeconds_ + damping_);
    return now > 0.0 ? seconds * (seconds + damping_) / now : 1.0;
  }
  /// The rigid motions of a component at the positions at which its forces are computed: kRigidMotions velocities, 4
  /// scalars per slot. Writes those of the component's nodes alone: several components may share the vectors, which are
  /// empty before the first. Returns false, and writes nothing, if some node of it is pinned, or it has no mass.
  bool rigidMotions(std::size_t component, AlignedVector<S> (&motions)[kRigidMotions]) const;
  std::size_t componentOf(std::size_t node) const { return partOf_[matrix_.slotOf(node)]; }
  std::size_t componentCount() const { return motions_.size(); }
  /// Replaces the solution, for each component, by the rigid motion with its momentum, as far as pinned nodes permit
  /// it.
  void projectToRigidMotion();
  /// Removes from the solution the linear and the angular momentum that internal forces cannot cause, but a solve that
  /// is cut short does: see `ComponentMotion::excess`.
  /// impulse  by node, of everything else that has acted on it in the step; empty: nothing has
  /// torques  by component, beside those of these impulses at the nodes; empty: none
  /// held     points where contacts resist the change; the caller changes their impulses accordingly
  void removeMomentum(const std::function<std::array<double, 3>(std::size_t node)>& impulse = {},
                      const std::vector<std::array<double, 3>>& torques = {},
                      std::vector<HeldPoint<S>>* held = nullptr);
  /// Where something other than elasticity has rotated a component in this step, the solution gets that rotation as a
  /// chord: a straight motion would stretch a stiff body. Nothing changes for soft bodies, for which the effect is
  /// negligible.
  void bendTurns(double seconds);

  std::optional<CorotatedTets<S>>& tets() { return tets_; }

  /// Writes or reads what it remembers between steps. The material, and the masses of the nodes, must be those of the
  /// snapshot when it is read. The matrix is assembled only if it is not the same.
  /// outdated   while saving: the masses of the nodes are no longer those of the matrix
  /// continues  while saving: true for all nodes, see `continues`
  /// Returns    true if the last step is remembered
  bool visitState(StateStream& stream, bool outdated, bool continues);
  /// The velocity to which the last step has brought a node; call the second function for each node after reading.
  void reached(std::size_t node, S* velocity) const;
  void arrive(std::size_t node, const S* velocity);

 private:
  /// How far a step is: calls in another order would use what the step before has left.
  enum class Stage { Before, Predicted, Started, Solvable };

  bool mayRemember() const { return tets_ && !stiff_ && untouched_ >= kUntouched; }
  void keep(const AlignedVector<S>& impulses, double seconds);
  void beginForces(double seconds);
  void chooseScheme(double seconds);
  static std::vector<std::uint32_t> components(const RestTets& rest, const BlockMatrix<S>& matrix);
  void findMotions(double seconds);
  void moveRigidly(double seconds);
  void assembleIfNeeded(double seconds, double turnFraction, ParallelFor* threads);
  int solveInTwoLevels(ConjugateGradient<S>& gradient, SolveLimits limits, ParallelFor* threads);
  void findUnitImpulses(ParallelFor* threads);
  double allowedTurn() const;
  std::vector<ComponentMomentum> momentaNow(bool withRigid = true) const;
  template <class Change>
  void changeSolution(const std::vector<RigidVelocity>& velocities, Change&& change);
  void findResidual(ParallelFor* threads);
  Eigen::Vector3d placeOf(const HeldPoint<S>& point) const;

  BlockMatrix<S> matrix_;
  std::optional<CorotatedTets<S>> tets_;
  AlignedVector<S> points_, moved_, velocities_, relative_,
      forces_;                          ///< by slot; moved_: displacements of x0, see NodePlaces
  AlignedVector<S> rightSide_, image_;  ///< in the wide layout
  AlignedVector<S> began_;              ///< in the wide layout: the solution without elastic forces
  AlignedVector<S> acting_;             ///< in the wide layout: impulses, see `solve`
  double unitImpulses_ = 0.0;           ///< `squaredImpulses` of 1, by the matrix without rows
  double damping_ = 0.0;
  double alpha_ = 0.0;  ///< of the last assembly
  bool stiff_ = false, pressed_ = false, staggered_ = false, secondOrder_ = false, deterministic_ = false;
  bool remembered_ = false;      ///< the last step
  Stage stage_ = Stage::Before;  ///< Started: the residual is missing
  /// Steps after which a body that was touched counts as free: its matrix is made anew then, which is not to happen
  /// each time that it bounces.
  static constexpr int kUntouched = 8;
  int untouched_ = kUntouched;  ///< number of steps since it was last touched
  TimeScheme scheme_;           ///< of the last `predict`
  double lastSeconds_ = 0.0;    ///< length of the last step; 0: there was none
  double forceSeconds_ = 0.0;   ///< for which forces act in this step
  ImpulseHistory<S> history_;
  S length_ = S(0), near_ = S(0);  ///< of the last step that is remembered: see `continues`
  double stiffnessNumber_ = 0.0;
  bool changed_ = true;                   ///< masses or material have changed since the last assembly
  std::size_t pinned_;                    ///< number of pinned nodes
  std::vector<std::uint32_t> partOf_;     ///< by slot: number of its component
  std::vector<ComponentMotion> motions_;  ///< by component, of the last `predict`
  NodePlaces<S> places_;
  std::vector<double> stiffness_;      ///< by component: sum of V (2 mu + lambda) over its tets, linear and quadratic
  double stiffnessOverInertia_ = 0.0;  ///< times dt^2: how much rotation is taken for strain; the largest
  InitialGuess<S> guess_;
  int twoLevelSolves_ = 0;  ///< number of solves in two levels until the conjugate gradient is tried alone again
  std::unique_ptr<TwoLevelGradient<S>> twoLevelSolve_;  ///< null until it is used
};

}  // namespace tetskin::elastic_detail
