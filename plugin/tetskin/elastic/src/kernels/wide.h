// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: W tets or rows at a time, part of a group of eight, with conversions from and to points.
#pragma once

#include <tetskin/core/src/base/kernels/lanes.h>
#include <tetskin/elastic/src/base/elastic_kernels.h>
#if defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace tetskin::kernels::TETSKIN_KERNELS {

template <class S, int W>
TETSKIN_INLINE Lanes<S, W> wide(const S* from) {
  Lanes<S, W> v;
  ::memcpy(&v, from, sizeof v);
  return v;
}
template <class S, int W>
TETSKIN_INLINE void put(const Lanes<S, W>& v, S* to) {
  ::memcpy(to, &v, sizeof v);
}
template <class S, int W>
TETSKIN_INLINE Lanes<S, W> all(S s) {
  return Lanes<S, W>{} + s;
}

/// W vectors, stored by component.
template <class S, int W>
struct WideVector {
  Lanes<S, W> x, y, z;
};

template <class S, int W>
TETSKIN_INLINE WideVector<S, W> wideVector(const S* from) {
  return {wide<S, W>(from), wide<S, W>(from + kGroup), wide<S, W>(from + 2 * kGroup)};
}
template <class S, int W>
TETSKIN_INLINE void put(const WideVector<S, W>& v, S* to) {
  put<S, W>(v.x, to);
  put<S, W>(v.y, to + kGroup);
  put<S, W>(v.z, to + 2 * kGroup);
}
template <class S, int W>
TETSKIN_INLINE Lanes<S, W> dot(const WideVector<S, W>& a, const WideVector<S, W>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class S, int W>
TETSKIN_INLINE S laneSum(const Lanes<S, W>& v) {
  if constexpr (W == 1) {
    return v;
  } else {
    S total = 0;
    for (int i = 0; i < W; ++i) total += v[i];
    return total;
  }
}
template <class S, int W>
TETSKIN_INLINE S largest(const Lanes<S, W>& v) {
  if constexpr (W == 1) {
    return v;
  } else {
    S maximum = v[0];
    for (int i = 1; i < W; ++i) maximum = v[i] > maximum ? v[i] : maximum;
    return maximum;
  }
}
template <class S, int W>
TETSKIN_INLINE Lanes<S, W> absolute(const Lanes<S, W>& v) {
  return v < S(0) ? -v : v;
}

#if defined(TETSKIN_VECTOR_TYPES) && defined(TETSKIN_SHUFFLE) && defined(__wasm_simd128__)
// WebAssembly has registers of four floats; eight floats are two of them. What is written lane by lane below would be
// compiled lane by lane.
#define TETSKIN_HALVES 1
template <class S>
TETSKIN_INLINE Lanes<S, 8> joined(const Lanes<S, 4>& low, const Lanes<S, 4>& high) {
  return TETSKIN_SHUFFLE(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
template <class S>
TETSKIN_INLINE Lanes<S, 4> lowHalf(const Lanes<S, 8>& v) {
  return TETSKIN_SHUFFLE(v, v, 0, 1, 2, 3);
}
template <class S>
TETSKIN_INLINE Lanes<S, 4> highHalf(const Lanes<S, 8>& v) {
  return TETSKIN_SHUFFLE(v, v, 4, 5, 6, 7);
}
#endif

template <class S, int W>
TETSKIN_INLINE Lanes<S, W> squareRoots(const Lanes<S, W>& v) {
#ifdef TETSKIN_HALVES
  if constexpr (W == 4 && sizeof(S) == sizeof(float)) {
    return reinterpret_cast<Lanes<S, W>>(wasm_f32x4_sqrt(reinterpret_cast<v128_t>(v)));
  }
  if constexpr (W == 8) return joined<S>(squareRoots<S, 4>(lowHalf<S>(v)), squareRoots<S, 4>(highHalf<S>(v)));
#endif
#if defined(TETSKIN_VECTOR_TYPES)
#if defined(__AVX2__)
  if constexpr (W == 8 && sizeof(S) == sizeof(float)) return _mm256_sqrt_ps(v);
  if constexpr (W == 4 && sizeof(S) == sizeof(double)) return _mm256_sqrt_pd(v);
#endif
#if defined(__SSE2__)
  if constexpr (W == 4 && sizeof(S) == sizeof(float)) return _mm_sqrt_ps(v);
  if constexpr (W == 2 && sizeof(S) == sizeof(double)) return _mm_sqrt_pd(v);
#endif
#endif
  if constexpr (W == 1) {
    return squareRoot(v);
  } else {
    Lanes<S, W> roots;
    for (int i = 0; i < W; ++i) roots[i] = squareRoot(v[i]);
    return roots;
  }
}

template <class S, int W>
TETSKIN_INLINE bool anyAbove(const Lanes<S, W>& v, S limit) {
  if constexpr (W == 1) {
    return v > limit;
  } else {
    const auto above = v > limit;  // all bits set where it is true
#if defined(TETSKIN_VECTOR_TYPES) && defined(__AVX2__)
    if constexpr (sizeof above == 32) return _mm256_movemask_ps(reinterpret_cast<__m256>(above)) != 0;
#endif
#if defined(TETSKIN_VECTOR_TYPES) && defined(__SSE2__)
    if constexpr (sizeof above == 16) return _mm_movemask_ps(reinterpret_cast<__m128>(above)) != 0;
#endif
#ifdef TETSKIN_VECTOR_TYPES
    std::uint64_t words[sizeof above / sizeof(std::uint64_t)], any = 0;
    ::memcpy(words, &above, sizeof above);
    for (const std::uint64_t word : words) any |= word;
    return any != 0;
#else
    for (int i = 0; i < W; ++i) {
      if (above[i]) return true;
    }
    return false;
#endif
  }
}

/// Four numbers of W points, by number.
template <class S, int W>
struct WidePoints {
  Lanes<S, W> x, y, z, w;
};

#if defined(TETSKIN_VECTOR_TYPES) && defined(__AVX2__)
TETSKIN_INLINE __m256 pairOf(const float* low, const float* high) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(low)), _mm_loadu_ps(high), 1);
}
#endif

