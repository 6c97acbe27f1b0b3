// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the other constraints of rigid bodies that touch soft ones: contacts with each other
// and with the world, and joints.
//
// Bullet has already solved for these, without the impulses of soft bodies. They become rows of the same solve, and
// start where Bullet has left them: a contact, a motor or a stop starts with the impulse and the velocity that Bullet
// has found, so that nothing changes where nothing pushes. Rows are followed from body to body, up to kMaxUnknowns;
// bodies beyond move as Bullet has solved them.
#pragma once

#include <tetskin/solver/src/rows/contact_rows.h>

class btDiscreteDynamicsWorld;

namespace tetskin::bullet_detail {

/// Appends the rows, and adds the bodies that they lead to to the unknowns. Cost O(manifolds + joints of the world), if
/// there are unknowns.
void collectRigidRows(btDiscreteDynamicsWorld& world, btScalar seconds, RigidUnknowns& rigids, ContactRows& rows);

}  // namespace tetskin::bullet_detail
