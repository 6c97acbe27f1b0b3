// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The few unknowns of a system: V of rigid bodies, and q of the components of stiff bodies. They are eliminated from
// the nodes' equations, and are computed from the nodes' velocities afterwards.
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/system_solve.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>

namespace tetskin {
namespace {

/// Stiffness factor from which on the rigid motions of components are separate unknowns.
constexpr double kStiffPart = 5.0;
/// Most components of a body whose rigid motions are separate unknowns.
constexpr std::size_t kMaxParts = 4;

Eigen::Matrix3d toEigenMatrix(const btMatrix3x3& m) {
  Eigen::Matrix3d to;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) to(i, j) = static_cast<double>(m[i][j]);
  }
  return to;
}

/// In one place, and into a vector of its own: the compiler takes seconds for each kind of vector that Eigen solves
/// into.
Vector6 ldltSolve(const Eigen::Matrix<double, 6, 6>& matrix, const Vector6& right) {
  return matrix.ldlt().solve(right);
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

void SystemSolve::collectComponents() {
  endParts_.assign(system_.rows.size(), {});
  for (const std::size_t b : system_.bodies) {
    const SolvedBody& body = step_.bodies.bodies()[b];
    // The separate unknowns do not include other forces on the nodes.
    if (!body.elastic || body.rowCount == 0 || !system_.forces.empty() || !body.fixed.empty()) continue;
    if (body.dynamics->stiffnessNumber() < kStiffPart && !isJoined(b)) continue;
    for (std::size_t component = 0; component < std::min(body.dynamics->componentCount(), kMaxParts); ++component)
      addComponent(b, component);
  }
  few_ = fewStep_ = fewResidual_ = Vector::Zero(fewSize_);
}

bool SystemSolve::isJoined(std::size_t body) const {
  return std::any_of(system_.rows.begin(), system_.rows.end(), [&](const ContactRow* row) {
    return row->joined && !row->constant && row->ends[0].isSoft() && row->ends[0].body == body;
  });
}

void SystemSolve::addComponent(std::size_t body, std::size_t component) {
  assert(endParts_.size() == system_.rows.size());
  const Dynamics& dynamics = *step_.bodies.bodies()[body].dynamics;
  std::optional<ComponentUnknown> unknown = ComponentUnknown::make(dynamics, component, threads_);
  if (!unknown) return;
  unknown->body = body;
  unknown->first = fewSize_;
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    for (std::size_t e = 0; e < 2; ++e) {
      const RowEnd& end = system_.rows[r]->ends[e];
      if (!end.isSoft() || end.body != body) continue;
      const RowMotions motions = unknown->motionsAt(dynamics, end);
      if (!motions.isZero(0.0)) endParts_[r][e] = {static_cast<int>(components_.size()), motions};
    }
  }
  components_.push_back(std::move(*unknown));
  fewSize_ += static_cast<Eigen::Index>(Dynamics::kRigidMotions);
}

Dynamics& SystemSolve::dynamicsOf(const ComponentUnknown& component) const {
  return *step_.bodies.bodies()[component.body].dynamics;
}

/// Moves the rigid motions of the components out of the solutions into the separate unknowns.
void SystemSolve::moveIntoComponents() {
  for (const ComponentUnknown& component : components_) {
    few_.segment<6>(component.first) =
        ldltSolve(component.mass, component.imageProducts(dynamicsOf(component).matrix().solution()));
    component.addMotions(-few_.segment<6>(component.first), dynamicsOf(component));
  }
}

void SystemSolve::moveOutOfComponents() {
  for (const ComponentUnknown& component : components_)
    component.addMotions(few_.segment<6>(component.first), dynamicsOf(component));
}

/// Z^T A (y + Z q)
Vector6 SystemSolve::momentumOf(const ComponentUnknown& component) const {
  return component.imageProducts(dynamicsOf(component).matrix().solution()) +
         component.mass * few_.segment<6>(component.first);
}

/// The nodes' equations also contain each component's rigid motion, and must agree with its own equation about it:
/// together they are singular, and where they contradict each other the conjugate gradient does not converge. Forces of
/// stiff bodies, whose sum is 0, differ by rounding of that size.
void SystemSolve::matchComponents() {
  for (const ComponentUnknown& component : components_) {
    btScalar* residual = dynamicsOf(component).matrix().residual();
    const Vector6 excess =
        component.motionProducts(dynamicsOf(component), residual) - fewResidual_.segment<6>(component.first);
    component.addImages(-ldltSolve(component.mass, excess), residual);
  }
}

