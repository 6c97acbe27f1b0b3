// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The few unknowns of a system: V of rigid bodies, and q of stiff bodies' parts. They are eliminated from the nodes'
// equations, and follow what the nodes do.
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/system_solve.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

namespace tetskin {
namespace {

/// Stiffness numbers from which on the rigid motions of parts are unknowns of their own.
constexpr double kStiffPart = 5.0;
/// Parts of a body whose rigid motions are solved for by themselves.
constexpr std::size_t kMaxParts = 4;

Eigen::Matrix3d toEigenMatrix(const btMatrix3x3& m) {
  Eigen::Matrix3d to;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) to(i, j) = static_cast<double>(m[i][j]);
  }
  return to;
}

}  // namespace

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

void SystemSolve::collectParts() {
  endParts_.assign(system_.rows.size(), {});
  for (const std::size_t b : system_.bodies) {
    const SolvedBody& of = step_.bodies.bodies()[b];
    // What others do to the nodes is not asked of parts.
    if (!of.elastic || of.rowCount == 0 || !system_.forces.empty() || !of.fixed.empty()) continue;
    if (of.dynamics->stiffnessNumber() < kStiffPart && !isJoined(b)) continue;
    for (std::size_t part = 0; part < std::min(of.dynamics->partCount(), kMaxParts); ++part) addPart(b, part);
  }
  few_ = fewStep_ = fewResidual_ = Vector::Zero(fewSize_);
}

bool SystemSolve::isJoined(std::size_t body) const {
  return std::any_of(system_.rows.begin(), system_.rows.end(), [&](const ContactRow* row) {
    return row->joined && !row->constant && row->ends[0].isSoft() && row->ends[0].body == body;
  });
}

void SystemSolve::addPart(std::size_t body, std::size_t part) {
  const Dynamics& dynamics = *step_.bodies.bodies()[body].dynamics;
  std::optional<PartUnknown> unknown = PartUnknown::make(dynamics, part, threads_);
  if (!unknown) return;
  unknown->body = body;
  unknown->first = fewSize_;
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    for (std::size_t e = 0; e < 2; ++e) {
      const RowEnd& end = system_.rows[r]->ends[e];
      if (!end.isSoft() || end.body != body) continue;
      const RowMotions motions = unknown->motionsAt(dynamics, end);
      if (!motions.isZero(0.0)) endParts_[r][e] = {static_cast<int>(parts_.size()), motions};
    }
  }
  parts_.push_back(std::move(*unknown));
  fewSize_ += static_cast<Eigen::Index>(Dynamics::kRigidMotions);
}

Dynamics& SystemSolve::dynamicsOf(const PartUnknown& part) const {
  return *step_.bodies.bodies()[part.body].dynamics;
}

/// Beside the parts' rigid motions solutions have none.
void SystemSolve::moveIntoParts() {
  for (const PartUnknown& part : parts_) {
    few_.segment<6>(part.first) = part.mass.ldlt().solve(part.imageProducts(dynamicsOf(part).matrix().solution()));
    part.addMotions(-few_.segment<6>(part.first), dynamicsOf(part));
  }
}

void SystemSolve::moveOutOfParts() {
  for (const PartUnknown& part : parts_) part.addMotions(few_.segment<6>(part.first), dynamicsOf(part));
}

/// Z^T A (y + Z q)
Vector6 SystemSolve::momentumOf(const PartUnknown& part) const {
  return part.imageProducts(dynamicsOf(part).matrix().solution()) + part.mass * few_.segment<6>(part.first);
}

/// The nodes' equations have each part's rigid motion, too, and must ask of it what its own do: together they are
/// singular, and along what contradicts the conjugate gradient goes on without end. Forces of stiff bodies, which are
/// summed to 0, leave that much by rounding.
void SystemSolve::matchParts() {
  for (const PartUnknown& part : parts_) {
    btScalar* residual = dynamicsOf(part).matrix().residual();
    const Vector6 excess = part.motionProducts(dynamicsOf(part), residual) - fewResidual_.segment<6>(part.first);
    part.addImages(-part.mass.ldlt().solve(excess), residual);
  }
}

bool SystemSolve::meetsFew(std::size_t r) const {
  const ContactRow& row = *system_.rows[r];
  for (std::size_t e = 0; e < 2; ++e) {
    if (row.ends[e].rigid.unknown >= 0 || endParts_[r][e].part >= 0) return true;
  }
  return false;
}

/// Of the part's six among the few unknowns.
Eigen::Index SystemSolve::firstOf(const EndPart& of) const {
  return parts_[static_cast<std::size_t>(of.part)].first;
}

/// What the few unknowns do to the velocity of a row.
btVector3 SystemSolve::fewVelocity(std::size_t r, const Vector& few) const {
  btVector3 sum(0, 0, 0);
  for (std::size_t e = 0; e < 2; ++e) {
    const EndPart& of = endParts_[r][e];
    btVector3 velocity = step_.rigids.velocity(system_.rows[r]->ends[e].rigid, few);
    if (of.part >= 0) velocity += toBullet(of.motions * few.segment<6>(firstOf(of)));
    sum += btScalar(signOf(e)) * velocity;
  }
  return sum;
}

