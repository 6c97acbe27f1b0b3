// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "report/report_options.h"

namespace tetskin::report {

/// Runs the plot program (lab/plots/error_vs_time.py), which makes tables and plots from the files written. Prints
/// one line where there is no Python with matplotlib; if the program fails, prints a warning to standard error.
void makeTablesAndPlots(const ReportOptions& options);

}  // namespace tetskin::report
