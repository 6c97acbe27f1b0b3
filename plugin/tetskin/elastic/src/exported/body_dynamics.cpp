// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/exported/body_dynamics.h>

#include <algorithm>
#include <cassert>
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
/// Value of dt^2 times that sum over the inertia, above which a rotation by a tenth of a radian that arises within a
/// step stores noticeable energy.
constexpr double kFeelsTurns = 1.0;

/// alpha over dt^2 of flat and inverted tets of a pressed body, at least: their forces change faster with a node's
/// position than the matrix knows. Otherwise nodes of a squashed body jump endlessly between two positions,
/// by sixty of its sizes per second; with 25, by one. What nothing presses comes back faster without.
constexpr double kFlatAlpha = 200.0;

/// Least bound of the iterations of a solve that is continued in two levels: with a lower one it must be cheap.
constexpr int kPatience = 50;
/// Number of solves after which the conjugate gradient is tried alone again.
constexpr int kTwoLevelSolves = 240;

/// Share of a body's radius up to which a node counts as where it was: far more than rounding.
constexpr double kNear = 1e-4;

/// Calls visit(slot, first scalar in wide vectors) for all slots.
template <class Visit>
void bySlots(std::size_t slots, Visit&& visit) {
  for (std::size_t chunk = 0; chunk < slots / kGroup; ++chunk) {
    for (std::size_t lane = 0; lane < kGroup; ++lane) visit(kGroup * chunk + lane, kernels::kWideVector * chunk + lane);
  }
}

/// Sums side by side, none of which waits for the one before.
struct LaneSums {
  double lanes[kGroup] = {};

  double total() const { return std::accumulate(lanes, lanes + kGroup, 0.0); }
};

}  // namespace

template <class S>
BodyDynamics<S>::BodyDynamics(RestTets rest, std::size_t nodes)
    : matrix_(nodes, rest),
      pinned_(nodes),
      partOf_(components(rest, matrix_)),
      motions_(1 + *std::max_element(partOf_.begin(), partOf_.end())),
      places_(rest.nodes, matrix_.pattern().slotOf, partOf_, motions_.size()),
      stiffness_(motions_.size(), 0.0) {
  if (!rest.empty()) tets_.emplace(std::move(rest), matrix_.pattern().slotOf, matrix_.slotCount());
  if (tets_ && places_.hasFrames()) {
    tets_->setFrames(places_.frames(), motions_.size() > 1 ? partOf_.data() : nullptr);
  }
  for (AlignedVector<S>* v : {&points_, &moved_, &velocities_, &relative_, &forces_}) {
    v->assign(4 * matrix_.slotCount(), S(0));
  }
  for (AlignedVector<S>* v : {&rightSide_, &image_, &began_, &acting_}) v->assign(matrix_.wideSize(), S(0));
}

/// The component of each slot. Slots without a node, which have no mass, count as part of the first one.
template <class S>
std::vector<std::uint32_t> BodyDynamics<S>::components(const RestTets& rest, const BlockMatrix<S>& matrix) {
  DisjointSets sets(matrix.nodeCount());
  const auto connect = [&](const auto& nodes) {
    for (const int n : nodes) sets.unite(nodes[0], n);
  };
  for (const Tet& tet : rest.tets) connect(tet);
  for (const RestQuadraticTet& tet : rest.quadratic) connect(tet.nodes);
  std::vector<std::uint32_t> partOf(std::max<std::size_t>(matrix.slotCount(), 1), 0);
  const std::vector<int> numbers = sets.numbers();
  for (std::size_t n = 0; n < numbers.size(); ++n) partOf[matrix.slotOf(n)] = static_cast<std::uint32_t>(numbers[n]);
  return partOf;
}

template <class S>
void BodyDynamics<S>::setMaterial(const Lame& lame) {
  assert(tets_);
  const RestTets& rest = tets_->rest();
  tets_->setMaterial(lame);
  std::fill(stiffness_.begin(), stiffness_.end(), 0.0);
  const auto add = [&](int node, double volume) {
    stiffness_[partOf_[matrix_.slotOf(static_cast<std::size_t>(node))]] += volume * (2.0 * lame.mu + lame.lambda);
  };
  for (std::size_t t = 0; t < rest.count(); ++t) add(rest.tets[t][0], rest.volumes[t]);
  for (const RestQuadraticTet& tet : rest.quadratic) add(tet.nodes[0], tet.volume);
  changed_ = true;
}

