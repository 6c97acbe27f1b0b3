// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: several numbers side by side. Included once per instruction set, each time in its own
// namespace (TETSKIN_KERNELS), without Eigen or the standard library: see skinning_kernels.h. It has no include guard,
// because a unit may need it in several namespaces; one header per namespace (points.h, wide.h, four.h) includes it for
// all others.
//
// With GCC and Clang it uses the compiler's vector types, on every processor. Without them, or with
// TETSKIN_PLAIN_LANES, the same code is plain C++: lanes are one wide, and only points are four numbers.
#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif
#include <math.h>
#include <string.h>
#include <tetskin/core/src/base/compiler.h>

#include <cstddef>
#include <cstdint>

#if defined(TETSKIN_GNU) && !defined(TETSKIN_PLAIN_LANES)
#define TETSKIN_VECTOR_TYPES 1
// Vectors wider than a register are only passed between functions compiled with the same flags.
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace tetskin::kernels::TETSKIN_KERNELS {

template <class S, int W>
struct LanesOf {
#ifdef TETSKIN_VECTOR_TYPES
  typedef S Type __attribute__((vector_size(W * sizeof(S))));
#endif
};
template <class S>
struct LanesOf<S, 1> {
  using Type = S;
};
#ifndef TETSKIN_VECTOR_TYPES
/// A padded point for compilers without vector types. No loops: their counters would keep it in memory.
template <class S>
struct LanesOf<S, 4> {
  struct Type {
    S v[4];
    S operator[](int i) const { return v[i]; }
    S& operator[](int i) { return v[i]; }
    template <class Function>
    static Type each(const Type& a, const Type& b, Function f) {
      return {{f(a.v[0], b.v[0]), f(a.v[1], b.v[1]), f(a.v[2], b.v[2]), f(a.v[3], b.v[3])}};
    }
    friend Type operator+(const Type& a, const Type& b) {
      return each(a, b, [](S p, S q) { return p + q; });
    }
    friend Type operator-(const Type& a, const Type& b) {
      return each(a, b, [](S p, S q) { return p - q; });
    }
    friend Type operator*(const Type& a, const Type& b) {
      return each(a, b, [](S p, S q) { return p * q; });
    }
    friend Type operator*(const Type& a, S b) { return a * Type{{b, b, b, b}}; }
    Type& operator+=(const Type& b) { return *this = *this + b; }
    Type& operator-=(const Type& b) { return *this = *this - b; }
    friend Type smaller(const Type& a, const Type& b) {
      return each(a, b, [](S p, S q) { return p < q ? p : q; });
    }
    friend Type larger(const Type& a, const Type& b) {
      return each(a, b, [](S p, S q) { return p > q ? p : q; });
    }
  };
};
#endif
/// W numbers. Arithmetic is lane by lane; a scalar operand applies to every lane.
template <class S, int W>
using Lanes = typename LanesOf<S, W>::Type;

/// Loads W floats from any address.
template <int W>
Lanes<float, W> load(const float* from) {
  Lanes<float, W> v;
  ::memcpy(&v, from, sizeof v);
  TETSKIN_ONE_LOAD(v);
  return v;
}

/// Lanes 0, 1, 2, ...
template <class S, int W>
Lanes<S, W> laneNumbers() {
  Lanes<S, W> v{};
  for (int i = 0; i < W; ++i) v[i] = static_cast<S>(i);
  return v;
}

/// The smaller, or the larger, of two numbers, lane by lane; b if a is NaN.
template <class V>
V smaller(const V& a, const V& b) {
  return a < b ? a : b;
}
template <class V>
V larger(const V& a, const V& b) {
  return a > b ? a : b;
}

/// One bit per lane: set if the lane is negative.
template <int W>
unsigned negativeLanes(const Lanes<float, W>& v) {
  if constexpr (W == 1) {
    return v < 0.0f ? 1u : 0u;
  } else {
    const auto negative = v < 0.0f;  // all bits set where it is true
#if defined(__AVX2__)
    if constexpr (W == 8) return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(negative)));
#endif
#if defined(__SSE2__)
    if constexpr (W == 4) return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(negative)));
#endif
    unsigned bits = 0;
    for (int i = 0; i < W; ++i) bits |= negative[i] ? 1u << i : 0u;
    return bits;
  }
}

#ifdef TETSKIN_VECTOR_TYPES
/// Converts each lane to another type.
template <class To, class From>
TETSKIN_INLINE To converted(const From& v) {
  return __builtin_convertvector(v, To);
}
inline float squareRoot(float x) {
  return __builtin_sqrtf(x);
}
inline double squareRoot(double x) {
  return __builtin_sqrt(x);
}
#else
inline float squareRoot(float x) {
  return ::sqrtf(x);
}
inline double squareRoot(double x) {
  return ::sqrt(x);
}
#endif

}  // namespace tetskin::kernels::TETSKIN_KERNELS
