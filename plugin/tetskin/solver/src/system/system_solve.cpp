// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/rows/fixed_nodes.h>
#include <tetskin/solver/src/system/step_fraction.h>
#include <tetskin/solver/src/system/system_limits.h>
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

// ---- what a solve that is cut short leaves of momentum

using HeldPoint = elastic_detail::HeldPoint<btScalar>;

/// True if a joint connects the body to an object whose motion is prescribed. Such an object takes up any momentum, and
/// a point with a joint of that stiffness depends on where in the step its impulse acts.
bool isHung(const SystemBodies& bodies, const SystemBody& body) {
  return std::any_of(body.ends.list().begin(), body.ends.list().end(), [&](const BodyEnd& end) {
    const ContactRow& row = bodies.row(end.row);
    return end.index == 0 && row.joined && !row.constant && row.ends[1].rigid.unknown < 0;
  });
}

/// What a joint gives to a rigid body acts at its point of that body, from which the soft body's may have gone astray:
/// the two are to get opposite torques.
void addTorqueOfGap(const SystemBodies& bodies, const SystemBody& body, const BodyEnd& end, const btVector3& impulse,
                    std::vector<std::array<double, 3>>& torques) {
  const ContactRow& row = bodies.row(end.row);
  if (end.index != 0 || row.constant || row.ends[1].rigid.unknown < 0) return;
  const CarriedPoint& point = bodies.pointOf(end.row, 0);
  const btVector3 gap = bodies.input().rows.originOf(row).position - point.position(*body.solved.body);
  const btVector3 torque = gap.cross(impulse);
  std::array<double, 3>& to = torques[body.solved.dynamics->componentOf(static_cast<std::size_t>(point.nodes[0]))];
  for (int k = 0; k < 3; ++k) to[static_cast<std::size_t>(k)] += static_cast<double>(torque[k]);
}

