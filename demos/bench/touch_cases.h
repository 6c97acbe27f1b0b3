// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// Rays against the visual surface, and what springs and welds at its points cost and miss.
void registerTouchCases();

}  // namespace tetskin::bench
