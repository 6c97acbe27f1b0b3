// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/base/hash.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace tetskin::bullet_detail {

/// Position of the hash in a snapshot: it covers all bytes after it.
constexpr std::size_t kHashAt = 32;
constexpr std::size_t kHashedFrom = kHashAt + 8;

/// A hash of bytes, for some 100 kilobytes within microseconds: its lanes are independent. A step is one-to-one in each
/// word, as in `Hash`, so that a change of a single word never goes unnoticed.
inline std::uint64_t snapshotHash(const unsigned char* bytes, std::size_t count) {
  constexpr std::size_t kLanes = 8;
  std::uint64_t lanes[kLanes] = {};
  const auto mix = [&](std::size_t lane, std::uint64_t word) {
    const std::uint64_t product = (lanes[lane] ^ word) * 0x9E3779B97F4A7C15u;
    lanes[lane] = product ^ product >> 32;
  };
  std::size_t at = 0;
  for (; at + 8 * kLanes <= count; at += 8 * kLanes) {
    std::uint64_t words[kLanes];
    std::memcpy(words, bytes + at, sizeof words);
    for (std::size_t lane = 0; lane < kLanes; ++lane) mix(lane, words[lane]);
  }
  for (std::size_t lane = 0; at < count; at += 8, ++lane) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + at, count - at < 8 ? count - at : 8);
    mix(lane, word);
  }
  Hash hash;
  hash.add(std::uint64_t{count});
  for (const std::uint64_t lane : lanes) hash.add(lane);
  return hash.value();
}

}  // namespace tetskin::bullet_detail
