// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// Registers the cost of a body's frame: each force and solver, compared with Bullet's and with a plain hand-written
/// solver; and a mostly sleeping crowd.
void registerStepCases();

}  // namespace tetskin::bench
