// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What couples the bodies of a system: rows between two of them, the reduced unknowns, and other forces. The bodies'
// matrices contain the blocks of each end of a row with itself; the rest is added to their products in each iteration.
//
// The reduced unknowns of a system: V of rigid bodies, and q of the components of stiff bodies. They are eliminated
// from the nodes' equations, and are computed from the nodes' velocities afterwards.
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/system/system_solve.h>

#include <algorithm>
#include <cassert>

namespace tetskin::bullet_detail {
namespace {

/// Stiffness factor from which on the rigid motions of components are separate unknowns.
constexpr double kStiffPart = 5.0;
/// Most components of a body whose rigid motions are separate unknowns.
constexpr std::size_t kMaxParts = 64;

Small3x3 toSmallMatrix(const btMatrix3x3& m) {
  Small3x3 to;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) to(i, j) = static_cast<double>(m[i][j]);
  }
  return to;
}

}  // namespace

SystemSolve::Vector SystemSolve::zeros(Eigen::Index size) {
  Vector v(size);
  std::fill(v.data(), v.data() + size, 0.0);
  return v;
}

void SystemSolve::addTimes(double factor, const Vector& of, Vector& to) {
  assert(of.size() <= to.size());
  for (Eigen::Index k = 0; k < of.size(); ++k) to[k] += factor * of[k];
}

double SystemSolve::dotOfFirst(Eigen::Index size, const Vector& a, const Vector& b) {
  assert(size <= a.size() && size <= b.size());
  double sum = 0.0;
  for (Eigen::Index k = 0; k < size; ++k) sum += a[k] * b[k];
  return sum;
}

void SystemSolve::numberRigids() {
  for (const std::size_t r : system_.rigids) {
    RigidUnknown& unknown = in_.rigids.list()[r];
    unknown.first = schurComplement_.addRigid(unknown.inverseMass);
  }
  rigidSize_ = schurComplement_.size();
  rigidMomentum_ = rigidPush_ = zeros(rigidSize_);
}

void SystemSolve::collectComponents() {
  componentOf_.assign(system_.rows.size(), {nullptr, nullptr});
  std::vector<std::vector<ComponentUnknown>> found(bodies_.size());
  forEachBody([&](Body& body, ParallelFor* inner) {
    if (!needsComponents(body)) return;
    found[body.solved.place] = ComponentUnknown::makeAll(body.dynamics(), kMaxParts, inner);
  });
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    bodies_[k].firstComponent = components_.size();
    for (ComponentUnknown& unknown : found[k]) {
      unknown.body = bodies_[k].index;
      unknown.first = schurComplement_.add(static_cast<Eigen::Index>(Dynamics::kRigidMotions));
      components_.push_back(std::move(unknown));
    }
    bodies_[k].lastComponent = components_.size();
  }
  if (!components_.empty()) motionsOf_.assign(system_.rows.size(), {});
  forEachBody([&](Body& body, ParallelFor*) { findEndMotions(body); });
  reducedSize_ = schurComplement_.size();
  reduced_ = reducedStep_ = reducedResidual_ = images_ = imagesBefore_ = partsBefore_ = zeros(reducedSize_);
  stepImages_ = reduced_;
  if (reducedSize_ > 0) coupleReduced();
}

/// Finds which of the reduced unknowns rows couple.
void SystemSolve::coupleReduced() {
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const Eigen::Index first = firstReduced(r, 0), second = firstReduced(r, 1);
    if (first >= 0 || second >= 0) reducedRows_.push_back(r);
    if (first >= 0 && second >= 0) schurComplement_.couple(first, second);
  }
  schurComplement_.order();
}

/// The first of the reduced unknowns that move an end; below 0: none does.
Eigen::Index SystemSolve::firstReduced(std::size_t r, std::size_t e) const {
  assert(r < componentOf_.size());
  if (isOnComponent(r, e)) return componentOf_[r][e]->first;
  const int unknown = system_.rows[r]->ends[e].rigid.unknown;
  return unknown < 0 ? -1 : in_.rigids.list()[static_cast<std::size_t>(unknown)].first;
}

