// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// Registers what a frame of the body costs: each force and solver, beside Bullet's and a plain solver by hand; and a
/// crowd of which most sleep.
void registerStepCases();

}  // namespace tetskin::bench
