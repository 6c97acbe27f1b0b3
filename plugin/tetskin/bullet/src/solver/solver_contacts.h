// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: what Bullet's contact solve leaves for the solve after it.
#pragma once

#include <tetskin/bullet/src/solver/solver_bodies.h>

class btDeformableContactProjection;

namespace tetskin {

class RigidTies;

/// Bullet's directions in which a node's velocity stays as its contacts have made it. Marks the bodies that have any
/// but held nodes, and those that are tied.
void fixContacts(const btDeformableContactProjection& projection, const RigidTies& ties, SolverBodies& bodies);

/// What friction does to nodes that slide: on bodies under Bullet's forces impulses, as Bullet has it; on elastic ones
/// resistance, after their velocities have been read; ties have their own. Before `fixContacts`.
/// residual  by node number
void addDynamicFriction(const btDeformableContactProjection& projection, const RigidTies& ties, SolverBodies& bodies,
                        VectorStack& residual);

/// The normal impulses of this step's contacts, of the solution: for the next. Ties have their own, after this.
/// residual  of the solve's right side, beside the body's own: what addDynamicFriction and others gave, by node number
void keepNormalImpulses(const btDeformableContactProjection& projection, SolverBodies& bodies,
                        const VectorStack& residual);

}  // namespace tetskin
