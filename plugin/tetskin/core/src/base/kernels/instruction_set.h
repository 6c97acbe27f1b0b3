// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/export.h>

#include <vector>

namespace tetskin {

/// The skinning kernels exist once for each of these; the widest that the processor has is chosen automatically.
/// Results differ by rounding only, and the tet that carries a vertex never depends on it.
enum class InstructionSet {
  Plain,     ///< standard C++, one vertex at a time: for compilers without vector types
  Baseline,  ///< the platform's baseline (SSE2 on x86-64), through the compiler's vector types
  Avx2,      ///< with fused multiply-adds
  Avx512,    ///< F, DQ, BW and VL
};

const char* toString(InstructionSet set);

/// The instruction sets that this processor and this build support, narrowest first.
std::vector<InstructionSet> availableInstructionSets();

TETSKIN_CORE_API InstructionSet instructionSet();

/// For tests and measurements: everything uses this one from now on. It must be available. Not during an update.
void setInstructionSet(InstructionSet set);

}  // namespace tetskin