/// The contacts with rigid objects that resist a motion of the whole body. Contacts with soft bodies keep their
/// impulses, as these count for two bodies.
void findHeld(const SystemBodies& bodies, const SystemBody& body, std::vector<HeldPoint>& held,
              std::vector<ContactRow*>& rows) {
  for (const BodyEnd& of : body.ends.list()) {
    ContactRow& row = bodies.row(of.row);
    if (of.index != 0 || row.ends[1].isSoft() || row.constant || row.state == ContactRow::State::Apart) continue;
    const CarriedPoint& carried = bodies.pointOf(of.row, 0);
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

void removeMomentumError(const SystemBodies& bodies, const SystemBody& body) {
  std::vector<std::array<double, 3>> impulses(body.dynamics().nodeCount(), {0.0, 0.0, 0.0});
  std::vector<std::array<double, 3>> torques(body.dynamics().componentCount(), {0.0, 0.0, 0.0});
  Small3 net;
  double pressed = 0.0;
  for (const BodyEnd& of : body.ends.list()) {
    const CarriedPoint& point = bodies.pointOf(of.row, of.index);
    const btVector3 impulse = btScalar(signOf(of.index)) * bodies.row(of.row).impulse;
    const ContactRow& row = bodies.row(of.row);
    if (row.joined) {
      addTorqueOfGap(bodies, body, of, impulse, torques);
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
  if (pressed > kSqueezed * norm(net)) findHeld(bodies, body, held, rows);
  body.dynamics().removeMomentum([&](std::size_t node) { return impulses[node]; }, torques, &held);
  assert(rows.size() == held.size());
  for (std::size_t k = 0; k < held.size(); ++k) {
    const btVector3 change = fromSmall({{held[k].change[0], held[k].change[1], held[k].change[2]}});
    rows[k]->impulse -= rows[k]->tangent * change;
    rows[k]->slip += change - rows[k]->normal.dot(change) * rows[k]->normal;
  }
}

/// Removes the momentum error of soft bodies. Where other forces act on the system, their share is unknown here.
void removeMomentumErrors(SystemBodies& bodies) {
  if (bodies.hasForces()) return;
  bodies.forEachBody([&](SystemBody& body, ParallelFor*) {
    if (body.solved.elastic && body.solved.acted.fixed.empty() && !isHung(bodies, body))
      removeMomentumError(bodies, body);
  });
}

}  // namespace

SystemSolve::SystemSolve(const SystemInput& input, const SolvedSystem& system, ParallelFor* threads)
    : bodies_(input, system, threads),
      reduced_(bodies_),
      products_(bodies_, reduced_),
      gradient_(bodies_.list().front().solved.memory->gradient),
      endVelocities_(bodies_.rowCount(), {btVector3(0, 0, 0), btVector3(0, 0, 0)}),
      before_(bodies_.rowCount(), btVector3(0, 0, 0)),
      stepped_(before_) {
  bodies_.forEachBody([&](SystemBody& body, ParallelFor*) { readSolution(body); });
}

SolveReport SystemSolve::solve() {
  const SolveReport report = bodies_.hasRows() ? solvePasses() : solveOnce();
  bodies_.forEachBody([&](SystemBody& body, ParallelFor*) {
    body.matrix().free();
    reduced_.moveOut(body);
  });
  if (!bodies_.hasRows()) return report;
  removeMomentumErrors(bodies_);
  reduced_.apply();
  return report;
}

/// Without rows, everything is linear.
SolveReport SystemSolve::solveOnce() {
  const Step step = solve(reduce(linearise(findResiduals(), 0)));
  SolveReport report;
  report.iterations = step.iterations;
  report.passes = 1;
  return report;
}

SolveReport SystemSolve::solvePasses() {
  SolveReport report;
  Residuals residuals = findResiduals();
  beginBounds();
  for (int pass = 0;; ++pass) {
    const Reduced reduced = reduce(linearise(residuals, pass));
    if (pass > 0 && (reduced.isSolved || pass == kMaxPasses)) {
      report.converged = reduced.isSolved;
      break;
    }
    ++report.passes;
    const Step step = solve(reduced);
    report.iterations += step.iterations;
    residuals = take(step);
    refreshBounds(pass < kPassesBeforeMeans ? btScalar(1) : kNewBound);
  }
  reduced_.settle();
  return report;
}

/// Estimates the impulse on each point in this step, as if there were no other: the first bounds of friction.
void SystemSolve::beginBounds() {
  for (std::size_t r = 0; r < bodies_.rowCount(); ++r) {
    ContactRow& row = bodies_.row(r);
    if (row.normalBound > 0 || row.joined || !row.ends[0].isSoft()) continue;
    const btScalar towards = row.normal.dot(velocityOf(r)) + row.gapVelocity;
    row.normalBound = row.effectiveMass * std::max(-towards, btScalar(0));
  }
}

// ---- residuals

void SystemSolve::readSolution(const SystemBody& body) {
  for (const BodyEnd& end : body.ends.list()) endVelocities_[end.row][end.index] = body.ends.velocity(end);
  reduced_.readSolution(body);
}

btVector3 SystemSolve::velocityOf(std::size_t r) const {
  const EndVelocities& ends = endVelocities_[r];
  const btVector3 own = bodies_.row(r).relative + (ends[0] - ends[1]);
  return reduced_.empty() ? own : own + reduced_.velocity(r);
}

SystemSolve::Residuals SystemSolve::findResiduals() {
  OtherForces& others = bodies_.input().others;
  if (bodies_.hasForces()) others.multiplySolutions(bodies_.system());
  bodies_.forEachBody([&](SystemBody& body, ParallelFor* inner) {
    body.matrix().free();
    if (!body.moves) {
      std::copy(body.start.residual.begin(), body.start.residual.end(), body.matrix().residual());
      return;
    }
    body.dynamics().findResidual(inner);
    others.addResiduals(bodies_.system(), body.index);
    reduced_.addImages(body);
  });
  return {};
}

// ---- a pass: linear rows

SystemSolve::Linearised SystemSolve::linearise(const Residuals& residuals, int pass) {
  assert(pass >= 0 && residuals.length >= 0 && residuals.length <= 1);
  Linearised linearised;
  linearised.derivative = pass >= kPassesBeforeDerivative && residuals.length > kLongStep;
  evaluateRows(linearised.derivative ? kKept : btScalar(1), pass == 0);
  reduced_.findResidual();
  bodies_.forEachBody([&](SystemBody& body, ParallelFor*) { addRows(body); });
  linearised.limits = bodies_.hasRows() ? limitsOfPass(bodies_, reduced_, pass) : limitsWithoutRows(bodies_);
  return linearised;
}

void SystemSolve::evaluateRows(btScalar kept, bool first) {
  bodies_.forEachRow([&](std::size_t r) {
    ContactRow& row = bodies_.row(r);
    before_[r] = velocityOf(r);
    row.slip = before_[r] - row.normal.dot(before_[r]) * row.normal;
    row.impulse = impulseAt(row, before_[r], first && row.stuck, row.state);
    row.tangent = tangentAt(row, before_[r], row.state, kept);
  });
}

/// Keeps the body's state, and adds the rows to its residual and matrix.
void SystemSolve::addRows(SystemBody& body) {
  auto& matrix = body.matrix();
  if (bodies_.hasRows()) {  // without rows, there is one pass
    body.start.solution.assign(matrix.solution(), matrix.solution() + matrix.wideSize());
    body.start.residual.assign(matrix.residual(), matrix.residual() + matrix.wideSize());
    body.start.byMatrix = body.dynamics().squaredByMatrix();
    body.start.byMasses = body.dynamics().squaredChange();
  }
  for (const BodyEnd& end : body.ends.list()) {
    const btVector3& impulse = bodies_.row(end.row).impulse;
    if (!impulse.isZero()) body.ends.addImpulse(end, btScalar(signOf(end.index)) * impulse, matrix.residual());
  }
  reduced_.matchComponents(body);
  body.ends.addTangents(bodies_.system().rows);
  fixNodes(body.solved);
  listCoupled(body);
}

/// The matrices contain the blocks of each end with itself.
void SystemSolve::listCoupled(SystemBody& body) const {
  body.coupled.clear();
  std::vector<BodyEnd>& ends = body.ends.list();
  for (std::size_t e = 0; e < ends.size(); ++e) {
    BodyEnd& end = ends[e];
    const ContactRow& row = bodies_.row(end.row);
    if (row.state == ContactRow::State::Apart) continue;
    end.byOther = row.ends[1 - end.index].isSoft();
    end.byReduced = !reduced_.empty() && reduced_.couples(end.row);
    if (end.byOther || end.byReduced) body.coupled.push_back(static_cast<std::uint32_t>(e));
  }
}

// ---- a pass: the linear system

SystemSolve::Reduced SystemSolve::reduce(const Linearised& linearised) {
  reduced_.eliminate();
  elastic_detail::ConjugateGradient<btScalar>::Matrices matrices;
  for (const SystemBody& body : bodies_.list()) matrices.push_back(&body.matrix());
  const bool coupled = bodies_.hasForces() || !reduced_.empty() || bodies_.joinsSoft();
  gradient_.start(std::move(matrices), linearised.limits, coupled ? &products_ : nullptr, bodies_.threads());
  const double accepted = kAccepted * kAccepted * linearised.limits.enough;
  const double squared = gradient_.squaredResidual() + reduced_.squaredResidual();
  chooseMoving();
  return {linearised.derivative, squared <= accepted};
}

/// Bodies with a small share of the residual keep their velocities in this pass; at least one moves.
void SystemSolve::chooseMoving() {
  const bool all = !reduced_.empty() || bodies_.hasForces() || !bodies_.hasRows();
  std::vector<SystemBody>& list = bodies_.list();
  std::vector<std::size_t> order(list.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return gradient_.squaredResidualOf(a) < gradient_.squaredResidualOf(b);
  });
  double left = 0.0;
  const double most = kLeftShare * gradient_.squaredResidual();
  for (SystemBody& body : list) body.moves = true;
  for (std::size_t place = 0; place + 1 < order.size() && !all; ++place) {
    left += gradient_.squaredResidualOf(order[place]);
    if (!(left <= most)) break;
    list[order[place]].moves = false;
  }
  std::vector<std::size_t> moving;
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (list[k].moves) moving.push_back(k);
  }
  if (moving.size() < list.size()) gradient_.keepOnly(moving);
  products_.begin(std::move(moving));
}

/// Up to the limits of the pass.
SystemSolve::Step SystemSolve::solve(const Reduced& reduced) {
  gradient_.iterate(std::numeric_limits<int>::max(), bodies_.threads());
  const Step step{reduced.derivative, gradient_.iterations()};
  if (!bodies_.hasRows()) return step;
  bodies_.forEachBody([&](SystemBody& body, ParallelFor*) {
    if (body.moves) readSolution(body);
  });
  const auto findSteps = [&] { bodies_.forEachRow([&](std::size_t r) { stepped_[r] = velocityOf(r) - before_[r]; }); };
  findSteps();
  reduced_.move(stepped_);
  if (!reduced_.empty()) findSteps();
  reduced_.takeBack(stepped_);
  return step;
}

// ---- a pass: its step

SystemSolve::Residuals SystemSolve::take(const Step& step) {
  Residuals residuals = findResiduals();
  if (!step.derivative) return residuals;
  const btScalar length = searchLine(residuals);
  if (length < 1) {
    moveBack(length);
    residuals = findResiduals();
  }
  residuals.length = length;
  return residuals;
}

/// Bounds friction by the normal impulses of the current pass.
/// share  of these in the bounds; the rest is that of the bounds before
void SystemSolve::refreshBounds(btScalar share) {
  assert(stepped_.size() == bodies_.rowCount() && share > 0 && share <= 1);
  bodies_.forEachRow([&](std::size_t r) {
    ContactRow& row = bodies_.row(r);
    const btVector3 impulse = row.impulse - row.tangent * stepped_[r];
    const btScalar bound = std::max(row.normal.dot(impulse), btScalar(0));
    row.normalBound = share < 1 ? row.normalBound + share * (bound - row.normalBound) : bound;
  });
}

// ---- line search: sliding is nonlinear, and the pass has linearized it

/// The derivative, along the pass's step, of the energy that the solve minimizes.
double SystemSolve::slope(btScalar fraction, const Slope& of) const {
  assert(before_.size() == bodies_.rowCount() && stepped_.size() == bodies_.rowCount());
  double sum = of.linear + static_cast<double>(fraction) * of.quadratic;
  for (std::size_t r = 0; r < bodies_.rowCount(); ++r) {
    const ContactRow& row = bodies_.row(r);
    ContactRow::State state{};
    const btVector3 impulse = impulseAt(row, before_[r] + fraction * stepped_[r], false, state);
    sum -= dot(toSmall(impulse - row.given), toSmall(stepped_[r]));
  }
  return sum;
}

/// The fraction of the pass's step to take, by the residuals at its end.
btScalar SystemSolve::searchLine(const Residuals&) {
  Slope of = reduced_.slopeOfRigids();
  std::vector<Slope> slopes(bodies_.list().size());
  bodies_.forEachBody([&](SystemBody& body, ParallelFor*) {
    const auto& matrix = body.matrix();
    const btScalar *solution = matrix.solution(), *residual = body.matrix().residual();
    Slope& own = slopes[body.solved.solve.place];
    for (std::size_t i = 0; i < matrix.wideSize(); ++i) {
      const auto step = static_cast<double>(solution[i] - body.start.solution[i]);
      const auto before = static_cast<double>(body.start.residual[i]);
      own.linear -= step * before;
      own.quadratic += step * (before - static_cast<double>(residual[i]));
    }
  });
  for (const Slope& own : slopes) {
    of.linear += own.linear;
    of.quadratic += own.quadratic;
  }
  reduced_.addSlopeOfComponents(of);
  return static_cast<btScalar>(
      stepFraction([&](double fraction) { return slope(static_cast<btScalar>(fraction), of); }));
}

void SystemSolve::moveBack(btScalar fraction) {
  assert(fraction >= 0 && fraction <= 1);
  bodies_.forEachBody([&](SystemBody& body, ParallelFor*) {
    btScalar* solution = body.matrix().solution();
    for (std::size_t i = 0; i < body.matrix().wideSize(); ++i) {
      solution[i] = body.start.solution[i] + fraction * (solution[i] - body.start.solution[i]);
    }
    readSolution(body);
  });
  reduced_.moveBack(fraction);
  for (btVector3& step : stepped_) step *= fraction;
}

}  // namespace tetskin::bullet_detail