/// Points gathered by their indices.
template <class S, int W>
TETSKIN_INLINE WidePoints<S, W> pointsAt(const S* points, const std::uint32_t* indices) {
  const auto at = [&](int i) { return points + 4 * static_cast<std::size_t>(indices[i]); };
#if defined(TETSKIN_VECTOR_TYPES) && defined(__AVX2__)
  if constexpr (W == 8 && sizeof(S) == sizeof(float)) {
    const __m256 a = pairOf(at(0), at(4)), b = pairOf(at(1), at(5)), c = pairOf(at(2), at(6)), d = pairOf(at(3), at(7));
    const __m256 ab0 = _mm256_unpacklo_ps(a, b), ab1 = _mm256_unpackhi_ps(a, b);
    const __m256 cd0 = _mm256_unpacklo_ps(c, d), cd1 = _mm256_unpackhi_ps(c, d);
    return {_mm256_shuffle_ps(ab0, cd0, 0x44), _mm256_shuffle_ps(ab0, cd0, 0xee), _mm256_shuffle_ps(ab1, cd1, 0x44),
            _mm256_shuffle_ps(ab1, cd1, 0xee)};
  }
  if constexpr (W == 4 && sizeof(S) == sizeof(double)) {
    const __m256d a = _mm256_loadu_pd(at(0)), b = _mm256_loadu_pd(at(1));
    const __m256d c = _mm256_loadu_pd(at(2)), d = _mm256_loadu_pd(at(3));
    const __m256d ab0 = _mm256_unpacklo_pd(a, b), ab1 = _mm256_unpackhi_pd(a, b);
    const __m256d cd0 = _mm256_unpacklo_pd(c, d), cd1 = _mm256_unpackhi_pd(c, d);
    return {_mm256_permute2f128_pd(ab0, cd0, 0x20), _mm256_permute2f128_pd(ab1, cd1, 0x20),
            _mm256_permute2f128_pd(ab0, cd0, 0x31), _mm256_permute2f128_pd(ab1, cd1, 0x31)};
  }
#endif
#if defined(TETSKIN_VECTOR_TYPES) && defined(__SSE2__)
  if constexpr (W == 4 && sizeof(S) == sizeof(float)) {
    const __m128 a = _mm_loadu_ps(at(0)), b = _mm_loadu_ps(at(1)), c = _mm_loadu_ps(at(2)), d = _mm_loadu_ps(at(3));
    const __m128 ab0 = _mm_unpacklo_ps(a, b), ab1 = _mm_unpackhi_ps(a, b);
    const __m128 cd0 = _mm_unpacklo_ps(c, d), cd1 = _mm_unpackhi_ps(c, d);
    return {_mm_movelh_ps(ab0, cd0), _mm_movehl_ps(cd0, ab0), _mm_movelh_ps(ab1, cd1), _mm_movehl_ps(cd1, ab1)};
  }
#elif defined(TETSKIN_VECTOR_TYPES) && defined(TETSKIN_SHUFFLE)
  if constexpr (W == 4) {
    const Lanes<S, W> a = wide<S, W>(at(0)), b = wide<S, W>(at(1)), c = wide<S, W>(at(2)), d = wide<S, W>(at(3));
    const Lanes<S, W> ab0 = TETSKIN_SHUFFLE(a, b, 0, 4, 1, 5), ab1 = TETSKIN_SHUFFLE(a, b, 2, 6, 3, 7);
    const Lanes<S, W> cd0 = TETSKIN_SHUFFLE(c, d, 0, 4, 1, 5), cd1 = TETSKIN_SHUFFLE(c, d, 2, 6, 3, 7);
    return {TETSKIN_SHUFFLE(ab0, cd0, 0, 1, 4, 5), TETSKIN_SHUFFLE(ab0, cd0, 2, 3, 6, 7),
            TETSKIN_SHUFFLE(ab1, cd1, 0, 1, 4, 5), TETSKIN_SHUFFLE(ab1, cd1, 2, 3, 6, 7)};
  }
#endif
#ifdef TETSKIN_HALVES
  if constexpr (W == 8) {
    const WidePoints<S, 4> low = pointsAt<S, 4>(points, indices), high = pointsAt<S, 4>(points, indices + 4);
    return {joined<S>(low.x, high.x), joined<S>(low.y, high.y), joined<S>(low.z, high.z), joined<S>(low.w, high.w)};
  }
#endif
  if constexpr (W == 1) {
    return {at(0)[0], at(0)[1], at(0)[2], at(0)[3]};
  } else {
    WidePoints<S, W> v{};
    for (int i = 0; i < W; ++i) {
      v.x[i] = at(i)[0];
      v.y[i] = at(i)[1];
      v.z[i] = at(i)[2];
      v.w[i] = at(i)[3];
    }
    return v;
  }
}
template <class S, int W>
TETSKIN_INLINE WideVector<S, W> vectorsAt(const S* points, const std::uint32_t* indices) {
  const WidePoints<S, W> v = pointsAt<S, W>(points, indices);
  return {v.x, v.y, v.z};
}

