// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/src/dynamics/part_motion.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace tetskin::elastic_detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Of a step: a turn of 90 degrees is the most that straight lines can make, and near it the equation is singular. What
/// a part has beyond this is left to the solve.
constexpr double kMostSineOfTurn = 0.8;

Vector3d vectorOf(const double v[3]) {
  return {v[0], v[1], v[2]};
}

/// sum of m (r x A r), for `spread` = sum of m r r^T.
Vector3d momentOf(const Matrix3d& a, const Matrix3d& spread) {
  const Matrix3d p = a * spread;
  return {p(2, 1) - p(1, 2), p(0, 2) - p(2, 0), p(1, 0) - p(0, 1)};
}

/// N w = sum of m r x (w x Q r)
Matrix3d inertiaOf(const Matrix3d& turn, const Matrix3d& spread) {
  const Matrix3d p = turn * spread;
  return p.trace() * Matrix3d::Identity() - p;
}

Matrix3d crossMatrix(const Vector3d& w) {
  Matrix3d m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

Matrix3d rotationBy(const Vector3d& angle) {
  const double size = angle.norm();
  return size > 0.0 ? Eigen::AngleAxisd(size, angle / size).toRotationMatrix() : Matrix3d::Identity();
}

/// The rotation Q with sum m r x Q r = `moment`, by Newton's method; of less than the moment where it is beyond what
/// rotations have, and none where there is no inertia.
Matrix3d turnWith(Vector3d moment, const Matrix3d& spread) {
  constexpr int kMostSteps = 12;
  constexpr double kConverged = 1e-14;
  Vector3d step = inertiaOf(Matrix3d::Identity(), spread).ldlt().solve(moment);
  const double sine = step.norm();
  if (!std::isfinite(sine)) return Matrix3d::Identity();
  if (sine > kMostSineOfTurn) {
    moment *= kMostSineOfTurn / sine;
    step *= kMostSineOfTurn / sine;
  }
  Matrix3d turn = Matrix3d::Identity();
  for (int k = 0; k < kMostSteps; ++k) {
    turn = rotationBy(step) * turn;
    if (step.norm() < kConverged) break;
    step = inertiaOf(turn, spread).partialPivLu().solve(moment - momentOf(turn, spread));
    if (!(step.norm() < 1.0)) return Matrix3d::Identity();
  }
  return turn;
}

Matrix3d turnAround(const Vector3d& axis, double moment, const Matrix3d& spread) {
  const double sine = moment / axis.dot(inertiaOf(Matrix3d::Identity(), spread) * axis);
  if (!std::isfinite(sine)) return Matrix3d::Identity();
  return rotationBy(std::asin(std::clamp(sine, -kMostSineOfTurn, kMostSineOfTurn)) * axis);
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

void HeldNodes::add(const Vector3d& point, const Vector3d& nodeVelocity) {
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
  places_ += arm;
  velocities_ += nodeVelocity;
  placesByPlaces_ += arm * arm.transpose();
  velocitiesByPlaces_ += nodeVelocity * arm.transpose();
}

void HeldNodes::finish(double seconds) {
  if (kind == Nothing) return;
  const Vector3d mean = places_ / count_;
  centre = first_ + mean;
  velocity = velocities_ / count_;
  // About the centre.
  const Matrix3d rates = velocitiesByPlaces_ - velocity * places_.transpose();
  if (kind == Point || rates.isZero(0.0)) return;
  const Matrix3d spread = placesByPlaces_ - places_ * mean.transpose();
  if (kind == Line) {
    const Vector3d moved = axis + seconds / axis.dot(spread * axis) * (rates * axis);
    turn = Eigen::Quaterniond::FromTwoVectors(axis, moved).toRotationMatrix();
    return;
  }
  const Eigen::JacobiSVD<Matrix3d> svd(spread + seconds * rates, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  turn = svd.matrixU() * Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

void PartMotion::find(const PartMoments& moments, const Vector3d& near, const HeldNodes& held, double seconds) {
  *this = {};
  held_ = held;
  mass_ = moments.mass;
  const Vector3d first = vectorOf(moments.first), momentum = vectorOf(moments.momentum);
  const Vector3d mean = mass_ > 0.0 ? Vector3d(first / mass_) : Vector3d(Vector3d::Zero());
  const double* s = moments.second;
  Matrix3d second;
  second << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  central_ = second - mass_ * mean * mean.transpose();

  const bool free = held_.kind == HeldNodes::Nothing;
  const Vector3d offset = free ? mean : Vector3d(held.centre - near);
  about_ = near + offset;
  velocity_ = !free ? held.velocity : mass_ > 0.0 ? Vector3d(momentum / mass_) : Vector3d(Vector3d::Zero());
  momentum_ = momentum;
  spin_ = vectorOf(moments.spin) - offset.cross(momentum);
  const Vector3d arm = mean - offset;  // of the centre of mass
  second_ = central_ + mass_ * arm * arm.transpose();
  if (!(about_.allFinite() && velocity_.allFinite() && spin_.allFinite() && second_.allFinite())) {
    // Of what is not finite nothing is predicted.
    *this = {};
    return;
  }
  findInverseInertia();
  const Vector3d own = seconds * (spin_ - mass_ * arm.cross(velocity_));  // beside the motion of what is held
  switch (held.kind) {
    case HeldNodes::Nothing:
    case HeldNodes::Point:
      turn_ = turnWith(own, second_);
      break;
    case HeldNodes::Line: {
      const Vector3d led = momentOf(held.turn, second_);
      turn_ = turnAround(held.turn * held.axis, held.axis.dot(own - led), second_) * held.turn;
      break;
    }
    case HeldNodes::Fixed:
      turn_ = held.turn;
  }
}

void PartMotion::findInverseInertia() {
  const Matrix3d inertia = inertiaOf(Matrix3d::Identity(), second_);
  if (held_.kind == HeldNodes::Nothing || held_.kind == HeldNodes::Point) inverseInertia_ = inertia.inverse();
  if (held_.kind == HeldNodes::Line) {
    inverseInertia_ = held_.axis * held_.axis.transpose() / held_.axis.dot(inertia * held_.axis);
  }
  if (!inverseInertia_.allFinite()) inverseInertia_.setZero();
}

RigidVelocity PartMotion::velocities(double seconds) const {
  return rigidVelocity(about_, velocity_, (turn_ - Matrix3d::Identity()) / seconds);
}

Vector3d PartMotion::anchor() const {
  const double spread = mass_ > 0.0 ? std::sqrt(second_.trace() / mass_) : 0.0;
  if (!(spread > 0.0)) return about_;
  const double grid = std::exp2(std::ceil(std::log2(spread)));
  return grid * (about_ / grid).array().round().matrix();
}

double PartMotion::reach() const {
  return mass_ > 0.0 ? about_.norm() + std::sqrt(second_.trace() / mass_) : about_.norm();
}

double PartMotion::leastInertia() const {
  const Matrix3d inertia = inertiaOf(Matrix3d::Identity(), central_);
  return std::max(0.0, Eigen::SelfAdjointEigenSolver<Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues()[0]);
}

double PartMotion::compliance(const Vector3d& point, const Vector3d& direction) const {
  const Vector3d moment = (point - about_).cross(direction);
  const bool free = held_.kind == HeldNodes::Nothing;
  const double moved = free && mass_ > 0.0 ? direction.squaredNorm() / mass_ : 0.0;
  return moved + moment.dot(inverseInertia_ * moment);
}

RigidVelocity PartMotion::excess(const PartMomentum& now, const Vector3d& impulse, const Vector3d& torque) const {
  const Vector3d momentum = vectorOf(now.momentum) - momentum_ - impulse, spin = vectorOf(now.spin) - spin_ - torque;
  return rigidWith(momentum, spin, turn_);
}

RigidVelocity PartMotion::withMomentum(const PartMomentum& own) const {
  return rigidWith(vectorOf(own.momentum), vectorOf(own.spin), Matrix3d::Identity());
}

RigidVelocity PartMotion::rigidWith(const Vector3d& momentum, const Vector3d& spin, const Matrix3d& turn) const {
  Vector3d push = Vector3d::Zero(), rate = Vector3d::Zero();
  const Matrix3d inertia = inertiaOf(turn, second_);
  if (held_.kind == HeldNodes::Nothing && mass_ > 0.0) push = momentum / mass_;
  if (held_.kind == HeldNodes::Nothing || held_.kind == HeldNodes::Point) rate = inertia.partialPivLu().solve(spin);
  if (held_.kind == HeldNodes::Line) rate = held_.axis * (held_.axis.dot(spin) / held_.axis.dot(inertia * held_.axis));
  if (!push.allFinite()) push.setZero();
  if (!rate.allFinite()) rate.setZero();
  return rigidVelocity(about_, push, crossMatrix(rate) * turn);
}

RigidVelocity PartMotion::chord(const PartMomentum& now, const PartMoments& moments, const Vector3d& near,
                                double seconds) const {
  PartMotion turned;
  turned.find(moments, near, held_, seconds);
  return turned.velocities(seconds) - velocities(seconds) - excess(now, Vector3d::Zero(), Vector3d::Zero());
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