/// The separate unknowns do not include other forces on the nodes.
bool SystemSolve::needsComponents(const Body& body) const {
  const SolvedBody& solved = body.solved;
  if (!solved.elastic || solved.rowCount == 0 || !system_.forces.empty() || !solved.fixed.empty()) return false;
  return !(solved.dynamics->stiffnessNumber() < kStiffPart) || isJoined(body);
}

bool SystemSolve::isJoined(const Body& body) const {
  return std::any_of(body.ends.list().begin(), body.ends.list().end(), [&](const BodyEnd& end) {
    return end.index == 0 && system_.rows[end.row]->joined && !system_.rows[end.row]->constant;
  });
}

void SystemSolve::findEndMotions(const Body& body) {
  assert(componentOf_.size() == system_.rows.size());
  for (std::size_t c = body.firstComponent; c < body.lastComponent; ++c) {
    for (const BodyEnd& end : body.ends.list()) {
      const RowMotions motions = components_[c].motionsAt(body.dynamics(), pointOf(end.row, end.index));
      if (isZero(motions)) continue;
      componentOf_[end.row][end.index] = &components_[c];
      motionsOf_[end.row][end.index] = motions;
    }
  }
}

/// Moves the rigid motions of the components out of the solution into the separate unknowns.
void SystemSolve::moveIntoComponents(const Body& body) {
  for (std::size_t c = body.firstComponent; c < body.lastComponent; ++c) {
    const ComponentUnknown& component = components_[c];
    const Small6 moved = SmallLdlt<6>(component.mass).solve(component.imageProducts(body.matrix().solution()));
    setPart(reduced_, component, moved);
    component.addMotions(-moved, body.dynamics());
  }
}

void SystemSolve::moveOutOfComponents(const Body& body) {
  for (std::size_t c = body.firstComponent; c < body.lastComponent; ++c)
    components_[c].addMotions(partOf(reduced_, components_[c]), body.dynamics());
}

/// Z^T A (y + Z q)
Small6 SystemSolve::momentumOf(const ComponentUnknown& component) const {
  return partOf(images_, component) + component.mass * partOf(reduced_, component);
}

/// The nodes' equations also contain each component's rigid motion, and must agree with its own equation about it:
/// together they are singular, and where they contradict each other the conjugate gradient does not converge. Forces of
/// stiff bodies, whose sum is 0, differ by rounding of that size.
void SystemSolve::matchComponents(const Body& body) {
  btScalar* residual = body.matrix().residual();
  for (std::size_t c = body.firstComponent; c < body.lastComponent; ++c) {
    const ComponentUnknown& component = components_[c];
    const Small6 excess = component.motionProducts(residual) - partOf(reducedResidual_, component);
    component.addImages(-SmallLdlt<6>(component.mass).solve(excess), residual);
  }
}

bool SystemSolve::couplesReduced(std::size_t r) const {
  return firstReduced(r, 0) >= 0 || firstReduced(r, 1) >= 0;
}

/// The velocity that the reduced unknowns give a row.
btVector3 SystemSolve::reducedVelocity(std::size_t r, const Vector& reduced) const {
  btVector3 sum(0, 0, 0);
  for (std::size_t e = 0; e < 2; ++e) {
    btVector3 velocity = in_.rigids.velocity(system_.rows[r]->ends[e].rigid, reduced);
    if (isOnComponent(r, e)) {
      velocity += fromSmall(motionsOf_[r][e] * partOf(reduced, *componentOf_[r][e]));
    }
    sum += btScalar(signOf(e)) * velocity;
  }
  return sum;
}

/// The transpose of `reducedVelocity`: adds the effect of an impulse of the row on the reduced unknowns.
void SystemSolve::addRowPush(std::size_t r, const btVector3& push, Vector& to) const {
  for (std::size_t e = 0; e < 2; ++e) {
    const btVector3 own = btScalar(signOf(e)) * push;
    in_.rigids.addImpulse(system_.rows[r]->ends[e].rigid, own, to);
    if (isOnComponent(r, e)) {
      addPart(to, *componentOf_[r][e], transposeTimes(motionsOf_[r][e], toSmall(own)));
    }
  }
}

