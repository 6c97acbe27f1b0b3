// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: how far a point is from the shapes that have formulas.
#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include <optional>

namespace tetskin {

/// Of a point from a shape, in the shape's space.
struct ShapeDistance {
  btScalar distance = BT_LARGE_FLOAT;  ///< below 0 inside
  btVector3 normal{0, 1, 0};           ///< of unit length, the direction in which the distance grows
};

/// A plane, a box, a sphere, a capsule or a cylinder whose section is a circle, as Bullet collides with it, its own
/// margin included.
class ExactShape {
 public:
  /// Nothing for another shape.
  static std::optional<ExactShape> of(const btCollisionShape& shape);

  /// Inside, to the nearest point of the surface; where there are several, to one of them. Cost O(1)
  ShapeDistance distance(const btVector3& point) const;

 private:
  enum class Kind { Plane, Box, Ball, Capsule, Cylinder };

  ShapeDistance fromBox(const btVector3& point) const;
  ShapeDistance fromBall(const btVector3& point) const;
  ShapeDistance fromCapsule(const btVector3& point) const;
  ShapeDistance fromCylinder(const btVector3& point) const;

  Kind kind_ = Kind::Ball;
  int axis_ = 1;         ///< that of a capsule or cylinder
  btScalar radius_ = 0;  ///< of all that are round
  btScalar half_ = 0;    ///< of their length along the axis, without a capsule's caps; a plane's constant
  btVector3 extents_{};  ///< half the sides of a box; a plane's normal
};

}  // namespace tetskin
