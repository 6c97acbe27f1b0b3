// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/twist.h"

#include <algorithm>

namespace tetskin::scenes {

using Eigen::Vector3d;

double Twist::angleAt(const Vector3d& p) const {
  return turn * std::clamp((p[axis] - from) / (to - from), 0.0, 1.0);
}

Vector3d Twist::point(const Vector3d& p) const {
  return centre + Eigen::AngleAxisd(angleAt(p), Vector3d::Unit(axis)) * (p - centre);
}

/// The gradient of the map is R (I + rate (a x r) a^T), with R the rotation, a the axis and r = p - centre. Its
/// determinant is 1, so the normal is transformed by R (I - rate a (a x r)^T).
Vector3d Twist::normal(const Vector3d& p, const Vector3d& n) const {
  const double rate = turn / (to - from);
  const Vector3d a = Vector3d::Unit(axis);
  const Vector3d sheared = n - rate * n.dot(a.cross(p - centre)) * a;
  return (Eigen::AngleAxisd(angleAt(p), a) * sheared).normalized();
}

Twist twistOf(const Box3& box, double turn) {
  Twist twist;
  box.sizes().maxCoeff(&twist.axis);
  twist.centre = box.center();
  twist.from = box.min()[twist.axis];
  twist.to = box.max()[twist.axis];
  twist.turn = turn;
  return twist;
}

Twist smoothTwistOf(const Box3& box) {
  constexpr double kTurn = 4.5;  // radians, over three times the body's length
  Twist twist = twistOf(box, kTurn);
  twist.from -= box.sizes()[twist.axis];
  twist.to += box.sizes()[twist.axis];
  return twist;
}

}  // namespace tetskin::scenes
