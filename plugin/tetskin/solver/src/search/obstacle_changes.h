// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: rigid objects that the application has changed in ways that Bullet's search by nodes
// does not notice.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/solver/src/base/shape_key.h>

#include <unordered_map>

namespace tetskin::bullet_detail {

/// Bullet caches distances to a shape in cells and never renews them; and it searches for contacts at an object's
/// predicted transform, which nothing updates for objects that do not move by themselves or that sleep. This class
/// detects such changes.
class ObstacleChanges {
 public:
  /// Call it before nodes of the body are tested against the object.
  void syncRigidObject(btSoftBody& body, const btCollisionObjectWrapper& rigid);

 private:
  std::unordered_map<const btCollisionShape*, ShapeKey> known_;
};

}  // namespace tetskin::bullet_detail
