// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <tetskin/touch/src/joints/joint.h>
#include <tetskin/touch/src/points/body_kind.h>

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
/// Stiffer, or more damped, than this nothing is, in any precision.
constexpr double kStiffest = 1e9;
/// What moves faster, in lengths a second, wakes what sleeps at the other end; Bullet's own threshold of sleep.
constexpr double kWakingSpeed = 0.04;

/// Of all nodes that can move: a body hangs as heavily on light ones.
double meanNodeMass(const btSoftBody& body) {
  double sum = 0.0;
  int count = 0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    if (body.m_nodes[n].m_im == 0) continue;
    sum += 1.0 / static_cast<double>(body.m_nodes[n].m_im);
    ++count;
  }
  return count > 0 ? sum / count : 1.0;
}

/// What it takes to turn the nodes of a point, all of one mass.
double inertiaAt(const Lever& lever, double nodeMass) {
  double about = 0.0;
  for (const LeverNode& of : lever) about += of.angular.squaredNorm();
  return about > 0.0 ? 3.0 * nodeMass / about : nodeMass;
}

Vector3d turnOf(const Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

}  // namespace

Joint::Joint(const SurfacePoint& point, std::unique_ptr<Partner> partner, const JointSettings& settings)
    : point_(point),
      partner_(std::move(partner)),
      settings_(settings),
      nodeMass_(meanNodeMass(*point.body())),
      lever_(leverOf(point.data(), *point.body())),
      places_(placesOf(lever_, *point.body())),
      turned_(partner_->anchor().getBasis()),
      anchorBefore_(partner_->anchor()) {
  btCollisionObject* other = partner_->object();
  if (settings.collide || !other) return;
  // An entry for each joint: another one may go before this one does.
  point_.body()->m_collisionDisabledObjects.push_back(other);
  hidden_ = true;
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

bool Joint::softMoves() const {
  return point_.body()->isActive();
}

/// What has come to rest stays so: each of the two may sleep while the other holds still.
void Joint::wake() {
  const btTransform anchor = partner_->anchor();
  const bool moved = !(anchor == anchorBefore_);
  anchorBefore_ = anchor;
  btCollisionObject* other = partner_->object();
  if (!other) return;
  if (other->isStaticOrKinematicObject()) {
    if (moved && !softMoves()) point_.body()->activate();
    return;
  }
  if (softMoves() == other->isActive()) return;
  const double speed = softMoves() ? pointVelocity().head<3>().norm() : partner_->speed();
  if (speed > kWakingSpeed) softMoves() ? other->activate() : point_.body()->activate();
}

void Joint::begin(btScalar dt, int sharers) {
  active_ = false;
  if (spent() || !(dt > 0) || point_.status() != TouchStatus::Ok) return;
  lever_ = leverOf(point_.data(), *point_.body());
  dt_ = static_cast<double>(dt);
  sharers_ = sharers;
  offset_ = offsetOf(lever_);
  began_ = pointVelocity();
  active_ = true;
  wake();
}

Vector6 Joint::pointVelocity(bool split) const {
  Vector6 v = Vector6::Zero();
  if (!softMoves()) return v;
  v.head<3>() = velocityOf(lever_, *point_.body(), split);
  if (settings_.turns) v.tail<3>() = spinOf(lever_, *point_.body(), split);
  return v;
}

void Joint::measure() {
  partner_->begin();
  response_ = sharers_ * partner_->response();
  const double mass = 4.0 * nodeMass_, rate = std::min(settings_.stiffness, kStiffest) * kUnitRate * kUnitRate;
  const double k = rate * mass;
  const double d = 2.0 * std::min(settings_.damping, kStiffest) * std::sqrt(k * mass);
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
    const double turning = rate * inertiaAt(lever_, nodeMass_);
    compliance_.tail<3>().setConstant(1.0 / (dt_ * dt_ * turning));
    wanted_.tail<3>() += offset_.tail<3>() / dt_;
  }
  matrix_ = inverse();
}

Matrix6 Joint::inverse() const {
  Matrix6 given = response_;
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

void Joint::addTo(VectorStack& impulses) {
  if (!active_) return;
  measure();
  spread(impulse(false), impulses);
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

void Joint::finish() {
  load_.setZero();
  if (!active_ || spent()) return;
  const Vector6 given = impulse();
  load_ = given / dt_;
  excess_ = std::max(excess_ + given.head<3>().norm() - settings_.maxForce * dt_, 0.0);
  partner_->apply(-given, dt_, sharers_);
}

}  // namespace tetskin::touch_detail
