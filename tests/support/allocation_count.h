// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstddef>

namespace tetskin::test {

/// How often operator new has been called in this program, which links the counting replacement of it.
std::size_t allocationCount();

/// Bytes that are allocated now, and the largest number of them since the last `resetPeak`.
std::size_t allocatedBytes();
std::size_t peakBytes();
void resetPeak();

}  // namespace tetskin::test
