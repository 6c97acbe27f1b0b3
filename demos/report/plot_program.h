// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "report/report_options.h"

namespace tetskin::report {

/// Has the plot program (demos/plots/error_vs_time.py) make tables and plots of what was written, beside the rows. Says
/// so in one line where there is no Python with matplotlib; if the program fails, that is a warning on standard error.
void makeTablesAndPlots(const ReportOptions& options);

}  // namespace tetskin::report
