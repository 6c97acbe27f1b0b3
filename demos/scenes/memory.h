// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tetskin::scenes {

/// Evicts everything from the processor's caches, by streaming through more memory than they hold.
class CacheEviction {
 public:
  CacheEviction();
  void evict();
  std::size_t bytes() const { return buffer_.size() * sizeof(buffer_[0]); }

 private:
  std::vector<std::uint64_t> buffer_;
};

}  // namespace tetskin::scenes
