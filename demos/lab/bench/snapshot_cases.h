// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// Registers what it costs to save and to restore a world: of one body on the floor, and of a heap of eight.
void registerSnapshotCases();

}  // namespace tetskin::bench
