// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: points as they are read, computed and written. A point is four numbers, x y z and a
// meaningless one; P of them fill a register. A tet's coefficients are then used in their memory layout, and a run of
// few vertices, as most are, costs little more than its vertices.
#pragma once

#include <tetskin/core/src/base/kernels/lanes.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

template <class S, int P>
using Points = Lanes<S, 4 * P>;

/// Points in their memory layout, four scalars each: one point, and P points.
template <class S>
Lanes<S, 4> loadPadded(const S* from) {
  Lanes<S, 4> v;
  ::memcpy(&v, from, sizeof v);
  return v;
}
template <class S, int P>
TETSKIN_INLINE Points<S, P> loadPoints(const S* from) {
  Points<S, P> v;
  ::memcpy(&v, from, sizeof v);
  return v;
}

template <class S, int P>
TETSKIN_INLINE void storeWhole(const Points<S, P>& v, S* to) {
  ::memcpy(to, &v, sizeof v);
}

/// The same point P times.
template <class S, int P>
TETSKIN_INLINE Points<S, P> repeated(const Lanes<S, 4>& v) {
#if defined(__AVX512F__)
  if constexpr (P == 4) return _mm512_broadcast_f32x4(v);
  if constexpr (P == 2 && sizeof(S) == sizeof(double)) return _mm512_broadcast_f64x4(v);
#endif
#if defined(__AVX2__)
  if constexpr (P == 2 && sizeof(S) == sizeof(float)) return _mm256_set_m128(v, v);
#endif
  if constexpr (P == 1) return v;
}
template <class S, int P>
TETSKIN_INLINE Points<S, P> repeated(const S* from) {
  return repeated<S, P>(loadPadded(from));
}

/// Loads P floats as S, each into the four lanes of its point.
template <class S, int P>
TETSKIN_INLINE Points<S, P> spread(const float* from) {
#if defined(__AVX512F__)
  if constexpr (P == 4) {
    const __m512i lanes = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
    return _mm512_permutexvar_ps(lanes, _mm512_castps128_ps512(_mm_loadu_ps(from)));
  }
  if constexpr (P == 2 && sizeof(S) == sizeof(double)) return _mm512_cvtps_pd(spread<float, P>(from));
#endif
#if defined(__AVX2__)
  if constexpr (P == 2 && sizeof(S) == sizeof(float)) {
    double both;
    ::memcpy(&both, from, sizeof both);
    const __m256 twice = _mm256_castpd_ps(_mm256_set1_pd(both));
    return _mm256_permutevar_ps(twice, _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1));
  }
#endif
  if constexpr (P == 1) {
    const S v = static_cast<S>(*from);
    return Points<S, P>{v, v, v, v};
  }
}
template <class S, int P>
TETSKIN_INLINE Points<double, P> spread(const double* from) {
#if defined(__AVX512F__)
  if constexpr (P == 2) {
    const __m512i lanes = _mm512_setr_epi64(0, 0, 0, 0, 1, 1, 1, 1);
    return _mm512_permutexvar_pd(lanes, _mm512_castpd128_pd512(_mm_loadu_pd(from)));
  }
#endif
  if constexpr (P == 1) return Points<double, P>{*from, *from, *from, *from};
}

/// Of every point: components A and B of v, followed by C and D of w.
template <int A, int B, int C, int D, class S, int P>
TETSKIN_INLINE Points<S, P> mixed(const Points<S, P>& v, const Points<S, P>& w) {
#if defined(__SSE2__) && defined(TETSKIN_VECTOR_TYPES)
  if constexpr (sizeof(S) == sizeof(float)) {
    // In the encoding of the processor's shuffle: two bits for each lane.
    constexpr int kOrder = A | B << 2 | C << 4 | D << 6;
#if defined(__AVX512F__)
    if constexpr (P == 4) return _mm512_shuffle_ps(v, w, kOrder);
#endif
#if defined(__AVX2__)
    if constexpr (P == 2) return _mm256_shuffle_ps(v, w, kOrder);
#endif
    if constexpr (P == 1) return _mm_shuffle_ps(v, w, kOrder);
  }
#endif
  Points<S, P> all;
  for (int i = 0; i < 4 * P; i += 4) {
    all[i] = v[i + A];
    all[i + 1] = v[i + B];
    all[i + 2] = w[i + C];
    all[i + 3] = w[i + D];
  }
  return all;
}
template <int A, int B, int C, int D, class S, int P>
TETSKIN_INLINE Points<S, P> turned(const Points<S, P>& v) {
  return mixed<A, B, C, D, S, P>(v, v);
}

