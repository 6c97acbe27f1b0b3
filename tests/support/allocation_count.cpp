// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Replaces the global operator new: link into the one test program that counts. In a file of its own, so that no caller
// is inlined into it.
#include "support/allocation_count.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> allocations{0}, bytes{0}, peak{0};  // threads allocate, too

/// In front of every block; keeps its alignment.
struct alignas(std::max_align_t) Header {
  std::size_t size;
};

void release(void* memory) {
  if (!memory) return;
  Header* header = static_cast<Header*>(memory) - 1;
  bytes -= header->size;
  std::free(header);
}

}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  const std::size_t now = bytes += size;
  std::size_t most = peak;
  while (now > most && !peak.compare_exchange_weak(most, now)) {
  }
  Header* header = static_cast<Header*>(std::malloc(sizeof(Header) + size));
  if (!header) throw std::bad_alloc();
  header->size = size;
  return header + 1;
}
void operator delete(void* memory) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  release(memory);
}

namespace tetskin::test {

std::size_t allocationCount() {
  return allocations;
}
std::size_t allocatedBytes() {
  return bytes;
}
std::size_t peakBytes() {
  return peak;
}
void resetPeak() {
  peak = bytes.load();
}

}  // namespace tetskin::test
