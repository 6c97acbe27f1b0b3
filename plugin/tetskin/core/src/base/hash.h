// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/export.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace tetskin {

/// A hash of a sequence of words. Every step is one-to-one in the previous hash and in the word, so that a change of a
/// single word never goes unnoticed (the multiplier is the golden ratio's, after Knuth, "The Art of Computer
/// Programming" 3, section 6.4). Saved embeddings contain such hashes.
class Hash {
 public:
  void add(std::uint64_t word) {
    value_ = (value_ ^ word) * kMultiplier;
    value_ ^= value_ >> 32;
  }
  /// Adds a coordinate: 0 and -0 are the same position.
  void add(double x) {
    x += 0.0;
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    add(bits);
  }
  std::uint64_t value() const { return value_; }
  /// The hash for use in tables: every bit depends on all bits of the words.
  std::uint32_t mixed() const { return static_cast<std::uint32_t>(value_ * kMultiplier >> 32); }

 private:
  /// 2^64 over the golden ratio, odd: its products spread neighbouring values over all upper bits (Knuth).
  static constexpr std::uint64_t kMultiplier = 0x9E3779B97F4A7C15u;
  std::uint64_t value_ = 0xCBF29CE484222325u;
};

/// A hash of bytes, for some 100 kilobytes within microseconds: its lanes are independent. A change of a single byte
/// never goes unnoticed.
TETSKIN_CORE_API std::uint64_t hashInLanes(const unsigned char* bytes, std::size_t count);

/// What hashes of states begin with. Not FNV's own basis: recorded hashes were made with this one.
constexpr std::uint64_t kStateHashBasis = 1469598103934665603u;

/// FNV-1a of bytes, for results that other programs compare: anyone can compute it.
/// before  the hash of the bytes before them
inline std::uint64_t fnv1a(const void* bytes, std::size_t count, std::uint64_t before) {
  const auto* data = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < count; ++i) before = (before ^ data[i]) * 1099511628211u;
  return before;
}

}  // namespace tetskin
