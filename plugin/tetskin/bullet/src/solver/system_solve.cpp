// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/coupling_force.h>
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/solver_contacts.h>
#include <tetskin/bullet/src/solver/system_solve.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

/// Where forces of Bullet's or of the application's act on elastic bodies, the residual at most: they act on few nodes,
/// so that their part of it is small, and what is left of that they give anew in each step, and energy with it.
constexpr double kWithForeignForces = 1e-6;
/// With rows: the tolerance over that of a body by itself.
constexpr double kCloserWithRows = 0.1;
/// By how much the first pass lessens the residual, at most, and the others: rows are others after it.
constexpr double kFirstPass = 0.02, kLaterPass = 0.1;
constexpr int kMaxPasses = 30;
/// Passes from which on the derivative of sliding is used, but for a tenth, and from how long a step on.
constexpr int kPassesBeforeDerivative = 2;
constexpr btScalar kKept = btScalar(0.1), kLongStep = btScalar(0.9);
/// A residual so many times the one aimed at is converged.
constexpr double kAccepted = 3.0;
/// Of a line search.
constexpr int kMaxHalvings = 20;
constexpr double kFlat = 0.05;

/// The upper triangle.
void addSymmetric(const btMatrix3x3& m, btScalar factor, btScalar to[6]) {
  const btScalar entries[6] = {m[0][0], m[0][1], m[0][2], m[1][1], m[1][2], m[2][2]};
  for (int k = 0; k < 6; ++k) to[k] += factor * entries[k];
}

Eigen::Matrix3d toEigenMatrix(const btMatrix3x3& m) {
  Eigen::Matrix3d to;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) to(i, j) = static_cast<double>(m[i][j]);
  }
  return to;
}

double product(const btVector3& a, const btVector3& b) {
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) sum += static_cast<double>(a[k]) * static_cast<double>(b[k]);
  return sum;
}

bool sameNodes(const ContactRow& a, const ContactRow& b) {
  return a.body == b.body && a.nodeCount == b.nodeCount &&
         std::equal(a.nodes.begin(), a.nodes.begin() + a.nodeCount, b.nodes.begin());
}

}  // namespace

SystemSolve::SystemSolve(DeformableSolver::Parts& step, const SolvedSystem& system, ParallelFor* threads)
    : step_(step), system_(system), threads_(threads) {
  assert(!system.bodies.empty());
  states_.resize(system.bodies.size());
  numberRigids();
}

SolvedBody& SystemSolve::bodyAt(std::size_t k) const {
  return step_.bodies.bodies()[system_.bodies[k]];
}

void SystemSolve::numberRigids() {
  Eigen::Index size = 0;
  for (const std::size_t r : system_.rigids) {
    RigidUnknown& unknown = step_.rigids.list()[r];
    unknown.first = size;
    size += unknown.size;
  }
  inverseMass_ = Matrix::Zero(size, size);
  for (const std::size_t r : system_.rigids) {
    const RigidUnknown& unknown = step_.rigids.list()[r];
    inverseMass_.block(unknown.first, unknown.first, unknown.size, unknown.size) = unknown.inverseMass;
  }
  rigidChange_ = rigidMomentum_ = rigidStep_ = rigidPush_ = Vector::Zero(size);
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
    evaluateRows(kept);
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
    moveRigids();
    length = derivative ? searchLine() : btScalar(1);
    if (length < 1) moveBack(length);
    refreshBounds();
  }
  for (std::size_t k = 0; k < states_.size(); ++k) bodyAt(k).dynamics->matrix().free();
  giveMomentum();
  return report;
}

/// What a point is pushed with in this step, before anything is known: as if it were alone.
void SystemSolve::beginBounds() {
  for (ContactRow* row : system_.rows) {
    if (row->normalBound > 0 || row->joined || row->nodeCount == 0) continue;
    const btScalar towards = row->normal.dot(velocityOf(*row)) + row->gapVelocity;
    row->normalBound = row->effectiveMass * std::max(-towards, btScalar(0));
  }
}

// ---- a pass

/// Without rows.
void SystemSolve::findResiduals() {
  for (std::size_t k = 0; k < states_.size(); ++k) {
    bodyAt(k).dynamics->matrix().free();
    bodyAt(k).dynamics->startAgain(threads_);
  }
  step_.addOtherResiduals(system_);
}

