// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/exported/body_dynamics.h>
#include <tetskin/elastic/src/matrix/wide_vectors.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tetskin::elastic_detail {
namespace {

using kernels::kGroup;

/// Mean and largest rotation of tets since the assembly, in radians, up to which a matrix is still used: only the
/// matrix is outdated, while forces are those of the current rotations.
constexpr double kMeanTurn = 0.015, kMaxTurn = 0.3;
/// These angles apply to steps of this many seconds and more; for shorter ones they are reduced in proportion, so that
/// the simulation converges.
constexpr double kFullTurnStep = 1.0 / 240.0;
/// A matrix with rotations that are outdated by an angle of phi takes rigid rotation for strain; its stress rotates the
/// body, by dt (dt + damping) phi^2 times the sum of V (2 mu + lambda) over the least inertia, times the rotation. This
/// much is allowed: values from 1 to 0.01 are stable.
constexpr double kMaxGain = 0.1;
/// Value of dt (dt + damping) times that sum over the inertia, above which a deviation from rigid motion does not last
/// for a step.
constexpr double kStiff = 1e3;
/// The same, without damping, up to which a step carries on all that it may, in lasting contact and in an impact. What
/// vibrates faster overshoots: with all of it, a ring of 14 that is squeezed flat swings to 1.37 times its energy.
constexpr double kResolvable = 8.0, kResolvableImpact = 12.0;
/// Relative difference in length of two steps that count as equally long.
constexpr double kSameLength = 0.1;
/// Value of dt^2 times that sum over the inertia, above which a rotation by a tenth of a radian that arises within a
/// step stores noticeable energy.
constexpr double kFeelsTurns = 1.0;

/// alpha over dt^2 of flat and inverted tets of a pressed body, at least: their forces change faster with a node's
/// position than the matrix knows. Otherwise nodes of a squashed body jump endlessly between two positions,
/// by sixty of its sizes per second; with 25, by one. What nothing presses comes back faster without.
constexpr double kFlatAlpha = 200.0;

/// Share of a body's radius up to which a node counts as where it was: far more than rounding.
constexpr double kNear = 1e-4;

/// Share of a tet's height by which nodes may move in a step, relative to the body, without a look at what its law
/// does.
constexpr double kSmallMove = 0.1;
/// The share of its energy that damping leaves a vibration in half a period.
/// damping  in seconds: the damping ratio is half of this times the circular frequency
double keptInHalfPeriod(double damping, double frequency) {
  constexpr double kQuarter = 1.57079632679489662;
  const double ratio = 0.5 * damping * frequency;
  if (!(ratio < 1.0)) return 0.0;
  // exp(-4 x), to a few per cent: its bits are the same everywhere.
  const double x = kQuarter * ratio / std::sqrt(1.0 - ratio * ratio), root = 1.0 / (1.0 + x + 0.5 * x * x);
  return root * root * root * root;
}

}  // namespace

template <class S>
BodyDynamics<S>::BodyDynamics(RestTets rest, std::size_t nodes)
    : matrix_(nodes, rest),
      components_(rest, matrix_),
      places_(rest.nodes, matrix_.pattern().slotOf, components_.bySlot(), components_.count()),
      pinned_(nodes) {
  if (!rest.empty()) tets_.emplace(std::move(rest), matrix_.pattern().slotOf, matrix_.slotCount());
  if (tets_ && places_.hasFrames()) {
    tets_->setFrames(places_.frames(), components_.count() > 1 ? components_.bySlot().data() : nullptr);
  }
  for (AlignedVector<S>* v : {&points_, &moved_, &velocities_, &relative_, &forces_}) {
    v->assign(4 * matrix_.slotCount(), S(0));
  }
  for (AlignedVector<S>* v : {&rightSide_, &image_, &began_, &acting_}) v->assign(matrix_.wideSize(), S(0));
}

template <class S>
void BodyDynamics<S>::setMaterial(const Lame& lame) {
  assert(tets_);
  tets_->setMaterial(lame);
  shearModulus_ = lame.mu;
  tets_->setFibres(fibres_, matrix_.pattern().slotOf);
  components_.setStiffness(tets_->rest(), lame, matrix_);
  findMaterialVolume();
  changed_ = true;
}

template <class S>
void BodyDynamics<S>::findMaterialVolume() {
  const RestTets& rest = tets_->rest();
  materialVolume_ = std::accumulate(rest.volumes.begin(), rest.volumes.end(), 0.0);
  for (const RestQuadraticTet& tet : rest.quadratic) materialVolume_ += tet.volume;
}