/// W points at a constant distance in memory.
template <class S, int W>
TETSKIN_INLINE void putPoints(const WidePoints<S, W>& v, S* to, std::size_t apart) {
#if defined(TETSKIN_VECTOR_TYPES) && defined(__AVX2__)
  if constexpr (W == 8 && sizeof(S) == sizeof(float)) {
    const __m256 a = _mm256_unpacklo_ps(v.x, v.y), b = _mm256_unpackhi_ps(v.x, v.y);
    const __m256 c = _mm256_unpacklo_ps(v.z, v.w), d = _mm256_unpackhi_ps(v.z, v.w);
    const __m256 rows[4] = {_mm256_shuffle_ps(a, c, 0x44), _mm256_shuffle_ps(a, c, 0xee), _mm256_shuffle_ps(b, d, 0x44),
                            _mm256_shuffle_ps(b, d, 0xee)};
    for (int i = 0; i < 4; ++i) {
      _mm_storeu_ps(to + static_cast<std::size_t>(i) * apart, _mm256_castps256_ps128(rows[i]));
      _mm_storeu_ps(to + static_cast<std::size_t>(i + 4) * apart, _mm256_extractf128_ps(rows[i], 1));
    }
    return;
  }
  if constexpr (W == 4 && sizeof(S) == sizeof(double)) {
    const __m256d a = _mm256_unpacklo_pd(v.x, v.y), b = _mm256_unpackhi_pd(v.x, v.y);
    const __m256d c = _mm256_unpacklo_pd(v.z, v.w), d = _mm256_unpackhi_pd(v.z, v.w);
    _mm256_storeu_pd(to, _mm256_permute2f128_pd(a, c, 0x20));
    _mm256_storeu_pd(to + apart, _mm256_permute2f128_pd(b, d, 0x20));
    _mm256_storeu_pd(to + 2 * apart, _mm256_permute2f128_pd(a, c, 0x31));
    _mm256_storeu_pd(to + 3 * apart, _mm256_permute2f128_pd(b, d, 0x31));
    return;
  }
#endif
#if defined(TETSKIN_VECTOR_TYPES) && defined(__SSE2__)
  if constexpr (W == 4 && sizeof(S) == sizeof(float)) {
    const __m128 a = _mm_unpacklo_ps(v.x, v.y), b = _mm_unpackhi_ps(v.x, v.y);
    const __m128 c = _mm_unpacklo_ps(v.z, v.w), d = _mm_unpackhi_ps(v.z, v.w);
    _mm_storeu_ps(to, _mm_movelh_ps(a, c));
    _mm_storeu_ps(to + apart, _mm_movehl_ps(c, a));
    _mm_storeu_ps(to + 2 * apart, _mm_movelh_ps(b, d));
    _mm_storeu_ps(to + 3 * apart, _mm_movehl_ps(d, b));
    return;
  }
#elif defined(TETSKIN_VECTOR_TYPES) && defined(TETSKIN_SHUFFLE)
  if constexpr (W == 4) {
    const Lanes<S, W> a = TETSKIN_SHUFFLE(v.x, v.y, 0, 4, 1, 5), b = TETSKIN_SHUFFLE(v.x, v.y, 2, 6, 3, 7);
    const Lanes<S, W> c = TETSKIN_SHUFFLE(v.z, v.w, 0, 4, 1, 5), d = TETSKIN_SHUFFLE(v.z, v.w, 2, 6, 3, 7);
    put<S, W>(TETSKIN_SHUFFLE(a, c, 0, 1, 4, 5), to);
    put<S, W>(TETSKIN_SHUFFLE(a, c, 2, 3, 6, 7), to + apart);
    put<S, W>(TETSKIN_SHUFFLE(b, d, 0, 1, 4, 5), to + 2 * apart);
    put<S, W>(TETSKIN_SHUFFLE(b, d, 2, 3, 6, 7), to + 3 * apart);
    return;
  }
#endif
#ifdef TETSKIN_HALVES
  if constexpr (W == 8) {
    putPoints<S, 4>(WidePoints<S, 4>{lowHalf<S>(v.x), lowHalf<S>(v.y), lowHalf<S>(v.z), lowHalf<S>(v.w)}, to, apart);
    putPoints<S, 4>(WidePoints<S, 4>{highHalf<S>(v.x), highHalf<S>(v.y), highHalf<S>(v.z), highHalf<S>(v.w)},
                    to + 4 * apart, apart);
    return;
  }
#endif
  if constexpr (W == 1) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
    to[3] = v.w;
  } else {
    for (int i = 0; i < W; ++i) {
      S* point = to + static_cast<std::size_t>(i) * apart;
      point[0] = v.x[i];
      point[1] = v.y[i];
      point[2] = v.z[i];
      point[3] = v.w[i];
    }
  }
}
template <class S, int W>
TETSKIN_INLINE void putPoints(const WideVector<S, W>& v, S* to, std::size_t apart) {
  putPoints<S, W>(WidePoints<S, W>{v.x, v.y, v.z, Lanes<S, W>{}}, to, apart);
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
