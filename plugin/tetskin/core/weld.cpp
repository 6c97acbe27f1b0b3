// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/weld.h>

#include <cstring>

namespace tetskin {
namespace {

std::uint64_t bitsOf(double x) {
  x += 0.0;  // -0 becomes 0
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

/// Mixes three coordinates so that the high bits depend on all of theirs (the multiplier is the golden ratio's, after
/// Knuth, "The Art of Computer Programming" 3, section 6.4).
std::uint64_t hashOf(const double* p) {
  constexpr std::uint64_t kMultiplier = 0x9E3779B97F4A7C15u;
  std::uint64_t h = bitsOf(p[0]) * kMultiplier;
  h = ((h >> 32) ^ h ^ bitsOf(p[1])) * kMultiplier;
  h = ((h >> 32) ^ h ^ bitsOf(p[2])) * kMultiplier;
  return h ^ (h >> 32);
}

bool samePoint(const double* a, const double* b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

}  // namespace

std::vector<std::uint32_t> weldCoincident(PointView<const double> points) {
  assert(firstNonFinite(points) == points.size());
  constexpr std::uint32_t kFree = 0xFFFFFFFFu;
  std::size_t size = 16;
  while (size < 2 * points.size()) size *= 2;  // at most half full: probes stay short
  std::vector<std::uint32_t> table(size, kFree);
  std::vector<std::uint32_t> first(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::size_t slot = hashOf(points[i]) & (size - 1);
    while (table[slot] != kFree && !samePoint(points[table[slot]], points[i])) slot = (slot + 1) & (size - 1);
    if (table[slot] == kFree) table[slot] = i;
    first[i] = table[slot];
  }
  return first;
}

}  // namespace tetskin
