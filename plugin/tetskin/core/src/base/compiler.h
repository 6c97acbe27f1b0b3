// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal: what GCC and clang offer beyond the standard, and what is done without it. With TETSKIN_PORTABLE, which is
// there for tests, every compiler counts as one that has nothing of it. Nothing but macros, and functions that
// are always inlined: kernels include this, and are compiled for processors that not everyone has.
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

// GCC 12 would read a number that is used several times from memory again for each use; unaligned, that is slow.
#if defined(TETSKIN_GNU) && !defined(__clang__) && defined(__x86_64__)
#define TETSKIN_ONE_LOAD(v) asm("" : "+v"(v))
#else
#define TETSKIN_ONE_LOAD(v)
#endif

// From here on, GCC does not warn of templates that have a friend each, which is no template.
#if defined(__GNUC__) && !defined(__clang__)
#define TETSKIN_FRIENDS_OF_TEMPLATES _Pragma("GCC diagnostic ignored \"-Wnon-template-friend\"")
#else
#define TETSKIN_FRIENDS_OF_TEMPLATES
#endif

// Vectors of a compiler without this operator are put together number by number.
#if defined(TETSKIN_GNU) && (defined(__clang__) || __GNUC__ >= 12)
#define TETSKIN_SHUFFLE(...) __builtin_shufflevector(__VA_ARGS__)
#endif

namespace tetskin {

/// Reads memory into the caches that will be used soon.
TETSKIN_INLINE void prefetch(const void* where) {
#ifdef TETSKIN_GNU
  __builtin_prefetch(where);
#else
  (void)where;
#endif
}

/// Called while waiting in a loop: saves power, and leaves more to a thread on the same core.
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
