// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// Registers the cost of saving and restoring a world, with one body on the floor, and with a heap of eight.
void registerSnapshotCases();

}  // namespace tetskin::bench