void SystemSolve::evaluateRows(btScalar kept) {
  before_.resize(system_.rows.size());
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    ContactRow& row = *system_.rows[r];
    before_[r] = velocityOf(row);
    row.slip = before_[r] - row.normal.dot(before_[r]) * row.normal;
    row.impulse = impulseAt(row, before_[r], row.state);
    row.tangent = tangentAt(row, before_[r], row.state, kept);
  }
}

btVector3 SystemSolve::nodesOf(const ContactRow& row, bool steps) const {
  btVector3 sum(0, 0, 0);
  if (row.nodeCount == 0) return sum;
  const auto& matrix = step_.bodies.bodies()[row.body].dynamics->matrix();
  for (std::uint32_t k = 0; k < row.nodeCount; ++k) {
    const auto node = static_cast<std::size_t>(row.nodes[k]);
    sum += row.weights[k] * (steps ? fromPoint(matrix.stepPoints() + 4 * matrix.slotOf(node))
                                   : fromWide(matrix.solution() + matrix.wideOf(node)));
  }
  return sum;
}

btVector3 SystemSolve::velocityOf(const ContactRow& row) const {
  return row.relative + nodesOf(row, false) + step_.rigids.velocity(row.own, rigidChange_) -
         step_.rigids.velocity(row.rigid, rigidChange_);
}

void SystemSolve::addToNodes(const ContactRow& row, const btVector3& impulse) {
  if (row.nodeCount == 0) return;
  auto& matrix = step_.bodies.bodies()[row.body].dynamics->matrix();
  for (std::uint32_t k = 0; k < row.nodeCount; ++k) {
    btScalar* to = matrix.residual() + matrix.wideOf(static_cast<std::size_t>(row.nodes[k]));
    toWide(fromWide(to) + row.weights[k] * impulse, to);
  }
}

/// Makes the pass's linear system, and begins its solve. Returns whether there is nothing left to solve.
bool SystemSolve::start(int pass) {
  const elastic_detail::SolveLimits limits = system_.rows.empty() ? limitsWithoutRows() : limitsOfPass(pass);
  keepState();
  addImpulses();
  addTangents();
  for (std::size_t k = 0; k < states_.size(); ++k) fixNodes(bodyAt(k));
  eliminateRigids();
  elastic_detail::ConjugateGradient<btScalar>::Matrices matrices;
  for (std::size_t k = 0; k < states_.size(); ++k) matrices.push_back(&bodyAt(k).dynamics->matrix());
  elastic_detail::ConjugateGradient<btScalar>::Extra extra;
  if (!system_.forces.empty() || rigidChange_.size() > 0) {
    extra = [this](std::vector<const btScalar*>& added) { addProducts(added); };
  }
  auto& solve = *bodyAt(0).solve;
  solve.start(std::move(matrices), limits, std::move(extra), threads_);
  const double most = std::max(limits.enough, limits.floor * limits.floor * massOfAll());
  return solve.squaredResidual() <= kAccepted * kAccepted * most;
}

void SystemSolve::keepState() {
  for (std::size_t k = 0; k < states_.size(); ++k) {
    auto& matrix = bodyAt(k).dynamics->matrix();
    states_[k].solution.assign(matrix.solution(), matrix.solution() + matrix.wideSize());
    states_[k].residual.assign(matrix.residual(), matrix.residual() + matrix.wideSize());
  }
}

void SystemSolve::addImpulses() {
  Vector push = Vector::Zero(rigidChange_.size());
  for (const ContactRow* row : system_.rows) {
    addToNodes(*row, row->impulse);
    const btVector3 more = row->impulse - row->given;
    step_.rigids.addImpulse(row->own, more, push);
    step_.rigids.addImpulse(row->rigid, -more, push);
  }
  rigidResidual_ = push - rigidMomentum_;
}

/// Rows of one tet at once.
void SystemSolve::addTangents() {
  for (std::size_t first = 0; first < system_.rows.size();) {
    std::size_t last = first + 1;
    while (last < system_.rows.size() && sameNodes(*system_.rows[first], *system_.rows[last])) ++last;
    addBlocks(first, last);
    first = last;
  }
}