bool SystemSolve::collidesWithFew(std::size_t r) const {
  assert(r < endParts_.size());
  const ContactRow& row = *system_.rows[r];
  for (std::size_t e = 0; e < 2; ++e) {
    if (row.ends[e].rigid.unknown >= 0 || endParts_[r][e].component >= 0) return true;
  }
  return false;
}

/// Index of the component's six among the few unknowns.
Eigen::Index SystemSolve::firstOf(const EndPart& end) const {
  assert(end.component >= 0 && static_cast<std::size_t>(end.component) < components_.size());
  return components_[static_cast<std::size_t>(end.component)].first;
}

/// The velocity that the few unknowns give a row.
btVector3 SystemSolve::fewVelocity(std::size_t r, const Vector& few) const {
  btVector3 sum(0, 0, 0);
  for (std::size_t e = 0; e < 2; ++e) {
    const EndPart& end = endParts_[r][e];
    btVector3 velocity = step_.rigids.velocity(system_.rows[r]->ends[e].rigid, few);
    if (end.component >= 0) velocity += toBullet(end.motions * few.segment<6>(firstOf(end)));
    sum += btScalar(signOf(e)) * velocity;
  }
  return sum;
}

/// The transpose of `fewVelocity`: adds the effect of an impulse of the row on the few unknowns.
void SystemSolve::addRowPush(std::size_t r, const btVector3& push, Vector& to) const {
  for (std::size_t e = 0; e < 2; ++e) {
    const EndPart& end = endParts_[r][e];
    const btVector3 own = btScalar(signOf(e)) * push;
    step_.rigids.addImpulse(system_.rows[r]->ends[e].rigid, own, to);
    if (end.component >= 0) to.segment<6>(firstOf(end)) += end.motions.transpose() * toEigen(own);
  }
}

/// The momentum of rigid bodies and components that is left without rows.
void SystemSolve::findFewResiduals() {
  assert(fewResidual_.size() == fewSize_ && rigidMomentum_.size() == rigidSize_);
  fewResidual_.head(rigidSize_) -= rigidMomentum_;
  partsBefore_ = Vector::Zero(fewSize_);
  for (const ComponentUnknown& component : components_) {
    partsBefore_.segment<6>(component.first) = momentumOf(component);
    fewResidual_.segment<6>(component.first) += component.began - partsBefore_.segment<6>(component.first);
  }
}

/// The matrix of the few unknowns without the masses of rigid bodies: what rows, and the masses of components, couple
/// them by.
SystemSolve::Matrix SystemSolve::fewMatrix() const {
  Matrix few = Matrix::Zero(fewSize_, fewSize_);
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    if (system_.rows[r]->state == ContactRow::State::Apart || !collidesWithFew(r)) continue;
    const Eigen::Matrix3d h = toEigenMatrix(system_.rows[r]->tangent);
    for (std::size_t a = 0; a < 2; ++a) {
      for (std::size_t b = 0; b < 2; ++b) addFewStiffness(r, a, b, h, few);
    }
  }
  for (const ComponentUnknown& component : components_)
    few.block<6, 6>(component.first, component.first) += component.mass;
  return few;
}

/// Adds the block of two ends of a row. The block of a rigid body and a component, and its transpose, are added when
/// the component's end comes first.
void SystemSolve::addFewStiffness(std::size_t r, std::size_t a, std::size_t b, const Eigen::Matrix3d& h,
                                  Matrix& few) const {
  const RowEnd &first = system_.rows[r]->ends[a], &second = system_.rows[r]->ends[b];
  const double sign = signOf(a) * signOf(b);
  step_.rigids.addStiffness(first.rigid, second.rigid, h, sign, few);
  const EndPart &end = endParts_[r][a], &other = endParts_[r][b];
  if (end.component < 0) return;
  if (other.component >= 0) {
    few.block<6, 6>(firstOf(end), firstOf(other)) += sign * end.motions.transpose() * h * other.motions;
  }
  for (Eigen::Index k = 0; k < 6 && second.rigid.unknown >= 0; ++k) {
    Vector push = Vector::Zero(rigidSize_);
    step_.rigids.addImpulse(second.rigid, toBullet(sign * h * end.motions.col(k)), push);
    few.col(firstOf(end) + k).head(rigidSize_) += push;
    few.row(firstOf(end) + k).head(rigidSize_) += push.transpose();
  }
}

