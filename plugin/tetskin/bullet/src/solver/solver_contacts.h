// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: what Bullet's contact solve leaves for the solve after it.
#pragma once

#include <tetskin/bullet/src/solver/solver_bodies.h>

class btDeformableContactProjection;

namespace tetskin {

/// Lists the nodes whose velocity stays, in some directions, as Bullet's constraints have made it: of bodies under
/// Bullet's forces all, of elastic ones those of contacts that Bullet alone knows of.
void listFixedNodes(const btDeformableContactProjection& projection, SolverBodies& bodies);
/// Fixes them in the matrix: after all that is added to its diagonal.
void fixNodes(const SolvedBody& body);

/// What friction does to nodes that slide, as impulses, where Bullet solves for contacts.
/// residual  by node number
void addDynamicFriction(const btDeformableContactProjection& projection, SolverBodies& bodies, VectorStack& residual);

}  // namespace tetskin