template <class S>
void BodyDynamics<S>::setDamping(double damping, const std::vector<double>& factors) {
  DampingParts parts = dampingParts(damping, factors);
  changed_ |= parts.least != damping_ || parts.more != moreDamped_;
  damping_ = parts.least;
  meanDamping_ = parts.mean;
  moreDamped_ = std::move(parts.more);
  if (tets_) tets_->setExtraDamping(moreDamped_);
  if (moreDamped_.empty()) return extraDamping_.reset();
  if (!extraDamping_) extraDamping_.emplace(tets_->rest(), matrix_.nodeCount());
  extraDamping_->setDeterministic(deterministic_);
}

template <class S>
void BodyDynamics<S>::setLaws(const std::vector<ElasticLaw>& laws) {
  assert(tets_);
  if (laws == laws_) return;
  laws_ = laws;
  tets_->setLaws(laws_);
  changed_ = true;
}

template <class S>
void BodyDynamics<S>::setFibres(const std::vector<std::vector<TetFibre>>& families) {
  assert(tets_);
  if (families == fibres_) return;
  fibres_ = families;
  tets_->setFibres(fibres_, matrix_.pattern().slotOf);
  changed_ = true;
}

template <class S>
void BodyDynamics<S>::setShapeLaw(ShapeLaw law) {
  assert(tets_ || !law.find);
  if (law.find && tetNumbers_.empty()) tetNumbers_ = tetNumbers(tets_->rest());
  shapeLaw_ = std::move(law);
}

template <class S>
void BodyDynamics<S>::setPressure(const PressureLaw& law, std::shared_ptr<PressureSurface> surface) {
  assert(tets_ || !surface);
  pressure_.set(law, std::move(surface), matrix_);
  changed_ |= !pressure_.acts() && spread_ != 1.0;
}

template <class S>
void BodyDynamics<S>::setDeterministic(bool on) {
  changed_ |= on != deterministic_;
  deterministic_ = on;
  matrix_.setDeterministic(on);
  if (tets_) tets_->setDeterministic(on);
  if (extraDamping_) extraDamping_->setDeterministic(on);
}

template <class S>
void BodyDynamics<S>::setMass(std::size_t node, S mass) {
  assert(!(mass < S(0)));
  const S before = matrix_.mass(node);
  if (before == mass) return;
  matrix_.setMass(node, mass);
  changed_ = true;
  pinned_ += mass == S(0);
  assert(pinned_ > 0 || before != S(0));
  pinned_ -= before == S(0);
}

template <class S>
bool BodyDynamics<S>::isHeld() const {
  if (pinned_ == 0 || components_.count() == 1) return pinned_ > 0;
  return components_.areHeld(matrix_);
}

template <class S>
double BodyDynamics<S>::forceShare(double seconds, bool staggered) const {
  assert(seconds > 0.0);
  return staggered ? 0.5 * (lastSeconds_ + seconds) / seconds : 1.0;
}

template <class S>
bool BodyDynamics<S>::isAt(std::size_t node, const S* point) const {
  return places_.isAt(matrix_.slotOf(node), point, S(0));
}

template <class S>
bool BodyDynamics<S>::continues(std::size_t node, const S* point, const S* velocity) const {
  S last[3];
  reachedVelocity(node, last);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(std::abs(length_ * (velocity[k] - last[k])) <= near_)) return false;
  }
  return places_.isAt(matrix_.slotOf(node), point, near_);
}

// ---- the beginning of a step

template <class S>
void BodyDynamics<S>::findMotion() {
  places_.take(points_);
  components_.find(nodes(), pinned_ > 0, lastSeconds_);
  stage_ = Stage::Begun;
}

template <class S>
double BodyDynamics<S>::vibrationEnergy() {
  assert(stage_ == Stage::Begun);
  BodyProbe<S> here(matrix_);
  here.points_ = points_;
  return components_.energyBesideRigid(nodes()) + energy(std::move(here), nullptr);
}

template <class S>
double BodyDynamics<S>::vibrationBefore() {
  assert(stage_ == Stage::Begun || stage_ == Stage::Solvable);
  BodyProbe<S> here(matrix_);
  here.points_ = points_;
  double sum = 0.0;
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    for (std::size_t k = 0; k < 3 && !last_.empty(); ++k) {
      const auto v = static_cast<double>(last_[wide + k * kGroup]);
      sum += static_cast<double>(matrix_.massAt(slot)) * v * v;
    }
  });
  return 0.5 * sum + energy(std::move(here), nullptr);
}

