// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "report/scene_runner.h"

namespace tetskin::report {

/// Writes a page that plays a scene in the cage chosen by --show-tets, next to the reference. The cage is simulated
/// again, as results hold errors only. Throws InputError.
void writeView(SceneRunner& runner, const ReportModel& model, const ReportOptions& options);

}  // namespace tetskin::report
