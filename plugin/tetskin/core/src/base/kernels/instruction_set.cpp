// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/compiler.h>
#include <tetskin/core/src/base/kernels/instruction_set.h>

#include <algorithm>
#include <atomic>
#include <cassert>

namespace tetskin {
namespace {

bool available(InstructionSet set) {
  switch (set) {
#ifdef TETSKIN_VECTOR_KERNELS
    case InstructionSet::Baseline:
#endif
    case InstructionSet::Plain:
      return true;
#ifdef TETSKIN_X86_KERNELS
    case InstructionSet::Avx2:
      return processorHasAvx2();
    case InstructionSet::Avx512:
      return processorHasAvx512();
#endif
    default:
      return false;
  }
}

std::atomic<InstructionSet>& chosen() {
  static std::atomic<InstructionSet> set(availableInstructionSets().back());
  return set;
}

}  // namespace

const char* toString(InstructionSet set) {
  switch (set) {
    case InstructionSet::Plain:
      return "plain";
    case InstructionSet::Baseline:
      return "baseline";
    case InstructionSet::Avx2:
      return "AVX2";
    case InstructionSet::Avx512:
      return "AVX-512";
  }
  return "unknown instruction set";
}

std::vector<InstructionSet> availableInstructionSets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set :
       {InstructionSet::Plain, InstructionSet::Baseline, InstructionSet::Avx2, InstructionSet::Avx512}) {
    if (available(set)) sets.push_back(set);
  }
  return sets;
}

InstructionSet instructionSet() {
  return chosen().load(std::memory_order_relaxed);
}

void setInstructionSet(InstructionSet set) {
  assert(available(set));
  chosen().store(set, std::memory_order_relaxed);
}

}  // namespace tetskin