/// x^2 + y^2 + z^2, in every lane of its point.
template <class S, int P>
TETSKIN_INLINE Points<S, P> squaredLengths(const Points<S, P>& v) {
  const Points<S, P> q = v * v;
  return turned<0, 0, 0, 0, S, P>(q) + turned<1, 1, 1, 1, S, P>(q) + turned<2, 2, 2, 2, S, P>(q);
}
/// The squared lengths of four times P points, in one register: those of v[k] are in lanes k of its points.
template <class S, int P>
TETSKIN_INLINE Points<S, P> squaredLengths(const Points<S, P> v[4]) {
  const Points<S, P> xy01 = mixed<0, 1, 0, 1, S, P>(v[0], v[1]), xy23 = mixed<0, 1, 0, 1, S, P>(v[2], v[3]);
  const Points<S, P> z01 = mixed<2, 2, 2, 2, S, P>(v[0], v[1]), z23 = mixed<2, 2, 2, 2, S, P>(v[2], v[3]);
  const Points<S, P> x = mixed<0, 2, 0, 2, S, P>(xy01, xy23), y = mixed<1, 3, 1, 3, S, P>(xy01, xy23);
  const Points<S, P> z = mixed<0, 2, 0, 2, S, P>(z01, z23);
  return x * x + y * y + z * z;
}

/// With r turning x y z into y z x, it is r(a r(b) - r(a) b).
template <class S, int P>
TETSKIN_INLINE Points<S, P> cross(const Points<S, P>& a, const Points<S, P>& b) {
  return turned<1, 2, 0, 3, S, P>(a * turned<1, 2, 0, 3, S, P>(b) - turned<1, 2, 0, 3, S, P>(a) * b);
}

/// True if all lanes lie between two numbers.
template <class S, int P>
TETSKIN_INLINE bool allBetween(const Points<S, P>& v, S low, S high) {
#if defined(__AVX512F__)
  if constexpr (P == 4) {
    const __mmask16 above = _mm512_cmp_ps_mask(v, _mm512_set1_ps(low), _CMP_GT_OQ);
    return _mm512_mask_cmp_ps_mask(above, v, _mm512_set1_ps(high), _CMP_LT_OQ) == 0xffff;
  }
#endif
#if defined(TETSKIN_VECTOR_TYPES)
  const auto between = (v > low) & (v < high);  // all bits set where it is true
#if defined(__AVX2__)
  if constexpr (P == 2 && sizeof(S) == sizeof(float))
    return _mm256_movemask_ps(reinterpret_cast<__m256>(between)) == 0xff;
#endif
#if defined(__SSE2__)
  if constexpr (P == 1 && sizeof(S) == sizeof(float)) return _mm_movemask_ps(reinterpret_cast<__m128>(between)) == 0xf;
#endif
  std::uint64_t words[sizeof between / sizeof(std::uint64_t)];
  ::memcpy(words, &between, sizeof between);
  std::uint64_t both = words[0];
  for (std::size_t k = 1; k < sizeof between / sizeof(std::uint64_t); ++k) both &= words[k];
  return both == ~std::uint64_t{0};
#else
  for (int i = 0; i < 4 * P; ++i) {
    if (!(v[i] > low && v[i] < high)) return false;
  }
  return true;
#endif
}

template <class S, int P>
TETSKIN_INLINE Points<float, P> toFloats(const Points<S, P>& v) {
  if constexpr (sizeof(S) == sizeof(float)) {
    return v;
  } else {
#if defined(TETSKIN_VECTOR_TYPES)
    return converted<Points<float, P>>(v);
#else
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), 0.0f};
#endif
  }
}

