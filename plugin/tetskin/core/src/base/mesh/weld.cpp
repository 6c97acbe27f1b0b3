// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A hash table of all points would miss the cache at every look-up once there are millions. So points are first dealt
// into buckets by their hash, a sequential pass; the table of one bucket then stays in the cache. Hashes are kept, so
// that a point is compared, which reads it from anywhere, only with one of the same hash.
#include <tetskin/core/src/base/hash.h>
#include <tetskin/core/src/base/lists.h>
#include <tetskin/core/src/base/mesh/weld.h>

#include <cassert>
#include <cstring>
#include <numeric>

namespace tetskin {
namespace {

/// Most points per bucket, on average: its keys and its table fill about half of a small second-level cache. Smaller
/// buckets would be more than a processor writes to at once without missing its address cache.
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

/// How far to shift a hash to the right for its bucket.
int bucketShift(std::size_t count) {
  int shift = 31;
  while (shift > 0 && (count >> (32 - shift)) > kBucketSize) --shift;
  return shift;
}

/// The points' keys, bucket by bucket, and in each in the points' order.
Lists<Key> dealtKeys(const std::vector<std::uint32_t>& hashes) {
  const int shift = bucketShift(hashes.size());
  return packLists<Key>(std::size_t{1} << (32 - shift), [&](auto&& add) {
    for (std::uint32_t i = 0; i < hashes.size(); ++i) add(hashes[i] >> shift, Key{hashes[i], i});
  });
}

/// Names the first point at the position of every other among the keys of one bucket. `table` is scratch memory.
void weldBucket(PointReader points, const Key* keys, std::uint32_t count, std::vector<std::uint32_t>& table,
                std::vector<std::uint32_t>& first) {
  assert(first.size() == points.size());
  // A place of the table that holds no vertex.
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
  std::vector<std::uint32_t> first(points.size());  // holds hashes until their points are dealt
  for (std::size_t i = 0; i < points.size(); ++i) first[i] = hashOf(points[i]);
  std::vector<std::uint32_t> table;
  const Lists<Key> buckets = dealtKeys(first);
  // Now every point is its own first. Only the few exceptions are written, at random positions, as points of a bucket
  // are far apart.
  std::iota(first.begin(), first.end(), std::uint32_t{0});
  for (std::size_t b = 0; b + 1 < buckets.starts.size(); ++b) {
    const std::uint32_t begin = buckets.starts[b], end = buckets.starts[b + 1];
    weldBucket(points, buckets.values.data() + begin, end - begin, table, first);
  }
  return first;
}

}  // namespace tetskin
