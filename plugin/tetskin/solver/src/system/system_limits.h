// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SystemSolve: the tolerances to which a system is solved.
#pragma once

#include <tetskin/solver/src/system/reduced_unknowns.h>

namespace tetskin::bullet_detail {

/// The strictest tolerance of all bodies of the system.
elastic_detail::SolveLimits limitsWithoutRows(const SystemBodies& bodies);
/// The residual is relative to what contacts and others have changed: the size of the solution, or the change of the
/// velocities in the step, whichever is larger.
/// bodies  whose `start` is that of the pass;  reduced  with the residual of the pass
elastic_detail::SolveLimits limitsOfPass(const SystemBodies& bodies, const ReducedUnknowns& reduced, int pass);

}  // namespace tetskin::bullet_detail
