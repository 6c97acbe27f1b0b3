// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// Registers what bodies of a tetskin::World cost in all, by their number and tets: time of a frame, and memory.
void registerBudgetCases();

}  // namespace tetskin::bench
