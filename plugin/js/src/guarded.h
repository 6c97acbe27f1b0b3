// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Functions as JavaScript calls them: with numbers, handles and addresses. Their exceptions become JavaScript
// exceptions, which unwind no C++.
#pragma once

#include <emscripten/bind.h>
#include <facade/errors.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tetskin::js {

using namespace facade;

/// The error for `throwFault`.
struct Fault {
  const char* code = nullptr;
  std::string message;
};

/// The fault of the exception being handled.
Fault currentFault();
/// Throws a JavaScript exception; does not return.
void throwFault(const Fault& fault);

template <auto Function>
struct Guarded;
template <class Return, class... Arguments, Return (*Function)(Arguments...)>
struct Guarded<Function> {
  static Return call(Arguments... arguments) {
    Fault fault;
    try {
      return Function(std::forward<Arguments>(arguments)...);
    } catch (...) {
      fault = currentFault();
    }
    throwFault(fault);
    __builtin_unreachable();
  }
};

/// Exports a function to JavaScript.
template <auto Function>
void expose(const char* name) {
  emscripten::function(name, &Guarded<Function>::call, emscripten::allow_raw_pointers());
}

/// Numbers that JavaScript has put into memory.
struct Doubles {
  std::uintptr_t at = 0;
  std::size_t count = 0;

  const double* begin() const { return reinterpret_cast<const double*>(at); }
  const double* end() const { return begin() + count; }
};
struct Indices {
  std::uintptr_t at = 0;
  std::size_t count = 0;

  const std::int32_t* begin() const { return reinterpret_cast<const std::int32_t*>(at); }
  const std::int32_t* end() const { return begin() + count; }
};
/// Memory that JavaScript views, or copies.
struct View {
  std::uintptr_t at = 0;
  std::size_t count = 0;  ///< of numbers
};
template <class Number>
View viewNumbers(const Number* numbers, std::size_t count) {
  return {reinterpret_cast<std::uintptr_t>(numbers), count};
}
/// Numbers that JavaScript copies before the next call.
template <class Number>
View lent(std::vector<Number>&& numbers) {
  static std::vector<Number> kept;
  kept = std::move(numbers);
  return viewNumbers(kept.data(), kept.size());
}

}  // namespace tetskin::js
