// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// What it costs in a substep to find what bodies touch: by their surfaces, by their cages, in Bullet's own solver, and
/// in free flight. The counter `step_us` is of the whole substep: less that in free flight it is what contact costs.
void registerContactCases();

}  // namespace tetskin::bench
