// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// Registers the cost of a frame in which many bodies touch: balls on a soft mat (`Pit/`), and soft cubes in a bin
/// (`Bin/`), the scenes of tetskin_pile. `/falling` is the mean of the first two seconds, `/rest` that of a second in
/// which the pile lies still, awake.
void registerPileCases();

}  // namespace tetskin::bench
