// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: whether an application lets two bodies touch. Bullet asks for groups, masks and the world's
// overlap filter callback when two boxes begin to overlap, and never again: here they are asked for in each step.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/export.h>

namespace tetskin {

/// By m_cfg.collisions (any of RVSmask), groups, masks, the callback, m_collisionDisabledObjects,
/// setIgnoreCollisionCheck and CF_NO_CONTACT_RESPONSE of either. Cost O(objects that are ignored).
TETSKIN_BULLET_API bool meetsRigid(const btSoftBody& body, const btCollisionObject& object);

/// The same of another soft body, or of itself, to which neither groups nor masks apply. What includes bodies asks for
/// their contact: of m_cfg.collisions 0 forbids it, and any other value is Bullet's own contact of soft bodies.
TETSKIN_BULLET_API bool meetsSoft(const btSoftBody& body, const btSoftBody& other);

}  // namespace tetskin
