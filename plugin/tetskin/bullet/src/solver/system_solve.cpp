// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/coupling_force.h>
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/solver_contacts.h>
#include <tetskin/bullet/src/solver/system_solve.h>

#include <Eigen/Cholesky>
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
/// Stiffness numbers from which on the rigid motions of parts are unknowns of their own.
constexpr double kStiffPart = 5.0;
/// And from which on what the matrix makes of them is rounding.
constexpr double kRoundedPart = 1e5;
/// Parts of a body whose rigid motions are solved for by themselves.
constexpr std::size_t kMaxParts = 4;
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

double product(const btScalar* a, const btScalar* b, std::size_t count) {
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) sum += static_cast<double>(a[k]) * static_cast<double>(b[k]);
  return sum;
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
  collectParts();
  moveIntoParts();
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
  rigidSize_ = fewSize_ = size;
  rigidMomentum_ = rigidPush_ = Vector::Zero(size);
}

// ---- parts of stiff bodies

void SystemSolve::collectParts() {
  rowParts_.assign(system_.rows.size(), -1);
  rowMotions_.assign(system_.rows.size(), Eigen::Matrix<double, 3, 6>::Zero());
  for (const std::size_t b : system_.bodies) {
    const SolvedBody& of = step_.bodies.bodies()[b];
    // What others do to the nodes is not asked of parts.
    if (!of.elastic || of.rowCount == 0 || !system_.forces.empty() || !of.fixed.empty()) continue;
    if (of.dynamics->stiffnessNumber() < kStiffPart) continue;
    for (std::size_t part = 0; part < std::min(of.dynamics->partCount(), kMaxParts); ++part) addPart(b, part);
  }
  few_ = fewStep_ = fewResidual_ = Vector::Zero(fewSize_);
}

void SystemSolve::addPart(std::size_t body, std::size_t part) {
  const Dynamics& dynamics = *step_.bodies.bodies()[body].dynamics;
  PartUnknown unknown;
  unknown.body = body;
  unknown.first = fewSize_;
  if (!dynamics.rigidMotions(part, unknown.motions)) return;
  const auto& matrix = dynamics.matrix();
  // Elasticity resists rigid motions as far as the matrix is of other rotations than the body's, or of a deformed body.
  // Of the stiffest, rounding in it would outweigh their mass: it does not count.
  const bool rounded = dynamics.stiffnessNumber() > kRoundedPart;
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    unknown.images[k].assign(matrix.wideSize(), btScalar(0));
    if (!rounded) {
      matrix.multiply(unknown.motions[k].data(), unknown.images[k].data(), threads_);
      continue;
    }
    for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
      toWide(matrix.mass(n) * fromPoint(&unknown.motions[k][4 * matrix.slotOf(n)]),
             &unknown.images[k][matrix.wideOf(n)]);
    }
  }
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    btVector3 began = matrix.mass(n) * fromWide(dynamics.deviation() + matrix.wideOf(n));
    if (!rounded) dynamics.rightSide(n, began.m_floats);
    for (std::size_t i = 0; i < Dynamics::kRigidMotions; ++i) {
      const btVector3 motion = fromPoint(&unknown.motions[i][4 * matrix.slotOf(n)]);
      unknown.began[static_cast<Eigen::Index>(i)] += product(motion, began);
      for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
        unknown.mass(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) +=
            product(motion, fromWide(&unknown.images[k][matrix.wideOf(n)]));
      }
    }
  }
  unknown.mass = (0.5 * (unknown.mass + unknown.mass.transpose())).eval();
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    if (row.nodeCount == 0 || row.body != body) continue;
    bool moves = false;
    for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
      btVector3 sum(0, 0, 0);
      for (std::uint32_t n = 0; n < row.nodeCount; ++n) {
        const std::size_t slot = matrix.slotOf(static_cast<std::size_t>(row.nodes[n]));
        sum += row.weights[n] * fromPoint(&unknown.motions[k][4 * slot]);
      }
      moves |= !sum.isZero();
      for (int i = 0; i < 3; ++i) {
        if (!sum.isZero()) rowMotions_[r](i, static_cast<Eigen::Index>(k)) = static_cast<double>(sum[i]);
      }
    }
    if (moves) rowParts_[r] = static_cast<int>(parts_.size());
  }
  parts_.push_back(std::move(unknown));
  fewSize_ += static_cast<Eigen::Index>(Dynamics::kRigidMotions);
}

