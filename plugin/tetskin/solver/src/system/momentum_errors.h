// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SystemSolve: what a solve that is cut short leaves of momentum.
#pragma once

#include <tetskin/solver/src/system/system_bodies.h>

namespace tetskin::bullet_detail {

/// Removes from soft bodies the momentum error of a solve that is cut short, where rows act on the system. Where other
/// forces do, too, their share is unknown here, and nothing is removed.
/// bodies  with their solutions, and the impulses of their rows, which change by what the rows take back
void removeMomentumErrors(SystemBodies& bodies);

}  // namespace tetskin::bullet_detail
