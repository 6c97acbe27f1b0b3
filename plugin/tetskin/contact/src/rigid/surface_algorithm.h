// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: where Bullet asks who finds the contacts of a pair.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/contact/src/rigid/body_contacts.h>

#include <memory>

namespace tetskin {

/// From now on the dispatcher asks the soft body of each new pair of a soft and a rigid body for its contacts: see
/// `contactsOf`. Bodies without get Bullet's algorithms. What the dispatcher is given has no state and is never
/// destroyed, so that nothing need be taken back. May be called again.
void registerSurfaceAlgorithms(btCollisionDispatcher& dispatcher);

/// Null where the body has none, or they are gone.
std::shared_ptr<BodyContacts> contactsOf(const btSoftBody& body);

}  // namespace tetskin
