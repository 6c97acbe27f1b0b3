// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <tetskin/touch/src/joints/joint.h>
#include <tetskin/touch/src/points/body_kind.h>
#include <tetskin/touch/src/points/corners.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace tetskin::touch_detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The unit of a spring's frequency: one over Bullet's usual substep.
constexpr double kUnitRate = 240.0;
/// Of the force allowed, what a spring gives at least that was too strong before.
constexpr double kLeastShare = 0.01;
/// What moves faster, in lengths a second, wakes what sleeps at the other end; Bullet's own threshold of sleep.
constexpr double kWakingSpeed = 0.04;

Vector3d turnOf(const Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

}  // namespace

Joint::Joint(const SurfacePoint& point, std::unique_ptr<Partner> partner, const JointSettings& settings)
    : point_(point),
      partner_(std::move(partner)),
      settings_(settings),
      nodeCount_(point.body()->m_nodes.size()),
      lever_(leverOf(point.data(), *point.body())),
      places_(placesOf(lever_, *point.body())),
      turned_(partner_->anchor().getBasis()) {
  btCollisionObject* other = partner_->object();
  if (settings.collide || !other) return;
  auto& hidden = point_.body()->m_collisionDisabledObjects;
  hidden_ = hidden.findLinearSearch(other) == hidden.size();
  if (hidden_) hidden.push_back(other);
}

Joint::~Joint() {
  drop();
}

void Joint::drop() {
  btSoftBody* of = body();
  if (of && hidden_) of->m_collisionDisabledObjects.remove(partner_->object());
  hidden_ = false;
  dropped_ = true;
  active_ = false;
}

Vector6 Joint::offset() const {
  return offsetOf(leverOf(point_.data(), *point_.body()));
}

Vector6 Joint::offsetOf(const Lever& lever) const {
  Vector6 way = Vector6::Zero();
  const btTransform anchor = partner_->anchor();
  way.head<3>() = toEigen(anchor.getOrigin() - linearPosition(point_.data(), *point_.body()));
  if (!settings_.turns) return way;
  const Matrix3d wanted = turnSince(places_, lever, *point_.body()) * toMatrix(turned_);
  way.tail<3>() = turnOf(toMatrix(anchor.getBasis()) * wanted.transpose());
  return way;
}

/// Within a step, when forces may hide a body's tets, which is all that `SurfacePoint::status` looks at besides.
bool Joint::readable() const {
  const btSoftBody& soft = *point_.body();
  return soft.m_nodes.size() == nodeCount_ && isFiniteVector(linearPosition(point_.data(), soft));
}

bool Joint::softMoves() const {
  return point_.body()->isActive();
}

/// What has come to rest stays so: each of the two may sleep while the other holds still.
void Joint::wake() {
  btCollisionObject* other = partner_->object();
  if (!other || other->isStaticOrKinematicObject() || softMoves() == other->isActive()) return;
  const double speed = softMoves() ? pointVelocity().head<3>().norm() : partner_->speed();
  if (speed > kWakingSpeed) softMoves() ? other->activate() : point_.body()->activate();
}

void Joint::begin(btScalar dt, int sharers) {
  active_ = false;
  if (spent() || !(dt > 0) || !readable()) return;
  lever_ = leverOf(point_.data(), *point_.body());
  dt_ = static_cast<double>(dt);
  sharers_ = sharers;
  offset_ = offsetOf(lever_);
  began_ = pointVelocity();
  active_ = true;
  wake();
}

Vector6 Joint::pointVelocity() const {
  Vector6 v = Vector6::Zero();
  if (!softMoves()) return v;
  v.head<3>() = velocityOf(lever_, *point_.body());
  if (settings_.turns) v.tail<3>() = spinOf(lever_, *point_.body());
  return v;
}

double Joint::stiffnessOf(const Matrix3d& pointResponse, const Matrix3d& partnerResponse) const {
  // Pinned nodes hold anything: then the partner's mass counts.
  const double mass = std::min(massOf(pointResponse), 1e30);
  return settings_.stiffness * kUnitRate * kUnitRate * (mass < 1e30 ? mass : std::min(massOf(partnerResponse), 1.0));
}

