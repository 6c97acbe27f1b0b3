// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// Registers FaceTree, Ray and Step: what face trees cost a body, and what they gain.
void registerBodyCases();

}  // namespace tetskin::bench