/// The other way round: what an impulse of the row is to the few unknowns.
void SystemSolve::addRowPush(std::size_t r, const btVector3& push, Vector& to) const {
  for (std::size_t e = 0; e < 2; ++e) {
    const EndPart& of = endParts_[r][e];
    const btVector3 own = btScalar(signOf(e)) * push;
    step_.rigids.addImpulse(system_.rows[r]->ends[e].rigid, own, to);
    if (of.part >= 0) to.segment<6>(firstOf(of)) += of.motions.transpose() * toEigen(own);
  }
}

/// Without rows: what rigid bodies and parts have of momentum.
void SystemSolve::findFewResiduals() {
  fewResidual_.head(rigidSize_) -= rigidMomentum_;
  partsBefore_ = Vector::Zero(fewSize_);
  for (const PartUnknown& part : parts_) {
    partsBefore_.segment<6>(part.first) = momentumOf(part);
    fewResidual_.segment<6>(part.first) += part.began - partsBefore_.segment<6>(part.first);
  }
}

/// Of the few unknowns, but for the masses of rigid bodies: what rows, and the masses of parts, couple them by.
SystemSolve::Matrix SystemSolve::fewMatrix() const {
  Matrix few = Matrix::Zero(fewSize_, fewSize_);
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    if (system_.rows[r]->state == ContactRow::State::Apart || !meetsFew(r)) continue;
    const Eigen::Matrix3d h = toEigenMatrix(system_.rows[r]->tangent);
    for (std::size_t a = 0; a < 2; ++a) {
      for (std::size_t b = 0; b < 2; ++b) addFewStiffness(r, a, b, h, few);
    }
  }
  for (const PartUnknown& part : parts_) few.block<6, 6>(part.first, part.first) += part.mass;
  return few;
}

/// Of two ends of a row; what couples a rigid body and a part is added both ways from the part's end.
void SystemSolve::addFewStiffness(std::size_t r, std::size_t a, std::size_t b, const Eigen::Matrix3d& h,
                                  Matrix& few) const {
  const RowEnd &first = system_.rows[r]->ends[a], &second = system_.rows[r]->ends[b];
  const double sign = signOf(a) * signOf(b);
  step_.rigids.addStiffness(first.rigid, second.rigid, h, sign, few);
  const EndPart &part = endParts_[r][a], &other = endParts_[r][b];
  if (part.part < 0) return;
  if (other.part >= 0) {
    few.block<6, 6>(firstOf(part), firstOf(other)) += sign * part.motions.transpose() * h * other.motions;
  }
  for (Eigen::Index k = 0; k < 6 && second.rigid.unknown >= 0; ++k) {
    Vector push = Vector::Zero(rigidSize_);
    step_.rigids.addImpulse(second.rigid, toBullet(sign * h * part.motions.col(k)), push);
    few.col(firstOf(part) + k).head(rigidSize_) += push;
    few.row(firstOf(part) + k).head(rigidSize_) += push.transpose();
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
    if (row.state == ContactRow::State::Apart || !meetsFew(r)) continue;
    const btVector3 push = sign * (row.tangent * fewVelocity(r, few));
    for (std::size_t e = 0; e < 2; ++e) {
      const RowEnd& end = row.ends[e];
      if (end.isSoft()) addToNodes(end, btScalar(signOf(e)) * push, target(end.body));
    }
  }
  for (const PartUnknown& part : parts_) {
    part.addImages(static_cast<double>(sign) * few.segment<6>(part.first), target(part.body));
  }
}

/// What the nodes' steps of the conjugate gradient do to the few unknowns.
SystemSolve::Vector SystemSolve::fewOf() const {
  Vector few = Vector::Zero(fewSize_);
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    if (row.state == ContactRow::State::Apart || !meetsFew(r)) continue;
    addRowPush(r, -(row.tangent * nodesOf(row, true)), few);
  }
  for (const PartUnknown& part : parts_) {
    few.segment<6>(part.first) -= part.imageProducts(dynamicsOf(part).matrix().step());
  }
  return few;
}

/// What couples the nodes of two ends: the matrices have each end's own blocks.
void SystemSolve::addCrossProducts() {
  for (const ContactRow* row : system_.rows) {
    if (!row->ends[0].isSoft() || !row->ends[1].isSoft() || row->state == ContactRow::State::Apart) continue;
    for (std::size_t e = 0; e < 2; ++e) {
      const RowEnd &end = row->ends[e], &other = row->ends[1 - e];
      addToNodes(end, -(row->tangent * nodesOf(other, true)), step_.extras[end.body].data());
    }
  }
}

void SystemSolve::addProducts(std::vector<const btScalar*>& added) {
  step_.beginProducts(system_);
  addCrossProducts();
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
    push.segment<6>(part.first) -= part.imageProducts(dynamicsOf(part).matrix().solution()) -
                                   part.imageProducts(states_[placeOf(part.body)].solution.data());
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

/// What is left is small by what it moves, and by impulses need not be: of stiff rows. The few unknowns take it, so
/// that momentum by the rows' impulses is theirs, and changes little.
void SystemSolve::settleFew() {
  if (fewSize_ == 0) return;
  const Vector change = compliance_ * fewResidual_;
  few_ += change;
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    ContactRow& row = *system_.rows[r];
    if (row.state != ContactRow::State::Apart) row.impulse -= row.tangent * fewVelocity(r, change);
  }
}

std::size_t SystemSolve::placeOf(std::size_t body) const {
  return static_cast<std::size_t>(std::find(system_.bodies.begin(), system_.bodies.end(), body) -
                                  system_.bodies.begin());
}

}  // namespace tetskin
