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

#include <tetskin/elastic/src/dynamics/body_components.h>
#include <tetskin/elastic/src/dynamics/enclosed_pressure.h>
#include <tetskin/elastic/src/dynamics/extra_damping.h>
#include <tetskin/elastic/src/dynamics/impulse_history.h>
#include <tetskin/elastic/src/dynamics/lone_solve.h>
#include <tetskin/elastic/src/dynamics/tet_stretches.h>

#include <array>
#include <cassert>
#include <functional>
#include <memory>
#include <optional>

namespace tetskin::elastic_detail {

/// How a body comes to a step.
struct StepStart {
  double seconds = 0.0;    ///< length of the step; above 0
  bool continues = true;   ///< see BodyDynamics::continues; otherwise it forgets its last steps
  bool staggered = false;  ///< see BodyDynamics::forceShare
  /// Something outside may hold the body flat: its flat tets are then damped, so that they come to rest.
  bool pressed = false;
  /// It had contacts in the step before. This step and some more then carry on what they begin with: see time_scheme.h.
  bool touched = false;
  bool impact = false;  ///< these contacts stop it, or throw it back
};

/// What has changed the solution of a step.
enum class SolvedWith { ElasticityAlone, Others };

/// Shapes at rest that depend on how the body is deformed. Called at the beginning of each step, at the positions of
/// its forces.
struct ShapeLaw {
  /// Finds the shapes of all tets of the cage, or of `tets` alone: see CorotatedTets::setGiven and changeGiven.
  std::function<void(const TetStretches& stretches, bool ofAll, GivenShapes& given)> find;
  std::vector<int> tets;     ///< of the cage; those whose shapes change from step to step
  std::uint64_t number = 0;  ///< laws with the same number give the same shapes to all other tets
};

/// Positions of a body's nodes, and the elastic forces there: a question that leaves the body's state as it is.
template <class S>
class BodyProbe {
 public:
  explicit BodyProbe(const BlockMatrix<S>& matrix)
      : matrix_(matrix), points_(4 * matrix.slotCount(), S(0)), forces_(points_) {}

  /// A node's position, which the caller fills, and the force on it, 4 scalars each.
  S* point(std::size_t node) { return &points_[4 * matrix_.slotOf(node)]; }
  const S* force(std::size_t node) const { return &forces_[4 * matrix_.slotOf(node)]; }

 private:
  template <class T>
  friend class BodyDynamics;

  const BlockMatrix<S>& matrix_;
  AlignedVector<S> points_, forces_;  ///< by slot
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
  std::optional<CorotatedTets<S>>& tets() { return tets_; }

  // What takes effect at the next `predict`.
  void setMaterial(const Lame& lame);
  /// damping  seconds
  /// factors  of it by tet of the cage, 0 or more; empty: 1
  void setDamping(double damping, const std::vector<double>& factors = {});
  /// See CorotatedTets::setLaws.
  void setLaws(const std::vector<ElasticLaw>& laws);
  /// See FibreTets; empty: none.
  void setFibres(const std::vector<std::vector<TetFibre>>& families);
  /// What gives the tets their shapes at rest from now on; without `find`, they keep those that they have.
  void setShapeLaw(ShapeLaw law);
  /// The pressure in the body, and where it acts; null: the body has none. Its forces, stiffness and energy count as
  /// elastic ones everywhere.
  void setPressure(const PressureLaw& law, std::shared_ptr<PressureSurface> surface);
  /// The volume that a surface of the body encloses at the positions of a probe.
  double volumeIn(PressureSurface& surface, const BodyProbe<S>& probe) const;
  /// Whether each step has the same bits on every processor; see `elasticInUse`.
  void setDeterministic(bool on);
  /// mass  0: the node is pinned
  void setMass(std::size_t node, S mass);
  /// A node's state, 4 scalars each. Where the point is what `advance` has returned, the node's own position has more
  /// digits. From `predict` on, the velocity is that of the rigid motion.
  S* point(std::size_t node) { return &points_[4 * matrix_.slotOf(node)]; }
  S* velocity(std::size_t node) { return &velocities_[4 * matrix_.slotOf(node)]; }

  /// True if each component has a pinned node.
  bool isHeld() const;
  /// The length of the last step; 0: there was none.
  double lastSeconds() const { return lastSeconds_; }
  void setLastSeconds(double seconds) { lastSeconds_ = seconds; }
  /// Share of the next step's length for which forces act in it: 1, except of staggered velocities. Of these, the first
  /// step is half a step, as they are known at its beginning and belong to its middle from then on; each takes half of
  /// the lengths of the step before and of its own. Otherwise each takes its own length, as Bullet's rigid bodies do: a
  /// body of the same velocity then stays beside them.
  double forceShare(double seconds, bool staggered) const;
  /// True if the node is where the last step has brought it, and as fast, except for invisible differences.
  bool continues(std::size_t node, const S* point, const S* velocity) const;
  /// True if the last step is remembered for the next one.
  bool remembers() const { return history_.isKnown() || solved_; }