/// The equations of rigid bodies are multiplied by M^-1, in which axes may be locked.
void SystemSolve::eliminate() {
  if (fewSize_ == 0) return;
  matchComponents();
  Matrix scale = Matrix::Identity(fewSize_, fewSize_);
  scale.topLeftCorner(rigidSize_, rigidSize_) = inverseMass_;
  Matrix system = scale * fewMatrix();
  system.topLeftCorner(rigidSize_, rigidSize_) += Matrix::Identity(rigidSize_, rigidSize_);
  compliance_ = system.partialPivLu().solve(scale);
  addFew(compliance_ * fewResidual_, true);
}

/// Adds the effect of the few unknowns on the nodes, to their residuals or to the products.
void SystemSolve::addFew(const Vector& few, bool toResiduals) {
  const auto target = [&](std::size_t body) {
    return toResiduals ? step_.bodies.bodies()[body].dynamics->matrix().residual() : step_.extras[body].data();
  };
  const btScalar sign = toResiduals ? btScalar(-1) : btScalar(1);
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    if (row.state == ContactRow::State::Apart || !collidesWithFew(r)) continue;
    const btVector3 push = sign * (row.tangent * fewVelocity(r, few));
    for (std::size_t e = 0; e < 2; ++e) {
      const RowEnd& end = row.ends[e];
      if (end.isSoft()) addToNodes(end, btScalar(signOf(e)) * push, target(end.body));
    }
  }
  for (const ComponentUnknown& component : components_) {
    component.addImages(static_cast<double>(sign) * few.segment<6>(component.first), target(component.body));
  }
}

/// The effect of the nodes' steps of the conjugate gradient on the few unknowns.
SystemSolve::Vector SystemSolve::fewOf() const {
  Vector few = Vector::Zero(fewSize_);
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    if (row.state == ContactRow::State::Apart || !collidesWithFew(r)) continue;
    addRowPush(r, -(row.tangent * nodesOf(row, true)), few);
  }
  for (const ComponentUnknown& component : components_) {
    few.segment<6>(component.first) -= component.imageProducts(dynamicsOf(component).matrix().step());
  }
  return few;
}

/// Adds the blocks that couple the nodes of two ends; the matrices contain the blocks of each end with itself.
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
  assert(added.size() == system_.bodies.size() && compliance_.rows() == fewSize_);
  step_.beginProducts(system_);
  addCrossProducts();
  if (fewSize_ > 0) addFew(compliance_ * fewOf(), false);
  for (std::size_t k = 0; k < system_.bodies.size(); ++k) added[k] = step_.extras[system_.bodies[k]].data();
}

/// Computes the few unknowns from the nodes' change in the pass.
void SystemSolve::moveFew() {
  assert(before_.size() == system_.rows.size());
  Vector push = fewResidual_;
  for (std::size_t r = 0; r < system_.rows.size() && fewSize_ > 0; ++r) {
    const ContactRow& row = *system_.rows[r];
    if (row.state != ContactRow::State::Apart) addRowPush(r, -(row.tangent * (velocityOf(r) - before_[r])), push);
  }
  for (const ComponentUnknown& component : components_) {
    push.segment<6>(component.first) -= component.imageProducts(dynamicsOf(component).matrix().solution()) -
                                        component.imageProducts(states_[indexOf(component.body)].solution.data());
  }
  if (fewSize_ > 0) fewStep_ = compliance_ * push;
  few_ += fewStep_;
  stepped_.resize(system_.rows.size());
  // The momentum M times the step is the residual of the bodies' equation, minus what rows take back.
  Vector left = fewResidual_;
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const ContactRow& row = *system_.rows[r];
    stepped_[r] = velocityOf(r) - before_[r];
    if (rigidSize_ > 0 && row.state != ContactRow::State::Apart) addRowPush(r, -(row.tangent * stepped_[r]), left);
  }
  rigidPush_ = left.head(rigidSize_);
  rigidMomentum_ += rigidPush_;
}

/// The residual that is left is small in terms of velocity, but with stiff rows its impulses need not be small. The few
/// unknowns take them up, so that momentum agrees with the rows' impulses while velocities hardly change.
void SystemSolve::settleFew() {
  if (fewSize_ == 0) return;
  const Vector change = compliance_ * fewResidual_;
  few_ += change;
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    ContactRow& row = *system_.rows[r];
    if (row.state != ContactRow::State::Apart) row.impulse -= row.tangent * fewVelocity(r, change);
  }
}

std::size_t SystemSolve::indexOf(std::size_t body) const {
  assert(std::find(system_.bodies.begin(), system_.bodies.end(), body) != system_.bodies.end());
  return static_cast<std::size_t>(std::find(system_.bodies.begin(), system_.bodies.end(), body) -
                                  system_.bodies.begin());
}

}  // namespace tetskin
