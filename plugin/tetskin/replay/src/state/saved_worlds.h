// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to snapshots: which worlds can be saved.
#pragma once

#include <tetskin/core/types.h>
#include <tetskin/solver/deformable_world.h>

namespace tetskin::bullet_detail {

/// Errors  NotSaved, with a message that names the obstacle
Status checkIsSaved(btDeformableMultiBodyDynamicsWorld& world, const DeformableSolver& solver);

}  // namespace tetskin::bullet_detail