  /// Finds the rigid motions that its nodes' velocities have now: `rigidVelocity`, `rigidCompliance` and `centreOf` are
  /// those of now, and `push` may be called, until `predict`.
  void findMotion();
  /// The energy of the deformation, and of the velocities beside the rigid motions that `findMotion` has found; joules.
  double vibrationEnergy();
  /// The same at the beginning of a step, after `predict`.
  double vibrationBefore();
  /// Changes the nodes' velocities by an impulse on a component as a rigid body, as far as pinned nodes permit. World
  /// space.
  void push(std::size_t component, const std::array<double, 3>& point, const std::array<double, 3>& impulse);

  // ---- A step. `beTouched`, `findResidual`, `solve` and `remember` assert the stage that they need; the others, that
  // a first step has begun.

  /// The beginning of a step: computes the rigid motion, the forces at the points that it reaches, the matrix if it
  /// must change, and the right side. The solution is a velocity relative to the rigid motion; it begins with its last
  /// value for a soft body, and with 0 for a stiff one. What held nodes in the last step no longer does.
  void predict(const StepStart& start, ParallelFor* threads);
  /// The body turns out to have contacts in this step, which becomes one of a touched body: its right side is another
  /// one, and the residual is unknown.
  /// impact  they begin to stop it
  void beTouched(bool impact, ParallelFor* threads);
  /// Computes residual = right side - A solution for the current solution. The caller may add other forces to it. May
  /// be called again, until the step is remembered.
  void findResidual(ParallelFor* threads);
  /// Solves for the body alone, in at most `maximum` rounds; see LoneSolve. `findResidual` has been called for this
  /// solution. What acts are the elastic impulses, and what has changed velocities since the last step: at rest, both
  /// are those of the weight. Returns the number of iterations.
  /// limits  `acting` is replaced
  int solve(ConjugateGradient<S>& gradient, SolveLimits limits, int maximum, ParallelFor* threads);
  /// Keeps the solved step, for the next one to be of second order; at most once a step. A touched body keeps nothing.
  void remember(SolvedWith what, ParallelFor* threads);
  /// Moves a node by a velocity at the end of a step, and returns its point.
  const S* advance(std::size_t node, double seconds, const S* by) {
    assert(stage_ != Stage::Between);
    const std::size_t slot = matrix_.slotOf(node);
    places_.advance(slot, seconds, by);
    places_.round(slot, &points_[4 * slot]);
    return &points_[4 * slot];
  }

  // Of a step that has begun.
  /// True if it is of second order, or carries on a share of what it begins with.
  bool isSecondOrder() const { return secondOrder_ || scheme_.carried > 0.0; }
  /// True if it takes part in an impact.
  bool isImpact() const { return impact_; }
  /// True if the body counts as stiff in it.
  bool isStiff() const { return stiff_; }
  /// The stiffness factor: dt (dt + damping) times the sum of V (2 mu + lambda) over the least inertia. It is the
  /// squared ratio of a step to the time in which a deformation recedes.
  double stiffnessNumber() const { return stiffnessNumber_; }
  double alpha() const { return alpha_; }
  /// What alpha would be over what it is, if the step had this length and, in contact, carried on what it begins with.
  double alphaRatio(double seconds) const {
    const bool carriesNow = scheme_.carried > 0.0,
               carries = carriesNow || (!stiff_ && !sameLength_ && untouched_ < kUntouched);
    const double now = lastSeconds_ * ((carriesNow ? 0.5 : 1.0) * lastSeconds_ + lawDamping());
    return now > 0.0 ? seconds * ((carries ? 0.5 : 1.0) * seconds + lawDamping()) / now : 1.0;
  }
  /// The square of the norm of impulses that change all velocities by this speed.
  double squaredImpulses(double speed) const { return speed * speed * unitImpulses_; }
  /// A speed that hardly changes a displacement within the step, because of rounding.
  double roundingSpeed() const;
  /// The elastic force on a node.
  const S* force(std::size_t node) const {
    assert(stage_ != Stage::Between);
    return &forces_[4 * matrix_.slotOf(node)];
  }
  void rightSide(std::size_t node, S out[3]) const;
  /// The solution without elastic forces, in the wide layout: the velocities at the beginning of the step, including
  /// everything else that acts, relative to the rigid motion.
  const S* deviation() const {
    assert(stage_ != Stage::Between);
    return began_.data();
  }
  /// The change of velocity per unit impulse, both at a point and in a direction, if a component moves as a rigid body.
  /// World space.
  double rigidCompliance(std::size_t component, const std::array<double, 3>& point,
                         const std::array<double, 3>& direction) const;
  /// The share of its energy that material damping leaves it in an impact, that of a vibration in half a period, and
  /// that does not flow.
  /// energy  with which it comes
  double keptInImpact(std::size_t component, double energy) const;
  /// Seconds that an impact of the whole body takes, what a pressure wave takes through it and back; 0 if unknown, or
  /// if the body leaves less than this share of its energy in one. Between steps, too.
  /// radius  of gyration
  double bounceSeconds(double mass, double radius, double leastKept) const;
  /// Its centre of mass at the beginning of the step, or the centroid of its pinned nodes.
  std::array<double, 3> centreOf(std::size_t component) const;
  /// Its velocity as a rigid body of its momentum: at the beginning of the step, with what acts on it beside
  /// elasticity, or of the solution.
  RigidVelocity rigidVelocity(std::size_t component, bool solved) const;
  /// Whether the matrix contains a tension, by pressure, that resists rotations of a component as a whole: with forces
  /// from elsewhere, its rigid motion is then to be a separate unknown, which meets the masses alone.
  bool isStretched() const {
    constexpr double kFelt = 5e-3;  // share of the inertia
    return tets_ && spread_ > 1.0 &&
           alpha_ * (spread_ - 1.0) * stiffnessOverInertia_ > kFelt * (2.0 + static_cast<double>(tets_->ratio()));
  }
  std::size_t componentOf(std::size_t node) const { return components_.of(matrix_.slotOf(node)); }
  std::size_t componentCount() const { return components_.count(); }
  double componentMass(std::size_t component) const { return components_.mass(component); }
  /// The rigid motions of a component at the positions at which its forces are computed: kRigidMotions velocities, 4
  /// scalars per slot. Writes those of the component's nodes alone: several components may share the vectors, which are
  /// empty before the first. Returns false, and writes nothing, if some node of it is pinned, or it has no mass.
  bool rigidMotions(std::size_t component, AlignedVector<S> (&motions)[kRigidMotions]) const;