/// Adds what the rows take back if their velocities change by these.
void SystemSolve::addRowPushes(const std::vector<btVector3>& steps, Vector& to) const {
  for (const std::size_t r : reducedRows_) {
    const ContactRow& row = *system_.rows[r];
    if (row.state != ContactRow::State::Apart) addRowPush(r, -(row.tangent * steps[r]), to);
  }
}

/// The momentum of rigid bodies and components that is left.
void SystemSolve::findReducedResiduals() {
  assert(reducedResidual_.size() == reducedSize_ && rigidMomentum_.size() == rigidSize_);
  std::fill(reducedResidual_.data(), reducedResidual_.data() + reducedSize_, 0.0);
  addTimes(-1.0, rigidMomentum_, reducedResidual_);
  imagesBefore_ = images_;
  for (const ComponentUnknown& component : components_) {
    const Small6 momentum = momentumOf(component);
    setPart(partsBefore_, component, momentum);
    addPart(reducedResidual_, component, component.began - momentum);
  }
  for (const std::size_t r : reducedRows_) {
    addRowPush(r, system_.rows[r]->impulse - system_.rows[r]->given, reducedResidual_);
  }
}

void SystemSolve::eliminate() {
  if (reducedSize_ == 0) return;
  findReducedStiffness();
  schurComplement_.factor();
  const Vector reduced = schurComplement_.solve(reducedResidual_);
  forEachBody([&](Body& body, ParallelFor*) { addReduced(body, reduced, -1, false, body.matrix().residual()); });
}

/// The matrix of the reduced unknowns without the masses of rigid bodies: what rows, and the masses of components,
/// couple them by.
void SystemSolve::findReducedStiffness() {
  schurComplement_.setZero();
  for (const std::size_t r : reducedRows_) {
    if (system_.rows[r]->state == ContactRow::State::Apart) continue;
    const Small3x3 h = toSmallMatrix(system_.rows[r]->tangent);
    for (std::size_t a = 0; a < 2; ++a) {
      for (std::size_t b = 0; b < 2; ++b) addReducedStiffness(r, a, b, h);
    }
  }
  for (const ComponentUnknown& component : components_) {
    schurComplement_.add(component.first, component.first, component.mass);
  }
}

/// Adds J_a^T H J_b, where it belongs to the lower triangle.
void SystemSolve::addReducedStiffness(std::size_t r, std::size_t a, std::size_t b, const Small3x3& h) {
  const Eigen::Index first = firstReduced(r, a), second = firstReduced(r, b);
  if (second < 0 || first < second) return;
  const double sign = signOf(a) * signOf(b);
  if (hasRowMotions(r, a) && hasRowMotions(r, b)) {  // nearly always, so that nothing is allocated
    schurComplement_.add(first, second, sign * (transposeTimes(rowMotions(r, a), h) * rowMotions(r, b)));
  } else {
    schurComplement_.addProduct(first, second, sign, jacobianOf(r, a), h, jacobianOf(r, b));
  }
}

/// True if six unknowns move the end: those of a body or a component.
bool SystemSolve::hasRowMotions(std::size_t r, std::size_t e) const {
  return isOnComponent(r, e) || system_.rows[r]->ends[e].rigid.jacobian < 0;
}

RowMotions SystemSolve::rowMotions(std::size_t r, std::size_t e) const {
  assert(hasRowMotions(r, e));
  return isOnComponent(r, e) ? motionsOf_[r][e] : bodyJacobian(system_.rows[r]->ends[e].rigid);
}

RigidUnknowns::Jacobian SystemSolve::jacobianOf(std::size_t r, std::size_t e) const {
  return isOnComponent(r, e) ? RigidUnknowns::toJacobian(motionsOf_[r][e])
                             : in_.rigids.jacobianOf(system_.rows[r]->ends[e].rigid);
}

