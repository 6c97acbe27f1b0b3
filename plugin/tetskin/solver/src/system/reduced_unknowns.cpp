// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/system/reduced_unknowns.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace tetskin::bullet_detail {
namespace {

using Vector = Eigen::VectorXd;

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

// Vectors of the unknowns. By loops: each of Eigen's expressions takes the compiler tenths of a second.
Vector zeroVector(Eigen::Index size) {
  Vector v(size);
  std::fill(v.data(), v.data() + size, 0.0);
  return v;
}

/// to += factor of, for all numbers of `of`, which is the shorter one
void addTimes(double factor, const Vector& of, Vector& to) {
  assert(of.size() <= to.size());
  for (Eigen::Index k = 0; k < of.size(); ++k) to[k] += factor * of[k];
}

/// The product of the first `size` numbers of both.
double dotOfFirst(Eigen::Index size, const Vector& a, const Vector& b) {
  assert(size <= a.size() && size <= b.size());
  double sum = 0.0;
  for (Eigen::Index k = 0; k < size; ++k) sum += a[k] * b[k];
  return sum;
}

Small6 partOf(const Vector& of, const ComponentUnknown& component) {
  assert(component.first + 6 <= of.size());
  return smallFrom<6>(of.data() + component.first);
}
void setPart(Vector& of, const ComponentUnknown& component, const Small6& to) {
  std::copy(to.values, to.values + 6, of.data() + component.first);
}
void addPart(Vector& of, const ComponentUnknown& component, const Small6& more) {
  setPart(of, component, partOf(of, component) + more);
}

}  // namespace

ReducedUnknowns::ReducedUnknowns(SystemBodies& bodies) : bodies_(bodies), rigids_(bodies.input().rigids) {
  numberRigids();
  collectComponents();
  bodies_.forEachBody([&](SystemBody& body, ParallelFor*) { moveIn(body); });
}

void ReducedUnknowns::numberRigids() {
  for (const std::size_t r : bodies_.system().rigids) {
    RigidUnknown& unknown = rigids_.list()[r];
    unknown.first = schurComplement_.addRigid(unknown.inverseMass);
  }
  rigidSize_ = schurComplement_.size();
  rigidMomentum_ = rigidPush_ = zeroVector(rigidSize_);
}

void ReducedUnknowns::collectComponents() {
  componentOf_.assign(bodies_.rowCount(), {nullptr, nullptr});
  std::vector<std::vector<ComponentUnknown>> found(bodies_.list().size());
  bodies_.forEachBody([&](SystemBody& body, ParallelFor* inner) {
    if (needsComponents(body)) {
      found[body.solved.solve.place] = ComponentUnknown::makeAll(body.dynamics(), kMaxParts, inner);
    }
  });
  for (std::size_t k = 0; k < found.size(); ++k) {
    const std::size_t first = components_.size();
    for (ComponentUnknown& unknown : found[k]) {
      unknown.body = bodies_.list()[k].index;
      unknown.first = schurComplement_.add(static_cast<Eigen::Index>(Dynamics::kRigidMotions));
      components_.push_back(std::move(unknown));
    }
    componentsOf_.emplace_back(first, components_.size());
  }
  if (!components_.empty()) motionsOf_.assign(bodies_.rowCount(), {});
  bodies_.forEachBody([&](SystemBody& body, ParallelFor*) { findEndMotions(body); });
  size_ = schurComplement_.size();
  unknowns_ = step_ = residual_ = images_ = imagesBefore_ = momentaBefore_ = zeros();
  if (!empty()) couple();
}

/// Finds which of the unknowns rows couple.
void ReducedUnknowns::couple() {
  for (std::size_t r = 0; r < bodies_.rowCount(); ++r) {
    const Eigen::Index first = firstOf(r, 0), second = firstOf(r, 1);
    if (first >= 0 || second >= 0) rows_.push_back(r);
    if (first >= 0 && second >= 0) schurComplement_.couple(first, second);
  }
  schurComplement_.order();
}

