// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::contact: how far a point is from a rigid body's shape.
#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

namespace tetskin {

/// Of a point from a shape, in the shape's space.
struct ShapeDistance {
  btScalar distance = BT_LARGE_FLOAT;  ///< below 0 inside
  btVector3 normal{0, 1, 0};           ///< of unit length, the direction in which the distance grows
};

/// Whether `exactDistance` knows the shape: a plane, a box, a sphere, a capsule, or a cylinder whose section is a
/// circle.
bool hasExactDistance(const btCollisionShape& shape);

/// To the shape as Bullet collides with it, its own margin included. Inside, to the nearest point of its surface; where
/// there are several, to one of them. Cost O(1)
/// shape  one that `hasExactDistance`
ShapeDistance exactDistance(const btCollisionShape& shape, const btVector3& point);

}  // namespace tetskin