template <class S>
void BodyDynamics<S>::push(std::size_t component, const std::array<double, 3>& point,
                           const std::array<double, 3>& impulse) {
  assert(stage_ == Stage::Begun);
  components_.push(nodes(), component, Eigen::Vector3d(point[0], point[1], point[2]),
                   Eigen::Vector3d(impulse[0], impulse[1], impulse[2]), velocities_);
  findMotion();
}

template <class S>
void BodyDynamics<S>::predict(const StepStart& start, ParallelFor* threads) {
  assert(start.seconds > 0.0 && points_.size() == 4 * matrix_.slotCount());
  const double seconds = start.seconds;
  pressed_ = start.pressed;
  untouched_ = start.touched ? 0 : std::min(untouched_ + 1, kUntouched);
  impact_ = start.impact;
  continues_ = start.continues && solved_;
  solved_ = false;
  if (!start.continues) history_.forget();
  forceSeconds_ = seconds * forceShare(seconds, start.staggered);
  sameLength_ = lastSeconds_ == 0.0 || std::abs(seconds - lastSeconds_) <= kSameLength * seconds;
  lastSeconds_ = seconds;
  stage_ = Stage::Begun;
  places_.take(points_);
  matrix_.free();
  if (!tets_) {
    chooseScheme();
    assembleIfNeeded(1.0, threads);
    return begin();
  }
  if (shapeLaw_.find) giveShapes();
  components_.find(nodes(), pinned_ > 0, seconds);
  if (changed_) stiffnessOverInertia_ = components_.stiffnessOverInertia();
  stiffnessNumber_ = seconds * (seconds + meanDamping_ / tets_->countedLaws()) * stiffnessPerInertia();
  stiff_ = stiffnessNumber_ > kStiff;
  components_.move(matrix_, seconds, places_, velocities_, moved_, relative_);
  tets_->flowFor(seconds);
  tets_->forces(moved_.data(), forces_.data(), threads);
  pressure_.addForces(moved_, shearModulus_, materialVolume_, matrix_, places_, forces_, threads);
  chooseScheme();
  assembleIfNeeded(allowedTurn(), threads);
  pressure_.stiffen(matrix_, matrixAlpha());
  beginElastic(threads);
}

template <class S>
void BodyDynamics<S>::giveShapes() {
  const bool ofAll = !tets_->knowsGiven() || shapeLaw_.number != givenNumber_;
  shapeLaw_.find({tets_->rest(), tetNumbers_, matrix_.pattern().slotOf, places_.at(0)}, ofAll, given_);
  if (ofAll)
    tets_->setGiven(given_);
  else
    tets_->changeGiven(shapeLaw_.tets, tetNumbers_, given_);
  givenNumber_ = shapeLaw_.number;
}

/// Within a tenth.
template <class S>
bool BodyDynamics<S>::isSpread() const {
  constexpr double kShare = 0.1;
  return std::abs(pressure_.stretch() - spread_) <= kShare * (std::max(pressure_.stretch(), spread_) - 1.0);
}

/// A deviation from rigid motion does not last for a step of a stiff body, so that there is nothing to remember.
template <class S>
void BodyDynamics<S>::chooseScheme() {
  const bool free = untouched_ >= kUntouched;
  if (!free || stiff_ || changed_ || !remembered_) history_.forget();
  secondOrder_ = free && history_.fits(forceSeconds_);
  if (tets_) tets_->countLaws();
  const double damping = lawDamping();
  scheme_ = secondOrder_   ? secondOrder(lastSeconds_, damping)
            : free         ? firstOrder(lastSeconds_, damping)
            : mayCarryOn() ? carryingOn(lastSeconds_, damping, carriedShare())
                           : backwardEuler(lastSeconds_, damping);
}

/// In lasting contact points come and go, which shakes an undamped body: its own steps damp it.
template <class S>
double BodyDynamics<S>::carriedShare() const {
  constexpr double kLasting = 0.5, kLeastInImpact = 0.8;
  const double number = lastSeconds_ * lastSeconds_ * std::max(stiffnessPerInertia(), pressure_.gasFrequency());
  if (lasts()) return kLasting * std::min(1.0, kResolvable / number);
  return std::max(std::min(1.0, kResolvableImpact / number), kLeastInImpact);
}

/// What is squashed nearly flat is stiffer than its matrix by more than the scheme bears: in an impact, flat tets carry
/// on nothing; where a body is held flat, nothing does. Nor does anything where steps vary in length: an undamped box
/// that lands in steps of 4 and 32 ms in turn would explode.
template <class S>
bool BodyDynamics<S>::mayCarryOn() const {
  constexpr double kLeastVolume = 0.15;
  return tets_ && !stiff_ && sameLength_ && (!lasts() || tets_->flattest() >= kLeastVolume);
}

