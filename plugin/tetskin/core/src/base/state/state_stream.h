// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: the stream to and from a snapshot, a recorded step, or the bytes of a mesh or cage. One
// function per struct, `serialize`, serves both directions, so that they cannot differ.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace tetskin {

/// Counts, writes, or reads bytes. It writes numbers one by one, never structs, whose padding is not initialised; in
/// the machine's own byte order: a snapshot's header states it, and others are refused by their hash.
///
/// Reading never goes beyond the bytes: what is missing reads as 0, and `failed` is true from then on.
class StateStream {
 public:
  enum class Way { Count, Save, Restore };

  /// Counts bytes.
  StateStream() = default;
  /// Writes up to `capacity` bytes; beyond, it only counts.
  StateStream(unsigned char* to, std::size_t capacity) : way_(Way::Save), to_(to), size_(capacity) {}
  /// Reads.
  StateStream(const unsigned char* from, std::size_t size) : way_(Way::Restore), from_(from), size_(size) {}

  /// restoring: values must be replaced by what is read. saving: nothing may be changed.
  bool saving() const { return way_ != Way::Restore; }
  bool restoring() const { return way_ == Way::Restore; }
  /// Bytes so far.
  std::size_t count() const { return at_; }
  bool failed() const { return failed_; }
  /// Call it if a value that was read is impossible.
  void fail() { failed_ = true; }

  /// All bytes pass through here.
  void bytes(void* data, std::size_t count) {
    const std::size_t end = at_ + count;
    if (way_ == Way::Count) {
      at_ = end;
      return;
    }
    if (failed_ || count > size_ - at_) {
      if (way_ == Way::Save) {  // once full, only counts
        way_ = Way::Count;
        at_ = end;
      } else {
        failed_ = true;
        if (count > 0) std::memset(data, 0, count);
      }
      return;
    }
    if (count > 0) {
      if (way_ == Way::Save) {
        std::memcpy(to_ + at_, data, count);
      } else {
        std::memcpy(data, from_ + at_, count);
      }
    }
    at_ = end;
  }

  /// A number. Any byte is read as a valid bool.
  template <class T, std::enable_if_t<std::is_arithmetic_v<T> || std::is_enum_v<T>, int> = 0>
  void operator()(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      unsigned char byte = value ? 1 : 0;
      bytes(&byte, 1);
      if (restoring()) value = byte != 0;
    } else {
      bytes(&value, sizeof value);
    }
  }
  /// Several values, one after another.
  template <class First, class Second, class... More>
  void operator()(First& first, Second& second, More&... more) {
    (*this)(first);
    (*this)(second);
    ((*this)(more), ...);
  }
  /// The length of a list whose elements take at least `leastBytes` each: refused if the remaining bytes cannot hold
  /// it.
  std::size_t length(std::size_t now, std::size_t leastBytes = 1) {
    assert(now <= 0xFFFFFFFFu);
    auto n = static_cast<std::uint32_t>(now);
    (*this)(n);
    if (restoring() && (failed_ || n > (size_ - at_) / (leastBytes > 0 ? leastBytes : 1))) {
      failed_ = true;
      return 0;
    }
    return n;
  }
  /// A vector of numbers, with its length.
  template <class Vector>
  void array(Vector& values) {
    using T = std::decay_t<decltype(values[0])>;
    static_assert(std::is_arithmetic_v<T>);
    const std::size_t n = length(values.size(), sizeof(T));
    if (restoring()) values.resize(n);
    if (n > 0) bytes(values.data(), n * sizeof(T));
  }
  /// Numbers whose count is known on both sides.
  template <class T>
  void plain(T* values, std::size_t count) {
    static_assert(std::is_arithmetic_v<T>);
    bytes(values, count * sizeof(T));
  }
  /// A vector of anything, with its length: visit(element) for each. It grows as elements are read: missing ones take
  /// no memory.
  template <class Vector, class Visit>
  void each(Vector& values, Visit&& visit) {
    const std::size_t n = length(values.size());
    if (restoring() && values.size() > n) values.resize(n);
    for (auto& value : values) visit(value);
    while (values.size() < n && !failed_) visit(values.emplace_back());
  }

 private:
  Way way_ = Way::Count;
  unsigned char* to_ = nullptr;
  const unsigned char* from_ = nullptr;
  std::size_t size_ = 0;
  std::size_t at_ = 0;
  bool failed_ = false;
};

/// The bytes that `serialize(stream)` writes.
template <class Serialize>
std::vector<unsigned char> bytesWrittenBy(Serialize&& serialize) {
  StateStream counted;
  serialize(counted);
  std::vector<unsigned char> bytes(counted.count());
  StateStream written(bytes.data(), bytes.size());
  serialize(written);
  return bytes;
}

}  // namespace tetskin
