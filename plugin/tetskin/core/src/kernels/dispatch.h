// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: of what is compiled once for each instruction set, the one in use.
#pragma once

#include <tetskin/core/src/kernels/instruction_set.h>

namespace tetskin::kernels {

template <class T>
const T& forInstructionSet(const T& avx512, const T& avx2, const T& baseline, const T& plain) {
  switch (instructionSet()) {
    case InstructionSet::Avx512:
      return avx512;
    case InstructionSet::Avx2:
      return avx2;
    case InstructionSet::Baseline:
      return baseline;
    default:
      return plain;
  }
}

}  // namespace tetskin::kernels

/// `name` in kernels::avx512, kernels::avx2, ..., of which a build may have no more than kernels::plain.
#if defined(TETSKIN_X86_KERNELS)
#define TETSKIN_KERNELS_IN_USE(name) \
  kernels::forInstructionSet(kernels::avx512::name, kernels::avx2::name, kernels::baseline::name, kernels::plain::name)
#elif defined(TETSKIN_VECTOR_KERNELS)
#define TETSKIN_KERNELS_IN_USE(name)                                                                    \
  kernels::forInstructionSet(kernels::baseline::name, kernels::baseline::name, kernels::baseline::name, \
                             kernels::plain::name)
#else
#define TETSKIN_KERNELS_IN_USE(name) kernels::plain::name
#endif
