// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The state of a world as bytes, from which it can continue.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/core/types.h>
#include <tetskin/export.h>

#include <cstddef>

namespace tetskin {

/// Saves the state of a world, from which `restoreSnapshot` continues: everything that steps change, or the application
/// between them. What is only prepared (cages, shapes, bindings, the set of bodies) is not part of it. Changes nothing.
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
///          be saved, which the message names. Bullet's classes are recognised by their virtual tables and type
///          information. With MSVC, or without type information, those of a module with a Bullet of its own are not:
///          its joints, and its worlds, except a `DeformableWorld`. There, where tetskin is a DLL, Bullet must be one
TETSKIN_REPLAY_API Result<std::size_t> saveSnapshot(const btDeformableMultiBodyDynamicsWorld& world, void* buffer,
                                                    std::size_t size);

/// Restores the state of a world in place: pointers, skins, joints and records stay valid. The world then continues
/// like the saved one, to the last bit, in this process or another one, on any number of threads.
///
/// world     has the same bodies, objects and joints as when it was saved, created in the same order or the very same
///           ones; others may since have been added and removed again. Both worlds are deterministic, or neither is
/// snapshot  size bytes, not aligned, written by `saveSnapshot`; only read
/// Errors    Malformed: the bytes are damaged; UnsupportedFormat: they are of another version, precision or kind of
///           machine; SnapshotMismatch: the world is another one, and the message names what was added, removed or
///           differs; NotSaved. Nothing is changed on an error, unless the bytes were altered and hashed again
TETSKIN_REPLAY_API Status restoreSnapshot(btDeformableMultiBodyDynamicsWorld& world, const void* snapshot,
                                          std::size_t size);

}  // namespace tetskin