/// The first of the unknowns that move an end; below 0: none does.
Eigen::Index ReducedUnknowns::firstOf(std::size_t r, std::size_t e) const {
  assert(r < componentOf_.size());
  if (isOnComponent(r, e)) return componentOf_[r][e]->first;
  const int unknown = bodies_.row(r).ends[e].rigid.unknown;
  return unknown < 0 ? -1 : rigids_.list()[static_cast<std::size_t>(unknown)].first;
}

/// The separate unknowns do not include other forces on the nodes.
bool ReducedUnknowns::needsComponents(const SystemBody& body) const {
  const SolvedBody& solved = body.solved;
  if (!solved.elastic || solved.acted.rowCount == 0 || bodies_.hasForces() || !solved.acted.fixed.empty()) return false;
  const bool needs = solved.dynamics->isStretched() || !(solved.dynamics->stiffnessNumber() < kStiffPart);
  return needs || isJoined(body);
}

bool ReducedUnknowns::isJoined(const SystemBody& body) const {
  return std::any_of(body.ends.list().begin(), body.ends.list().end(), [&](const BodyEnd& end) {
    return end.index == 0 && bodies_.row(end.row).joined && !bodies_.row(end.row).constant;
  });
}

/// An end on several components, as a sample between two may be, counts as one of the last of them.
void ReducedUnknowns::findEndMotions(const SystemBody& body) {
  const auto& [first, last] = componentsOf_[body.solved.solve.place];
  const auto begin = components_.begin() + static_cast<std::ptrdiff_t>(first),
             end = components_.begin() + static_cast<std::ptrdiff_t>(last);
  if (begin == end) return;
  for (const BodyEnd& of : body.ends.list()) {
    const CarriedPoint& point = bodies_.pointOf(of.row, of.index);
    const ComponentUnknown*& met = componentOf_[of.row][of.index];
    for (std::uint32_t k = 0; k < point.count; ++k) {
      const std::size_t number = body.dynamics().componentOf(static_cast<std::size_t>(point.nodes[k]));
      if (met && number <= met->component) continue;
      const auto found = std::lower_bound(begin, end, number, [](const ComponentUnknown& unknown, std::size_t wanted) {
        return unknown.component < wanted;
      });
      if (found == end || found->component != number) continue;
      const RowMotions motions = found->motionsAt(body.dynamics(), point);
      if (isZero(motions)) continue;
      met = &*found;
      motionsOf_[of.row][of.index] = motions;
    }
  }
}

void ReducedUnknowns::moveIn(const SystemBody& body) {
  forComponents(body, [&](const ComponentUnknown& component) {
    const Small6 moved = SmallLdlt<6>(component.mass).solve(component.imageProducts(body.matrix().solution()));
    setPart(unknowns_, component, moved);
    component.addMotions(-moved, body.dynamics());
  });
}

void ReducedUnknowns::moveOut(const SystemBody& body) const {
  forComponents(body, [&](const ComponentUnknown& component) {
    component.addMotions(partOf(unknowns_, component), body.dynamics());
  });
}

void ReducedUnknowns::setImages(const SystemBody& body, const btScalar* wide, Vector& to) const {
  assert(to.size() == size_);
  forComponents(body, [&](const ComponentUnknown& c) { setPart(to, c, c.imageProducts(wide)); });
}

void ReducedUnknowns::readSolution(const SystemBody& body) {
  setImages(body, body.matrix().solution(), images_);
}

void ReducedUnknowns::addImages(const SystemBody& body) const {
  forComponents(body, [&](const ComponentUnknown& component) {
    component.addImages(-partOf(unknowns_, component), body.matrix().residual());
  });
}

/// Z^T A (y + Z q)
Small6 ReducedUnknowns::momentumOf(const ComponentUnknown& component) const {
  return partOf(images_, component) + component.mass * partOf(unknowns_, component);
}

double ReducedUnknowns::squaredByMasses(const ComponentUnknown& component) const {
  assert(stage_ == Stage::Residual);
  return dot(partOf(unknowns_, component), partOf(momentaBefore_, component));
}

