// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Tells whether an object still has the shape from which something was computed. Applications scale and change shapes
// without notice, and a new shape may have been created at the address of an old one.
#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

namespace tetskin::bullet_detail {

/// Identifies a shape by its address and its box; hulls with equal boxes may still differ (see HullFaces::fits).
struct ShapeKey {
  const btCollisionShape* shape = nullptr;
  btVector3 low{0, 0, 0}, high{0, 0, 0};  ///< its box, in its own space

  static ShapeKey of(const btCollisionShape& shape) {
    ShapeKey key;
    key.shape = &shape;
    shape.getAabb(btTransform::getIdentity(), key.low, key.high);
    return key;
  }
  bool operator==(const ShapeKey& other) const {
    return shape == other.shape && low == other.low && high == other.high;
  }
  bool operator!=(const ShapeKey& other) const { return !(*this == other); }
};

}  // namespace tetskin::bullet_detail
