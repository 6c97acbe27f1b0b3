// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: contacts as Bullet's solver takes them.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/contact/src/rigid/touch_search.h>

namespace tetskin {

/// Adds a contact of the node with the object: Bullet's own of a node, but its distance, its normal and its lever arm
/// are those of the point of the surface. Wakes the object. False where Bullet could not solve it: pinned or anchored
/// nodes.
bool addNodeContact(btSoftBody& body, const btCollisionObject& object, const NodeTouch& touch);

}  // namespace tetskin
