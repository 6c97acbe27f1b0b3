// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: how results of Bullet's contact solve enter the solve that follows.
#pragma once

#include <tetskin/solver/src/rows/solver_bodies.h>

class btDeformableContactProjection;

namespace tetskin::bullet_detail {

/// Lists the nodes whose velocity must stay as Bullet's constraints have set it, in some directions: all constrained
/// nodes of bodies under Bullet's forces; of elastic bodies, nodes in contacts that only Bullet handles.
void listFixedNodes(const btDeformableContactProjection& projection, SolverBodies& bodies);
/// Fixes these nodes in the matrix; call it after everything else has been added to the diagonal.
void fixNodes(const SolvedBody& body);

/// Adds the friction impulses on sliding nodes whose contacts Bullet solves.
/// residual  by node number
void addDynamicFriction(const btDeformableContactProjection& projection, SolverBodies& bodies, VectorStack& residual);

}  // namespace tetskin::bullet_detail
