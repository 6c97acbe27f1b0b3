// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tetskin::elastic_detail {

/// What is held of a body: a point, a line, or more.
struct Pivot {
  Eigen::Vector3d point = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::Zero();
  enum { Nothing, Point, Line, Fixed } kind = Nothing;

  void add(const Eigen::Vector3d& p) {
    constexpr double kOnLine = 1e-3;
    const Eigen::Vector3d arm = p - point;
    if (kind == Nothing) {
      point = p;
      kind = Point;
    } else if (kind == Point && arm.norm() > 0.0) {
      axis = arm.normalized();
      kind = Line;
    } else if (kind == Line && arm.cross(axis).norm() > kOnLine * arm.norm()) {
      kind = Fixed;
    }
  }
};

/// The momentum of one part of a body, nodes that tets connect, and the rigid motion that has it.
struct PartMotion {
  Pivot pivot;
  double mass = 0.0;
  Eigen::Vector3d push = Eigen::Vector3d::Zero(), about = Eigen::Vector3d::Zero(), rate = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();

  void finishPush() {
    const bool free = pivot.kind == Pivot::Nothing;
    push = free ? Eigen::Vector3d(push / mass) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    about = free ? Eigen::Vector3d(about / mass) : pivot.point;
  }
  void finishRate() {
    const Eigen::Vector3d &axis = pivot.axis, spin = rate;
    if (pivot.kind == Pivot::Line) {
      rate = axis * (axis.dot(spin) / axis.dot(inertia * axis));
    } else {
      rate = inertia.ldlt().solve(spin);
    }
    if (pivot.kind == Pivot::Fixed || !push.allFinite()) push.setZero();
    if (pivot.kind == Pivot::Fixed || !rate.allFinite()) rate.setZero();
  }
};

}  // namespace tetskin::elastic_detail