/// The angle by which tets may rotate before the matrix is assembled anew, relative to that of a soft body.
template <class S>
double BodyDynamics<S>::allowedTurn() const {
  return std::min(1.0, std::sqrt(kMaxGain / stiffnessNumber_) / kMeanTurn);
}

template <class S>
void BodyDynamics<S>::assembleIfNeeded(double turnFraction, ParallelFor* threads) {
  const double seconds = lastSeconds_;
  const double alpha = matrixAlpha();
  const double fraction = turnFraction * std::min(1.0, seconds / kFullTurnStep);
  // A stiff component rotates as a whole, and may be a single tet among many of other components.
  const double maximum = turnFraction < 1.0 ? kMeanTurn : kMaxTurn;
  const bool turned = tets_ && (tets_->meanTurn() > fraction * kMeanTurn || tets_->maxTurn() > fraction * maximum ||
                                tets_->isStiffer());
  if (changed_ || alpha != alpha_ || turned || !isSpread()) assemble(alpha, threads);
}

template <class S>
double BodyDynamics<S>::matrixAlpha() const {
  return tets_ ? scheme_.alpha(lastSeconds_) * forceSeconds_ / lastSeconds_ : 0.0;
}

template <class S>
void BodyDynamics<S>::assemble(double alpha, ParallelFor* threads) {
  const double seconds = lastSeconds_, flat = pressed_ ? kFlatAlpha * seconds * seconds
                                              : scheme_.carried > 0.0
                                                  ? backwardEuler(seconds, lawDamping()).alpha(seconds)
                                                  : 0.0;
  const auto flatAlpha = static_cast<S>(flat);
  changed_ = true;  // until it is done: memory may run out
  alpha_ = alpha;
  spread_ = pressure_.stretch();
  if (tets_) tets_->findFactors(forceSeconds_ / alpha);
  assembleFrom(tets_ ? tets_->cornersForMatrix(static_cast<S>(alpha), threads, flatAlpha) : nullptr, threads);
  changed_ = false;
  findUnitImpulses(threads);
}

template <class S>
void BodyDynamics<S>::assembleFrom(const S* corners, ParallelFor* threads) {
  matrix_.assemble(corners, tets_ ? tets_->ratio() : S(0), threads, static_cast<S>(spread_),
                   tets_ ? tets_->fibreLayers() : kernels::FibreLayers<S>());
  if (!extraDamping_) return;
  extraDamping_->take(tets_->rest(), corners, tets_->ratio(), static_cast<S>(spread_), tets_->extraShares(), threads);
}

/// While the matrix is as it was assembled.
template <class S>
void BodyDynamics<S>::findUnitImpulses(ParallelFor* threads) {
  const auto part = static_cast<S>(std::sqrt(1.0 / 3.0));
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    for (std::size_t k = 0; k < 3; ++k) image_[wide + k * kGroup] = part * matrix_.massAt(slot);
  });
  unitImpulses_ = matrix_.squaredNorm(image_.data(), threads);
}

/// Nothing acts on masses alone.
template <class S>
void BodyDynamics<S>::begin() {
  assert(!tets_ && stage_ == Stage::Begun);
  std::fill_n(matrix_.solution(), matrix_.wideSize(), S(0));
  std::fill(rightSide_.begin(), rightSide_.end(), S(0));
}

template <class S>
void BodyDynamics<S>::beginElastic(ParallelFor* threads) {
  assert(tets_ && forceSeconds_ > 0.0 && stage_ == Stage::Begun);
  S* solution = matrix_.solution();
  loneSolve_.beginStep(matrix_);
  keepLastSolution();
  const auto dt = static_cast<S>(forceSeconds_);
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    const S mass = matrix_.massAt(slot);
    const S* deviation = &relative_[4 * slot];
    for (std::size_t k = 0; k < 3; ++k) {
      const S impulse = mass * deviation[k], elastic = dt * forces_[4 * slot + k];
      began_[wide + k * kGroup] = deviation[k];
      rightSide_[wide + k * kGroup] = elastic + impulse;
      // They are opposite at rest, where their sum is 0.
      const bool free = mass != S(0);
      acting_[wide + k * kGroup] = free ? elastic - mass * (deviation[k] - solution[wide + k * kGroup]) : S(0);
      solution[wide + k * kGroup] = stiff_ && free ? S(0) : deviation[k];
    }
  });
  remembered_ = false;
  if (history_.isKnown()) {
    history_.turn(components_.turns(), components_.bySlot());
    if (secondOrder_) history_.addTo(rightSide_, scheme_, forceSeconds_);
  }
  carry(threads);
}