/// Of nodes that no tet has both the matrix has no block: they are as stiff each by itself as they are together.
void SystemSolve::addBlocks(std::size_t first, std::size_t last) {
  const ContactRow& any = *system_.rows[first];
  if (any.nodeCount == 0) return;
  auto& matrix = step_.bodies.bodies()[any.body].dynamics->matrix();
  btScalar own[kMaxPointNodes][6] = {};
  for (std::uint32_t i = 0; i < any.nodeCount; ++i) {
    for (std::uint32_t j = 0; j < i; ++j) {
      btScalar block[6] = {}, size[6] = {};
      for (std::size_t r = first; r < last; ++r) {
        const ContactRow& row = *system_.rows[r];
        if (row.state == ContactRow::State::Apart) continue;
        const btScalar weight = row.weights[i] * row.weights[j];
        addSymmetric(row.tangent, weight, block);
        addSymmetric(row.tangent, std::abs(weight), size);
      }
      const auto a = static_cast<std::size_t>(any.nodes[i]), b = static_cast<std::size_t>(any.nodes[j]);
      if (matrix.couple(a, b, block)) continue;
      for (int k = 0; k < 6; ++k) {
        own[i][k] += size[k];
        own[j][k] += size[k];
      }
    }
    for (std::size_t r = first; r < last; ++r) {
      const ContactRow& row = *system_.rows[r];
      if (row.state != ContactRow::State::Apart) {
        addSymmetric(row.tangent, row.weights[i] * row.weights[i], own[i]);
      }
    }
  }
  for (std::uint32_t i = 0; i < any.nodeCount; ++i) matrix.resist(static_cast<std::size_t>(any.nodes[i]), own[i]);
}

void SystemSolve::eliminateRigids() {
  const Eigen::Index size = rigidChange_.size();
  if (size == 0) return;
  Matrix stiffness = Matrix::Zero(size, size);
  const RigidUnknowns& rigids = step_.rigids;
  for (const ContactRow* row : system_.rows) {
    if (row->state == ContactRow::State::Apart || (row->own.unknown < 0 && row->rigid.unknown < 0)) continue;
    const Eigen::Matrix3d h = toEigenMatrix(row->tangent);
    rigids.addStiffness(row->rigid, row->rigid, h, 1.0, stiffness);
    rigids.addStiffness(row->own, row->own, h, 1.0, stiffness);
    rigids.addStiffness(row->rigid, row->own, h, -1.0, stiffness);
    rigids.addStiffness(row->own, row->rigid, h, -1.0, stiffness);
  }
  const Matrix system = Matrix::Identity(size, size) + inverseMass_ * stiffness;
  compliance_ = system.partialPivLu().solve(inverseMass_);
  const Vector change = compliance_ * rigidResidual_;
  for (const ContactRow* row : system_.rows) {
    if (row->state == ContactRow::State::Apart || row->rigid.unknown < 0) continue;
    addToNodes(*row, row->tangent * rigids.velocity(row->rigid, change));
  }
}

void SystemSolve::addProducts(std::vector<const btScalar*>& added) {
  step_.beginProducts(system_);
  const RigidUnknowns& rigids = step_.rigids;
  if (rigidChange_.size() > 0) {
    Vector push = Vector::Zero(rigidChange_.size());
    for (const ContactRow* row : system_.rows) {
      if (row->nodeCount == 0 || row->state == ContactRow::State::Apart) continue;
      rigids.addImpulse(row->rigid, row->tangent * nodesOf(*row, true), push);
    }
    const Vector change = compliance_ * push;
    for (const ContactRow* row : system_.rows) {
      if (row->nodeCount == 0 || row->state == ContactRow::State::Apart || row->rigid.unknown < 0) continue;
      const btVector3 less = row->tangent * rigids.velocity(row->rigid, change);
      const auto& matrix = step_.bodies.bodies()[row->body].dynamics->matrix();
      for (std::uint32_t k = 0; k < row->nodeCount; ++k) {
        btScalar* to = &step_.extras[row->body][matrix.wideOf(static_cast<std::size_t>(row->nodes[k]))];
        toWide(fromWide(to) - row->weights[k] * less, to);
      }
    }
  }
  for (std::size_t k = 0; k < system_.bodies.size(); ++k) added[k] = step_.extras[system_.bodies[k]].data();
}