template <class S>
void BodyDynamics<S>::setDamping(double damping) {
  changed_ |= damping != damping_;
  damping_ = damping;
}

template <class S>
void BodyDynamics<S>::setDeterministic(bool on) {
  changed_ |= on != deterministic_;
  deterministic_ = on;
  matrix_.setDeterministic(on);
  if (tets_) tets_->setDeterministic(on);
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
void BodyDynamics<S>::setTouched(bool touched) {
  untouched_ = touched ? 0 : std::min(untouched_ + 1, kUntouched);
}

template <class S>
void BodyDynamics<S>::beTouched(double seconds, ParallelFor* threads) {
  assert(stage_ >= Stage::Started);
  if (!tets_ || untouched_ == 0) return;
  stage_ = Stage::Started;
  untouched_ = 0;
  if (secondOrder_) history_.takeFrom(rightSide_);
  chooseScheme(seconds);
  assembleIfNeeded(seconds, allowedTurn(), threads);
}

template <class S>
bool BodyDynamics<S>::isHeld() const {
  if (pinned_ == 0 || motions_.size() == 1) return pinned_ > 0;
  std::vector<bool> held(motions_.size(), false);
  for (std::size_t n = 0; n < nodeCount(); ++n) {
    const std::size_t slot = matrix_.slotOf(n);
    if (matrix_.massAt(slot) == S(0)) held[partOf_[slot]] = true;
  }
  return std::find(held.begin(), held.end(), false) == held.end();
}

template <class S>
double BodyDynamics<S>::forceShare(double seconds) const {
  assert(seconds > 0.0);
  return staggered_ ? 0.5 * (lastSeconds_ + seconds) / seconds : 1.0;
}

template <class S>
void BodyDynamics<S>::beginForces(double seconds) {
  forceSeconds_ = seconds * forceShare(seconds);
  lastSeconds_ = seconds;
  chooseScheme(seconds);
}

template <class S>
bool BodyDynamics<S>::isAt(std::size_t node, const S* point) const {
  return places_.isAt(matrix_.slotOf(node), point, S(0));
}

template <class S>
bool BodyDynamics<S>::continues(std::size_t node, const S* point, const S* velocity) const {
  S last[3];
  reached(node, last);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(std::abs(length_ * (velocity[k] - last[k])) <= near_)) return false;
  }
  return places_.isAt(matrix_.slotOf(node), point, near_);
}

/// A deviation from rigid motion does not last for a step of a stiff body, so that there is nothing to remember.
template <class S>
void BodyDynamics<S>::chooseScheme(double seconds) {
  const bool free = untouched_ >= kUntouched;
  if (!free || stiff_ || changed_ || !remembered_) history_.forget();
  secondOrder_ = history_.fits(forceSeconds_);
  scheme_ = secondOrder_ ? secondOrder(seconds, damping_)
            : free       ? firstOrder(seconds, damping_)
                         : backwardEuler(seconds, damping_);
}

template <class S>
void BodyDynamics<S>::probeForces(ParallelFor* threads) {
  if (!tets_) return;
  places_.displacePoints(moved_);
  tets_->probeForces(moved_.data(), forces_.data(), threads);
}

template <class S>
double BodyDynamics<S>::probeEnergy(ParallelFor* threads) {
  if (!tets_) return 0.0;
  places_.displacePoints(moved_);
  return tets_->energy(moved_.data(), threads);
}