/// The deviation from rigid motion that the last step has ended with, turned with the body. What the step begins with
/// also deviates because nodes fly straight on where the body turns.
template <class S>
void BodyDynamics<S>::keepLastSolution() {
  last_.assign(matrix_.wideSize(), S(0));
  if (!continues_ || stiff_) return;
  std::copy_n(matrix_.solution(), matrix_.wideSize(), last_.data());
  turnWide(last_.data(), components_.turns(), components_.bySlot());
}

/// Adds the share of (A - M) u that the scheme carries on, without the flat tets' part of A.
template <class S>
void BodyDynamics<S>::carry(ParallelFor* threads) {
  carried_.clear();
  if (!(scheme_.carried > 0.0)) return;
  carried_.resize(matrix_.wideSize());
  toPoints(last_.data(), relative_);
  const bool flat = tets_->flattest() < kernels::kFlatVolume;
  changed_ |= flat;
  if (flat) assembleFrom(tets_->cornersWithoutFlat(static_cast<S>(alpha_), threads), threads);
  matrix_.multiply(relative_.data(), carried_.data(), threads);
  if (extraDamping_) extraDamping_->takeFrom(carried_, last_.data(), threads);
  if (flat) assemble(alpha_, threads);
  const auto share = static_cast<S>(scheme_.carried);
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    const S mass = matrix_.massAt(slot);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = wide + k * kGroup;
      carried_[at] = mass != S(0) ? share * (carried_[at] - mass * last_[at]) : S(0);
      rightSide_[at] += carried_[at];
    }
  });
}

template <class S>
void BodyDynamics<S>::beTouched(bool impact, ParallelFor* threads) {
  assert(stage_ == Stage::Begun || stage_ == Stage::Solvable);
  if (!tets_ || (untouched_ == 0 && impact_ >= impact)) return;
  stage_ = Stage::Begun;
  untouched_ = 0;
  impact_ = impact_ || impact;
  if (secondOrder_) history_.takeFrom(rightSide_);
  for (std::size_t k = 0; k < carried_.size(); ++k) rightSide_[k] -= carried_[k];
  chooseScheme();
  assembleIfNeeded(allowedTurn(), threads);
  pressure_.stiffen(matrix_, matrixAlpha());
  carry(threads);
}

// ---- the solve

/// A solution of 0 needs no product.
template <class S>
void BodyDynamics<S>::findResidual(ParallelFor* threads) {
  assert(stage_ == Stage::Begun || stage_ == Stage::Solvable);
  stage_ = Stage::Solvable;
  const S* solution = matrix_.solution();
  S* residual = matrix_.residual();
  if (std::all_of(solution, solution + matrix_.wideSize(), [](S v) { return v == S(0); })) {
    std::fill(image_.begin(), image_.end(), S(0));
    std::copy(rightSide_.begin(), rightSide_.end(), residual);
    return;
  }
  toPoints(solution, relative_);
  matrix_.multiply(relative_.data(), image_.data(), threads);
  for (std::size_t k = 0; k < rightSide_.size(); ++k) residual[k] = rightSide_[k] - image_[k];
}

template <class S>
int BodyDynamics<S>::solve(ConjugateGradient<S>& gradient, SolveLimits limits, int maximum, ParallelFor* threads) {
  assert(tets_ && maximum >= 0 && stage_ == Stage::Solvable);
  limits.acting = matrix_.squaredNorm(acting_.data(), threads);
  return loneSolve_.solve(system(), gradient, limits, maximum, threads);
}

/// The elastic impulses are what the right side and the momentum of the solution differ by, but for what is left of the
/// residual; with others, A times the solution.
template <class S>
void BodyDynamics<S>::remember(SolvedWith what, ParallelFor* threads) {
  assert(stage_ == Stage::Solvable);
  if (tets_ && !stiff_ && untouched_ >= kUntouched) {
    if (what == SolvedWith::Others) findResidual(threads);
    if (!secondOrder_) history_.clear(matrix_.wideSize());
    AlignedVector<S>& impulses = what == SolvedWith::Others ? image_ : rightSide_;
    if (extraDamping_) extraDamping_->takeFrom(impulses, matrix_.solution(), threads);
    history_.keep(matrix_, impulses, scheme_, lastSeconds_, forceSeconds_);
    remembered_ = true;
  }
  solved_ = tets_ && !stiff_;
  if (solved_) {
    near_ = static_cast<S>(kNear * components_.largestRadius());
    length_ = static_cast<S>(lastSeconds_);
  }
  stage_ = Stage::Remembered;
}

