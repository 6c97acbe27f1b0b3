// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: the impulses of contacts by the masses of their nodes alone, before elasticity has a say.
#pragma once

#include <tetskin/contact/src/soft/contact_row.h>

#include <vector>

namespace tetskin::contact_detail {

/// Moves the nodes of rows so that a part of each penetration beyond `slop` is gone: positions of the included bodies,
/// and the rows' distances.
void correctPositions(std::vector<ContactRow>& rows, btScalar part, btScalar slop);

/// Impulses that keep points from going into each other, from the step before's and the velocities that the bodies
/// have: `ContactBody::velocities`, which are changed. Rows whose impulse is 0 do not touch.
/// memory  of the step before, sorted by `before`
void estimateImpulses(std::vector<ContactRow>& rows, const std::vector<ContactMemory>& memory, btScalar dt);

/// What the solve has made of the rows: impulses as they were in the end.
/// hold  see SoftContactOptions
std::vector<ContactMemory> memoryOf(const std::vector<ContactRow>& rows, btScalar hold);

}  // namespace tetskin::contact_detail
