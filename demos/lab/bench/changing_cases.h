// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// A frame of bodies that flow, grow, contract or are under pressure, in turns with the same bodies that do not: the
/// time, and its ratio to that without.
void registerChangingCases();

}  // namespace tetskin::bench
