// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/arithmetic/small_matrix.h>
#include <tetskin/core/src/base/arithmetic/turns.h>
#include <tetskin/core/src/base/cross_matrix.h>
#include <tetskin/elastic/src/dynamics/component_motion.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::elastic_detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Bound of the sine of a step's rotation: straight paths can represent at most a rotation by 90 degrees, and near that
/// the equation is singular. The rest of the rotation is left to the solve.
constexpr double kMaxSineOfTurn = 0.8;

Vector3d vectorOf(const double v[3]) {
  return {v[0], v[1], v[2]};
}

/// The sum of m (r x A r), for `spread` = sum of m r r^T.
Vector3d momentOf(const Matrix3d& a, const Matrix3d& spread) {
  const Matrix3d p = a * spread;
  return {p(2, 1) - p(1, 2), p(0, 2) - p(2, 0), p(1, 0) - p(0, 1)};
}

/// The matrix N with N w = sum of m r x (w x Q r).
Matrix3d inertiaOf(const Matrix3d& turn, const Matrix3d& spread) {
  const Matrix3d p = turn * spread;
  return p.trace() * Matrix3d::Identity() - p;
}

/// x such that A x = b.
Vector3d solutionOf(const Matrix3d& a, const Vector3d& b) {
  return vectorOf(solved(smallFrom<3, 3>(a.data()), smallFrom<3>(b.data())).values);
}

Matrix3d rotationBy(const Vector3d& angle) {
  const double size = angle.norm();
  if (!(size > 0.0)) return Matrix3d::Identity();
  const SineAndCosine half = sineAndCosine(0.5 * size);
  Eigen::Quaterniond rotation;
  rotation.w() = half.cosine;
  rotation.vec() = half.sine / size * angle;
  return rotation.toRotationMatrix();
}

/// The smallest rotation that takes one unit vector to the other. Eigen's own version includes half a singular value
/// decomposition, for opposite vectors, which takes the compiler longer than the rest of this file.
Matrix3d rotationBetween(const Vector3d& from, const Vector3d& to) {
  const double cosine = to.dot(from);
  if (cosine < -1.0 + 1e-12) return rotationBy(3.14159265358979323846 * from.unitOrthogonal());
  const double root = std::sqrt((1.0 + cosine) * 2.0);
  Eigen::Quaterniond rotation;
  rotation.vec() = from.cross(to) * (1.0 / root);
  rotation.w() = 0.5 * root;
  return rotation.toRotationMatrix();
}

/// The rotation Q with sum m r x Q r = `moment`, by Newton's method. If the moment exceeds what a rotation can have, it
/// is reduced; without inertia, Q is the identity.
Matrix3d turnWith(Vector3d moment, const Matrix3d& spread) {
  // Newton's method doubles its digits in each step: if more steps are needed, it does not converge.
  constexpr int kMaxSteps = 12;
  // Radians: the next step would be below the last digit.
  constexpr double kConverged = 1e-14;
  const Matrix3d inertia = inertiaOf(Matrix3d::Identity(), spread);
  Vector3d step = vectorOf(SmallLdlt<3>(smallFrom<3, 3>(inertia.data())).solve(smallFrom<3>(moment.data())).values);
  const double sine = step.norm();
  if (!std::isfinite(sine)) return Matrix3d::Identity();
  if (sine > kMaxSineOfTurn) {
    moment *= kMaxSineOfTurn / sine;
    step *= kMaxSineOfTurn / sine;
  }
  Matrix3d turn = Matrix3d::Identity();
  for (int k = 0; k < kMaxSteps; ++k) {
    turn = rotationBy(step) * turn;
    if (step.norm() < kConverged) break;
    step = solutionOf(inertiaOf(turn, spread), moment - momentOf(turn, spread));
    if (!(step.norm() < 1.0)) return Matrix3d::Identity();
  }
  return turn;
}

Matrix3d turnAround(const Vector3d& axis, double moment, const Matrix3d& spread) {
  const double sine = moment / axis.dot(inertiaOf(Matrix3d::Identity(), spread) * axis);
  if (!std::isfinite(sine)) return Matrix3d::Identity();
  return rotationBy(arcSine(std::clamp(sine, -kMaxSineOfTurn, kMaxSineOfTurn)) * axis);
}

void keep(const Vector3d& v, double out[3]) {
  for (int k = 0; k < 3; ++k) out[k] = v[k];
}

RigidVelocity rigidVelocity(const Vector3d& about, const Vector3d& velocity, const Matrix3d& field) {
  RigidVelocity rigid;
  keep(about, rigid.about);
  keep(velocity, rigid.velocity);
  for (int i = 0; i < 9; ++i) rigid.field[i] = field(i / 3, i % 3);
  return rigid;
}

}  // namespace

