// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/rows/fixed_nodes.h>
#include <tetskin/solver/src/system/step_fraction.h>
#include <tetskin/solver/src/system/system_solve.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>

namespace tetskin::bullet_detail {
namespace {

/// A bound that few steps reach. It must not be one that most do, as each pass that is missing adds energy: with 3, in
/// `tetskin_measure` rest/box/k50 never rests (nodes at 0.03 m/s), and stop/equal steps slides 8 % too far.
constexpr int kMaxPasses = 30;
/// Passes from which on the derivative of sliding is used, up to a tenth, and the length of a step from which on it is.
constexpr int kPassesBeforeDerivative = 2;
constexpr btScalar kKept = btScalar(0.1), kLongStep = btScalar(0.9);
/// Passes from which on bounds of friction are means of those before and the new ones, and the share of the new: where
/// friction jams a body between two others, its bound swings from pass to pass about the one that agrees with itself.
/// Without them, 80 of 720 steps of 50 balls in the pit of `tetskin_pile` do not converge.
constexpr int kPassesBeforeMeans = 6;
constexpr btScalar kNewBound = btScalar(0.5);
/// A solve has converged if the residual is at most this multiple of the tolerance.
constexpr double kAccepted = 3.0;
/// Share of the squared residual that a pass may leave to the next one, in bodies that it does not move.
constexpr double kLeftShare = 1e-3;
/// Sum of the impulses' sizes on a body, over the size of their sum, from which on it counts as squeezed. The error
/// that a solve leaves is a share of the impulses: if a light body between heavy ones took it up, it would keep
/// shaking, by tens of its sizes per second under 100 times its mass. Joints do not count: they hold what spins around
/// what it is joined to, as a tyre its hub, and impulses that were changed would turn the other body.
constexpr double kSqueezed = 30.0;

}  // namespace

SystemSolve::SystemSolve(const SystemInput& input, const SolvedSystem& system, ParallelFor* threads)
    : in_(input), system_(system), threads_(threads) {
  assert(!system.bodies.empty());
  joinsSoft_ = std::any_of(system.rows.begin(), system.rows.end(),
                           [](const ContactRow* row) { return row->ends[0].isSoft() && row->ends[1].isSoft(); });
  collectBodies();
  collectEnds();
  numberRigids();
  collectComponents();
  forEachBody([&](Body& body, ParallelFor*) {
    moveIntoComponents(body);
    readSolution(body);
  });
}

void SystemSolve::collectBodies() {
  bodies_.reserve(system_.bodies.size());
  for (std::size_t k = 0; k < system_.bodies.size(); ++k) {
    Body& body = bodies_.emplace_back(system_.bodies[k], in_.bodies.bodies()[system_.bodies[k]]);
    body.solved.place = k;
    sizes_.push_back(body.matrix().slotCount());
  }
}

void SystemSolve::collectEnds() {
  const std::size_t count = system_.rows.size();
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> ends(bodies_.size());  // of each body: row and index
  for (const std::size_t index : {std::size_t{0}, std::size_t{1}}) {
    for (std::size_t r = 0; r < count; ++r) {
      const RowEnd& end = system_.rows[r]->ends[index];
      if (end.isSoft()) ends[in_.bodies.bodies()[end.body].place].emplace_back(r, index);
    }
  }
  forEachBody([&](Body& body, ParallelFor*) {
    for (const auto& [r, index] : ends[body.solved.place]) body.ends.add(r, index, pointOf(r, index));
  });
  endVelocities_.assign(count, {btVector3(0, 0, 0), btVector3(0, 0, 0)});
  endSteps_ = endVelocities_;
  before_.assign(count, btVector3(0, 0, 0));
  stepped_ = before_;
}

SolveReport SystemSolve::solve() {
  SolveReport report;
  auto& solve = *bodies_.front().solved.solve;
  findResiduals();
  beginBounds();
  btScalar length = 1;
  for (int pass = 0;; ++pass) {
    const bool derivative = pass >= kPassesBeforeDerivative && length > kLongStep;
    evaluateRows(derivative ? kKept : btScalar(1), pass == 0);
    const bool done = start(pass);
    const bool last = pass == (system_.rows.empty() ? 1 : kMaxPasses);
    if (pass > 0 && (done || last || system_.rows.empty())) {
      report.converged = done || system_.rows.empty();
      break;
    }
    ++report.passes;
    solve.iterate(std::numeric_limits<int>::max(), threads_);  // up to the limits of `start`
    report.iterations += solve.iterations();
    if (system_.rows.empty()) break;
    moveReduced();
    length = derivative ? searchLine() : btScalar(1);
    if (length < 1) moveBack(length);
    if (!derivative || length < 1) findResiduals();
    refreshBounds(pass < kPassesBeforeMeans ? btScalar(1) : kNewBound);
  }
  if (!system_.rows.empty()) settleReduced();
  forEachBody([&](Body& body, ParallelFor*) {
    body.matrix().free();
    moveOutOfComponents(body);
  });
  giveMomentum();
  return report;
}

/// Estimates the impulse on each point in this step, as if there were no other: the first bounds of friction.
void SystemSolve::beginBounds() {
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    ContactRow& row = *system_.rows[r];
    if (row.normalBound > 0 || row.joined || !row.ends[0].isSoft()) continue;
    const btScalar towards = row.normal.dot(velocityOf(r)) + row.gapVelocity;
    row.normalBound = row.effectiveMass * std::max(-towards, btScalar(0));
  }
}

