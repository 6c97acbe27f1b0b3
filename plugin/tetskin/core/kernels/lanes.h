// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: several numbers side by side. Included once for each instruction set, in a namespace of its
// own (TETSKIN_KERNELS), and without help from Eigen or the standard library: see skinning_kernels.h.
//
// With GCC and Clang the compiler's vector types do the work, on every processor. Without them, or with
// TETSKIN_PLAIN_LANES, the same code is plain C++: lanes are one wide, and only padded points are four numbers.
#pragma once

#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif
#include <math.h>
#include <string.h>

#include <cstddef>
#include <cstdint>

#if defined(__GNUC__) && !defined(TETSKIN_PLAIN_LANES)
#define TETSKIN_VECTOR_TYPES 1
#endif
#if defined(TETSKIN_VECTOR_TYPES) && defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector) && __has_builtin(__builtin_convertvector)
#define TETSKIN_SHUFFLES 1
#endif
#endif

// GCC 12 would read a number of several uses from memory again for each of them; unaligned, that is dear.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__)
#define TETSKIN_ONE_LOAD(v) asm("" : "+v"(v))
#else
#define TETSKIN_ONE_LOAD(v)
#endif
#if defined(__GNUC__)
#define TETSKIN_NOINLINE __attribute__((noinline))
#define TETSKIN_INLINE __attribute__((always_inline)) inline
#else
#define TETSKIN_NOINLINE
#define TETSKIN_INLINE inline
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
/// A padded point where the compiler has no vector types.
template <class S>
struct LanesOf<S, 4> {
  struct Type {
    S v[4];
    S operator[](int i) const { return v[i]; }
    friend Type operator+(Type a, const Type& b) { return a += b; }
    friend Type operator-(Type a, const Type& b) {
      for (int i = 0; i < 4; ++i) a.v[i] -= b.v[i];
      return a;
    }
    friend Type operator*(Type a, S b) {
      for (int i = 0; i < 4; ++i) a.v[i] *= b;
      return a;
    }
    Type& operator+=(const Type& b) {
      for (int i = 0; i < 4; ++i) v[i] += b.v[i];
      return *this;
    }
  };
};
#endif
/// W numbers. Arithmetic is lane by lane; a single number beside one stands for W equal ones.
template <class S, int W>
using Lanes = typename LanesOf<S, W>::Type;

template <class S, int W>
S lane(const Lanes<S, W>& v, int i) {
  if constexpr (W == 1) {
    return v;
  } else {
    return v[i];
  }
}

template <class S, int W>
Lanes<S, W> all(S value) {
  if constexpr (W == 1) {
    return value;
  } else {
    return Lanes<S, W>{} + value;
  }
}

/// W floats from memory at any address, as S.
template <class S, int W>
Lanes<S, W> load(const float* from) {
  if constexpr (W == 1) {
    return static_cast<S>(*from);
  } else {
    Lanes<float, W> v;
    ::memcpy(&v, from, sizeof v);
    TETSKIN_ONE_LOAD(v);
    if constexpr (sizeof(S) == sizeof(float)) {
      return v;
    } else {
      return __builtin_convertvector(v, Lanes<S, W>);
    }
  }
}

/// A point padded to four scalars.
template <class S>
Lanes<S, 4> loadPadded(const S* from) {
  Lanes<S, 4> v;
  ::memcpy(&v, from, sizeof v);
  return v;
}
template <class S>
void storePadded(const Lanes<S, 4>& v, S* to) {
  ::memcpy(to, &v, sizeof v);
}

/// Lanes 0, 1, 2, ...
template <class S, int W>
Lanes<S, W> laneNumbers() {
  if constexpr (W == 1) {
    return S(0);
  } else {
    Lanes<S, W> v{};
    for (int i = 0; i < W; ++i) v[i] = static_cast<S>(i);
    return v;
  }
}

/// Cross product of two padded points: with r turning x y z into y z x, it is r(a r(b) - r(a) b).
template <class S>
Lanes<S, 4> crossPadded(const Lanes<S, 4>& a, const Lanes<S, 4>& b) {
#ifdef TETSKIN_SHUFFLES
  const Lanes<S, 4> turned =
      a * __builtin_shufflevector(b, b, 1, 2, 0, 3) - __builtin_shufflevector(a, a, 1, 2, 0, 3) * b;
  return __builtin_shufflevector(turned, turned, 1, 2, 0, 3);
#else
  const S c[4] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], S(0)};
  return loadPadded(c);
#endif
}

/// Whether all lanes lie between two numbers.
template <class S, int W>
bool allBetween(const Lanes<S, W>& v, S low, S high) {
  if constexpr (W == 1) {
    return v > low && v < high;
  } else {
    const auto between = (v > low) & (v < high);  // all bits set where it holds
    std::uint64_t words[sizeof between / sizeof(std::uint64_t)];
    ::memcpy(words, &between, sizeof between);
    std::uint64_t both = words[0];
    for (std::size_t k = 1; k < sizeof between / sizeof(std::uint64_t); ++k) both &= words[k];
    return both == ~std::uint64_t{0};
  }
}