Matrix3d nearestRotation(const Matrix3d& moments) {
  const Eigen::JacobiSVD<Matrix3d> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

void PinnedNodes::add(const Vector3d& point, const Vector3d& nodeVelocity) {
  // Sine of the angle up to which a node counts as on the line of those before: more than the rounding of positions.
  constexpr double kOnLine = 1e-3;
  if (count_++ == 0) first_ = point;
  const Vector3d arm = point - first_;
  if (kind == Nothing) {
    kind = Point;
  } else if (kind == Point && arm.norm() > 0.0) {
    axis = arm.normalized();
    kind = Line;
  } else if (kind == Line && arm.cross(axis).norm() > kOnLine * arm.norm()) {
    kind = Fixed;
  }
  positions_ += arm;
  velocities_ += nodeVelocity;
  positionMoments_ += arm * arm.transpose();
  velocityMoments_ += nodeVelocity * arm.transpose();
}

void PinnedNodes::finish(double seconds) {
  assert(seconds > 0.0 && (count_ > 0) == (kind != Nothing));
  if (kind == Nothing) return;
  const Vector3d mean = positions_ / count_;
  centre = first_ + mean;
  velocity = velocities_ / count_;
  // Relative to the centre.
  const Matrix3d rates = velocityMoments_ - velocity * positions_.transpose();
  if (kind == Point || rates.isZero(0.0)) return;
  const Matrix3d spread = positionMoments_ - positions_ * mean.transpose();
  if (kind == Line) {
    const Vector3d moved = axis + seconds / axis.dot(spread * axis) * (rates * axis);
    turn = rotationBetween(axis.normalized(), moved.normalized());
    return;
  }
  turn = nearestRotation(spread + seconds * rates);
}

void ComponentMotion::find(const ComponentMoments& moments, const Vector3d& near, const PinnedNodes& pinned,
                           double seconds) {
  assert(seconds > 0.0 && moments.mass >= 0.0);
  *this = {};
  pinned_ = pinned;
  mass_ = moments.mass;
  const Vector3d first = vectorOf(moments.first), momentum = vectorOf(moments.momentum);
  const Vector3d mean = mass_ > 0.0 ? Vector3d(first / mass_) : Vector3d(Vector3d::Zero());
  const double* s = moments.second;
  Matrix3d second;
  second << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  central_ = second - mass_ * mean * mean.transpose();

  const bool free = pinned_.kind == PinnedNodes::Nothing;
  const Vector3d offset = free ? mean : Vector3d(pinned.centre - near);
  about_ = near + offset;
  velocity_ = !free ? pinned.velocity : mass_ > 0.0 ? Vector3d(momentum / mass_) : Vector3d(Vector3d::Zero());
  momentum_ = momentum;
  spin_ = vectorOf(moments.spin) - offset.cross(momentum);
  const Vector3d arm = mean - offset;  // of the centre of mass, relative to the reference point
  second_ = central_ + mass_ * arm * arm.transpose();
  if (!(about_.allFinite() && velocity_.allFinite() && spin_.allFinite() && second_.allFinite())) {
    // Nothing is predicted from values that are not finite.
    *this = {};
    return;
  }
  findInverseInertia();
  const Vector3d own = seconds * (spin_ - mass_ * arm.cross(velocity_));  // relative to the motion of the pinned nodes
  switch (pinned.kind) {
    case PinnedNodes::Nothing:
    case PinnedNodes::Point:
      turn_ = turnWith(own, second_);
      break;
    case PinnedNodes::Line: {
      const Vector3d led = momentOf(pinned.turn, second_);
      turn_ = turnAround(pinned.turn * pinned.axis, pinned.axis.dot(own - led), second_) * pinned.turn;
      break;
    }
    case PinnedNodes::Fixed:
      turn_ = pinned.turn;
  }
}

void ComponentMotion::findInverseInertia() {
  const Matrix3d inertia = inertiaOf(Matrix3d::Identity(), second_);
  if (pinned_.kind == PinnedNodes::Nothing || pinned_.kind == PinnedNodes::Point) inverseInertia_ = inertia.inverse();
  if (pinned_.kind == PinnedNodes::Line) {
    inverseInertia_ = pinned_.axis * pinned_.axis.transpose() / pinned_.axis.dot(inertia * pinned_.axis);
  }
  if (!inverseInertia_.allFinite()) inverseInertia_.setZero();
}

RigidVelocity ComponentMotion::velocities(double seconds) const {
  assert(seconds > 0.0);
  return rigidVelocity(about_, velocity_, (turn_ - Matrix3d::Identity()) / seconds);
}

Vector3d ComponentMotion::anchor() const {
  const double spread = mass_ > 0.0 ? std::sqrt(second_.trace() / mass_) : 0.0;
  if (!(spread > 0.0)) return about_;
  int exponent = 0;
  static_cast<void>(std::frexp(spread, &exponent));
  const double grid = std::ldexp(1.0, exponent);  // a power of two
  return grid * (about_ / grid).array().round().matrix();
}

double ComponentMotion::radius() const {
  return mass_ > 0.0 ? std::sqrt(std::max(central_.trace(), 0.0) / mass_) : 0.0;
}

double ComponentMotion::minInertia() const {
  const Matrix3d inertia = inertiaOf(Matrix3d::Identity(), central_);
  return std::max(0.0, Eigen::SelfAdjointEigenSolver<Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues()[0]);
}

double ComponentMotion::compliance(const Vector3d& point, const Vector3d& direction) const {
  const Vector3d moment = (point - about_).cross(direction);
  const bool free = pinned_.kind == PinnedNodes::Nothing;
  const double moved = free && mass_ > 0.0 ? direction.squaredNorm() / mass_ : 0.0;
  return moved + moment.dot(inverseInertia_ * moment);
}

RigidVelocity ComponentMotion::excess(const ComponentMomentum& now, const Vector3d& impulse, const Vector3d& torque,
                                      const Resistance& held) const {
  const Vector3d momentum = vectorOf(now.momentum) - momentum_ - impulse, spin = vectorOf(now.spin) - spin_ - torque;
  if (pinned_.kind != PinnedNodes::Nothing || held.isZero(0.0)) return rigidWith(momentum, spin, turn_);
  Resistance inertia = held;
  inertia.topLeftCorner<3, 3>().diagonal().array() += mass_;
  inertia.bottomRightCorner<3, 3>() += inertiaOf(turn_, second_);
  Small6 momenta;
  keep(momentum, momenta.values);
  keep(spin, momenta.values + 3);
  const Small6 found = solved(smallFrom<6, 6>(inertia.data()), momenta);
  const Vector3d push = vectorOf(found.values), rate = vectorOf(found.values + 3);
  if (!(push.allFinite() && rate.allFinite())) return {};
  return rigidVelocity(about_, push, crossMatrix(rate) * turn_);
}

void ComponentMotion::addResistance(const Vector3d& point, const Matrix3d& stiffness, Resistance& to) const {
  const Vector3d arm = point - about_;
  Eigen::Matrix<double, 3, 6> motion, moment;
  motion << Matrix3d::Identity(), -crossMatrix(turn_ * arm);
  moment << Matrix3d::Identity(), -crossMatrix(arm);
  to += moment.transpose() * stiffness * motion;
}

RigidVelocity ComponentMotion::withMomentum(const ComponentMomentum& own) const {
  return rigidWith(vectorOf(own.momentum), vectorOf(own.spin), Matrix3d::Identity());
}

RigidVelocity ComponentMotion::own() const {
  RigidVelocity motion = rigidWith(momentum_, spin_, Matrix3d::Identity());
  if (pinned_.kind != PinnedNodes::Nothing) {
    for (int k = 0; k < 3; ++k) motion.velocity[k] += velocity_[k];
  }
  return motion;
}

RigidVelocity ComponentMotion::rigidWith(const Vector3d& momentum, const Vector3d& spin, const Matrix3d& turn) const {
  Vector3d push = Vector3d::Zero(), rate = Vector3d::Zero();
  const Matrix3d inertia = inertiaOf(turn, second_);
  if (pinned_.kind == PinnedNodes::Nothing && mass_ > 0.0) push = momentum / mass_;
  if (pinned_.kind == PinnedNodes::Nothing || pinned_.kind == PinnedNodes::Point) rate = solutionOf(inertia, spin);
  if (pinned_.kind == PinnedNodes::Line)
    rate = pinned_.axis * (pinned_.axis.dot(spin) / pinned_.axis.dot(inertia * pinned_.axis));
  if (!push.allFinite()) push.setZero();
  if (!rate.allFinite()) rate.setZero();
  return rigidVelocity(about_, push, crossMatrix(rate) * turn);
}

RigidVelocity ComponentMotion::chord(const ComponentMomentum& now, const ComponentMoments& moments,
                                     const Vector3d& near, double seconds) const {
  ComponentMotion turned;
  turned.find(moments, near, pinned_, seconds);
  return turned.velocities(seconds) - velocities(seconds) -
         excess(now, Vector3d::Zero(), Vector3d::Zero(), Resistance::Zero());
}

RigidVelocity RigidVelocity::operator-(const RigidVelocity& other) const {
  RigidVelocity difference = *this;
  double there[3];
  other.at(about, there);
  for (int k = 0; k < 3; ++k) difference.velocity[k] -= there[k];
  for (int k = 0; k < 9; ++k) difference.field[k] -= other.field[k];
  return difference;
}

}  // namespace tetskin::elastic_detail
