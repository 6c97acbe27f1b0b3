// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal: extensions of GCC and clang, and replacements for other compilers. With TETSKIN_PORTABLE, which is for
// tests, every compiler counts as having none of them. Only macros and functions that are always inlined: kernels
// include this, and are compiled for processors that not everyone has.
#pragma once

#if defined(__GNUC__) && !defined(TETSKIN_PORTABLE)
#define TETSKIN_GNU 1
#endif

#ifdef TETSKIN_GNU
#define TETSKIN_NOINLINE __attribute__((noinline))
#define TETSKIN_INLINE __attribute__((always_inline)) inline
#else
#define TETSKIN_NOINLINE
#define TETSKIN_INLINE inline
#endif

// GCC 12 would reload a number that is used several times from memory for each use; unaligned, that is slow.
#if defined(TETSKIN_GNU) && !defined(__clang__) && defined(__x86_64__)
#define TETSKIN_ONE_LOAD(v) asm("" : "+v"(v))
#else
#define TETSKIN_ONE_LOAD(v)
#endif

// From here on, silences GCC's warning about a template with a non-template friend.
#if defined(__GNUC__) && !defined(__clang__)
#define TETSKIN_FRIENDS_OF_TEMPLATES _Pragma("GCC diagnostic ignored \"-Wnon-template-friend\"")
#else
#define TETSKIN_FRIENDS_OF_TEMPLATES
#endif

// For a compiler without this operator, vectors are built element by element.
#if defined(TETSKIN_GNU) && (defined(__clang__) || __GNUC__ >= 12)
#define TETSKIN_SHUFFLE(...) __builtin_shufflevector(__VA_ARGS__)
#endif

namespace tetskin {

/// Prefetches memory that will be needed soon.
TETSKIN_INLINE void prefetch(const void* where) {
#ifdef TETSKIN_GNU
  __builtin_prefetch(where);
#else
  (void)where;
#endif
}

/// Called while waiting in a loop: saves power, and leaves more to the other thread of the core.
TETSKIN_INLINE void pauseThread() {
#if defined(TETSKIN_GNU) && (defined(__x86_64__) || defined(__i386__))
  __builtin_ia32_pause();
#endif
}

#ifdef TETSKIN_X86_KERNELS
TETSKIN_INLINE bool processorHasAvx2() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}
TETSKIN_INLINE bool processorHasAvx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
}
#endif

}  // namespace tetskin
