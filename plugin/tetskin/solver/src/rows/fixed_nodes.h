// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: how results of Bullet's contact solve enter the solve that follows.
#pragma once

#include <tetskin/solver/src/rows/solver_bodies.h>

class btDeformableContactProjection;

namespace tetskin::bullet_detail {

/// Lists the nodes whose velocity must stay, in some directions, as Bullet's constraints have set it: for bodies under
/// Bullet's forces all nodes with constraints, for elastic ones those of contacts that only Bullet handles.
void listFixedNodes(const btDeformableContactProjection& projection, SolverBodies& bodies);
/// Fixes these nodes in the matrix; call it after everything that is added to its diagonal.
void fixNodes(const SolvedBody& body);

/// Adds the impulses of friction on sliding nodes, where Bullet solves for contacts.
/// residual  by node number
void addDynamicFriction(const btDeformableContactProjection& projection, SolverBodies& bodies, VectorStack& residual);

}  // namespace tetskin::bullet_detail