// ---- what is asked of a step

template <class S>
double BodyDynamics<S>::roundingSpeed() const {
  assert(stage_ != Stage::Between);
  constexpr double kFraction = 0.1;  // of the last digit
  return kFraction * static_cast<double>(std::numeric_limits<S>::epsilon()) * places_.largestDisplacement() /
         lastSeconds_;
}

template <class S>
double BodyDynamics<S>::rigidCompliance(std::size_t component, const std::array<double, 3>& point,
                                        const std::array<double, 3>& direction) const {
  assert(stage_ != Stage::Between);
  return tets_ ? components_.compliance(component, point, direction) : 0.0;
}

template <class S>
double BodyDynamics<S>::keptInImpact(std::size_t component, double energy) const {
  constexpr double kPi = 3.14159265358979324;  // half a period is a phase of it
  const double frequency = components_.impactFrequency(component), kept = keptInHalfPeriod(meanDamping_, frequency);
  return kept > 0.0 ? kept * (1.0 - flowsInImpact(component, energy, kPi / frequency)) : 0.0;
}

template <class S>
double BodyDynamics<S>::bounceSeconds(double mass, double radius, double leastKept) const {
  constexpr double kPi = 3.14159265358979324;  // half a period is a phase of it
  const double seconds = tets_ && !tets_->flows() ? components_.impactSeconds(mass, radius) : 0.0;
  return seconds > 0.0 && keptInHalfPeriod(meanDamping_, kPi / seconds) >= leastKept ? seconds : 0.0;
}

/// The share of an impact's energy that flows within half a period: what is beyond the energy at which the whole
/// yields.
template <class S>
double BodyDynamics<S>::flowsInImpact(std::size_t component, double energy, double seconds) const {
  if (!tets_ || !tets_->flows()) return 0.0;
  double mass = 0.0;
  for (std::size_t k = 0; k < components_.count(); ++k) mass += components_.mass(k);
  const double elastic = tets_->yieldEnergy() * components_.mass(component) / mass;
  return elastic < energy ? (1.0 - elastic / energy) * tets_->flowShare(seconds) : 0.0;
}

template <class S>
std::array<double, 3> BodyDynamics<S>::centreOf(std::size_t component) const {
  const Eigen::Vector3d& centre = components_.centre(component);
  return {centre[0], centre[1], centre[2]};
}

template <class S>
RigidVelocity BodyDynamics<S>::rigidVelocity(std::size_t component, bool solved) const {
  assert(stage_ != Stage::Between);
  return solved ? components_.solvedVelocity(nodes(), component, matrix_.solution())
                : components_.ownVelocity(component);
}

template <class S>
bool BodyDynamics<S>::rigidMotions(std::size_t component, AlignedVector<S> (&motions)[kRigidMotions]) const {
  assert(stage_ != Stage::Between);
  return components_.rigidMotions(nodes(), component, moved_, motions);
}

template <class S>
void BodyDynamics<S>::rightSide(std::size_t node, S out[3]) const {
  assert(stage_ != Stage::Between);
  for (std::size_t k = 0; k < 3; ++k) out[k] = rightSide_[matrix_.wideOf(node) + k * kGroup];
}

template <class S>
double BodyDynamics<S>::squaredSolution() const {
  assert(stage_ != Stage::Between);
  return squaredByMasses(matrix_, matrix_.solution());
}

template <class S>
double BodyDynamics<S>::squaredChange() const {
  assert(stage_ != Stage::Between);
  return squaredDifferenceByMasses(matrix_, matrix_.solution(), began_.data());
}

template <class S>
double BodyDynamics<S>::squaredByMatrix() const {
  assert(stage_ == Stage::Solvable);
  return std::max(dot(matrix_.solution(), image_.data(), image_.size()), 0.0);
}

template <class S>
void BodyDynamics<S>::projectToRigidMotion() {
  assert(stage_ == Stage::Begun || stage_ == Stage::Solvable);
  components_.projectToRigidMotion(nodes(), matrix_.solution());
}

template <class S>
void BodyDynamics<S>::removeMomentum(const NodeImpulse& impulse, const std::vector<std::array<double, 3>>& torques,
                                     std::vector<HeldPoint<S>>* held) {
  assert(stage_ == Stage::Solvable || stage_ == Stage::Remembered);
  components_.removeMomentum(nodes(), impulse, torques, held, matrix_.solution());
}

