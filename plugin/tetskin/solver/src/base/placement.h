// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: a rigid motion that takes bodies, and all that is remembered of them, to another place.
// In double, so that it neither stretches what it turns nor loses digits of what it moves.
#pragma once

#include <BulletSoftBody/btSoftBody.h>

#include <Eigen/Core>
#include <array>

namespace tetskin::bullet_detail {

struct Placement {
  bool turns = false;
  std::array<double, 9> turn{};  ///< a rotation about the origin, by rows; unused if nothing turns
  std::array<double, 3> by{};    ///< after the rotation

  explicit Placement(const btVector3& translation);
  /// motion  must be a rigid one: see `isRigid`
  explicit Placement(const btTransform& motion);

  btVector3 at(const btVector3& position) const;
  btVector3 turned(const btVector3& vector) const;
  /// Places a number of these.
  template <class... Positions>
  void place(Positions&... positions) const {
    ((positions = at(positions)), ...);
  }
  template <class... Vectors>
  void rotate(Vectors&... vectors) const {
    if (turns) ((vectors = turned(vectors)), ...);
  }

 private:
  Eigen::Vector3d turnedExactly(const btVector3& vector) const;
};

/// True for a position that a surface can be in: finite, and not beyond Limits::kMaxCoordinate.
bool isUsable(const btVector3& place);
/// True for a rotation and a translation to a usable position; false if a transform scales, shears or mirrors.
bool isRigid(const btTransform& motion);

}  // namespace tetskin::bullet_detail