// ---- a pass

/// Computes what the body's solution means for rows and components.
void SystemSolve::readSolution(Body& body) {
  for (const BodyEnd& end : body.ends.list()) endVelocities_[end.row][end.index] = body.ends.velocity(end);
  for (std::size_t c = body.firstComponent; c < body.lastComponent; ++c) {
    setPart(images_, components_[c], components_[c].imageProducts(body.matrix().solution()));
  }
}

/// Computes the residuals without rows.
void SystemSolve::findResiduals() {
  if (!system_.forces.empty()) in_.others.multiplySolutions(system_);
  forEachBody([&](Body& body, ParallelFor* inner) {
    body.matrix().free();
    if (!body.moves) {
      std::copy(body.residual.begin(), body.residual.end(), body.matrix().residual());
      return;
    }
    body.dynamics().findResidual(inner);
    in_.others.addResiduals(system_, body.index);
    for (std::size_t c = body.firstComponent; c < body.lastComponent; ++c) {
      components_[c].addImages(-partOf(reduced_, components_[c]), body.matrix().residual());
    }
  });
}

void SystemSolve::evaluateRows(btScalar kept, bool first) {
  forEachRow([&](std::size_t r) {
    ContactRow& row = *system_.rows[r];
    before_[r] = velocityOf(r);
    row.slip = before_[r] - row.normal.dot(before_[r]) * row.normal;
    row.impulse = impulseAt(row, before_[r], first && row.stuck, row.state);
    row.tangent = tangentAt(row, before_[r], row.state, kept);
  });
}

btVector3 SystemSolve::velocityOf(std::size_t r) const {
  const EndVelocities& ends = endVelocities_[r];
  const btVector3 own = system_.rows[r]->relative + (ends[0] - ends[1]);
  return reducedSize_ > 0 ? own + reducedVelocity(r, reduced_) : own;
}

/// Makes the pass's linear system, and begins its solve. Returns whether there is nothing left to solve.
bool SystemSolve::start(int pass) {
  findReducedResiduals();
  forEachBody([&](Body& body, ParallelFor*) { addRows(body); });
  const elastic_detail::SolveLimits limits = system_.rows.empty() ? limitsWithoutRows() : limitsOfPass(pass);
  eliminate();
  elastic_detail::ConjugateGradient<btScalar>::Matrices matrices;
  for (const Body& body : bodies_) matrices.push_back(&body.matrix());
  auto& solve = *bodies_.front().solved.solve;
  const bool coupled = !system_.forces.empty() || reducedSize_ > 0 || joinsSoft_;
  solve.start(std::move(matrices), limits, coupled ? this : nullptr, threads_);
  const double accepted = kAccepted * kAccepted * limits.enough;
  double squared = solve.squaredResidual();
  if (reducedSize_ > 0) squared += dotOfFirst(reducedSize_, reducedResidual_, schurComplement_.solve(reducedResidual_));
  chooseMoving();
  return squared <= accepted;
}

