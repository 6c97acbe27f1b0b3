// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: what Bullet's contact solve leaves for the solve after it.
#pragma once

#include <tetskin/bullet/src/solver/solver_bodies.h>

class btDeformableContactProjection;

namespace tetskin {

/// Bullet's directions in which a node's velocity stays as its constraints have made it: of bodies under Bullet's
/// forces all, of elastic ones those of contacts that Bullet alone knows of. Marks the bodies that have any but held
/// nodes.
void fixContacts(const btDeformableContactProjection& projection, SolverBodies& bodies);

/// What friction does to nodes that slide, as impulses, where Bullet solves for contacts. Before `fixContacts`.
/// residual  by node number
void addDynamicFriction(const btDeformableContactProjection& projection, SolverBodies& bodies, VectorStack& residual);

}  // namespace tetskin
