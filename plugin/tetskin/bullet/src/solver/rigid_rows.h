// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: what rigid bodies that soft ones touch are held by beside: contacts with each other and
// with the world, and joints.
//
// Bullet has solved for these already, without what soft bodies push with. They are rows of the same solve, which begin
// where Bullet has left them: a contact with the impulse that Bullet has found, at the velocity that it has found, so
// that nothing changes where nothing pushes. Rows are followed from body to body, as far as kMaxUnknowns; what is
// beyond moves as Bullet has it.
#pragma once

#include <tetskin/bullet/src/solver/contact_row.h>

#include <vector>

class btDiscreteDynamicsWorld;

namespace tetskin {

/// Appends the rows, and to the unknowns the bodies that they lead to. Cost O(manifolds + joints of the world), where
/// there are unknowns.
void collectRigidRows(btDiscreteDynamicsWorld& world, btScalar seconds, RigidUnknowns& rigids,
                      std::vector<ContactRow>& rows);

}  // namespace tetskin