/// Beside the parts' rigid motions solutions have none.
void SystemSolve::moveIntoParts() {
  for (const PartUnknown& part : parts_) {
    few_.segment<6>(part.first) = part.mass.ldlt().solve(imageProducts(part));
    addPartMotion(part, few_, btScalar(-1));
  }
}

/// Z^T A y
SystemSolve::Vector6 SystemSolve::imageProducts(const PartUnknown& part) const {
  const auto& matrix = step_.bodies.bodies()[part.body].dynamics->matrix();
  Vector6 sum;
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    sum[static_cast<Eigen::Index>(k)] = product(part.images[k].data(), matrix.solution(), part.images[k].size());
  }
  return sum;
}

void SystemSolve::moveOutOfParts() {
  for (const PartUnknown& part : parts_) addPartMotion(part, few_, btScalar(1));
}

void SystemSolve::addPartMotion(const PartUnknown& part, const Vector& few, btScalar factor) {
  auto& matrix = step_.bodies.bodies()[part.body].dynamics->matrix();
  for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
    btScalar* to = matrix.solution() + matrix.wideOf(n);
    btVector3 moved = fromWide(to);
    for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
      moved += factor * static_cast<btScalar>(few[part.first + static_cast<Eigen::Index>(k)]) *
               fromPoint(&part.motions[k][4 * matrix.slotOf(n)]);
    }
    toWide(moved, to);
  }
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
  for (std::size_t k = 0; k < states_.size(); ++k) bodyAt(k).dynamics->matrix().free();
  moveOutOfParts();
  giveMomentum();
  return report;
}

/// What a point is pushed with in this step, before anything is known: as if it were alone.
void SystemSolve::beginBounds() {
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    ContactRow& row = *system_.rows[r];
    if (row.normalBound > 0 || row.joined || row.nodeCount == 0) continue;
    const btScalar towards = row.normal.dot(velocityOf(r)) + row.gapVelocity;
    row.normalBound = row.effectiveMass * std::max(-towards, btScalar(0));
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
  for (const PartUnknown& part : parts_) {
    btScalar* to = step_.bodies.bodies()[part.body].dynamics->matrix().residual();
    for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
      const auto factor = static_cast<btScalar>(few_[part.first + static_cast<Eigen::Index>(k)]);
      for (std::size_t i = 0; i < part.images[k].size(); ++i) to[i] -= factor * part.images[k][i];
    }
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

/// What the few unknowns do to the velocity of a row.
btVector3 SystemSolve::fewVelocity(std::size_t r, const Vector& few) const {
  const ContactRow& row = *system_.rows[r];
  btVector3 sum = step_.rigids.velocity(row.own, few) - step_.rigids.velocity(row.rigid, few);
  if (rowParts_[r] >= 0) {
    const PartUnknown& part = parts_[static_cast<std::size_t>(rowParts_[r])];
    const Eigen::Vector3d moved = rowMotions_[r] * few.segment<6>(part.first);
    sum += btVector3(static_cast<btScalar>(moved[0]), static_cast<btScalar>(moved[1]), static_cast<btScalar>(moved[2]));
  }
  return sum;
}

/// The other way round: what an impulse of the row is to the few unknowns.
void SystemSolve::addRowPush(std::size_t r, const btVector3& push, Vector& to) const {
  const ContactRow& row = *system_.rows[r];
  step_.rigids.addImpulse(row.own, push, to);
  step_.rigids.addImpulse(row.rigid, -push, to);
  if (rowParts_[r] < 0) return;
  const PartUnknown& part = parts_[static_cast<std::size_t>(rowParts_[r])];
  to.segment<6>(part.first) += rowMotions_[r].transpose() * Eigen::Vector3d(push[0], push[1], push[2]);
}

btVector3 SystemSolve::velocityOf(std::size_t r) const {
  return system_.rows[r]->relative + nodesOf(*system_.rows[r], false) + fewVelocity(r, few_);
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
  keepState();
  addImpulses();
  const elastic_detail::SolveLimits limits = system_.rows.empty() ? limitsWithoutRows() : limitsOfPass(pass);
  addTangents();
  for (std::size_t k = 0; k < states_.size(); ++k) fixNodes(bodyAt(k));
  eliminate();
  elastic_detail::ConjugateGradient<btScalar>::Matrices matrices;
  for (std::size_t k = 0; k < states_.size(); ++k) matrices.push_back(&bodyAt(k).dynamics->matrix());
  elastic_detail::ConjugateGradient<btScalar>::Extra extra;
  if (!system_.forces.empty() || fewSize_ > 0) {
    extra = [this](std::vector<const btScalar*>& added) { addProducts(added); };
  }
  auto& solve = *bodyAt(0).solve;
  solve.start(std::move(matrices), limits, std::move(extra), threads_);
  const double most = std::max(kAccepted * kAccepted * limits.enough, limits.floor * limits.floor * massOfAll());
  double squared = solve.squaredResidual();
  if (fewSize_ > 0) squared += fewResidual_.dot(compliance_ * fewResidual_);
  return squared <= most;
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
    addToNodes(row, row.impulse);
    addRowPush(r, row.impulse - row.given, fewResidual_);
  }
}