  // Of its current solution.
  /// The square of the norm with respect to the masses.
  double squaredSolution() const;
  /// The square of the norm, with respect to the masses, of its difference to `deviation`.
  double squaredChange() const;
  /// The square of the norm with respect to the matrix, as `findResidual` has computed it.
  double squaredByMatrix() const;
  /// Replaces it, for each component, by the rigid motion with its momentum, as far as pinned nodes permit it.
  void projectToRigidMotion();
  /// Removes the linear and the angular momentum that internal forces cannot cause, but a solve that is cut short does:
  /// see `ComponentMotion::excess`.
  /// torques  by component, beside those of the impulses at the nodes; empty: none
  /// held     points where contacts resist the change; the caller changes their impulses accordingly
  void removeMomentum(const NodeImpulse& impulse = {}, const std::vector<std::array<double, 3>>& torques = {},
                      std::vector<HeldPoint<S>>* held = nullptr);
  /// Where something other than elasticity has rotated a component in this step, the solution gets that rotation as a
  /// chord: a straight motion would stretch a stiff body. Nothing changes for soft bodies, for which the effect is
  /// negligible.
  void bendTurns();

  /// Shortens the deformation that the step has found, where a law stiffens within it by more than its matrix bears, so
  /// that no energy comes from it. After the last change of the solution. Cost O(N); three times the forces if some
  /// node moves by a tenth of a tet relative to the body.
  void shortenStep(SolvedWith what, ParallelFor* threads);

  // ---- At any time.

  /// The elastic forces, and the energy, at the positions of a probe.
  void findForces(BodyProbe<S>& probe, ParallelFor* threads);
  double energy(BodyProbe<S> probe, ParallelFor* threads);
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

  // ---- Between steps.

  /// Takes the body and all that it remembers along a rigid motion, a rotation about the origin and a translation: the
  /// next step goes on from the last one there. Points and velocities are the caller's: see `rounded`.
  /// turn  a matrix by rows;  turns  false: it is that of no rotation
  void carry(bool turns, const std::array<double, 9>& turn, const std::array<double, 3>& by);
  /// Writes or reads what it remembers between steps. The material, and the masses of the nodes, must be those of the
  /// snapshot when it is read. The matrix is assembled only if it is not the same.
  /// outdated   while saving: the masses of the nodes are no longer those of the matrix
  /// continues  while saving: true for all nodes, see `continues`
  /// reached    called for each node if the last step is remembered: writes the velocity to which that has brought it,
  ///            or reads it
  void serialize(StateStream& stream, bool outdated, bool continues,
                 const std::function<void(std::size_t node, S (&velocity)[3])>& reached);

 private:
  /// How far a step is: calls in another order would use what the step before has left.
  enum class Stage { Between, Begun, Solvable, Remembered };

