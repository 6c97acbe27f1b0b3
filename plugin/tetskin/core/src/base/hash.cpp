// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/hash.h>

namespace tetskin {

std::uint64_t hashInLanes(const unsigned char* bytes, std::size_t count) {
  constexpr std::size_t kLanes = 8;  ///< as many as the processor works on at a time
  Hash lanes[kLanes];
  std::size_t at = 0;
  for (; at + 8 * kLanes <= count; at += 8 * kLanes) {
    std::uint64_t words[kLanes];
    std::memcpy(words, bytes + at, sizeof words);
    for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane].add(words[lane]);
  }
  for (std::size_t lane = 0; at < count; at += 8, ++lane) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + at, count - at < 8 ? count - at : 8);
    lanes[lane].add(word);
  }
  Hash hash;
  hash.add(std::uint64_t{count});
  for (const Hash& lane : lanes) hash.add(lane.value());
  return hash.value();
}

}  // namespace tetskin