/// 1 / sqrt(v) of numbers that are neither tiny nor huge.
template <class S, int P>
TETSKIN_INLINE Points<S, P> inverseSquareRoots(const Points<S, P>& v) {
#if defined(__SSE2__) && defined(TETSKIN_VECTOR_TYPES)
  if constexpr (sizeof(S) == sizeof(float)) {
    // The processor's estimate, accurate to 12 bits, and one Newton step: error some 1e-7, in a fifth of the time.
    Points<S, P> y;
#if defined(__AVX512F__)
    if constexpr (P == 4) y = _mm512_rsqrt14_ps(v);
#endif
#if defined(__AVX2__)
    if constexpr (P == 2) y = _mm256_rsqrt_ps(v);
#endif
    if constexpr (P == 1) y = _mm_rsqrt_ps(v);
    return y * (S(1.5) - (v * S(0.5)) * (y * y));
  }
#endif
  Points<S, P> inverse;
  for (int i = 0; i < 4 * P; ++i) inverse[i] = S(1) / squareRoot(v[i]);
  return inverse;
}

/// x0 y0 z0 x1 y1 z1 ... and P meaningless numbers.
template <class S, int P>
TETSKIN_INLINE Points<S, P> sideBySide(const Points<S, P>& v) {
#if defined(__AVX512F__)
  if constexpr (P == 4)
    return _mm512_permutexvar_ps(_mm512_setr_epi32(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, 15, 15, 15, 15), v);
  if constexpr (P == 2 && sizeof(S) == sizeof(double))
    return _mm512_permutexvar_pd(_mm512_setr_epi64(0, 1, 2, 4, 5, 6, 7, 7), v);
#endif
#if defined(__AVX2__)
  if constexpr (P == 2 && sizeof(S) == sizeof(float))
    return _mm256_permutevar8x32_ps(v, _mm256_setr_epi32(0, 1, 2, 4, 5, 6, 7, 7));
#endif
  if constexpr (P == 1) return v;
}

/// Writes P points contiguously; may overwrite up to P further numbers.
template <class S, int P>
TETSKIN_INLINE void storePoints(const Points<S, P>& v, S* out) {
  const Points<S, P> points = sideBySide<S, P>(v);
#if defined(__AVX512F__)
  if constexpr (P == 4) {
    // Exactly these bytes: a store of 64 bytes would straddle two cache lines most of the time.
    _mm256_storeu_ps(out, _mm512_castps512_ps256(points));
    return _mm_storeu_ps(out + 8, _mm512_extractf32x4_ps(points, 2));
  }
#endif
  ::memcpy(out, &points, sizeof points);
}
/// First slot from which storePoints may write past the points.
template <int P>
constexpr std::uint32_t kSlotsTouched = (4 * P + 2) / 3;

/// Writes P points contiguously, and nothing else.
template <int P>
TETSKIN_INLINE void storeExactly(const Points<float, P>& v, float* out) {
  if constexpr (P == 4) return storePoints<float, P>(v, out);
#if defined(__AVX2__)
  if constexpr (P == 2) {
    const Points<float, P> points = sideBySide<float, P>(v);
    _mm_storeu_ps(out, _mm256_castps256_ps128(points));
    return _mm_storel_pi(reinterpret_cast<__m64*>(out + 4), _mm256_extractf128_ps(points, 1));
  }
#endif
  if constexpr (P == 1) {
    for (int k = 0; k < 3; ++k) out[k] = v[k];
  }
}

template <int P>
int atMost(std::size_t count) {
  return count < static_cast<std::size_t>(P) ? static_cast<int>(count) : P;
}

/// Writes P points, or the first `count` if that is fewer, and nothing else.
template <class S, int P>
void storeFirst(const Points<S, P>& v, std::size_t count, S* out) {
  for (int i = 0; i < atMost<P>(count); ++i) {
    for (int k = 0; k < 3; ++k) out[3 * i + k] = v[4 * i + k];
  }
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