template <class S>
void BodyDynamics<S>::assembleIfNeeded(double seconds, double turnFraction, ParallelFor* threads) {
  const double alpha = tets_ ? scheme_.alpha(seconds) * forceSeconds_ / seconds : 0.0;
  const double fraction = turnFraction * std::min(1.0, seconds / kFullTurnStep);
  // A stiff component rotates as a whole, and may be a single tet among many of other components.
  const double maximum = turnFraction < 1.0 ? kMeanTurn : kMaxTurn;
  const bool turned = tets_ && (tets_->meanTurn() > fraction * kMeanTurn || tets_->maxTurn() > fraction * maximum);
  if (!changed_ && alpha == alpha_ && !turned) return;
  const auto flatAlpha = static_cast<S>(pressed_ ? kFlatAlpha * seconds * seconds : 0.0);
  matrix_.assemble(tets_ ? tets_->cornersForMatrix(static_cast<S>(alpha), threads, flatAlpha) : nullptr,
                   tets_ ? tets_->ratio() : S(0), threads);
  alpha_ = alpha;
  changed_ = false;
  findUnitImpulses(threads);
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

template <class S>
void BodyDynamics<S>::findMotions(double seconds) {
  assert(!motions_.empty());
  std::vector<PinnedNodes> pinned(motions_.size());
  for (std::size_t n = 0; pinned_ > 0 && n < nodeCount(); ++n) {
    const std::size_t slot = matrix_.slotOf(n);
    if (matrix_.massAt(slot) != S(0)) continue;
    const double* x = places_.at(slot);
    const S* v = &velocities_[4 * slot];
    pinned[partOf_[slot]].add(Eigen::Vector3d(x[0], x[1], x[2]), Eigen::Vector3d(v[0], v[1], v[2]));
  }
  // Moments about the components' previous positions: this needs one pass only, and keeps the digits far from the
  // origin.
  std::vector<ComponentMoments> moments(motions_.size());
  const auto add = [&](std::size_t slot, ComponentMoments& sums, const Eigen::Vector3d& about) {
    sums.add(matrix_.massAt(slot), places_.at(slot), &velocities_[4 * slot], about.data());
  };
  if (motions_.size() == 1) {  // nearly always: its sums stay in registers
    ComponentMoments sums;
    const Eigen::Vector3d about = motions_.front().about();
    for (std::size_t slot = 0; slot < matrix_.slotCount(); ++slot) add(slot, sums, about);
    moments.front() = sums;
  } else {
    for (std::size_t slot = 0; slot < matrix_.slotCount(); ++slot) {
      add(slot, moments[partOf_[slot]], motions_[partOf_[slot]].about());
    }
  }
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    pinned[k].finish(seconds);
    const Eigen::Vector3d near = motions_[k].about();
    motions_[k].find(moments[k], near, pinned[k], seconds);
  }
}

/// The velocities become those of the rigid motion, and `relative_` the difference to them. Forces do not depend on the
/// position of a component: without its translation, points have the same rounding in each step, and differences in
/// rounding are not taken for strain. A displacement is turned with its frame.
template <class S>
void BodyDynamics<S>::moveRigidly(double seconds) {
  assert(seconds > 0.0 && partOf_.size() >= matrix_.slotCount());
  struct Rigid {
    double about[3];
    S velocity[3], field[9];
  };
  std::vector<Rigid> components;
  std::vector<Eigen::Vector3d> anchors;
  std::vector<Eigen::Matrix3d> turns;
  for (const ComponentMotion& motion : motions_) {
    anchors.push_back(motion.anchor());
    turns.push_back(motion.turn());
    const RigidVelocity exact = motion.velocities(seconds);
    Rigid& component = components.emplace_back();
    for (int k = 0; k < 3; ++k) {
      component.about[k] = exact.about[k];
      component.velocity[k] = static_cast<S>(exact.velocity[k]);
    }
    for (int k = 0; k < 9; ++k) component.field[k] = static_cast<S>(exact.field[k]);
  }
  places_.displace(anchors, moved_);
  const bool framed = places_.hasFrames();
  const auto dt = static_cast<S>(seconds);
  for (std::size_t slot = 0; slot < matrix_.slotCount(); ++slot) {
    const Rigid& component = components[partOf_[slot]];
    const double* x = places_.at(slot);
    S *v = &velocities_[4 * slot], *moved = &moved_[4 * slot], *beside = &relative_[4 * slot];
    S arm[3], turning[3], turned[3];
    for (std::size_t k = 0; k < 3; ++k) arm[k] = static_cast<S>(x[k] - component.about[k]);
    const auto turn = [&](const S* from, S* to) {
      for (std::size_t k = 0; k < 3; ++k) {
        const S* row = component.field + 3 * k;
        to[k] = row[0] * from[0] + row[1] * from[1] + row[2] * from[2];
      }
    };
    turn(arm, turning);
    turn(framed ? moved : arm, turned);
    for (std::size_t k = 0; k < 3; ++k) {
      moved[k] += dt * turned[k];
      const S rigid = component.velocity[k] + turning[k];
      beside[k] = v[k] - rigid;
      v[k] = rigid;
    }
  }
  places_.turnFrames(turns);
}