/// By what the nodes have done in the pass.
void SystemSolve::moveRigids() {
  stepped_.resize(system_.rows.size());
  std::vector<btVector3> ofNodes(system_.rows.size());
  Vector push = rigidResidual_;
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    // What the row's velocity was, but for what has not moved yet.
    ofNodes[r] = velocityOf(row) - before_[r];
    if (row.state != ContactRow::State::Apart) step_.rigids.addImpulse(row.rigid, row.tangent * ofNodes[r], push);
  }
  if (rigidChange_.size() > 0) {
    rigidStep_ = compliance_ * push;
    rigidPush_ = push;
    rigidChange_ += rigidStep_;
  }
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    stepped_[r] = velocityOf(row) - before_[r];
    if (rigidChange_.size() == 0 || row.state == ContactRow::State::Apart) continue;
    // M times the step is what pushes it, less what rows take back.
    const btVector3 back = row.tangent * (step_.rigids.velocity(row.rigid, rigidStep_) -
                                          step_.rigids.velocity(row.own, rigidStep_));
    step_.rigids.addImpulse(row.rigid, -back, rigidPush_);
    step_.rigids.addImpulse(row.own, back, rigidPush_);
  }
  rigidMomentum_ += rigidPush_;
}

/// Of the energy of which the solve seeks the least, along the pass's step.
double SystemSolve::slope(btScalar share, double linear, double quadratic) const {
  double sum = linear + static_cast<double>(share) * quadratic;
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    ContactRow::State state{};
    const btVector3 impulse = impulseAt(row, before_[r] + share * stepped_[r], state);
    sum -= product(impulse - row.given, stepped_[r]);
  }
  return sum;
}

/// How much of the pass's step to take.
btScalar SystemSolve::searchLine() {
  findResiduals();
  double linear = rigidStep_.dot(rigidMomentum_ - rigidPush_), quadratic = rigidStep_.dot(rigidPush_);
  for (std::size_t k = 0; k < states_.size(); ++k) {
    auto& matrix = bodyAt(k).dynamics->matrix();
    for (std::size_t i = 0; i < matrix.wideSize(); ++i) {
      const auto step = static_cast<double>(matrix.solution()[i] - states_[k].solution[i]);
      const auto before = static_cast<double>(states_[k].residual[i]);
      linear -= step * before;
      quadratic += step * (before - static_cast<double>(matrix.residual()[i]));
    }
  }
  const double first = slope(0, linear, quadratic), all = slope(1, linear, quadratic);
  if (!(all > kFlat * std::abs(first))) return 1;
  double low = 0.0, high = 1.0, atLow = first, atHigh = all;
  for (int k = 0; k < kMaxHalvings; ++k) {
    const double tried = k % 2 == 1 ? 0.5 * (low + high) : low - atLow * (high - low) / (atHigh - atLow);
    const double here = slope(static_cast<btScalar>(tried), linear, quadratic);
    if (std::abs(here) < kFlat * std::abs(first)) return static_cast<btScalar>(tried);
    (here > 0.0 ? high : low) = tried;
    (here > 0.0 ? atHigh : atLow) = here;
  }
  return static_cast<btScalar>(0.5 * (low + high));
}

void SystemSolve::moveBack(btScalar share) {
  for (std::size_t k = 0; k < states_.size(); ++k) {
    auto& matrix = bodyAt(k).dynamics->matrix();
    btScalar* solution = matrix.solution();
    for (std::size_t i = 0; i < matrix.wideSize(); ++i) {
      solution[i] = states_[k].solution[i] + share * (solution[i] - states_[k].solution[i]);
    }
  }
  const auto rest = static_cast<double>(1 - share);
  rigidChange_ -= rest * rigidStep_;
  rigidMomentum_ -= rest * rigidPush_;
  for (btVector3& step : stepped_) step *= share;
}

/// Friction is bounded by the normal impulses as the pass has them.
void SystemSolve::refreshBounds() {
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    ContactRow& row = *system_.rows[r];
    const btVector3 impulse = row.impulse - row.tangent * stepped_[r];
    row.normalBound = std::max(row.normal.dot(impulse), btScalar(0));
  }
}

// ---- limits

double SystemSolve::massOfAll() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < states_.size(); ++k) sum += bodyAt(k).dynamics->matrix().totalMass();
  return sum;
}

