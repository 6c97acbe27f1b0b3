// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Replaces the global operator new: link it into the one test program that counts allocations. It has a separate file
// so that it is not inlined into callers.
#include "support/allocation_count.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

#ifdef _WIN32
#include <malloc.h>
#endif

namespace {

std::atomic<std::size_t> allocations{0}, bytes{0}, peak{0};  // threads also allocate
std::atomic<long long> untilFailure{-1};                     // allocations; below 0: none fails

/// The block's size is stored in front of the block, in as many bytes as the block's alignment needs.
constexpr std::size_t kOrdinary = alignof(std::max_align_t);

std::size_t& sizeOf(void* block) {
  return *reinterpret_cast<std::size_t*>(static_cast<char*>(block) - kOrdinary);
}

/// size  a multiple of the alignment
void* alignedMemory(std::size_t alignment, std::size_t size) noexcept {
#ifdef _WIN32
  return _aligned_malloc(size, alignment);
#else
  return std::aligned_alloc(alignment, size);
#endif
}

void freeAligned(void* memory) noexcept {
#ifdef _WIN32
  _aligned_free(memory);
#else
  std::free(memory);
#endif
}

void* allocate(std::size_t size, std::size_t alignment) noexcept {
  char* memory =
      static_cast<char*>(alignedMemory(alignment, (alignment + size + alignment - 1) / alignment * alignment));
  if (!memory) return nullptr;
  ++allocations;
  const std::size_t now = bytes += size;
  std::size_t maximum = peak;
  while (now > maximum && !peak.compare_exchange_weak(maximum, now)) {
  }
  sizeOf(memory + alignment) = size;
  return memory + alignment;
}
void* allocateOrThrow(std::size_t size, std::size_t alignment) {
  if (untilFailure >= 0 && untilFailure-- == 0) throw std::bad_alloc();
  void* block = allocate(size, alignment);
  if (!block) throw std::bad_alloc();
  return block;
}

void release(void* block, std::size_t alignment) noexcept {
  if (!block) return;
  bytes -= sizeOf(block);
  freeAligned(static_cast<char*>(block) - alignment);
}

std::size_t from(std::align_val_t alignment) {
  return std::max(kOrdinary, static_cast<std::size_t>(alignment));
}

}  // namespace

// The standard library's other operators call these, and a sanitizer's runtime defines the same ones.
void* operator new(std::size_t size) {
  return allocateOrThrow(size, kOrdinary);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return allocate(size, kOrdinary);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocateOrThrow(size, from(alignment));
}
void operator delete(void* block) noexcept {
  release(block, kOrdinary);
}
void operator delete(void* block, std::size_t) noexcept {
  release(block, kOrdinary);
}
void operator delete(void* block, const std::nothrow_t&) noexcept {
  release(block, kOrdinary);
}
void operator delete(void* block, std::align_val_t alignment) noexcept {
  release(block, from(alignment));
}
void operator delete(void* block, std::size_t, std::align_val_t alignment) noexcept {
  release(block, from(alignment));
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

AllocationThatFails::AllocationThatFails(std::size_t after) {
  untilFailure = static_cast<long long>(after);
}
AllocationThatFails::~AllocationThatFails() {
  untilFailure = -1;
}

}  // namespace tetskin::test
