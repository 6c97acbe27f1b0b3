// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/animation/affine_bone.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tetskin::io {
namespace {

/// Turns two columns of B = A V, and of V, until those of B are orthogonal. Returns false if they already are.
bool orthogonalise(int p, int q, Eigen::Matrix3d& b, Eigen::Matrix3d& v) {
  const double product = b.col(p).dot(b.col(q));
  const double squaredP = b.col(p).squaredNorm(), squaredQ = b.col(q).squaredNorm();
  // Cosine: Jacobi's rotations converge quadratically, so the next one would change nothing.
  constexpr double kOrthogonal = 1e-13;
  if (std::abs(product) <= kOrthogonal * std::sqrt(squaredP * squaredQ)) return false;
  const double zeta = (squaredQ - squaredP) / (2.0 * product);
  const double tangent = std::copysign(1.0, zeta) / (std::abs(zeta) + std::hypot(1.0, zeta));
  const double cosine = 1.0 / std::hypot(1.0, tangent), sine = cosine * tangent;
  for (Eigen::Matrix3d* m : {&b, &v}) {
    const Eigen::Vector3d first = cosine * m->col(p) - sine * m->col(q);
    m->col(q) = sine * m->col(p) + cosine * m->col(q);
    m->col(p) = first;
  }
  return true;
}

Eigen::Vector3d perpendicular(const Eigen::Vector3d& unit) {
  return unit.unitOrthogonal();
}

}  // namespace

void AffineBone::set(const Eigen::Matrix3d& map) {
  constexpr int kMaxSweeps = 30;  // a few are enough
  Eigen::Matrix3d columns = map * lower;
  bool changed = true;
  for (int sweep = 0; changed && sweep < kMaxSweeps; ++sweep) {
    changed = orthogonalise(0, 1, columns, lower);
    changed = orthogonalise(0, 2, columns, lower) || changed;
    changed = orthogonalise(1, 2, columns, lower) || changed;
  }
  lower = Eigen::Quaterniond(lower).normalized().toRotationMatrix();
  columns = map * lower;

  std::array<int, 3> order = {0, 1, 2};  // by length
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return columns.col(i).squaredNorm() > columns.col(j).squaredNorm(); });
  const auto [a, b, c] = order;
  const double longest = columns.col(a).norm();
  if (longest == 0.0) {
    scale.setZero();
    return;
  }
  upper.col(a) = columns.col(a) / longest;
  const Eigen::Vector3d rest = columns.col(b) - upper.col(a) * upper.col(a).dot(columns.col(b));
  const bool flat = rest.norm() <= std::numeric_limits<double>::epsilon() * longest;
  upper.col(b) = flat ? perpendicular(upper.col(a)) : Eigen::Vector3d(rest.normalized());
  const bool cyclic = b == (a + 1) % 3;
  upper.col(c) = (cyclic ? 1.0 : -1.0) * upper.col(a).cross(upper.col(b));
  for (int k = 0; k < 3; ++k) scale[k] = upper.col(k).dot(columns.col(k));
}

}  // namespace tetskin::io