/// Without rows: what rigid bodies and parts have of momentum.
void SystemSolve::findFewResiduals() {
  fewResidual_.head(rigidSize_) -= rigidMomentum_;
  partsBefore_ = Vector::Zero(fewSize_);
  for (const PartUnknown& part : parts_) {
    partsBefore_.segment<6>(part.first) = partMomentum(part);
    fewResidual_.segment<6>(part.first) += part.began - partsBefore_.segment<6>(part.first);
  }
}

/// Z^T A (y + Z q)
SystemSolve::Vector6 SystemSolve::partMomentum(const PartUnknown& part) const {
  return imageProducts(part) + part.mass * few_.segment<6>(part.first);
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
  btScalar blocks[kMaxPointNodes][kMaxPointNodes][6] = {};  // the lower triangle
  for (std::size_t r = first; r < last; ++r) {
    const ContactRow& row = *system_.rows[r];
    if (row.state == ContactRow::State::Apart) continue;
    const btMatrix3x3& h = row.tangent;
    const btScalar tangent[6] = {h[0][0], h[0][1], h[0][2], h[1][1], h[1][2], h[2][2]};
    for (std::uint32_t i = 0; i < row.nodeCount; ++i) {
      for (std::uint32_t j = 0; j <= i; ++j) {
        const btScalar weight = row.weights[i] * row.weights[j];
        for (int k = 0; k < 6; ++k) blocks[i][j][k] += weight * tangent[k];
      }
    }
  }
  for (std::uint32_t i = 0; i < any.nodeCount; ++i) {
    for (std::uint32_t j = 0; j < i; ++j) {
      const auto a = static_cast<std::size_t>(any.nodes[i]), b = static_cast<std::size_t>(any.nodes[j]);
      if (!matrix.couple(a, b, blocks[i][j])) addApart(first, last, i, j, blocks);
    }
  }
  for (std::uint32_t i = 0; i < any.nodeCount; ++i) {
    matrix.resist(static_cast<std::size_t>(any.nodes[i]), blocks[i][i]);
  }
}

void SystemSolve::addApart(std::size_t first, std::size_t last, std::uint32_t i, std::uint32_t j,
                           btScalar (&blocks)[kMaxPointNodes][kMaxPointNodes][6]) const {
  for (std::size_t r = first; r < last; ++r) {
    const ContactRow& row = *system_.rows[r];
    if (row.state == ContactRow::State::Apart) continue;
    const btScalar weight = std::abs(row.weights[i] * row.weights[j]);
    addSymmetric(row.tangent, weight, blocks[i][i]);
    addSymmetric(row.tangent, weight, blocks[j][j]);
  }
}

/// Of the few unknowns, but for the masses of rigid bodies: what rows, and the masses of parts, couple them by.
SystemSolve::Matrix SystemSolve::fewMatrix() const {
  Matrix few = Matrix::Zero(fewSize_, fewSize_);
  const RigidUnknowns& rigids = step_.rigids;
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    if (row.state == ContactRow::State::Apart) continue;
    const Eigen::Matrix3d h = toEigenMatrix(row.tangent);
    rigids.addStiffness(row.rigid, row.rigid, h, 1.0, few);
    rigids.addStiffness(row.own, row.own, h, 1.0, few);
    rigids.addStiffness(row.rigid, row.own, h, -1.0, few);
    rigids.addStiffness(row.own, row.rigid, h, -1.0, few);
    if (rowParts_[r] < 0) continue;
    const Eigen::Index first = parts_[static_cast<std::size_t>(rowParts_[r])].first;
    few.block<6, 6>(first, first) += rowMotions_[r].transpose() * h * rowMotions_[r];
    for (Eigen::Index k = 0; k < 6 && row.rigid.unknown >= 0; ++k) {
      const Eigen::Vector3d push = h * rowMotions_[r].col(k);
      Vector column = Vector::Zero(rigidSize_);
      rigids.addImpulse(
          row.rigid, {static_cast<btScalar>(push[0]), static_cast<btScalar>(push[1]), static_cast<btScalar>(push[2])},
          column);
      few.col(first + k).head(rigidSize_) -= column;
      few.row(first + k).head(rigidSize_) -= column.transpose();
    }
  }
  for (const PartUnknown& part : parts_) few.block<6, 6>(part.first, part.first) += part.mass;
  return few;
}

