// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: rigid objects that the application has changed, as Bullet's search by nodes does not
// notice it.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletSoftBody/btSoftBody.h>

#include <unordered_map>
#include <utility>

namespace tetskin {

/// Bullet keeps distances to a shape in cells, for good, and looks for contacts where an object is predicted to be,
/// which of those that do not move by themselves, or sleep, nobody keeps up to date.
class ObstacleChanges {
 public:
  /// Before nodes of the body are searched for in the object.
  void notice(btSoftBody& body, const btCollisionObjectWrapper& rigid);

 private:
  using Box = std::pair<btVector3, btVector3>;
  std::unordered_map<const btCollisionShape*, Box> boxes_;  ///< in the shape's space
};

}  // namespace tetskin
