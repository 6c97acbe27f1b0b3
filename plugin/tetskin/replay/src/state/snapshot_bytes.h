// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal: where a snapshot's hash is; for recorded runs, snapshots as vectors, and whether two are of one world.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/core/types.h>

#include <cstddef>
#include <vector>

namespace tetskin::bullet_detail {

/// Position of the hash in a snapshot: it covers all bytes after it.
constexpr std::size_t kHashAt = 32, kHashedFrom = kHashAt + 8;

/// Saves a snapshot without force records, which need not exist where a run is played; reuses the vector's memory.
/// Errors: those of `saveSnapshot`.
Status saveInto(btDeformableMultiBodyDynamicsWorld& world, std::vector<unsigned char>& snapshot);

/// True if both snapshots are of the same bodies, objects and joints: one may be restored where the other was saved.
bool areOfOneWorld(const std::vector<unsigned char>& a, const std::vector<unsigned char>& b);

}  // namespace tetskin::bullet_detail