  NodeStates<S> nodes() const { return {matrix_, places_, velocities_}; }
  LoneSystem<S> system() { return {matrix_, *tets_, places_, rightSide_, alpha_, spread_}; }
  /// Of the present rest shapes.
  double stiffnessPerInertia() const { return stiffnessOverInertia_ * (tets_ ? tets_->stiffening() : 1.0); }
  double flowsInImpact(std::size_t component, double energy, double seconds) const;
  void giveShapes();
  void findMaterialVolume();
  bool isSpread() const;
  void chooseScheme();
  /// A contact that neither stops it nor throws it back.
  bool lasts() const { return untouched_ == 0 && !impact_; }
  bool mayCarryOn() const;
  double carriedShare() const;
  void carry(ParallelFor* threads);
  void keepLastSolution();
  double strainShare(SolvedWith what, const AlignedVector<S>& deviation, const AlignedVector<S>& from,
                     ParallelFor* threads);
  void begin();
  void beginElastic(ParallelFor* threads);
  /// The material's damping as a share of what the matrix has: viscosity does not grow with what laws add to it.
  double lawDamping() const { return tets_ ? damping_ / tets_->countedLaws() : damping_; }
  void assembleIfNeeded(double turnFraction, ParallelFor* threads);
  double matrixAlpha() const;
  void assemble(double alpha, ParallelFor* threads);
  void assembleFrom(const S* corners, ParallelFor* threads);
  void findUnitImpulses(ParallelFor* threads);
  double allowedTurn() const;
  void assembleAgain(double alpha);
  void serializeReached(StateStream& stream, const std::function<void(std::size_t node, S (&velocity)[3])>& reached);
  void reachedVelocity(std::size_t node, S* velocity) const;

  BlockMatrix<S> matrix_;
  BodyComponents<S> components_;
  NodePlaces<S> places_;
  std::optional<CorotatedTets<S>> tets_;
  LoneSolve<S> loneSolve_;
  std::vector<std::vector<TetFibre>> fibres_;  ///< see `setFibres`
  std::vector<ElasticLaw> laws_;               ///< see `setLaws`
  ShapeLaw shapeLaw_;
  GivenShapes given_;                      ///< by it
  std::uint64_t givenNumber_ = 0;          ///< of the law that has given all tets their shapes
  std::vector<std::uint32_t> tetNumbers_;  ///< see TetStretches; empty until there is such a law
  EnclosedPressure<S> pressure_;
  double shearModulus_ = 1.0;
  double materialVolume_ = 0.0;  ///< of the tets, times their stiffness factors
  double spread_ = 1.0;          ///< of the last assembly
  ImpulseHistory<S> history_;
  AlignedVector<S> points_, moved_, velocities_, relative_,
      forces_;                                ///< by slot; moved_: displacements of x0, see NodePlaces
  AlignedVector<S> carried_, last_;           ///< in the wide layout, see `carry`
  AlignedVector<S> rightSide_, image_;        ///< in the wide layout
  AlignedVector<S> began_;                    ///< in the wide layout: the solution without elastic forces
  AlignedVector<S> acting_;                   ///< in the wide layout: impulses, see `solve`
  double unitImpulses_ = 0.0;                 ///< `squaredImpulses` of 1, by the matrix without rows
  double damping_ = 0.0, meanDamping_ = 0.0;  ///< the first one: of the least damped tet
  std::vector<double> moreDamped_;            ///< seconds beside it, by tet of the cage; empty: none
  std::optional<ExtraDamping<S>> extraDamping_;
  double alpha_ = 0.0;  ///< of the last assembly
  Stage stage_ = Stage::Between;
  bool stiff_ = false, pressed_ = false, secondOrder_ = false, impact_ = false, sameLength_ = false,
       deterministic_ = false;
  bool changed_ = true;      ///< masses or material have changed since the last assembly
  bool remembered_ = false;  ///< the last step
  bool solved_ = false;      ///< the last step was, of a body that is not stiff
  bool continues_ = false;   ///< the step begins where that one has ended
  /// Steps after which a body that was touched counts as free: its matrix is made anew then, which is not to happen
  /// each time that it bounces.
  static constexpr int kUntouched = 8;
  int untouched_ = kUntouched;     ///< number of steps since it was last touched
  TimeScheme scheme_;              ///< of the last `predict`
  double lastSeconds_ = 0.0;       ///< length of the last step, from `predict` on of this one; 0: there was none
  double forceSeconds_ = 0.0;      ///< for which forces act in this step
  S length_ = S(0), near_ = S(0);  ///< of the last step that is remembered: see `continues`
  double stiffnessNumber_ = 0.0;
  double stiffnessOverInertia_ = 0.0;  ///< see BodyComponents, of the last assembly for other masses or materials
  std::size_t pinned_;                 ///< number of pinned nodes
};

}  // namespace tetskin::elastic_detail
