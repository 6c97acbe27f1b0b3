// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstddef>

namespace tetskin::test {

/// How often operator new has been called in this program, which links the counting replacement.
std::size_t allocationCount();

}  // namespace tetskin::test