/// Bodies with a small share of the residual keep their velocities in this pass; at least one moves.
void SystemSolve::chooseMoving() {
  moving_.clear();
  auto& solve = *bodies_.front().solved.solve;
  const bool all = reducedSize_ > 0 || !system_.forces.empty() || system_.rows.empty();
  std::vector<std::size_t> order(bodies_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return solve.squaredResidualOf(a) < solve.squaredResidualOf(b);
  });
  double left = 0.0;
  const double most = kLeftShare * solve.squaredResidual();
  for (Body& body : bodies_) body.moves = true;
  for (std::size_t place = 0; place + 1 < order.size() && !all; ++place) {
    left += solve.squaredResidualOf(order[place]);
    if (!(left <= most)) break;
    bodies_[order[place]].moves = false;
  }
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (bodies_[k].moves) {
      moving_.push_back(k);
    } else {
      for (const std::uint32_t e : bodies_[k].coupled) {
        const BodyEnd& end = bodies_[k].ends.list()[e];
        endSteps_[end.row][end.index].setZero();
      }
    }
  }
  if (moving_.size() < bodies_.size()) solve.keepOnly(moving_);
}

/// Keeps the body's state, and adds the rows to its residual and matrix.
void SystemSolve::addRows(Body& body) {
  auto& matrix = body.matrix();
  if (!system_.rows.empty()) {  // without rows, there is one pass
    body.solution.assign(matrix.solution(), matrix.solution() + matrix.wideSize());
    body.residual.assign(matrix.residual(), matrix.residual() + matrix.wideSize());
    body.byMatrix = body.dynamics().squaredByMatrix();
    body.byMasses = body.dynamics().squaredChange();
  }
  for (const BodyEnd& end : body.ends.list()) {
    const btVector3& impulse = system_.rows[end.row]->impulse;
    if (!impulse.isZero()) body.ends.addImpulse(end, btScalar(signOf(end.index)) * impulse, matrix.residual());
  }
  matchComponents(body);
  body.ends.addTangents(system_.rows);
  fixNodes(body.solved);
  listCoupled(body);
}

/// The matrices contain the blocks of each end with itself.
void SystemSolve::listCoupled(Body& body) const {
  body.coupled.clear();
  std::vector<BodyEnd>& ends = body.ends.list();
  for (std::size_t e = 0; e < ends.size(); ++e) {
    BodyEnd& end = ends[e];
    const ContactRow& row = *system_.rows[end.row];
    if (row.state == ContactRow::State::Apart) continue;
    end.byOther = row.ends[1 - end.index].isSoft();
    end.byReduced = reducedSize_ > 0 && couplesReduced(end.row);
    if (end.byOther || end.byReduced) body.coupled.push_back(static_cast<std::uint32_t>(e));
  }
}

/// Bounds friction by the normal impulses of the current pass.
/// share  of these in the bounds; the rest is that of the bounds before
void SystemSolve::refreshBounds(btScalar share) {
  assert(stepped_.size() == system_.rows.size() && share > 0 && share <= 1);
  forEachRow([&](std::size_t r) {
    ContactRow& row = *system_.rows[r];
    const btVector3 impulse = row.impulse - row.tangent * stepped_[r];
    const btScalar bound = std::max(row.normal.dot(impulse), btScalar(0));
    row.normalBound = share < 1 ? row.normalBound + share * (bound - row.normalBound) : bound;
  });
}

// ---- line search: sliding is nonlinear, and the pass has linearized it

