// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/solver_contacts.h>
#include <tetskin/bullet/src/solver/system_solve.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

constexpr int kMaxPasses = 30;
/// Passes from which on the derivative of sliding is used, up to a tenth, and the length of a step from which on it is.
constexpr int kPassesBeforeDerivative = 2;
constexpr btScalar kKept = btScalar(0.1), kLongStep = btScalar(0.9);
/// A solve has converged if the residual is at most this multiple of the tolerance.
constexpr double kAccepted = 3.0;

/// Adds the upper triangle of the matrix.
void addSymmetric(const btMatrix3x3& m, btScalar factor, btScalar to[6]) {
  const btScalar entries[6] = {m[0][0], m[0][1], m[0][2], m[1][1], m[1][2], m[2][2]};
  for (int k = 0; k < 6; ++k) to[k] += factor * entries[k];
}

bool sameNodes(const RowEnd& a, const RowEnd& b) {
  return a.body == b.body && a.nodeCount == b.nodeCount &&
         std::equal(a.nodes.begin(), a.nodes.begin() + a.nodeCount, b.nodes.begin());
}

}  // namespace

SystemSolve::SystemSolve(DeformableSolver::Impl& step, const SolvedSystem& system, ParallelFor* threads)
    : step_(step), system_(system), threads_(threads) {
  assert(!system.bodies.empty());
  states_.resize(system.bodies.size());
  joinsSoft_ = std::any_of(system.rows.begin(), system.rows.end(),
                           [](const ContactRow* row) { return row->ends[0].isSoft() && row->ends[1].isSoft(); });
  numberRigids();
  collectComponents();
  moveIntoComponents();
}

SolvedBody& SystemSolve::bodyAt(std::size_t k) const {
  assert(k < system_.bodies.size());
  return step_.bodies.bodies()[system_.bodies[k]];
}

elastic_detail::BlockMatrix<btScalar>& SystemSolve::matrixOf(const RowEnd& end) const {
  assert(end.isSoft());
  return step_.bodies.bodies()[end.body].dynamics->matrix();
}

SolveReport SystemSolve::solve() {
  SolveReport report;
  auto& solve = *bodyAt(0).solve;
  beginBounds();
  btScalar length = 1;
  for (int pass = 0;; ++pass) {
    const bool derivative = pass >= kPassesBeforeDerivative && length > kLongStep;
    const btScalar kept = derivative ? kKept : btScalar(1);
    findResiduals();
    evaluateRows(kept, pass == 0);
    const bool done = start(pass);
    const bool last = pass == (system_.rows.empty() ? 1 : kMaxPasses);
    if (pass > 0 && (done || last || system_.rows.empty())) {
      report.converged = done || system_.rows.empty();
      break;
    }
    ++report.passes;
    solve.iterate(elastic_detail::SolveLimits{}.iterations, threads_);
    report.iterations += solve.iterations();
    if (system_.rows.empty()) break;
    moveFew();
    length = derivative ? searchLine() : btScalar(1);
    if (length < 1) moveBack(length);
    refreshBounds();
  }
  if (!system_.rows.empty()) settleFew();
  for (std::size_t k = 0; k < states_.size(); ++k) bodyAt(k).dynamics->matrix().free();
  moveOutOfComponents();
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

/// Computes the residuals without rows.
void SystemSolve::findResiduals() {
  for (std::size_t k = 0; k < states_.size(); ++k) {
    bodyAt(k).dynamics->matrix().free();
    bodyAt(k).dynamics->restart(threads_);
  }
  step_.addOtherResiduals(system_);
  for (const ComponentUnknown& component : components_) {
    component.addImages(-few_.segment<6>(component.first), dynamicsOf(component).matrix().residual());
  }
}

void SystemSolve::evaluateRows(btScalar kept, bool first) {
  before_.resize(system_.rows.size());
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    ContactRow& row = *system_.rows[r];
    before_[r] = velocityOf(r);
    row.slip = before_[r] - row.normal.dot(before_[r]) * row.normal;
    row.impulse = impulseAt(row, before_[r], first && row.stuck, row.state);
    row.tangent = tangentAt(row, before_[r], row.state, kept);
  }
}

btVector3 SystemSolve::nodesOf(const RowEnd& end, bool steps) const {
  btVector3 sum(0, 0, 0);
  if (!end.isSoft()) return sum;
  const auto& matrix = matrixOf(end);
  for (std::uint32_t k = 0; k < end.nodeCount; ++k) {
    const auto node = static_cast<std::size_t>(end.nodes[k]);
    sum += end.weights[k] * (steps ? fromPoint(matrix.stepPoints() + 4 * matrix.slotOf(node))
                                   : fromWide(matrix.solution() + matrix.wideOf(node)));
  }
  return sum;
}