/// The nodes' equations also contain each component's rigid motion, and must agree with its own equation about it:
/// together they are singular, and where they contradict each other the conjugate gradient does not converge. Forces of
/// stiff bodies, whose sum is 0, differ by rounding of that size.
void ReducedUnknowns::matchComponents(const SystemBody& body) const {
  assert(stage_ == Stage::Residual);
  btScalar* residual = body.matrix().residual();
  forComponents(body, [&](const ComponentUnknown& component) {
    const Small6 excess = component.motionProducts(residual) - partOf(residual_, component);
    component.addImages(-SmallLdlt<6>(component.mass).solve(excess), residual);
  });
}

btVector3 ReducedUnknowns::velocityBy(std::size_t r, const Vector& change) const {
  btVector3 sum(0, 0, 0);
  for (std::size_t e = 0; e < 2; ++e) {
    btVector3 velocity = rigids_.velocity(bodies_.row(r).ends[e].rigid, change);
    if (isOnComponent(r, e)) velocity += fromSmall(motionsOf_[r][e] * partOf(change, *componentOf_[r][e]));
    sum += btScalar(signOf(e)) * velocity;
  }
  return sum;
}

/// The transpose of `velocityBy`: adds the effect of an impulse of the row on the unknowns.
void ReducedUnknowns::addPush(std::size_t r, const btVector3& push, Vector& to) const {
  for (std::size_t e = 0; e < 2; ++e) {
    const btVector3 own = btScalar(signOf(e)) * push;
    rigids_.addImpulse(bodies_.row(r).ends[e].rigid, own, to);
    if (isOnComponent(r, e)) addPart(to, *componentOf_[r][e], transposeTimes(motionsOf_[r][e], toSmall(own)));
  }
}

/// Adds what the rows take back if their velocities change by these.
void ReducedUnknowns::addPushes(const std::vector<btVector3>& steps, Vector& to) const {
  assert(steps.size() == bodies_.rowCount());
  for (const std::size_t r : rows_) {
    const ContactRow& row = bodies_.row(r);
    if (row.state != ContactRow::State::Apart) addPush(r, -(row.tangent * steps[r]), to);
  }
}

// ---- a pass

void ReducedUnknowns::findResidual() {
  assert(stage_ == Stage::Current);
  stage_ = Stage::Residual;
  std::fill(residual_.data(), residual_.data() + size_, 0.0);
  addTimes(-1.0, rigidMomentum_, residual_);
  imagesBefore_ = images_;
  for (const ComponentUnknown& component : components_) {
    const Small6 momentum = momentumOf(component);
    setPart(momentaBefore_, component, momentum);
    addPart(residual_, component, component.began - momentum);
  }
  for (const std::size_t r : rows_) addPush(r, bodies_.row(r).impulse - bodies_.row(r).given, residual_);
}

void ReducedUnknowns::eliminate() {
  assert(stage_ == Stage::Residual);
  stage_ = Stage::Eliminated;
  if (empty()) return;
  findStiffness();
  schurComplement_.factor();
  const Vector change = schurComplement_.solve(residual_);
  bodies_.forEachBody(
      [&](SystemBody& body, ParallelFor*) { addEffect(body, change, -1, nullptr, body.matrix().residual()); });
}

double ReducedUnknowns::squaredResidual() const {
  assert(stage_ == Stage::Eliminated);
  return empty() ? 0.0 : dotOfFirst(size_, residual_, schurComplement_.solve(residual_));
}

/// The matrix of the unknowns without the masses of rigid bodies: what rows, and the masses of components, couple them
/// by.
void ReducedUnknowns::findStiffness() {
  schurComplement_.setZero();
  for (const std::size_t r : rows_) {
    if (bodies_.row(r).state == ContactRow::State::Apart) continue;
    const Small3x3 h = toSmallMatrix(bodies_.row(r).tangent);
    for (std::size_t a = 0; a < 2; ++a) {
      for (std::size_t b = 0; b < 2; ++b) addStiffness(r, a, b, h);
    }
  }
  for (const ComponentUnknown& component : components_) {
    schurComplement_.add(component.first, component.first, component.mass);
  }
}