/// The derivative, along the pass's step, of the energy that the solve minimizes.
double SystemSolve::slope(btScalar fraction, double linear, double quadratic) const {
  assert(before_.size() == system_.rows.size() && stepped_.size() == system_.rows.size());
  double sum = linear + static_cast<double>(fraction) * quadratic;
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    ContactRow::State state{};
    const btVector3 impulse = impulseAt(row, before_[r] + fraction * stepped_[r], false, state);
    sum -= dot(toSmall(impulse - row.given), toSmall(stepped_[r]));
  }
  return sum;
}

/// The fraction of the pass's step to take.
btScalar SystemSolve::searchLine() {
  findResiduals();
  Vector rigidBefore = rigidMomentum_;
  addTimes(-1.0, rigidPush_, rigidBefore);
  double linear = dotOfFirst(rigidSize_, reducedStep_, rigidBefore);
  double quadratic = dotOfFirst(rigidSize_, reducedStep_, rigidPush_);
  forEachBody([](Body& body, ParallelFor*) {
    const auto& matrix = body.matrix();
    const btScalar *solution = matrix.solution(), *residual = body.matrix().residual();
    body.linear = body.quadratic = 0.0;
    for (std::size_t i = 0; i < matrix.wideSize(); ++i) {
      const auto step = static_cast<double>(solution[i] - body.solution[i]);
      const auto before = static_cast<double>(body.residual[i]);
      body.linear -= step * before;
      body.quadratic += step * (before - static_cast<double>(residual[i]));
    }
  });
  for (const Body& body : bodies_) {
    linear += body.linear;
    quadratic += body.quadratic;
  }
  for (const ComponentUnknown& component : components_) {
    const Small6 step = partOf(reducedStep_, component), was = partOf(partsBefore_, component);
    linear += dot(step, was - component.began);
    quadratic += dot(step, momentumOf(component) - was);
  }
  return static_cast<btScalar>(
      stepFraction([&](double fraction) { return slope(static_cast<btScalar>(fraction), linear, quadratic); }));
}

void SystemSolve::moveBack(btScalar fraction) {
  assert(fraction >= 0 && fraction <= 1);
  forEachBody([&](Body& body, ParallelFor*) {
    btScalar* solution = body.matrix().solution();
    for (std::size_t i = 0; i < body.matrix().wideSize(); ++i) {
      solution[i] = body.solution[i] + fraction * (solution[i] - body.solution[i]);
    }
    readSolution(body);
  });
  const auto rest = static_cast<double>(1 - fraction);
  addTimes(-rest, reducedStep_, reduced_);
  addTimes(-rest, rigidPush_, rigidMomentum_);
  for (btVector3& step : stepped_) step *= fraction;
}

// ---- finish

/// True if a joint connects the body to an object whose motion is prescribed. Such an object takes up any momentum, and
/// a point with a joint of that stiffness depends on where in the step its impulse acts.
bool SystemSolve::isHung(const Body& body) const {
  return std::any_of(body.ends.list().begin(), body.ends.list().end(), [&](const BodyEnd& end) {
    const ContactRow& row = *system_.rows[end.row];
    return end.index == 0 && row.joined && !row.constant && row.ends[1].rigid.unknown < 0;
  });
}

/// Removes from soft bodies the momentum error of a solve that is cut short, and adds the sum of the rows' impulses to
/// rigid ones. Where other forces act on the system, their share is unknown here.
void SystemSolve::giveMomentum() {
  if (system_.rows.empty()) return;
  if (system_.forces.empty()) {
    forEachBody([&](Body& body, ParallelFor*) {
      if (body.solved.elastic && body.solved.fixed.empty() && !isHung(body)) removeMomentumError(body);
    });
  }
  Vector push = zeros(reducedSize_);
  for (const std::size_t r : reducedRows_) {
    const ContactRow& row = *system_.rows[r];
    const btVector3 more = row.impulse - row.given;
    for (std::size_t e = 0; e < 2; ++e) in_.rigids.addImpulse(row.ends[e].rigid, btScalar(signOf(e)) * more, push);
  }
  const Vector change = schurComplement_.timesInverseMass(std::move(push));
  for (const std::size_t r : system_.rigids) RigidUnknowns::apply(in_.rigids.list()[r], change);
}

