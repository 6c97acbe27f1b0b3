// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// With millions of points, a single hash table would miss the cache at every look-up. So points are first distributed
// into buckets by their hash, in a sequential pass; the table of one bucket then stays in the cache. Hashes are kept,
// so that a point, whose read may go anywhere in memory, is only compared with one of the same hash.
#include <tetskin/core/src/base/hash.h>
#include <tetskin/core/src/base/lists.h>
#include <tetskin/core/src/base/mesh/weld.h>

#include <cassert>
#include <cstring>
#include <numeric>

namespace tetskin {
namespace {

/// Most points per bucket, on average: its keys and its table fill about half of a small second-level cache. With
/// smaller buckets, there would be more of them than a processor can write to at once without missing its address
/// cache.
constexpr std::size_t kBucketSize = 8192;

struct Key {
  std::uint32_t hash;
  std::uint32_t point;
};

std::uint32_t hashOf(const Eigen::Vector3d& p) {
  Hash hash;
  for (int k = 0; k < 3; ++k) hash.add(p[k]);
  return hash.mixed();
}

/// The right shift that turns a hash into its bucket.
int bucketShift(std::size_t count) {
  int shift = 31;
  while (shift > 0 && (count >> (32 - shift)) > kBucketSize) --shift;
  return shift;
}

/// The points' keys, bucket by bucket, in each in the points' order.
Lists<Key> dealtKeys(const std::vector<std::uint32_t>& hashes) {
  const int shift = bucketShift(hashes.size());
  return packLists<Key>(std::size_t{1} << (32 - shift), [&](auto&& add) {
    for (std::uint32_t i = 0; i < hashes.size(); ++i) add(hashes[i] >> shift, Key{hashes[i], i});
  });
}

/// For each key of one bucket, finds the first point at its position. `table` is scratch memory.
void weldBucket(PointReader points, const Key* keys, std::uint32_t count, std::vector<std::uint32_t>& table,
                std::vector<std::uint32_t>& first) {
  assert(first.size() == points.size());
  // A free place of the table.
  constexpr std::uint32_t kFree = 0xFFFFFFFFu;
  std::size_t size = 16;
  while (size < 2 * std::size_t{count}) size *= 2;  // at most half full: probes stay short
  table.assign(size, kFree);
  for (std::uint32_t k = 0; k < count; ++k) {
    const Key& key = keys[k];
    const auto differs = [&](const Key& other) {
      return other.hash != key.hash || points[other.point] != points[key.point];
    };
    std::size_t slot = key.hash & (size - 1);
    while (table[slot] != kFree && differs(keys[table[slot]])) slot = (slot + 1) & (size - 1);
    if (table[slot] == kFree) {
      table[slot] = k;
    } else {
      first[key.point] = keys[table[slot]].point;
    }
  }
}

}  // namespace

std::vector<std::uint32_t> weldCoincident(PointReader points) {
  assert(points.size() < 0xFFFFFFFFu);
  std::vector<std::uint32_t> first(points.size());  // holds hashes until their points are distributed
  for (std::size_t i = 0; i < points.size(); ++i) first[i] = hashOf(points[i]);
  std::vector<std::uint32_t> table;
  const Lists<Key> buckets = dealtKeys(first);
  // Now every point is its own first. Only the few exceptions are written, at random positions, because the points of a
  // bucket are far apart.
  std::iota(first.begin(), first.end(), std::uint32_t{0});
  for (std::size_t b = 0; b + 1 < buckets.starts.size(); ++b) {
    const std::uint32_t begin = buckets.starts[b], end = buckets.starts[b + 1];
    weldBucket(points, buckets.values.data() + begin, end - begin, table, first);
  }
  return first;
}

}  // namespace tetskin
