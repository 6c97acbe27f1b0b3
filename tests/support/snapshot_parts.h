// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Snapshots with one part of another moment: nothing in a snapshot is there in vain.
#pragma once

#include <gtest/gtest.h>
#include <tetskin/core/src/base/hash.h>
#include <tetskin/replay/src/state/snapshot_bytes.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace tetskin::test {

using SavedBytes = std::vector<unsigned char>;

/// Objects, soft bodies, joints, broadphase, pairs, solver, contact search, forces.
constexpr std::size_t kParts = 8, kContactSearch = 6;
constexpr std::size_t kSnapshotLengthAt = 24;

inline std::size_t snapshotPayload() {
  return bullet_detail::kHashedFrom + 8 * (kParts + 1);
}

/// Where the list of objects ends, and each part.
inline std::vector<std::uint64_t> endsOf(const SavedBytes& snapshot) {
  std::vector<std::uint64_t> ends(kParts + 1);
  std::memcpy(ends.data(), snapshot.data() + bullet_detail::kHashedFrom, 8 * ends.size());
  EXPECT_EQ(ends.back(), snapshot.size() - snapshotPayload());
  return ends;
}

/// A snapshot in which one part is of another one of the same world.
inline SavedBytes withPartOf(const SavedBytes& later, std::size_t part, const SavedBytes& snapshot) {
  const std::vector<std::uint64_t> from = endsOf(later);
  std::vector<std::uint64_t> ends = endsOf(snapshot);
  const auto at = [](const SavedBytes& of, std::uint64_t offset) {
    return of.begin() + static_cast<std::ptrdiff_t>(snapshotPayload() + offset);
  };
  SavedBytes mixed(snapshot.begin(), at(snapshot, ends[part]));
  mixed.insert(mixed.end(), at(later, from[part]), at(later, from[part + 1]));
  mixed.insert(mixed.end(), at(snapshot, ends[part + 1]), snapshot.end());
  const std::uint64_t change = (from[part + 1] - from[part]) - (ends[part + 1] - ends[part]);
  for (std::size_t k = part + 1; k < ends.size(); ++k) ends[k] += change;
  std::memcpy(mixed.data() + kSnapshotLengthAt, &ends.back(), 8);
  std::memcpy(mixed.data() + bullet_detail::kHashedFrom, ends.data(), 8 * ends.size());
  const std::uint64_t hash =
      hashInLanes(mixed.data() + bullet_detail::kHashedFrom, mixed.size() - bullet_detail::kHashedFrom);
  std::memcpy(mixed.data() + bullet_detail::kHashAt, &hash, 8);
  return mixed;
}

}  // namespace tetskin::test