template <class S>
void BodyDynamics<S>::bendTurns() {
  assert(stage_ == Stage::Solvable || stage_ == Stage::Remembered);
  if (!tets_ || lastSeconds_ * lastSeconds_ * stiffnessPerInertia() < kFeelsTurns) return;
  components_.bendTurns(nodes(), lastSeconds_, matrix_.solution());
}

template <class S>
void BodyDynamics<S>::shortenStep(SolvedWith what, ParallelFor* threads) {
  assert(stage_ == Stage::Solvable || stage_ == Stage::Remembered);
  if (!tets_ || !tets_->hasLaws()) return;
  AlignedVector<S> rigid(matrix_.solution(), matrix_.solution() + matrix_.wideSize());
  components_.projectToRigidMotion(nodes(), rigid.data());
  AlignedVector<S> deviation(4 * matrix_.slotCount(), S(0)), from = moved_;
  const auto dt = static_cast<S>(lastSeconds_);
  S fastest{};
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    const bool free = matrix_.massAt(slot) != S(0);
    for (std::size_t k = 0; k < 3; ++k) {
      const S all = matrix_.solution()[wide + k * kGroup], own = free ? rigid[wide + k * kGroup] : all;
      deviation[4 * slot + k] = all - own;
      from[4 * slot + k] += dt * own;
      fastest = std::max(fastest, std::abs(all - own));
    }
  });
  if (lastSeconds_ * static_cast<double>(fastest) <= kSmallMove * tets_->leastHeight()) return;
  const double share = strainShare(what, deviation, from, threads);
  if (share == 1.0) return;
  const auto kept = static_cast<S>(share);
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    for (std::size_t k = 0; k < 3; ++k)
      matrix_.solution()[wide + k * kGroup] -= (S(1) - kept) * deviation[4 * slot + k];
  });
  history_.forget();
}

/// The share of a deformation, by velocities, which stores no more energy than its forces and the matrix account for: a
/// power of a half.
/// from  where it begins, displacements
template <class S>
double BodyDynamics<S>::strainShare(SolvedWith what, const AlignedVector<S>& deviation, const AlignedVector<S>& from,
                                    ParallelFor* threads) {
  constexpr int kMostHalvings = 12;
  constexpr double kRounding = 1e-5;
  AlignedVector<S> forces(deviation.size()), points = from, product;
  if (what == SolvedWith::Others) {
    product.resize(matrix_.wideSize());
    matrix_.multiply(deviation.data(), product.data(), threads);
  }
  // Without others, A times the solution is the right side: what rotates a body beside it is not resisted.
  const AlignedVector<S>& impulses = what == SolvedWith::Others ? product : rightSide_;
  tets_->probeForces(points.data(), forces.data(), threads);
  double resisted = 0.0, power = 0.0;  // deviation (A - M) deviation, forces deviation
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    for (std::size_t k = 0; k < 3; ++k) {
      const S by = deviation[4 * slot + k];
      resisted += static_cast<double>(by * (impulses[wide + k * kGroup] - matrix_.massAt(slot) * by));
      power += static_cast<double>(by * forces[4 * slot + k]);
    }
  });
  const double began = (1.0 + kRounding) * tets_->energy(points.data(), threads);
  const double borne = std::max(resisted, 0.0) * std::max(1.0, lastSeconds_ * lastSeconds_ / alpha_);
  double share = 1.0;
  for (int k = 0; k < kMostHalvings; ++k, share *= 0.5) {
    const double by = share * lastSeconds_;
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = from[i] + static_cast<S>(by) * deviation[i];
    if (tets_->energy(points.data(), threads) <= began - by * power + share * share * borne) break;
  }
  return share;
}

// ---- probes

template <class S>
void BodyDynamics<S>::findForces(BodyProbe<S>& probe, ParallelFor* threads) {
  assert(&probe.matrix_ == &matrix_);
  if (!tets_) return;
  AlignedVector<S> moved = probe.points_;
  places_.displacePoints(moved);
  tets_->probeForces(moved.data(), probe.forces_.data(), threads);
  pressure_.addForcesAt(probe.points_, matrix_, places_, probe.forces_);
}

template <class S>
double BodyDynamics<S>::energy(BodyProbe<S> probe, ParallelFor* threads) {
  assert(&probe.matrix_ == &matrix_);
  if (!tets_) return 0.0;
  const double ofPressure = pressure_.energyAt(probe.points_, matrix_, places_);
  places_.displacePoints(probe.points_);
  return tets_->energy(probe.points_.data(), threads) + ofPressure;
}