/// The nodes' equations have each part's rigid motion, too, and must ask of it what its own do: together they are
/// singular, and along what contradicts the conjugate gradient goes on without end. Forces of stiff bodies, which are
/// summed to 0, leave that much by rounding.
void SystemSolve::matchParts() {
  for (const PartUnknown& part : parts_) {
    auto& matrix = step_.bodies.bodies()[part.body].dynamics->matrix();
    Vector6 excess = -fewResidual_.segment<6>(part.first);
    for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
      const btVector3 residual = fromWide(matrix.residual() + matrix.wideOf(n));
      for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
        excess[static_cast<Eigen::Index>(k)] += product(fromPoint(&part.motions[k][4 * matrix.slotOf(n)]), residual);
      }
    }
    const Vector6 motion = part.mass.ldlt().solve(excess);
    for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
      const auto factor = static_cast<btScalar>(motion[static_cast<Eigen::Index>(k)]);
      for (std::size_t i = 0; i < part.images[k].size(); ++i) matrix.residual()[i] -= factor * part.images[k][i];
    }
  }
}

/// Rows of rigid bodies are multiplied by M^-1, in which axes may be locked.
void SystemSolve::eliminate() {
  if (fewSize_ == 0) return;
  matchParts();
  Matrix scale = Matrix::Identity(fewSize_, fewSize_);
  scale.topLeftCorner(rigidSize_, rigidSize_) = inverseMass_;
  Matrix system = scale * fewMatrix();
  system.topLeftCorner(rigidSize_, rigidSize_) += Matrix::Identity(rigidSize_, rigidSize_);
  compliance_ = system.partialPivLu().solve(scale);
  addFew(compliance_ * fewResidual_, true);
}

/// What the few unknowns do to the nodes: to their residuals, or to the products.
void SystemSolve::addFew(const Vector& few, bool toResiduals) {
  const auto target = [&](std::size_t body) {
    return toResiduals ? step_.bodies.bodies()[body].dynamics->matrix().residual() : step_.extras[body].data();
  };
  const btScalar sign = toResiduals ? btScalar(-1) : btScalar(1);
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    if (row.nodeCount == 0 || row.state == ContactRow::State::Apart) continue;
    if (row.rigid.unknown < 0 && rowParts_[r] < 0) continue;
    const btVector3 push = sign * (row.tangent * fewVelocity(r, few));
    const auto& matrix = step_.bodies.bodies()[row.body].dynamics->matrix();
    for (std::uint32_t k = 0; k < row.nodeCount; ++k) {
      btScalar* to = target(row.body) + matrix.wideOf(static_cast<std::size_t>(row.nodes[k]));
      toWide(fromWide(to) + row.weights[k] * push, to);
    }
  }
  for (const PartUnknown& part : parts_) {
    btScalar* to = target(part.body);
    for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
      const auto factor = sign * static_cast<btScalar>(few[part.first + static_cast<Eigen::Index>(k)]);
      for (std::size_t i = 0; i < part.images[k].size(); ++i) to[i] += factor * part.images[k][i];
    }
  }
}

/// What the nodes' steps of the conjugate gradient do to the few unknowns.
SystemSolve::Vector SystemSolve::fewOf() const {
  Vector few = Vector::Zero(fewSize_);
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    if (row.nodeCount == 0 || row.state == ContactRow::State::Apart) continue;
    if (row.rigid.unknown >= 0 || rowParts_[r] >= 0) addRowPush(r, -(row.tangent * nodesOf(row, true)), few);
  }
  for (const PartUnknown& part : parts_) {
    const btScalar* step = step_.bodies.bodies()[part.body].dynamics->matrix().step();
    for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
      few[part.first + static_cast<Eigen::Index>(k)] -= product(part.images[k].data(), step, part.images[k].size());
    }
  }
  return few;
}

