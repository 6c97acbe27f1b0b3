// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Code shared by the fuzzers. Each fuzzer is one function, called with bytes by libFuzzer, or by `random_driver.cpp`
// where the compiler has no libFuzzer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Stops the fuzzer, which then keeps the bytes that caused this.
#define TETSKIN_FUZZ_EXPECT(condition)                                             \
  do {                                                                             \
    if (!(condition)) {                                                            \
      std::fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                \
    }                                                                              \
  } while (false)

namespace tetskin::test {

/// Takes values from the front of the bytes; zeros once they are used up.
class FuzzedBytes {
 public:
  FuzzedBytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool empty() const { return size_ == 0; }
  const std::uint8_t* data() const { return data_; }
  std::size_t size() const { return size_; }

  template <class T>
  T take() {
    T value{};
    const std::size_t count = size_ < sizeof(T) ? size_ : sizeof(T);
    if (count > 0) std::memcpy(&value, data_, count);
    data_ += count;
    size_ -= count;
    return value;
  }
  /// A number from 0 to `most`.
  int number(int most) { return take<std::uint8_t>() % (most + 1); }
  /// A small multiple of a quarter, or, one time in four, any float.
  double coordinate() {
    const auto kind = take<std::uint8_t>();
    if (kind % 4 == 3) return static_cast<double>(take<float>());
    return 0.25 * (kind / 4 % 16);
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

}  // namespace tetskin::test
