// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The state of a world as bytes, from which it goes on.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/core/types.h>
#include <tetskin/export.h>

#include <cstddef>

namespace tetskin {

/// Saves the state of a world, from which `restoreSnapshot` goes on: what steps change, and the application between
/// them. What is only prepared (cages, shapes, bindings, which bodies there are) is not part of it. Changes nothing.
///
///     std::vector<unsigned char> snapshot(tetskin::saveSnapshot(world, nullptr, 0).value());
///     if (!tetskin::saveSnapshot(world, snapshot.data(), snapshot.size()).ok()) ...
///     ...
///     if (!tetskin::restoreSnapshot(world, snapshot.data(), snapshot.size()).ok()) ...
///
/// world    created with a `DeformableSolver`, and not within a step
/// buffer   size bytes, not aligned; null: only the size is computed
/// Returns  the number of bytes of the snapshot
/// Cost     O(nodes + tets + objects + contacts), some 50 microseconds for 3,000 tets; allocates little
/// Errors   SizeMismatch: the buffer is too small, and holds no snapshot; NotSaved: the world has something that cannot
///          be saved, which the message names. Bullet's classes are known by their tables and type information. Where
///          several modules of a program have a Bullet of their own, with MSVC or without type information, classes of
///          another module are unknown: with MSVC, if tetskin is a DLL, Bullet has to be one, too
TETSKIN_REPLAY_API Result<std::size_t> saveSnapshot(const btDeformableMultiBodyDynamicsWorld& world, void* buffer,
                                                    std::size_t size);

/// Restores the state of a world in place: pointers, skins, joints and records stay valid. The world then goes on as
/// the one that was saved, to the last bit, in this process or another one, on any number of threads.
///
/// world     with the same bodies, objects and joints as when it was saved, created in the same order or the very
///           same ones; others may have been added and removed again since. Both are deterministic, or both are not
/// snapshot  size bytes, not aligned, as `saveSnapshot` has written them; only read
/// Errors    Malformed: the bytes are damaged; UnsupportedFormat: they are of another version, precision or kind of
///           machine; SnapshotMismatch: the world is another one, the message names what was added, removed or is
///           different; NotSaved. On an error nothing is changed, but for bytes that were altered and hashed anew
TETSKIN_REPLAY_API Status restoreSnapshot(btDeformableMultiBodyDynamicsWorld& world, const void* snapshot,
                                          std::size_t size);

}  // namespace tetskin