/// The angle by which tets may rotate before the matrix is assembled anew, relative to that of a soft body.
template <class S>
double BodyDynamics<S>::allowedTurn() const {
  return std::min(1.0, std::sqrt(kMaxGain / stiffnessNumber_) / kMeanTurn);
}

template <class S>
void BodyDynamics<S>::predict(double seconds, ParallelFor* threads) {
  assert(seconds > 0.0);
  stage_ = Stage::Predicted;
  places_.take(points_);
  if (!tets_) {
    beginForces(seconds);
    return assembleIfNeeded(seconds, 1.0, threads);
  }
  findMotions(seconds);
  if (changed_) {
    stiffnessOverInertia_ = 0.0;
    for (std::size_t k = 0; k < motions_.size(); ++k) {
      const double inertia = motions_[k].minInertia();
      if (inertia > 0.0) stiffnessOverInertia_ = std::max(stiffnessOverInertia_, stiffness_[k] / inertia);
    }
  }
  stiffnessNumber_ = seconds * (seconds + damping_) * stiffnessOverInertia_;
  stiff_ = stiffnessNumber_ > kStiff;
  beginForces(seconds);
  moveRigidly(seconds);
  tets_->forces(moved_.data(), forces_.data(), threads);
  assembleIfNeeded(seconds, allowedTurn(), threads);
}

template <class S>
double BodyDynamics<S>::roundingSpeed(double seconds) const {
  constexpr double kFraction = 0.1;  // of the last digit
  return kFraction * static_cast<double>(std::numeric_limits<S>::epsilon()) * places_.largestDisplacement() / seconds;
}

template <class S>
double BodyDynamics<S>::rigidCompliance(std::size_t node, const std::array<double, 3>& point,
                                        const std::array<double, 3>& direction) const {
  if (!tets_) return 0.0;
  const ComponentMotion& motion = motions_[partOf_[matrix_.slotOf(node)]];
  return motion.compliance(Eigen::Vector3d(point[0], point[1], point[2]),
                           Eigen::Vector3d(direction[0], direction[1], direction[2]));
}

template <class S>
void BodyDynamics<S>::startLater() {
  assert(forceSeconds_ > 0.0 && stage_ == Stage::Predicted);
  stage_ = Stage::Started;
  S* solution = matrix_.solution();
  if (!tets_) {
    std::fill_n(solution, matrix_.wideSize(), S(0));
    std::fill(rightSide_.begin(), rightSide_.end(), S(0));
    return;
  }
  if (guess_.isUsed()) guess_.remember(matrix_);
  const auto dt = static_cast<S>(forceSeconds_);
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    const S mass = matrix_.massAt(slot);
    S* deviation = &relative_[4 * slot];
    for (std::size_t k = 0; k < 3; ++k) {
      const S impulse = mass * deviation[k], elastic = dt * forces_[4 * slot + k];
      began_[wide + k * kGroup] = deviation[k];
      rightSide_[wide + k * kGroup] = elastic + impulse;
      // They are opposite at rest, where their sum is 0.
      const bool free = mass != S(0);
      acting_[wide + k * kGroup] = free ? elastic - mass * (deviation[k] - solution[wide + k * kGroup]) : S(0);
      if (stiff_ && free) deviation[k] = S(0);
      solution[wide + k * kGroup] = deviation[k];
    }
  });
  remembered_ = false;
  if (!history_.isKnown()) return;
  std::vector<std::array<double, 9>> turns(motions_.size());
  for (std::size_t part = 0; part < motions_.size(); ++part) {
    const Eigen::Matrix3d& turn = motions_[part].turn();
    for (std::size_t k = 0; k < 9; ++k) turns[part][k] = turn(static_cast<int>(k) / 3, static_cast<int>(k) % 3);
  }
  history_.turn(turns, partOf_);
  if (secondOrder_) history_.addTo(rightSide_, scheme_, forceSeconds_);
}

