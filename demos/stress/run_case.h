// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "stress/skin_judge.h"

namespace tetskin::stress {

/// Simulates a case in Bullet with a skin on the body, and judges the result.
Verdict runCase(const StressCase& stressCase);

}  // namespace tetskin::stress
