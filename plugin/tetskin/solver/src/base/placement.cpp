// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>
#include <tetskin/solver/src/base/placement.h>

#include <Eigen/Geometry>
#include <cassert>

namespace tetskin::bullet_detail {
namespace {

/// By how much products of a rotation's columns may differ from exact ones.
constexpr btScalar kNotRigid = btScalar(1e-3);

}  // namespace

Placement::Placement(const btVector3& translation) {
  for (int k = 0; k < 3; ++k) by[static_cast<std::size_t>(k)] = static_cast<double>(translation[k]);
}

Placement::Placement(const btTransform& motion) : Placement(motion.getOrigin()) {
  assert(isRigid(motion));
  turns = !(motion.getBasis() == btMatrix3x3::getIdentity());
  if (!turns) return;
  const btQuaternion q = motion.getRotation();
  const Eigen::Quaterniond exact(static_cast<double>(q.w()), static_cast<double>(q.x()), static_cast<double>(q.y()),
                                 static_cast<double>(q.z()));
  const Eigen::Matrix3d rotation = exact.normalized().toRotationMatrix();
  for (int k = 0; k < 9; ++k) turn[static_cast<std::size_t>(k)] = rotation(k / 3, k % 3);
}

Eigen::Vector3d Placement::turnedExactly(const btVector3& vector) const {
  Eigen::Vector3d v = toEigen(vector);
  if (!turns) return v;
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(turn.data()) * v;
}

btVector3 Placement::at(const btVector3& position) const {
  return toBullet(Eigen::Vector3d(turnedExactly(position) + Eigen::Vector3d(by[0], by[1], by[2])));
}

btVector3 Placement::turned(const btVector3& vector) const {
  return toBullet(turnedExactly(vector));
}

bool isUsable(const btVector3& place) {
  const btScalar point[] = {place.x(), place.y(), place.z()};
  return firstUnusable(PointView<const btScalar>(point, 1)) == 1;
}

bool isRigid(const btTransform& motion) {
  const btMatrix3x3& m = motion.getBasis();
  const btMatrix3x3 square = m.transposeTimes(m);
  btScalar off = 0;
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 3; ++k) off += btFabs(square[row][k] - btScalar(row == k ? 1 : 0));
  }
  return off < kNotRigid && m.determinant() > 0 && isUsable(motion.getOrigin());
}

}  // namespace tetskin::bullet_detail