void SystemSolve::removeMomentumError(Body& body) const {
  std::vector<std::array<double, 3>> impulses(body.dynamics().nodeCount(), {0.0, 0.0, 0.0});
  std::vector<std::array<double, 3>> torques(body.dynamics().componentCount(), {0.0, 0.0, 0.0});
  Small3 net;
  double pressed = 0.0;
  for (const BodyEnd& of : body.ends.list()) {
    const CarriedPoint& point = pointOf(of.row, of.index);
    const btVector3 impulse = btScalar(signOf(of.index)) * system_.rows[of.row]->impulse;
    const ContactRow& row = *system_.rows[of.row];
    if (row.joined) {
      addTorqueOfGap(body, of, impulse, torques);
    } else {
      net += toSmall(impulse);
      pressed += norm(toSmall(impulse));
    }
    for (std::uint32_t n = 0; n < point.count; ++n) {
      auto& to = impulses[static_cast<std::size_t>(point.nodes[n])];
      for (std::size_t k = 0; k < 3; ++k) {
        to[k] += static_cast<double>(point.weights[n]) * static_cast<double>(impulse[static_cast<int>(k)]);
      }
    }
  }
  std::vector<HeldPoint> held;
  std::vector<ContactRow*> rows;
  if (pressed > kSqueezed * norm(net)) findHeld(body, held, rows);
  body.dynamics().removeMomentum([&](std::size_t node) { return impulses[node]; }, torques, &held);
  for (std::size_t k = 0; k < held.size(); ++k) {
    const btVector3 change = fromSmall({{held[k].change[0], held[k].change[1], held[k].change[2]}});
    rows[k]->impulse -= rows[k]->tangent * change;
    rows[k]->slip += change - rows[k]->normal.dot(change) * rows[k]->normal;
  }
}

/// What a joint gives to a rigid body acts at its point of that body, from which the soft body's may have gone astray:
/// the two are to get opposite torques.
void SystemSolve::addTorqueOfGap(const Body& body, const BodyEnd& end, const btVector3& impulse,
                                 std::vector<std::array<double, 3>>& torques) const {
  const ContactRow& row = *system_.rows[end.row];
  if (end.index != 0 || row.constant || row.ends[1].rigid.unknown < 0) return;
  const CarriedPoint& point = pointOf(end.row, 0);
  const btVector3 gap = in_.rows.originOf(row).position - point.position(*body.solved.body);
  const btVector3 torque = gap.cross(impulse);
  std::array<double, 3>& to = torques[body.solved.dynamics->componentOf(static_cast<std::size_t>(point.nodes[0]))];
  for (int k = 0; k < 3; ++k) to[static_cast<std::size_t>(k)] += static_cast<double>(torque[k]);
}

/// The contacts with rigid objects that resist a motion of the whole body. Contacts with soft bodies keep their
/// impulses, as these count for two bodies.
void SystemSolve::findHeld(const Body& body, std::vector<HeldPoint>& held, std::vector<ContactRow*>& rows) const {
  for (const BodyEnd& of : body.ends.list()) {
    ContactRow& row = *system_.rows[of.row];
    if (of.index != 0 || row.ends[1].isSoft() || row.constant || row.state == ContactRow::State::Apart) continue;
    const CarriedPoint& carried = pointOf(of.row, 0);
    HeldPoint& point = held.emplace_back();
    point.nodes = carried.nodes.data();
    point.weights = carried.weights.data();
    point.nodeCount = carried.count;
    for (int k = 0; k < 9; ++k) {
      point.stiffness[static_cast<std::size_t>(k)] = static_cast<double>(row.tangent[k / 3][k % 3]);
    }
    rows.push_back(&row);
  }
}

}  // namespace tetskin::bullet_detail
