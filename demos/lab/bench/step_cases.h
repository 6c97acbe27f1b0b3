// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// Registers what a frame of the body costs: each force and solver, compared with Bullet's and with a plain
/// hand-written solver; and a crowd most of which sleeps.
void registerStepCases();

}  // namespace tetskin::bench