btVector3 SystemSolve::nodesOf(const ContactRow& row, bool steps) const {
  return nodesOf(row.ends[0], steps) - nodesOf(row.ends[1], steps);
}

btVector3 SystemSolve::velocityOf(std::size_t r) const {
  return system_.rows[r]->relative + nodesOf(*system_.rows[r], false) + fewVelocity(r, few_);
}

/// to  vector of the end's body, in the wide layout
void SystemSolve::addToNodes(const RowEnd& end, const btVector3& impulse, btScalar* to) const {
  const auto& matrix = matrixOf(end);
  for (std::uint32_t k = 0; k < end.nodeCount; ++k) {
    btScalar* at = to + matrix.wideOf(static_cast<std::size_t>(end.nodes[k]));
    toWide(fromWide(at) + end.weights[k] * impulse, at);
  }
}

/// Makes the pass's linear system, and begins its solve. Returns whether there is nothing left to solve.
bool SystemSolve::start(int pass) {
  keepState();
  addImpulses();
  const elastic_detail::SolveLimits limits = system_.rows.empty() ? limitsWithoutRows() : limitsOfPass(pass);
  addTangents();
  for (std::size_t k = 0; k < states_.size(); ++k) fixNodes(bodyAt(k));
  eliminate();
  elastic_detail::ConjugateGradient<btScalar>::Matrices matrices;
  for (std::size_t k = 0; k < states_.size(); ++k) matrices.push_back(&bodyAt(k).dynamics->matrix());
  elastic_detail::ConjugateGradient<btScalar>::Extra extra;
  if (!system_.forces.empty() || fewSize_ > 0 || joinsSoft_) {
    extra = [this](std::vector<const btScalar*>& added) { addProducts(added); };
  }
  auto& solve = *bodyAt(0).solve;
  solve.start(std::move(matrices), limits, std::move(extra), threads_);
  const double accepted = std::max(kAccepted * kAccepted * limits.enough, limits.floor * limits.floor * massOfAll());
  double squared = solve.squaredResidual();
  if (fewSize_ > 0) squared += fewResidual_.dot(compliance_ * fewResidual_);
  return squared <= accepted;
}

void SystemSolve::keepState() {
  for (std::size_t k = 0; k < states_.size(); ++k) {
    auto& matrix = bodyAt(k).dynamics->matrix();
    states_[k].solution.assign(matrix.solution(), matrix.solution() + matrix.wideSize());
    states_[k].residual.assign(matrix.residual(), matrix.residual() + matrix.wideSize());
  }
}

void SystemSolve::addImpulses() {
  fewResidual_ = Vector::Zero(fewSize_);
  findFewResiduals();
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    for (std::size_t e = 0; e < 2; ++e) {
      if (row.ends[e].isSoft())
        addToNodes(row.ends[e], btScalar(signOf(e)) * row.impulse, matrixOf(row.ends[e]).residual());
    }
    addRowPush(r, row.impulse - row.given, fewResidual_);
  }
}

/// Rows of the same tet are added together.
void SystemSolve::addTangents() {
  for (std::size_t e = 0; e < 2; ++e) {
    const auto endAt = [&](std::size_t r) -> const RowEnd& { return system_.rows[r]->ends[e]; };
    for (std::size_t first = 0; first < system_.rows.size();) {
      std::size_t last = first + 1;
      while (last < system_.rows.size() && sameNodes(endAt(first), endAt(last))) ++last;
      if (endAt(first).isSoft()) addBlocks(e, first, last);
      first = last;
    }
  }
}

