// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: the hook by which Bullet asks for the contacts of a pair.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/solver/src/search/body_contacts.h>

namespace tetskin::bullet_detail {

/// From now on, the dispatcher asks the soft body of each new pair of a soft and a rigid body for its contacts: see
/// `contactsOf`. Bodies without such contacts get Bullet's algorithms. The registered object has no state and is never
/// destroyed, so nothing needs to be unregistered. May be called repeatedly.
void registerContactAlgorithms(btCollisionDispatcher& dispatcher);

}  // namespace tetskin::bullet_detail