/// The elastic impulses are what the right side and the momentum of the solution differ by, but for what is left of the
/// residual.
template <class S>
void BodyDynamics<S>::remember(double seconds) {
  assert(stage_ >= Stage::Started);
  if (mayRemember()) keep(rightSide_, seconds);
}

template <class S>
void BodyDynamics<S>::rememberAmongOthers(double seconds, ParallelFor* threads) {
  if (!mayRemember()) return;
  restart(threads);
  keep(image_, seconds);
}

template <class S>
void BodyDynamics<S>::keep(const AlignedVector<S>& impulses, double seconds) {
  if (!secondOrder_) history_.clear(matrix_.wideSize());
  history_.keep(matrix_, impulses, scheme_, seconds, forceSeconds_);
  remembered_ = true;
  double radius = 0.0;
  for (const ComponentMotion& motion : motions_) radius = std::max(radius, motion.radius());
  near_ = static_cast<S>(kNear * radius);
  length_ = static_cast<S>(seconds);
}

template <class S>
void BodyDynamics<S>::start(ParallelFor* threads) {
  startLater();
  stage_ = Stage::Solvable;
  if (tets_ && !(stiff_ && pinned_ == 0)) return findResidual(threads);
  std::copy(rightSide_.begin(), rightSide_.end(), matrix_.residual());
}

/// Of the solution, which `relative_` has as points.
template <class S>
void BodyDynamics<S>::findResidual(ParallelFor* threads) {
  matrix_.multiply(relative_.data(), image_.data(), threads);
  S* residual = matrix_.residual();
  for (std::size_t k = 0; k < rightSide_.size(); ++k) residual[k] = rightSide_[k] - image_[k];
}

template <class S>
double BodyDynamics<S>::squaredActing(ParallelFor* threads) {
  return matrix_.squaredNorm(acting_.data(), threads);
}

template <class S>
int BodyDynamics<S>::solve(ConjugateGradient<S>& gradient, SolveLimits limits, int maximum, ParallelFor* threads) {
  assert(tets_ && maximum >= 0 && stage_ == Stage::Solvable);
  limits.acting = squaredActing(threads);
  const bool guesses = maximum > 0;
  if (guesses) guess_.improve(matrix_, limits, threads);
  if (guesses && twoLevelSolves_ > 0) return solveInTwoLevels(gradient, limits, threads);
  gradient.start({&matrix_}, limits, nullptr, threads);
  const double squared = gradient.squaredResidual();
  gradient.iterate(maximum, threads);
  const int iterations = gradient.iterations();
  if (guesses) guess_.learn(squared, limits.acting, iterations);
  const bool ended = iterations < limits.iterations || gradient.squaredResidual() <= gradient.enough();
  if (ended || limits.iterations < kPatience) return iterations;
  twoLevelSolves_ = kTwoLevelSolves;
  return iterations + solveInTwoLevels(gradient, limits, threads);
}

template <class S>
int BodyDynamics<S>::solveInTwoLevels(ConjugateGradient<S>& gradient, SolveLimits limits, ParallelFor* threads) {
  assert(tets_ && twoLevelSolves_ > 0);
  --twoLevelSolves_;
  if (!twoLevelSolve_) twoLevelSolve_ = std::make_unique<TwoLevelGradient<S>>(tets_->rest(), matrix_);
  std::vector<double> points(3 * matrix_.slotCount());
  for (std::size_t slot = 0; slot < matrix_.slotCount(); ++slot) std::copy_n(places_.at(slot), 3, &points[3 * slot]);
  const double relative = limits.tolerance * limits.tolerance * limits.acting;
  const double target = std::max({relative, limits.enough, static_cast<double>(std::numeric_limits<S>::min())});
  const S* corners = tets_->cornersAgain(static_cast<S>(alpha_), threads);
  const int iterations = twoLevelSolve_->solve(matrix_, {tets_->rest(), corners, static_cast<double>(tets_->ratio())},
                                               rightSide_.data(), points, target, limits.iterations, threads);
  // What is left is measured, and stays.
  limits.reduction = 1.0;
  limits.iterations = 0;
  gradient.start({&matrix_}, limits, nullptr, threads);
  return iterations;
}