/// Adds J_a^T H J_b, where it belongs to the lower triangle.
void ReducedUnknowns::addStiffness(std::size_t r, std::size_t a, std::size_t b, const Small3x3& h) {
  const Eigen::Index first = firstOf(r, a), second = firstOf(r, b);
  if (second < 0 || first < second) return;
  const double sign = signOf(a) * signOf(b);
  if (hasRowMotions(r, a) && hasRowMotions(r, b)) {  // nearly always, so that nothing is allocated
    schurComplement_.add(first, second, sign * (transposeTimes(rowMotions(r, a), h) * rowMotions(r, b)));
  } else {
    schurComplement_.addProduct(first, second, sign, jacobianOf(r, a), h, jacobianOf(r, b));
  }
}

/// True if six unknowns move the end: those of a body or a component.
bool ReducedUnknowns::hasRowMotions(std::size_t r, std::size_t e) const {
  return isOnComponent(r, e) || bodies_.row(r).ends[e].rigid.jacobian < 0;
}

RowMotions ReducedUnknowns::rowMotions(std::size_t r, std::size_t e) const {
  assert(hasRowMotions(r, e));
  return isOnComponent(r, e) ? motionsOf_[r][e] : bodyJacobian(bodies_.row(r).ends[e].rigid);
}

RigidUnknowns::Jacobian ReducedUnknowns::jacobianOf(std::size_t r, std::size_t e) const {
  return isOnComponent(r, e) ? RigidUnknowns::toJacobian(motionsOf_[r][e])
                             : rigids_.jacobianOf(bodies_.row(r).ends[e].rigid);
}

/// The momentum M times the step is the residual of the unknowns' equation, minus what rows take back.
void ReducedUnknowns::move(const std::vector<btVector3>& steps) {
  assert(stage_ == Stage::Eliminated);
  stage_ = Stage::Moved;
  if (empty()) return;
  Vector push = residual_;
  addPushes(steps, push);
  for (const ComponentUnknown& component : components_) {
    addPart(push, component, -(partOf(images_, component) - partOf(imagesBefore_, component)));
  }
  step_ = schurComplement_.solve(push);
  addTimes(1.0, step_, unknowns_);
}

void ReducedUnknowns::takeBack(const std::vector<btVector3>& steps) {
  assert(stage_ == Stage::Moved);
  stage_ = Stage::Current;
  if (rigidSize_ == 0) return;
  Vector left = residual_;
  addPushes(steps, left);
  std::copy(left.data(), left.data() + rigidSize_, rigidPush_.data());
  addTimes(1.0, rigidPush_, rigidMomentum_);
}

void ReducedUnknowns::moveBack(btScalar fraction) {
  assert(fraction >= 0 && fraction <= 1 && stage_ == Stage::Current);
  const auto rest = static_cast<double>(1 - fraction);
  addTimes(-rest, step_, unknowns_);
  addTimes(-rest, rigidPush_, rigidMomentum_);
}

void ReducedUnknowns::settle() {
  assert(stage_ == Stage::Eliminated);
  stage_ = Stage::Current;
  if (empty()) return;
  const Vector change = schurComplement_.solve(residual_);
  addTimes(1.0, change, unknowns_);
  for (const std::size_t r : rows_) {
    ContactRow& row = bodies_.row(r);
    if (row.state != ContactRow::State::Apart) row.impulse -= row.tangent * velocityBy(r, change);
  }
}

Slope ReducedUnknowns::slopeOfRigids() const {
  Vector before = rigidMomentum_;
  addTimes(-1.0, rigidPush_, before);
  return {dotOfFirst(rigidSize_, step_, before), dotOfFirst(rigidSize_, step_, rigidPush_)};
}

void ReducedUnknowns::addSlopeOfComponents(Slope& to) const {
  for (const ComponentUnknown& component : components_) {
    const Small6 step = partOf(step_, component), was = partOf(momentaBefore_, component);
    to.linear += dot(step, was - component.began);
    to.quadratic += dot(step, momentumOf(component) - was);
  }
}

