// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

namespace tetskin::scenes {

/// Turns the cross-sections of a body about a coordinate axis: the angle grows linearly from zero at `from` to `turn`
/// at `to`, and is constant beyond them. Smooth in between, hence a reference for interpolations.
struct Twist {
  Eigen::Vector3d centre;       ///< on the axis
  int axis = 0;                 ///< 0, 1 or 2: x, y or z
  double from = 0.0, to = 1.0;  ///< coordinates on the axis
  double turn = 0.0;            ///< radians

  double angleAt(const Eigen::Vector3d& p) const;
  Eigen::Vector3d point(const Eigen::Vector3d& p) const;
  /// The unit normal at point(p) of a surface whose normal at p is n, for p between `from` and `to`.
  Eigen::Vector3d normal(const Eigen::Vector3d& p, const Eigen::Vector3d& n) const;
};

/// The twist of a whole body along the longest side of its box, from end to end.
Twist twistOf(const Box3& box, double turn);

/// The map of the scene "exact", smooth beyond the body as well, as cages are larger than the body.
Twist smoothTwistOf(const Box3& box);

}  // namespace tetskin::scenes
