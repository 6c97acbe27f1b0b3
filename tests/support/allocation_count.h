// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstddef>

namespace tetskin::test {

/// How often operator new has been called in this program, which links the counting replacement.
std::size_t allocationCount();

/// Bytes asked of operator new and not yet given back; and the most that has been since the last `resetPeak`.
std::size_t allocatedBytes();
std::size_t peakBytes();
void resetPeak();

}  // namespace tetskin::test
