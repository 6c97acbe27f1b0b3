// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A hash table of all points would miss the cache at every look-up once there are millions. So points are first dealt
// into buckets by their hash, a sequential pass; the table of one bucket then stays in the cache. Hashes are kept, so
// that a point is compared, which reads it from anywhere, only with one of the same hash.
#include <tetskin/core/src/mesh/weld.h>

#include <cstring>
#include <numeric>

namespace tetskin {
namespace {

/// Most points a bucket, on average: its keys and its table fill about half of a small second-level cache. Smaller
/// buckets would be more than a processor writes to at once without missing its address cache.
constexpr std::size_t kBucketSize = 8192;

struct Key {
  std::uint32_t hash;
  std::uint32_t point;
};

std::uint64_t bitsOf(double x) {
  x += 0.0;  // -0 becomes 0
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

/// Mixes three coordinates so that all bits depend on all of theirs (the multiplier is the golden ratio's, after Knuth,
/// "The Art of Computer Programming" 3, section 6.4).
std::uint32_t hashOf(const Eigen::Vector3d& p) {
  constexpr std::uint64_t kMultiplier = 0x9E3779B97F4A7C15u;
  std::uint64_t h = bitsOf(p[0]) * kMultiplier;
  h = ((h >> 32) ^ h ^ bitsOf(p[1])) * kMultiplier;
  h = ((h >> 32) ^ h ^ bitsOf(p[2])) * kMultiplier;
  return static_cast<std::uint32_t>((h ^ (h >> 32)) * kMultiplier >> 32);
}

/// How far to shift a hash to the right for its bucket.
int bucketShift(std::size_t count) {
  int shift = 31;
  while (shift > 0 && (count >> (32 - shift)) > kBucketSize) --shift;
  return shift;
}

/// The points' keys, bucket by bucket, and in each in the points' order; `bucketEnd` receives where each ends.
std::vector<Key> dealtKeys(const std::vector<std::uint32_t>& hashes, std::vector<std::uint32_t>& bucketEnd) {
  const int shift = bucketShift(hashes.size());
  bucketEnd.assign(std::size_t{1} << (32 - shift), 0);
  for (const std::uint32_t hash : hashes) ++bucketEnd[hash >> shift];
  std::uint32_t sum = 0;
  for (std::uint32_t& bucket : bucketEnd) {
    const std::uint32_t size = bucket;
    bucket = sum;  // where the bucket begins: filling it moves that to its end
    sum += size;
  }
  std::vector<Key> keys(hashes.size());
  for (std::uint32_t i = 0; i < hashes.size(); ++i) keys[bucketEnd[hashes[i] >> shift]++] = {hashes[i], i};
  return keys;
}

/// Names the first point at the position of every other among the keys of one bucket. `table` is scratch memory.
void weldBucket(PointReader points, const Key* keys, std::uint32_t count, std::vector<std::uint32_t>& table,
                std::vector<std::uint32_t>& first) {
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
  std::vector<std::uint32_t> bucketEnd, table;
  const std::vector<Key> keys = dealtKeys(first, bucketEnd);
  // Now every point is its own first, and only the few that are not are written to, far apart as those of a bucket are.
  std::iota(first.begin(), first.end(), std::uint32_t{0});
  std::uint32_t begin = 0;
  for (const std::uint32_t end : bucketEnd) {
    weldBucket(points, keys.data() + begin, end - begin, table, first);
    begin = end;
  }
  return first;
}

}  // namespace tetskin
