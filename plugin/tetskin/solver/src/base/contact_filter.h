// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: tests whether an application lets two bodies touch. Bullet tests groups, masks and the world's
// overlap filter callback only once, when two boxes begin to overlap; here they are tested in each step.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/export.h>

namespace tetskin::bullet_detail {

/// Tests m_cfg.collisions (any of RVSmask), groups, masks, the callback, m_collisionDisabledObjects,
/// setIgnoreCollisionCheck and CF_NO_CONTACT_RESPONSE of either object. Cost O(objects that are ignored).
TETSKIN_SOLVER_API bool collidesWithRigid(const btSoftBody& body, const btCollisionObject& object);

/// The corresponding test for another soft body, or for the body itself; groups and masks do not apply to the latter.
/// The caller wants contact: a value of 0 of m_cfg.collisions forbids it, and any other value selects Bullet's own
/// contact of soft bodies.
TETSKIN_SOLVER_API bool collidesWithSoft(const btSoftBody& body, const btSoftBody& other);

}  // namespace tetskin::bullet_detail
