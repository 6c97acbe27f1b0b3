// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// What it costs in a substep to find what a body touches, by its surface and by its cage.
void registerContactCases();

}  // namespace tetskin::bench