template <class S>
double BodyDynamics<S>::squaredSolution() const {
  const S* solution = matrix_.solution();
  double sum = 0.0;
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    for (std::size_t k = 0; k < 3; ++k) {
      const S v = solution[wide + k * kGroup];
      sum += static_cast<double>(matrix_.massAt(slot) * v * v);
    }
  });
  return sum;
}

template <class S>
double BodyDynamics<S>::squaredChange() const {
  const S* solution = matrix_.solution();
  LaneSums sums;
  for (std::size_t chunk = 0; chunk < matrix_.slotCount() / kGroup; ++chunk) {
    for (std::size_t lane = 0; lane < kGroup; ++lane) {
      double squared = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = kernels::kWideVector * chunk + k * kGroup + lane;
        const auto change = static_cast<double>(solution[at] - began_[at]);
        squared += change * change;
      }
      sums.lanes[lane] += static_cast<double>(matrix_.massAt(kGroup * chunk + lane)) * squared;
    }
  }
  return sums.total();
}

template <class S>
double BodyDynamics<S>::squaredByMatrix() const {
  const S* solution = matrix_.solution();
  LaneSums sums;
  for (std::size_t k = 0; k < image_.size(); k += kGroup) {
    for (std::size_t lane = 0; lane < kGroup; ++lane) {
      sums.lanes[lane] += static_cast<double>(solution[k + lane]) * static_cast<double>(image_[k + lane]);
    }
  }
  return std::max(sums.total(), 0.0);
}

template <class S>
void BodyDynamics<S>::rightSide(std::size_t node, S out[3]) const {
  for (std::size_t k = 0; k < 3; ++k) out[k] = rightSide_[matrix_.wideOf(node) + k * kGroup];
}

template <class S>
void BodyDynamics<S>::restart(ParallelFor* threads) {
  assert(rightSide_.size() == matrix_.wideSize() && image_.size() == matrix_.wideSize());
  assert(stage_ >= Stage::Started);
  stage_ = Stage::Solvable;
  const S* solution = matrix_.solution();
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    for (std::size_t k = 0; k < 3; ++k) relative_[4 * slot + k] = solution[wide + k * kGroup];
  });
  findResidual(threads);
}

/// Moments of the velocities of the current solution, with those of the rigid motion or without.
template <class S>
std::vector<ComponentMomentum> BodyDynamics<S>::momentaNow(bool withRigid) const {
  const S* solution = matrix_.solution();
  std::vector<ComponentMomentum> now(motions_.size());
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    double velocity[3];
    for (std::size_t k = 0; k < 3; ++k) {
      velocity[k] = solution[wide + k * kGroup];
      if (withRigid) velocity[k] += static_cast<double>(velocities_[4 * slot + k]);
    }
    const std::uint32_t component = partOf_[slot];
    now[component].add(matrix_.massAt(slot), places_.at(slot), velocity, motions_[component].about().data());
  });
  return now;
}

/// Makes change(solution, velocity) of the solution where a node is not pinned, with the velocity of its component.
template <class S>
template <class Change>
void BodyDynamics<S>::changeSolution(const std::vector<RigidVelocity>& velocities, Change&& change) {
  S* solution = matrix_.solution();
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    if (matrix_.massAt(slot) == S(0)) return;
    double v[3];
    velocities[partOf_[slot]].at(places_.at(slot), v);
    for (std::size_t k = 0; k < 3; ++k) {
      S& own = solution[wide + k * kGroup];
      own = change(own, static_cast<S>(v[k]));
    }
  });
}

template <class S>
void BodyDynamics<S>::bendTurns(double seconds) {
  if (!tets_ || seconds * seconds * stiffnessOverInertia_ < kFeelsTurns) return;
  S* solution = matrix_.solution();
  const std::vector<ComponentMomentum> now = momentaNow();
  std::vector<ComponentMoments> moments(motions_.size());
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    S v[3];
    for (std::size_t k = 0; k < 3; ++k) v[k] = velocities_[4 * slot + k] + solution[wide + k * kGroup];
    const std::uint32_t component = partOf_[slot];
    moments[component].add(matrix_.massAt(slot), places_.at(slot), v, motions_[component].about().data());
  });
  std::vector<RigidVelocity> chords;
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    chords.push_back(motions_[k].chord(now[k], moments[k], motions_[k].about(), seconds));
  }
  changeSolution(chords, [](S own, S chord) { return own + chord; });
}

