// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstdio>

namespace tetskin::test {

/// Prints a measured figure, for the table in tests/BULLET_DEFECTS.md.
inline void figure(const char* what, double value) {
  std::printf("[  figure  ] %s: %.3g\n", what, value);
}

}  // namespace tetskin::test
