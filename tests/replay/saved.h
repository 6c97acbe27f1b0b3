// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/replay/snapshot.h>

#include <vector>

namespace tetskin::test {

using Snapshot = std::vector<unsigned char>;

inline Snapshot saved(const btDeformableMultiBodyDynamicsWorld& world) {
  Snapshot snapshot(saveSnapshot(world, nullptr, 0).value());
  (void)saveSnapshot(world, snapshot.data(), snapshot.size()).value();
  return snapshot;
}

}  // namespace tetskin::test
