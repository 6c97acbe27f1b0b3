// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin: whether a world has the solver that corotated bodies, contacts and joints need.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/deformable_solver.h>

#include <string>
#include <vector>

namespace tetskin {

/// What an application whose world has another solver must do.
constexpr const char* kUseDeformableSolver =
    "make the world and its constraint solver with a DeformableSolver in place of Bullet's";

/// Of the world that the body is in; null if it is in none, or its world has another solver.
TETSKIN_BULLET_API DeformableSolver* deformableSolverOf(const btSoftBody& body);

/// Of a deformable world, whoever's it is. Bullet tells it to bodies alone: an empty one is added for as long as it
/// takes, where there is none.
TETSKIN_BULLET_API btDeformableBodySolver& solverOf(btDeformableMultiBodyDynamicsWorld& world);
/// Null if it is another one.
TETSKIN_BULLET_API DeformableSolver* deformableSolverOf(btDeformableMultiBodyDynamicsWorld& world);

/// Ok if there is nothing to change; else InvalidOption, with all of it.
/// subject  what was asked for: "surface contact"
TETSKIN_BULLET_API Status refusal(const std::string& subject, const std::vector<std::string>& changes);

}  // namespace tetskin
