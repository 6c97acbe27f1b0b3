// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to snapshots: which worlds can be saved.
#pragma once

#include <tetskin/bullet/deformable_world.h>
#include <tetskin/core/types.h>

namespace tetskin::bullet_detail {

/// Errors  NotSaved, which names what it is
Status checkIsSaved(btDeformableMultiBodyDynamicsWorld& world, const DeformableSolver& solver);

}  // namespace tetskin::bullet_detail