void Joint::measure() {
  partner_->begin();
  const btSoftBody& soft = *point_.body();
  response_ = sharers_ * partner_->response();
  const Matrix3d along = linearResponse(lever_, soft);
  const double k = stiffnessOf(along, response_.topLeftCorner<3, 3>());
  const double mass = std::min(massOf(along), 1e30);
  const double d = 2.0 * settings_.damping * (mass < 1e30 ? std::sqrt(k * mass) : 0.0);
  double c = dt_ * (k * dt_ + d);
  wanted_ = partner_->velocity();
  wanted_.head<3>() += k * dt_ / (k * dt_ + d) * offset_.head<3>() / dt_;
  if (std::isfinite(settings_.maxForce)) {
    // What it comes to is known when the step is solved: until then, what it would be if the point went on as it does.
    // What it has been too much, it gives less in the next step.
    const double most = c * (wanted_ - began_).head<3>().norm();
    const double allowed = std::max(settings_.maxForce * dt_ - excess_, kLeastShare * settings_.maxForce * dt_);
    if (most > allowed) c *= allowed / most;
  }
  compliance_.head<3>().setConstant(1.0 / c);
  if (settings_.turns) {
    const double turning = stiffnessOf(angularResponse(lever_, soft), response_.bottomRightCorner<3, 3>());
    compliance_.tail<3>().setConstant(1.0 / (dt_ * dt_ * turning));
    wanted_.tail<3>() += offset_.tail<3>() / dt_;
  }
  matrix_ = inverse(response_);
}

Matrix6 Joint::inverse(const Matrix6& response) const {
  Matrix6 given = response;
  given.diagonal() += compliance_;
  if (settings_.turns) return given.inverse();
  Matrix6 only = Matrix6::Zero();
  only.topLeftCorner<3, 3>() = given.topLeftCorner<3, 3>().inverse();
  return only;
}

void Joint::spread(const Vector6& impulse, VectorStack& impulses) const {
  if (!softMoves()) return;
  for (const LeverNode& of : lever_) {
    const btSoftBody::Node& node = point_.body()->m_nodes[of.node];
    if (node.m_im == 0) continue;
    impulses[node.index] +=
        toBullet(of.linear.transpose() * impulse.head<3>() + of.angular.transpose() * impulse.tail<3>());
  }
}

void Joint::addPrediction(VectorStack& impulses) {
  if (!active_) return;
  measure();
  Matrix6 all = response_;
  all.topLeftCorner<3, 3>() += linearResponse(lever_, *point_.body());
  if (settings_.turns) all.bottomRightCorner<3, 3>() += angularResponse(lever_, *point_.body());
  spread(inverse(all) * (wanted_ - pointVelocity()), impulses);
}

void Joint::addTo(VectorStack& impulses) {
  if (!active_) return;
  measure();
  spread(impulse(), impulses);
}

void Joint::addResistance(const VectorStack& change, VectorStack& impulses) const {
  if (!active_ || !softMoves()) return;
  Vector6 faster = Vector6::Zero();
  for (const LeverNode& of : lever_) {
    const btSoftBody::Node& node = point_.body()->m_nodes[of.node];
    if (node.m_im == 0) continue;
    const Vector3d by = toEigen(change[node.index]);
    faster.head<3>() += of.linear * by;
    faster.tail<3>() += of.angular * by;
  }
  spread(matrix_ * faster, impulses);
}

void Joint::addDiagonal(VectorStack& diagonal) const {
  if (!active_ || !softMoves()) return;
  for (const LeverNode& of : lever_) {
    const btSoftBody::Node& node = point_.body()->m_nodes[of.node];
    if (node.m_im == 0) continue;
    Eigen::Matrix<double, 6, 3> column;
    column << of.linear, of.angular;
    diagonal[node.index] += toBullet((column.transpose() * matrix_ * column).diagonal());
  }
}

double Joint::energy() const {
  if (!active_) return 0;
  const Vector6 missed = wanted_ - pointVelocity();
  return 0.5 * missed.dot(matrix_ * missed);
}

void Joint::finish() {
  load_.setZero();
  if (!active_ || spent()) return;
  const Vector6 given = impulse();
  load_ = given / dt_;
  excess_ = std::max(excess_ + given.head<3>().norm() - settings_.maxForce * dt_, 0.0);
  partner_->apply(-given, dt_, sharers_);
}

}  // namespace tetskin::touch_detail
