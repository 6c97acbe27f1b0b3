// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// Registers what contact search costs per substep: by the bodies' surfaces, by their cages, in Bullet's own solver,
/// and in free flight. The counter `step_us` is the time of the whole substep; contact costs that time minus the time
/// in free flight.
void registerContactCases();

}  // namespace tetskin::bench
