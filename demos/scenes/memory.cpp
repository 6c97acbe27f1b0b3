// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/memory.h"

#include <unistd.h>

#include <algorithm>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace tetskin::scenes {
namespace {

/// Assumed size of the last-level cache where the system does not report it, and the most that is streamed through.
constexpr std::size_t kUnknownCache = std::size_t(64) << 20, kMaxStreamed = std::size_t(512) << 20;

std::size_t lastLevelCacheBytes() {
#ifdef _SC_LEVEL3_CACHE_SIZE
  if (const long bytes = sysconf(_SC_LEVEL3_CACHE_SIZE); bytes > 0) return static_cast<std::size_t>(bytes);
#endif
  return kUnknownCache;
}

}  // namespace

std::size_t heapBytes() {
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
#else
  return 0;
#endif
}

CacheEviction::CacheEviction() : buffer_(std::min(2 * lastLevelCacheBytes(), kMaxStreamed) / sizeof(std::uint64_t)) {}

void CacheEviction::evict() {
  constexpr std::size_t kLine = 64 / sizeof(std::uint64_t);
  volatile std::uint64_t* data = buffer_.data();
  for (std::size_t i = 0; i < buffer_.size(); i += kLine) data[i] = data[i] + 1;
}

}  // namespace tetskin::scenes
