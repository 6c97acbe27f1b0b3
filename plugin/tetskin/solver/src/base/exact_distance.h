// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: exact distances of points from shapes that have formulas for them.
#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include <tetskin/export.h>

#include <optional>

namespace tetskin::bullet_detail {

/// The distance of a point from a shape, in the shape's space.
struct ShapeDistance {
  btScalar distance = BT_LARGE_FLOAT;  ///< below 0 inside
  btVector3 normal{0, 1, 0};           ///< of unit length, the direction in which the distance grows
};

/// A plane, a box, a sphere, a capsule or a cylinder with a circular section, as Bullet collides with it, including its
/// own margin.
class TETSKIN_SOLVER_API ExactShape {
 public:
  /// Empty for any other shape.
  static std::optional<ExactShape> exactShape(const btCollisionShape& shape);

  /// The signed distance. Inside, it is the distance to the nearest point of the surface; if several are nearest, to
  /// one of them. Cost O(1)
  ShapeDistance distance(const btVector3& point) const;
  /// True if all points of this ball are nearest to one and the same plane face. Cost O(1)
  bool isHalfSpace(const btVector3& centre, btScalar radius) const;

 private:
  enum class Kind { Plane, Box, Ball, Capsule, Cylinder };

  ShapeDistance fromBox(const btVector3& point) const;
  ShapeDistance fromBall(const btVector3& point) const;
  ShapeDistance fromCapsule(const btVector3& point) const;
  ShapeDistance fromCylinder(const btVector3& point) const;

  Kind kind_ = Kind::Ball;
  int axis_ = 1;         ///< axis of a capsule or cylinder
  btScalar radius_ = 0;  ///< radius of a round shape
  btScalar half_ = 0;    ///< half the length along the axis, without a capsule's caps; a plane's constant
  btVector3 extents_{};  ///< half the sides of a box; a plane's normal
};

}  // namespace tetskin::bullet_detail