void SystemSolve::addProducts(std::vector<const btScalar*>& added) {
  step_.beginProducts(system_);
  if (fewSize_ > 0) addFew(compliance_ * fewOf(), false);
  for (std::size_t k = 0; k < system_.bodies.size(); ++k) added[k] = step_.extras[system_.bodies[k]].data();
}

/// The few unknowns follow what the nodes have done in the pass.
void SystemSolve::moveFew() {
  Vector push = fewResidual_;
  for (std::size_t r = 0; r < system_.rows.size() && fewSize_ > 0; ++r) {
    const ContactRow& row = *system_.rows[r];
    if (row.state != ContactRow::State::Apart) addRowPush(r, -(row.tangent * (velocityOf(r) - before_[r])), push);
  }
  for (const PartUnknown& part : parts_) {
    const auto& matrix = step_.bodies.bodies()[part.body].dynamics->matrix();
    const BodyState& state = states_[placeOf(part.body)];
    for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
      const std::size_t size = part.images[k].size();
      push[part.first + static_cast<Eigen::Index>(k)] -= product(part.images[k].data(), matrix.solution(), size) -
                                                         product(part.images[k].data(), state.solution.data(), size);
    }
  }
  if (fewSize_ > 0) fewStep_ = compliance_ * push;
  few_ += fewStep_;
  stepped_.resize(system_.rows.size());
  // M times the step is what is left of the bodies' equation, less what rows take back.
  Vector left = fewResidual_;
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    stepped_[r] = velocityOf(r) - before_[r];
    if (rigidSize_ > 0 && row.state != ContactRow::State::Apart) addRowPush(r, -(row.tangent * stepped_[r]), left);
  }
  rigidPush_ = left.head(rigidSize_);
  rigidMomentum_ += rigidPush_;
}

std::size_t SystemSolve::placeOf(std::size_t body) const {
  return static_cast<std::size_t>(std::find(system_.bodies.begin(), system_.bodies.end(), body) -
                                  system_.bodies.begin());
}

/// Of the energy of which the solve seeks the least, along the pass's step.
double SystemSolve::slope(btScalar share, double linear, double quadratic) const {
  double sum = linear + static_cast<double>(share) * quadratic;
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    ContactRow::State state{};
    const btVector3 impulse = impulseAt(row, before_[r] + share * stepped_[r], false, state);
    sum -= product(impulse - row.given, stepped_[r]);
  }
  return sum;
}

/// How much of the pass's step to take.
btScalar SystemSolve::searchLine() {
  findResiduals();
  const Vector rigidStep = fewStep_.head(rigidSize_);
  double linear = rigidStep.dot(rigidMomentum_ - rigidPush_), quadratic = rigidStep.dot(rigidPush_);
  for (std::size_t k = 0; k < states_.size(); ++k) {
    auto& matrix = bodyAt(k).dynamics->matrix();
    for (std::size_t i = 0; i < matrix.wideSize(); ++i) {
      const auto step = static_cast<double>(matrix.solution()[i] - states_[k].solution[i]);
      const auto before = static_cast<double>(states_[k].residual[i]);
      linear -= step * before;
      quadratic += step * (before - static_cast<double>(matrix.residual()[i]));
    }
  }
  for (const PartUnknown& part : parts_) {
    const Vector6 step = fewStep_.segment<6>(part.first);
    const Vector6 grown = partMomentum(part) - partsBefore_.segment<6>(part.first);
    linear += step.dot(partsBefore_.segment<6>(part.first) - part.began);
    quadratic += step.dot(grown);
  }
  const double first = slope(0, linear, quadratic), all = slope(1, linear, quadratic);
  // A step that does not lead down, by rounding or as bounds are refreshed, has no least on it.
  if (!(first < 0.0 && all > -kFlat * first)) return 1;
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
  few_ -= rest * fewStep_;
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
    if (of.elastic && !of.waits) limits.enough += of.solve->enough();
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
    limits.floor = std::max(limits.floor, pass > 0 ? of.dynamics->roundingSpeed(seconds) : 0.0);
    byMatrix += of.dynamics->squaredByMatrix();
    byMasses += of.dynamics->squaredChange();
  }
  for (const PartUnknown& part : parts_) {
    byMasses += few_.segment<6>(part.first).dot(partsBefore_.segment<6>(part.first));
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
  Vector push = Vector::Zero(rigidSize_);
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