template <class S>
double BodyDynamics<S>::volumeIn(PressureSurface& surface, const BodyProbe<S>& probe) const {
  return EnclosedPressure<S>::volumeAt(probe.points_, surface, matrix_, places_);
}

// ---- between steps

template <class S>
void BodyDynamics<S>::carry(bool turns, const std::array<double, 9>& turn, const std::array<double, 3>& by) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  for (int k = 0; k < 9 && turns; ++k) rotation(k / 3, k % 3) = turn[static_cast<std::size_t>(k)];
  const Eigen::Vector3d translation(by[0], by[1], by[2]);
  places_.carry(turns, rotation, translation);
  components_.carry(rotation, translation);
  if (!turns) return;
  if (history_.isKnown()) history_.turn({turn}, components_.bySlot());
  turnWide(matrix_.solution(), {turn}, components_.bySlot());
  loneSolve_.turn(turn, components_.bySlot());
  const Eigen::Matrix<S, 3, 3> rounded = rotation.template cast<S>();
  for (std::size_t slot = 0; slot < matrix_.slotCount(); ++slot) {
    Eigen::Map<Eigen::Matrix<S, 3, 1>> v(&velocities_[4 * slot]);
    v = (rounded * v).eval();
  }
}

template <class S>
void BodyDynamics<S>::assembleAgain(double alpha) {
  assembleFrom(tets_ ? tets_->cornersAgain(static_cast<S>(alpha), nullptr) : nullptr, nullptr);
  findUnitImpulses(nullptr);
}

/// Earlier steps are written only if the next one would use them.
template <class S>
void BodyDynamics<S>::serialize(StateStream& stream, bool outdated, bool continues,
                                const std::function<void(std::size_t, S (&)[3])>& reached) {
  bool deterministic = deterministic_;
  stream(deterministic);
  setDeterministic(deterministic);  // a step that found it changed would make the matrix anew
  bool changed = changed_ || outdated;
  bool known = history_.isKnown() && remembered_ && continues && !changed;
  bool solved = solved_ && continues;
  double alpha = alpha_;
  stream(changed);
  stream(known);
  stream(solved);
  stream(alpha);
  double spread = pressure_.acts() ? spread_ : 1.0;
  if (pressure_.acts()) stream(spread);
  stream(stiffnessOverInertia_);
  stream(untouched_);
  stream(lastSeconds_);
  components_.serialize(stream);
  places_.serialize(stream);
  const bool turned = tets_ && tets_->serialize(stream, static_cast<S>(alpha), !changed);
  if (tets_) matrix_.serializeWide(stream, matrix_.solution());
  loneSolve_.serialize(stream, matrix_);
  if (stream.restoring()) {
    const bool same = alpha == alpha_ && spread == spread_;
    spread_ = spread;
    if (!changed && (changed_ || turned || !same)) assembleAgain(alpha);
    alpha_ = alpha;
    changed_ = changed;
    remembered_ = known;
    solved_ = solved;
    history_.forget();
    stage_ = Stage::Between;
  }
  if (!known && !solved) return;
  stream(length_);
  stream(near_);
  if (known) history_.serialize(stream, matrix_);
  serializeReached(stream, reached);
}

template <class S>
void BodyDynamics<S>::serializeReached(StateStream& stream, const std::function<void(std::size_t, S (&)[3])>& reached) {
  for (std::size_t n = 0; n < nodeCount(); ++n) {
    S velocity[3] = {};
    if (stream.saving()) reachedVelocity(n, velocity);
    reached(n, velocity);
    if (!stream.restoring()) continue;
    const std::size_t slot = matrix_.slotOf(n), wide = matrix_.wideOfSlot(slot);
    for (std::size_t k = 0; k < 3; ++k) {
      velocities_[4 * slot + k] = velocity[k] - matrix_.solution()[wide + k * kGroup];
    }
  }
}

template <class S>
void BodyDynamics<S>::reachedVelocity(std::size_t node, S* velocity) const {
  const std::size_t slot = matrix_.slotOf(node), wide = matrix_.wideOfSlot(slot);
  for (std::size_t k = 0; k < 3; ++k) {
    velocity[k] = velocities_[4 * slot + k] + matrix_.solution()[wide + k * kGroup];
  }
}

TETSKIN_INSTANTIATE_CLASS(BodyDynamics)

}  // namespace tetskin::elastic_detail
