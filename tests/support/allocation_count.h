// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstddef>
#include <new>

#ifndef __has_feature
#define __has_feature(name) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || __has_feature(address_sanitizer)
#include <sanitizer/lsan_interface.h>
#endif

namespace tetskin::test {

/// Bullet leaks half-made objects when memory runs out: as long as this exists, leaks are not reported.
#if defined(__SANITIZE_ADDRESS__) || __has_feature(address_sanitizer)
using LeaksOfBullet = __lsan::ScopedDisabler;
#else
struct LeaksOfBullet {
  LeaksOfBullet() {}
};
#endif

/// How often operator new has been called in this program, which links the counting replacement of it.
std::size_t allocationCount();

/// Bytes that are allocated now, and the largest number of them since the last `resetPeak`.
std::size_t allocatedBytes();
std::size_t peakBytes();
void resetPeak();

/// As long as this exists, the allocation after this many others fails once.
class AllocationThatFails {
 public:
  explicit AllocationThatFails(std::size_t after);
  ~AllocationThatFails();
  AllocationThatFails(const AllocationThatFails&) = delete;
  AllocationThatFails& operator=(const AllocationThatFails&) = delete;
};

/// Calls it with ever later allocations that fail, until none does. Returns how often it has failed.
/// whenFailed  called after each failure
template <class Call, class WhenFailed>
int failEachAllocation(Call&& call, WhenFailed&& whenFailed) {
  for (std::size_t after = 0;; after += 1 + after / 16) {
    try {
      const LeaksOfBullet leaks;
      const AllocationThatFails failing(after);
      call();
      return static_cast<int>(after);
    } catch (const std::bad_alloc&) {
    }
    whenFailed();
    if (after > 100000) return -1;
  }
}

}  // namespace tetskin::test