/// A bit a lane: is it below 0?
template <int W>
unsigned negativeLanes(const Lanes<float, W>& v) {
  if constexpr (W == 1) {
    return v < 0.0f ? 1u : 0u;
  } else {
    const auto negative = v < 0.0f;  // all bits set where it holds
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

template <class S, int W>
Lanes<S, W> squareRoots(const Lanes<S, W>& v) {
  if constexpr (W == 1) {
    return squareRoot(v);
  } else {
    Lanes<S, W> roots;
    for (int i = 0; i < W; ++i) roots[i] = squareRoot(v[i]);
    return roots;
  }
}

#ifdef TETSKIN_SHUFFLES
template <int... I>
struct Indices {};
template <int N, int... I>
struct IndicesUpTo : IndicesUpTo<N - 1, N - 1, I...> {};
template <int... I>
struct IndicesUpTo<0, I...> {
  using Type = Indices<I...>;
};

/// Numbers [Part * W, Part * W + W) of x0 y0 z0 x1 y1 z1 ...: number g is coordinate g % 3 of point g / 3.
template <int Part, int W, class V, int... I>
V interleavedPart(const V& x, const V& y, const V& z, Indices<I...>) {
  constexpr int kFirst = Part * W;
  const V xy = __builtin_shufflevector(x, y, ((kFirst + I) % 3 == 2 ? -1 : (kFirst + I) % 3 * W + (kFirst + I) / 3)...);
  return __builtin_shufflevector(xy, z, ((kFirst + I) % 3 == 2 ? W + (kFirst + I) / 3 : I)...);
}
#endif

/// Writes the first `count` of W numbers, none for a count below 0. With masked stores nothing else is touched;
/// without, what is there is written back.
template <int W>
TETSKIN_INLINE void storeFirst(const Lanes<float, W>& v, int count, float* out) {
#if defined(__AVX512VL__)
  const unsigned mask = count <= 0 ? 0u : count >= W ? (1u << W) - 1u : (1u << count) - 1u;
  if constexpr (W == 16) {
    _mm512_mask_storeu_ps(out, static_cast<__mmask16>(mask), v);
  } else if constexpr (W == 8) {
    _mm256_mask_storeu_ps(out, static_cast<__mmask8>(mask), v);
  } else {
    _mm_mask_storeu_ps(out, static_cast<__mmask8>(mask), v);
  }
#elif defined(__AVX2__)
  const auto mask = laneNumbers<float, W>() < static_cast<float>(count);
  if constexpr (W == 8) {
    _mm256_maskstore_ps(out, reinterpret_cast<__m256i>(mask), v);
  } else {
    _mm_maskstore_ps(out, reinterpret_cast<__m128i>(mask), v);
  }
#else
  Lanes<float, W> old;
  ::memcpy(&old, out, sizeof old);
  old = laneNumbers<float, W>() < static_cast<float>(count) ? v : old;
  ::memcpy(out, &old, sizeof old);
#endif
}

/// Writes W points side by side: x0 y0 z0 x1 y1 z1 ...
template <class S, int W>
void storePoints(const Lanes<S, W> p[3], S* out) {
#ifdef TETSKIN_SHUFFLES
  if constexpr (W >= 4) {
    using All = typename IndicesUpTo<W>::Type;
    const Lanes<S, W> first = interleavedPart<0, W>(p[0], p[1], p[2], All{});
    const Lanes<S, W> second = interleavedPart<1, W>(p[0], p[1], p[2], All{});
    const Lanes<S, W> third = interleavedPart<2, W>(p[0], p[1], p[2], All{});
    ::memcpy(out, &first, sizeof first);
    ::memcpy(out + W, &second, sizeof second);
    ::memcpy(out + 2 * W, &third, sizeof third);
    return;
  }
#endif
  for (int i = 0; i < W; ++i) {
    for (int k = 0; k < 3; ++k) out[3 * i + k] = lane<S, W>(p[k], i);
  }
}

/// Writes the first `count` of W points side by side. Memory for W points must be there.
template <int W>
TETSKIN_INLINE void storeFirstPoints(const Lanes<float, W> p[3], int count, float* out) {
#ifdef TETSKIN_SHUFFLES
  if constexpr (W >= 4) {
    using All = typename IndicesUpTo<W>::Type;
    storeFirst<W>(interleavedPart<0, W>(p[0], p[1], p[2], All{}), 3 * count, out);
    storeFirst<W>(interleavedPart<1, W>(p[0], p[1], p[2], All{}), 3 * count - W, out + W);
    storeFirst<W>(interleavedPart<2, W>(p[0], p[1], p[2], All{}), 3 * count - 2 * W, out + 2 * W);
    return;
  }
#endif
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) out[3 * i + k] = lane<float, W>(p[k], i);
  }
}

template <class To, class From, int W>
Lanes<To, W> convert(const Lanes<From, W>& v) {
  if constexpr (sizeof(To) == sizeof(From)) {
    return v;
  } else if constexpr (W == 1) {
    return static_cast<To>(v);
  } else {
    return __builtin_convertvector(v, Lanes<To, W>);
  }
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