/// Adds the effect of changes of the reduced unknowns on the body's nodes.
/// withOthers  adds that of the steps of the rows' other ends, too
/// to          in the wide layout: residuals or products
void SystemSolve::addReduced(const Body& body, const Vector& reduced, btScalar sign, bool withOthers,
                             btScalar* to) const {
  for (const std::uint32_t k : body.coupled) {
    const BodyEnd& end = body.ends.list()[k];
    const bool byOther = withOthers && end.byOther;
    if (!byOther && !end.byReduced) continue;
    const btScalar own = btScalar(signOf(end.index));
    btVector3 velocity(0, 0, 0);
    if (end.byReduced) velocity = reducedVelocity(end.row, reduced);
    if (byOther) velocity -= own * endSteps_[end.row][1 - end.index];
    body.ends.addImpulse(end, (sign * own) * (system_.rows[end.row]->tangent * velocity), to);
  }
  for (std::size_t c = body.firstComponent; c < body.lastComponent; ++c) {
    components_[c].addImages(static_cast<double>(sign) * partOf(reduced, components_[c]), to);
  }
}

/// Computes the reduced unknowns from the nodes' change in the pass.
void SystemSolve::moveReduced() {
  assert(before_.size() == system_.rows.size());
  forEachBody([&](Body& body, ParallelFor*) {
    if (body.moves) readSolution(body);
  });
  forEachRow([&](std::size_t r) { stepped_[r] = velocityOf(r) - before_[r]; });
  if (reducedSize_ == 0) return;
  // The momentum M times the step is the residual of the bodies' equation, minus what rows take back.
  Vector push = reducedResidual_, left = reducedResidual_;
  addRowPushes(stepped_, push);
  for (const ComponentUnknown& component : components_) {
    addPart(push, component, -(partOf(images_, component) - partOf(imagesBefore_, component)));
  }
  reducedStep_ = schurComplement_.solve(push);
  addTimes(1.0, reducedStep_, reduced_);
  forEachRow([&](std::size_t r) { stepped_[r] = velocityOf(r) - before_[r]; });
  if (rigidSize_ == 0) return;
  addRowPushes(stepped_, left);
  std::copy(left.data(), left.data() + rigidSize_, rigidPush_.data());
  addTimes(1.0, rigidPush_, rigidMomentum_);
}

/// The residual that is left is small in terms of velocity, but with stiff rows its impulses need not be small. The few
/// unknowns take them up, so that momentum agrees with the rows' impulses while velocities hardly change.
void SystemSolve::settleReduced() {
  if (reducedSize_ == 0) return;
  const Vector change = schurComplement_.solve(reducedResidual_);
  addTimes(1.0, change, reduced_);
  for (const std::size_t r : reducedRows_) {
    ContactRow& row = *system_.rows[r];
    if (row.state != ContactRow::State::Apart) row.impulse -= row.tangent * reducedVelocity(r, change);
  }
}

// ---- products

/// Computes the velocities that the body's step gives the rows' ends, and its images.
void SystemSolve::readPoints(std::size_t k) {
  assert(k < moving_.size());
  const Body& body = bodies_[moving_[k]];
  for (const std::uint32_t e : body.coupled) {
    const BodyEnd& end = body.ends.list()[e];
    endSteps_[end.row][end.index] = body.ends.stepVelocity(end);
  }
  for (std::size_t c = body.firstComponent; c < body.lastComponent; ++c) {
    setPart(stepImages_, components_[c], components_[c].imageProducts(body.matrix().step()));
  }
}

void SystemSolve::combine() {
  if (!system_.forces.empty()) in_.others.multiplySteps(system_);
  if (reducedSize_ == 0) return;
  Vector push = stepImages_;
  for (Eigen::Index k = 0; k < push.size(); ++k) push[k] = -push[k];
  for (const std::size_t r : reducedRows_) {
    const ContactRow& row = *system_.rows[r];
    if (row.state != ContactRow::State::Apart) addRowPush(r, row.tangent * (endSteps_[r][1] - endSteps_[r][0]), push);
  }
  reducedOfStep_ = schurComplement_.solve(std::move(push));
}

const btScalar* SystemSolve::apply(std::size_t k) {
  assert(k < moving_.size());
  const Body& body = bodies_[moving_[k]];
  std::vector<btScalar>& sum = in_.others.products(body.index);
  if (system_.forces.empty()) sum.assign(body.matrix().wideSize(), btScalar(0));
  addReduced(body, reducedOfStep_, 1, true, sum.data());
  return sum.data();
}

}  // namespace tetskin::bullet_detail
