// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <gtest/gtest.h>
#include <tetskin/core/src/base/kernels/instruction_set.h>

namespace tetskin::test {

/// Calls visit() with each instruction set that this processor has.
template <class Visit>
void onEachInstructionSet(Visit&& visit) {
  const InstructionSet before = instructionSet();
  for (const InstructionSet set : availableInstructionSets()) {
    const testing::ScopedTrace trace(__FILE__, __LINE__, toString(set));
    setInstructionSet(set);
    visit();
  }
  setInstructionSet(before);
}

}  // namespace tetskin::test
