// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: what a joint connects a point of a surface to.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

namespace tetskin::touch_detail {

struct JointAnchor {
  btCollisionObject* object = nullptr;  ///< a rigid body or a multibody's link; null: a point in space
  btTransform frame;                    ///< in the object's own space; for a point in space, in world space

  btTransform inWorld() const { return object ? object->getWorldTransform() * frame : frame; }
};

}  // namespace tetskin::touch_detail