/// The strictest of all.
elastic_detail::SolveLimits SystemSolve::limitsWithoutRows() const {
  elastic_detail::SolveLimits limits;
  limits.floor = kUnseen * static_cast<double>(step_.dt());
  limits.iterations = 0;
  bool changed = false, anyElastic = false, stiff = false;
  double squaredStart = 0.0;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const SolvedBody& of = bodyAt(k);
    limits.tolerance = std::min(limits.tolerance, of.limits->tolerance);
    limits.iterations = std::max(limits.iterations, of.limits->iterations);
    if (of.elastic) limits.enough += of.solve->enough();
    changed |= !of.fixed.empty() || of.touched;
    stiff |= of.dynamics->isStiff();
    squaredStart += of.dynamics->squaredSolution();
    anyElastic |= of.elastic != nullptr;
  }
  const double tolerance = toleranceWithForces(limits.tolerance, anyElastic);
  const double share = tolerance / std::max(limits.tolerance, 1e-300);  // 0 is a tolerance, too
  limits.tolerance = tolerance;
  limits.enough *= share * share;  // of squares
  // A share of how the velocities differ from rigid motion may be left, too. Of stiff bodies nothing else: the residual
  // that a contact begins with is as large as the body is stiff, and what may be left of it would move light nodes.
  if (changed || stiff) {
    limits.enough = std::max(limits.enough, limits.tolerance * limits.tolerance * squaredStart);
  }
  if (stiff) limits.tolerance = 0.0;
  return limits;
}

double SystemSolve::toleranceWithForces(double tolerance, bool anyElastic) const {
  for (const btDeformableLagrangianForce* force : system_.forces) {
    const auto* coupling = dynamic_cast<const CouplingForce*>(force);
    const double foreign = anyElastic ? kWithForeignForces : 1.0;
    tolerance = std::min(tolerance, coupling ? coupling->tolerance() : foreign);
  }
  return tolerance;
}

/// Over what contacts and others have changed: how much the solution is, or by how much velocities have changed in the
/// step, whichever is more.
elastic_detail::SolveLimits SystemSolve::limitsOfPass(int pass) const {
  elastic_detail::SolveLimits limits;
  limits.iterations = 0;
  limits.floor = 0.0;
  const auto seconds = static_cast<double>(step_.dt());
  double byMatrix = 0.0, byMasses = 0.0, tolerance = 1.0;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const SolvedBody& of = bodyAt(k);
    tolerance = std::min(tolerance, of.limits->tolerance);
    limits.iterations = std::max(limits.iterations, of.limits->iterations);
    limits.floor = std::max(limits.floor, of.dynamics->roundingSpeed(seconds));
    byMatrix += of.dynamics->squaredByMatrix();
    byMasses += of.dynamics->squaredChange(seconds);
  }
  tolerance = toleranceWithForces(kCloserWithRows * tolerance, true);
  limits.enough = tolerance * tolerance * std::max(byMatrix, byMasses);
  limits.tolerance = pass == 0 ? kFirstPass : kLaterPass;
  return limits;
}

// ---- finish

/// Rigid bodies get the sum of what rows push them with; soft ones lose the momentum that a solve which is cut short
/// gives them beside it. Where other forces act on the system, their part is not known here.
void SystemSolve::giveMomentum() {
  if (system_.rows.empty()) return;
  Vector push = Vector::Zero(rigidChange_.size());
  std::vector<std::vector<std::array<double, 3>>> impulses(states_.size());
  std::vector<std::size_t> places(step_.bodies.bodies().size(), states_.size());
  for (std::size_t k = 0; k < states_.size(); ++k) {
    places[system_.bodies[k]] = k;
    impulses[k].assign(bodyAt(k).dynamics->nodeCount(), {0.0, 0.0, 0.0});
  }
  for (const ContactRow* row : system_.rows) {
    const btVector3 more = row->impulse - row->given;
    step_.rigids.addImpulse(row->own, more, push);
    step_.rigids.addImpulse(row->rigid, -more, push);
    for (std::uint32_t n = 0; n < row->nodeCount; ++n) {
      auto& to = impulses[places[row->body]][static_cast<std::size_t>(row->nodes[n])];
      for (int k = 0; k < 3; ++k) {
        to[static_cast<std::size_t>(k)] += static_cast<double>(row->weights[n]) * static_cast<double>(row->impulse[k]);
      }
    }
  }
  const Vector change = inverseMass_ * push;
  for (const std::size_t r : system_.rigids) RigidUnknowns::apply(step_.rigids.list()[r], change);
  for (std::size_t k = 0; k < states_.size() && system_.forces.empty(); ++k) {
    if (!bodyAt(k).elastic || !bodyAt(k).fixed.empty()) continue;
    bodyAt(k).dynamics->removeMomentum([&](std::size_t node) { return impulses[k][node]; });
  }
}

}  // namespace tetskin