/// Nodes that no tet connects have no block in the matrix: each gets by itself the stiffness that they have together.
/// end  of the rows
void SystemSolve::addBlocks(std::size_t end, std::size_t first, std::size_t last) {
  assert(first < last && last <= system_.rows.size());
  const RowEnd& any = system_.rows[first]->ends[end];
  auto& matrix = matrixOf(any);
  btScalar blocks[kMaxPointNodes][kMaxPointNodes][6] = {};  // the lower triangle
  for (std::size_t r = first; r < last; ++r) {
    const ContactRow& row = *system_.rows[r];
    if (row.state == ContactRow::State::Apart) continue;
    const btMatrix3x3& h = row.tangent;
    const btScalar tangent[6] = {h[0][0], h[0][1], h[0][2], h[1][1], h[1][2], h[2][2]};
    const auto& weights = row.ends[end].weights;
    for (std::uint32_t i = 0; i < any.nodeCount; ++i) {
      for (std::uint32_t j = 0; j <= i; ++j) {
        const btScalar weight = weights[i] * weights[j];
        for (int k = 0; k < 6; ++k) blocks[i][j][k] += weight * tangent[k];
      }
    }
  }
  for (std::uint32_t i = 0; i < any.nodeCount; ++i) {
    for (std::uint32_t j = 0; j < i; ++j) {
      const auto a = static_cast<std::size_t>(any.nodes[i]), b = static_cast<std::size_t>(any.nodes[j]);
      if (!matrix.couple(a, b, blocks[i][j])) addApart(end, first, last, i, j, blocks);
    }
  }
  for (std::uint32_t i = 0; i < any.nodeCount; ++i) {
    matrix.resist(static_cast<std::size_t>(any.nodes[i]), blocks[i][i]);
  }
}

void SystemSolve::addApart(std::size_t end, std::size_t first, std::size_t last, std::uint32_t i, std::uint32_t j,
                           btScalar (&blocks)[kMaxPointNodes][kMaxPointNodes][6]) const {
  for (std::size_t r = first; r < last; ++r) {
    const ContactRow& row = *system_.rows[r];
    if (row.state == ContactRow::State::Apart) continue;
    const btScalar weight = std::abs(row.ends[end].weights[i] * row.ends[end].weights[j]);
    addSymmetric(row.tangent, weight, blocks[i][i]);
    addSymmetric(row.tangent, weight, blocks[j][j]);
  }
}

/// Bounds friction by the normal impulses of the current pass.
void SystemSolve::refreshBounds() {
  assert(stepped_.size() == system_.rows.size());
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    ContactRow& row = *system_.rows[r];
    const btVector3 impulse = row.impulse - row.tangent * stepped_[r];
    row.normalBound = std::max(row.normal.dot(impulse), btScalar(0));
  }
}

// ---- finish

/// True if a joint connects the body to an object whose motion is prescribed. Such an object takes up any momentum, and
/// a point with a joint of that stiffness depends on where in the step its impulse acts.
bool SystemSolve::isHung(std::size_t body) const {
  return std::any_of(system_.rows.begin(), system_.rows.end(), [&](const ContactRow* row) {
    const RowEnd& end = row->ends[0];
    return row->joined && !row->constant && end.isSoft() && end.body == body && row->ends[1].rigid.unknown < 0;
  });
}

/// Adds the sum of the rows' impulses to rigid bodies, and removes from soft ones the momentum error of a solve that is
/// cut short. Where other forces act on the system, their share is unknown here.
void SystemSolve::giveMomentum() {
  if (system_.rows.empty()) return;
  Vector push = Vector::Zero(rigidSize_);
  std::vector<std::vector<std::array<double, 3>>> impulses(states_.size());
  std::vector<std::size_t> indices(step_.bodies.bodies().size(), states_.size());
  for (std::size_t k = 0; k < states_.size(); ++k) {
    indices[system_.bodies[k]] = k;
    impulses[k].assign(bodyAt(k).dynamics->nodeCount(), {0.0, 0.0, 0.0});
  }
  for (const ContactRow* row : system_.rows) {
    const btVector3 more = row->impulse - row->given;
    for (std::size_t e = 0; e < 2; ++e) {
      const RowEnd& end = row->ends[e];
      const btScalar sign = btScalar(signOf(e));
      step_.rigids.addImpulse(end.rigid, sign * more, push);
      for (std::uint32_t n = 0; n < end.nodeCount; ++n) {
        assert(indices[end.body] < impulses.size());
        auto& to = impulses[indices[end.body]][static_cast<std::size_t>(end.nodes[n])];
        for (int k = 0; k < 3; ++k) {
          const auto value = static_cast<double>(sign * row->impulse[k]);
          to[static_cast<std::size_t>(k)] += static_cast<double>(end.weights[n]) * value;
        }
      }
    }
  }
  const Vector change = inverseMass_ * push;
  for (const std::size_t r : system_.rigids) RigidUnknowns::apply(step_.rigids.list()[r], change);
  for (std::size_t k = 0; k < states_.size() && system_.forces.empty(); ++k) {
    if (!bodyAt(k).elastic || !bodyAt(k).fixed.empty() || isHung(system_.bodies[k])) continue;
    bodyAt(k).dynamics->removeMomentum([&](std::size_t node) { return impulses[k][node]; });
  }
}

}  // namespace tetskin
