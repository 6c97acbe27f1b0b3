// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// Registers what the same frames cost with and without `DeformableWorldOptions::deterministic`.
void registerDeterministicCases();

}  // namespace tetskin::bench