void ReducedUnknowns::apply() const {
  Vector push = zeros();
  for (const std::size_t r : rows_) {
    const ContactRow& row = bodies_.row(r);
    const btVector3 more = row.impulse - row.given;
    for (std::size_t e = 0; e < 2; ++e) rigids_.addImpulse(row.ends[e].rigid, btScalar(signOf(e)) * more, push);
  }
  const Vector change = schurComplement_.timesInverseMass(std::move(push));
  for (const std::size_t r : bodies_.system().rigids) RigidUnknowns::apply(rigids_.list()[r], change);
}

// ---- products

Vector ReducedUnknowns::zeros() const {
  return zeroVector(size_);
}

Vector ReducedUnknowns::changeBy(const Vector& images, const std::vector<EndVelocities>& endSteps) const {
  assert(stage_ == Stage::Eliminated && endSteps.size() == bodies_.rowCount());
  Vector push = images;
  for (Eigen::Index k = 0; k < push.size(); ++k) push[k] = -push[k];
  for (const std::size_t r : rows_) {
    const ContactRow& row = bodies_.row(r);
    if (row.state != ContactRow::State::Apart) addPush(r, row.tangent * (endSteps[r][1] - endSteps[r][0]), push);
  }
  return schurComplement_.solve(std::move(push));
}

void ReducedUnknowns::addEffect(const SystemBody& body, const Vector& change, btScalar sign,
                                const std::vector<EndVelocities>* endSteps, btScalar* to) const {
  for (const std::uint32_t k : body.coupled) {
    const BodyEnd& end = body.ends.list()[k];
    const bool byOther = endSteps && end.byOther;
    if (!byOther && !end.byReduced) continue;
    const btScalar own = btScalar(signOf(end.index));
    btVector3 velocity(0, 0, 0);
    if (end.byReduced) velocity = velocityBy(end.row, change);
    if (byOther) velocity -= own * (*endSteps)[end.row][1 - end.index];
    body.ends.addImpulse(end, (sign * own) * (bodies_.row(end.row).tangent * velocity), to);
  }
  forComponents(body, [&](const ComponentUnknown& component) {
    component.addImages(static_cast<double>(sign) * partOf(change, component), to);
  });
}

CoupledProducts::CoupledProducts(const SystemBodies& bodies, const ReducedUnknowns& reduced)
    : bodies_(bodies),
      reduced_(reduced),
      endSteps_(bodies.rowCount(), {btVector3(0, 0, 0), btVector3(0, 0, 0)}),
      images_(reduced.zeros()) {}

/// The ends on bodies that do not move take no steps.
void CoupledProducts::begin(std::vector<std::size_t> moving) {
  assert(!moving.empty() && std::is_sorted(moving.begin(), moving.end()));
  moving_ = std::move(moving);
  for (const SystemBody& body : bodies_.list()) {
    if (body.moves) continue;
    for (const std::uint32_t e : body.coupled) {
      const BodyEnd& end = body.ends.list()[e];
      endSteps_[end.row][end.index].setZero();
    }
  }
}

void CoupledProducts::readPoints(std::size_t k) {
  assert(k < moving_.size());
  const SystemBody& body = bodies_.list()[moving_[k]];
  for (const std::uint32_t e : body.coupled) {
    const BodyEnd& end = body.ends.list()[e];
    endSteps_[end.row][end.index] = body.ends.stepVelocity(end);
  }
  reduced_.setImages(body, body.matrix().step(), images_);
}

void CoupledProducts::combine() {
  if (bodies_.hasForces()) bodies_.input().others.multiplySteps(bodies_.system());
  if (!reduced_.empty()) change_ = reduced_.changeBy(images_, endSteps_);
}

const btScalar* CoupledProducts::apply(std::size_t k) {
  assert(k < moving_.size());
  const SystemBody& body = bodies_.list()[moving_[k]];
  std::vector<btScalar>& sum = bodies_.input().others.products(body.index);
  if (!bodies_.hasForces()) sum.assign(body.matrix().wideSize(), btScalar(0));
  reduced_.addEffect(body, change_, 1, &endSteps_, sum.data());
  return sum.data();
}

}  // namespace tetskin::bullet_detail
