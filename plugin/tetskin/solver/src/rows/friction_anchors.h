// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: where contacts stick, from one step to the next.
#pragma once

#include <tetskin/solver/src/rows/contact_row.h>
#include <tetskin/solver/src/rows/solver_bodies.h>

namespace tetskin::bullet_detail {

/// Reads from the last step where the point sticks, and the impulse that acted on it.
/// remainder  the part of the point's position that rounding has cut off
/// frame      the object's
void warmStart(const SolvedBody& body, const btVector3& remainder, const btTransform& frame, btScalar seconds,
               ContactRow& row, RowOrigin& origin);

/// For the next step: the offset from the sticking position at the end of this one; for a sliding point, the offset
/// that friction can hold.
FrictionAnchor frictionAnchorOf(const ContactRow& row, const RowOrigin& origin, btScalar seconds);

}  // namespace tetskin::bullet_detail
