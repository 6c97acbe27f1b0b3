// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// Registers rays against the visual surface, and the cost and error of springs and welds at its points.
void registerTouchCases();

}  // namespace tetskin::bench
