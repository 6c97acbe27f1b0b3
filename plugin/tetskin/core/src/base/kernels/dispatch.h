// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Each instruction set that a build supports has its own namespace, with a copy of every kernel. Only macros: what the
// kernels' headers include is compiled for processors that not everyone has.
#pragma once

/// Declares the same names in the namespaces of all instruction sets.
#define TETSKIN_FOR_EACH_INSTRUCTION_SET(...) \
  namespace plain {                           \
  __VA_ARGS__                                 \
  }                                           \
  namespace baseline {                        \
  __VA_ARGS__                                 \
  }                                           \
  namespace avx2 {                            \
  __VA_ARGS__                                 \
  }                                           \
  namespace avx512 {                          \
  __VA_ARGS__                                 \
  }

#ifdef TETSKIN_X86_KERNELS
#define TETSKIN_RETURN_OF_X86(name)                                    \
  if (instructionSet() == InstructionSet::Avx512) return avx512::name; \
  if (instructionSet() == InstructionSet::Avx2) return avx2::name;
#else
#define TETSKIN_RETURN_OF_X86(name)
#endif
#ifdef TETSKIN_VECTOR_KERNELS
#define TETSKIN_RETURN_OF_BASELINE(name) \
  if (instructionSet() == InstructionSet::Baseline) return baseline::name;
#else
#define TETSKIN_RETURN_OF_BASELINE(name)
#endif
/// Returns `name` from the namespace of `instructionSet()`.
#define TETSKIN_RETURN_IN_USE(name) \
  TETSKIN_RETURN_OF_X86(name)       \
  TETSKIN_RETURN_OF_BASELINE(name)  \
  return plain::name
