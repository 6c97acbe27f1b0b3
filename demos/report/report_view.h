// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "report/scene_runner.h"

namespace tetskin::report {

/// Writes a page that plays a scene in the cage that --show-tets names, with the reference beside it. The cage is
/// simulated once more, as results keep errors alone. Throws InputError.
void writeView(SceneRunner& runner, const ReportModel& model, const ReportOptions& options);

}  // namespace tetskin::report