template <class S>
bool BodyDynamics<S>::rigidMotions(std::size_t component, AlignedVector<S> (&motions)[kRigidMotions]) const {
  assert(component < componentCount());
  double mass = 0.0, centroid[3] = {};
  S x[3];
  for (std::size_t n = 0; n < nodeCount(); ++n) {
    const std::size_t slot = matrix_.slotOf(n);
    if (partOf_[slot] != component) continue;
    if (matrix_.massAt(slot) == S(0)) return false;
    const auto m = static_cast<double>(matrix_.massAt(slot));
    mass += m;
    places_.fromDisplacement(slot, &moved_[4 * slot], x);
    for (std::size_t k = 0; k < 3; ++k) centroid[k] += m * static_cast<double>(x[k]);
  }
  if (!(mass > 0.0)) return false;
  for (AlignedVector<S>& motion : motions) motion.resize(4 * matrix_.slotCount(), S(0));
  for (std::size_t n = 0; n < nodeCount(); ++n) {
    const std::size_t slot = matrix_.slotOf(n);
    if (partOf_[slot] != component) continue;
    S arm[3];
    places_.fromDisplacement(slot, &moved_[4 * slot], x);
    for (std::size_t k = 0; k < 3; ++k) {
      arm[k] = x[k] - static_cast<S>(centroid[k] / mass);
      motions[k][4 * slot + k] = S(1);
    }
    for (std::size_t k = 0; k < 3; ++k) {  // about axis k
      motions[3 + k][4 * slot + (k + 1) % 3] = -arm[(k + 2) % 3];
      motions[3 + k][4 * slot + (k + 2) % 3] = arm[(k + 1) % 3];
    }
  }
  return true;
}

template <class S>
void BodyDynamics<S>::projectToRigidMotion() {
  const std::vector<ComponentMomentum> own = momentaNow(false);
  std::vector<RigidVelocity> rigid;
  for (std::size_t k = 0; k < motions_.size(); ++k) rigid.push_back(motions_[k].withMomentum(own[k]));
  changeSolution(rigid, [](S, S motion) { return motion; });
}

template <class S>
Eigen::Vector3d BodyDynamics<S>::placeOf(const HeldPoint<S>& point) const {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < point.nodeCount; ++k) {
    const double* x = places_.at(matrix_.slotOf(static_cast<std::size_t>(point.nodes[k])));
    place += static_cast<double>(point.weights[k]) * Eigen::Vector3d(x[0], x[1], x[2]);
  }
  return place;
}

template <class S>
void BodyDynamics<S>::removeMomentum(const std::function<std::array<double, 3>(std::size_t)>& impulse,
                                     const std::vector<std::array<double, 3>>& more, std::vector<HeldPoint<S>>* held) {
  assert(more.empty() || more.size() == motions_.size());
  const auto componentOf = [&](const HeldPoint<S>& point) {
    return partOf_[matrix_.slotOf(static_cast<std::size_t>(point.nodes[0]))];
  };
  std::vector<Resistance> resistance(motions_.size(), Resistance::Zero());
  if (held) {
    for (const HeldPoint<S>& point : *held) {
      const std::uint32_t component = componentOf(point);
      const Eigen::Map<const Eigen::Matrix3d> stiffness(point.stiffness.data());
      motions_[component].addResistance(placeOf(point), stiffness, resistance[component]);
    }
  }
  const std::vector<ComponentMomentum> now = momentaNow();
  std::vector<Eigen::Vector3d> impulses(motions_.size(), Eigen::Vector3d::Zero()), torques = impulses;
  for (std::size_t k = 0; k < more.size(); ++k) torques[k] = Eigen::Vector3d(more[k][0], more[k][1], more[k][2]);
  for (std::size_t n = 0; impulse && n < nodeCount(); ++n) {
    const std::size_t slot = matrix_.slotOf(n), component = partOf_[slot];
    if (matrix_.massAt(slot) == S(0)) continue;
    const double* x = places_.at(slot);
    const std::array<double, 3> from = impulse(n);
    const Eigen::Vector3d given(from[0], from[1], from[2]);
    impulses[component] += given;
    torques[component] += (Eigen::Vector3d(x[0], x[1], x[2]) - motions_[component].about()).cross(given);
  }
  std::vector<RigidVelocity> excess;
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    excess.push_back(motions_[k].excess(now[k], impulses[k], torques[k], resistance[k]));
  }
  if (held) {
    for (HeldPoint<S>& point : *held) {
      double v[3];
      const Eigen::Vector3d place = placeOf(point);
      excess[componentOf(point)].at(place.data(), v);
      for (std::size_t k = 0; k < 3; ++k) point.change[k] = -v[k];
    }
  }
  changeSolution(excess, [](S own, S wrong) { return own - wrong; });
}

