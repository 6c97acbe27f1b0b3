// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace tetskin {

/// Memory that begins at a cache line, which also aligns every register in it.
template <class T>
struct LineAllocator {
  using value_type = T;
  /// Bytes of a cache line on most processors, and of the widest register.
  static constexpr std::align_val_t kLine{64};

  LineAllocator() = default;
  template <class Other>
  LineAllocator(const LineAllocator<Other>&) {}  // NOLINT: implicit, as allocators are

  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, kLine); }
  friend bool operator==(const LineAllocator&, const LineAllocator&) { return true; }
  friend bool operator!=(const LineAllocator&, const LineAllocator&) { return false; }
};

/// Private to the libraries: application code compiled with other flags must not see its allocator.
template <class T>
using AlignedVector = std::vector<T, LineAllocator<T>>;

}  // namespace tetskin
