// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

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

}  // namespace tetskin
