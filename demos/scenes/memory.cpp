// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/memory.h"

#include <algorithm>

#include "scenes/system.h"

namespace tetskin::scenes {
namespace {

/// Assumed size of the last-level cache where the system does not report it, and the most that is streamed through.
constexpr std::size_t kUnknownCache = std::size_t(64) << 20, kMaxStreamed = std::size_t(512) << 20;

std::size_t streamedBytes() {
  const std::size_t cache = lastLevelCacheBytes();
  return std::min(2 * (cache > 0 ? cache : kUnknownCache), kMaxStreamed);
}

}  // namespace

CacheEviction::CacheEviction() : buffer_(streamedBytes() / sizeof(std::uint64_t)) {}

void CacheEviction::evict() {
  constexpr std::size_t kLine = 64 / sizeof(std::uint64_t);
  volatile std::uint64_t* data = buffer_.data();
  for (std::size_t i = 0; i < buffer_.size(); i += kLine) data[i] = data[i] + 1;
}

}  // namespace tetskin::scenes