template <class S>
void BodyDynamics<S>::carry(bool turns, const std::array<double, 9>& turn, const std::array<double, 3>& by) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  for (int k = 0; k < 9 && turns; ++k) rotation(k / 3, k % 3) = turn[static_cast<std::size_t>(k)];
  const Eigen::Vector3d translation(by[0], by[1], by[2]);
  places_.carry(turns, rotation, translation);
  for (ComponentMotion& motion : motions_) motion.carry(rotation, translation);
  if (!turns) return;
  const std::vector<std::array<double, 9>> ofAll{turn};
  if (history_.isKnown()) history_.turn(ofAll, partOf_);
  turnWide(matrix_.solution(), ofAll, partOf_);
  for (AlignedVector<S>* solution : guess_.known()) {
    if (solution) turnWide(solution->data(), ofAll, partOf_);
  }
  const Eigen::Matrix<S, 3, 3> rounded = rotation.template cast<S>();
  for (std::size_t slot = 0; slot < matrix_.slotCount(); ++slot) {
    Eigen::Map<Eigen::Matrix<S, 3, 1>> v(&velocities_[4 * slot]);
    v = (rounded * v).eval();
  }
}

/// Earlier steps are written only if the next one would use them.
template <class S>
bool BodyDynamics<S>::visitState(StateStream& stream, bool outdated, bool continues) {
  bool deterministic = deterministic_;
  stream(deterministic);
  setDeterministic(deterministic);  // a step that found it changed would make the matrix anew
  bool changed = changed_ || outdated;
  bool known = history_.isKnown() && remembered_ && continues && !changed;
  double alpha = alpha_;
  stream(changed);
  stream(known);
  stream(alpha);
  stream(stiffnessOverInertia_);
  stream(untouched_);
  stream(lastSeconds_);
  for (ComponentMotion& motion : motions_) motion.visitState(stream);
  places_.visitState(stream);
  const bool turned = tets_ && tets_->visitState(stream, static_cast<S>(alpha), !changed);
  if (tets_) matrix_.visitWide(stream, matrix_.solution());
  guess_.visitState(stream, matrix_);
  stream(twoLevelSolves_);
  if (stream.restoring()) {
    if (!changed && (changed_ || turned || alpha != alpha_)) {
      matrix_.assemble(tets_ ? tets_->cornersAgain(static_cast<S>(alpha), nullptr) : nullptr,
                       tets_ ? tets_->ratio() : S(0), nullptr);
      findUnitImpulses(nullptr);
    }
    alpha_ = alpha;
    changed_ = changed;
    remembered_ = known;
    history_.forget();
    stage_ = Stage::Before;
  }
  if (!known) return false;
  stream(length_);
  stream(near_);
  history_.visitState(stream, matrix_);
  return true;
}

template <class S>
void BodyDynamics<S>::reached(std::size_t node, S* velocity) const {
  const std::size_t slot = matrix_.slotOf(node), wide = matrix_.wideOfSlot(slot);
  for (std::size_t k = 0; k < 3; ++k) {
    velocity[k] = velocities_[4 * slot + k] + matrix_.solution()[wide + k * kGroup];
  }
}

template <class S>
void BodyDynamics<S>::arrive(std::size_t node, const S* velocity) {
  const std::size_t slot = matrix_.slotOf(node), wide = matrix_.wideOfSlot(slot);
  for (std::size_t k = 0; k < 3; ++k) {
    velocities_[4 * slot + k] = velocity[k] - matrix_.solution()[wide + k * kGroup];
  }
}

TETSKIN_INSTANTIATE_CLASS(BodyDynamics)

}  // namespace tetskin::elastic_detail
