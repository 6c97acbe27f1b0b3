// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>

#include "report/report.h"

namespace tetskin::report {

/// The rows as CSV. The first line names the columns, with their units if they have any.
std::string csvOf(const ReportResult& result);

/// The whole result as JSON.
nlohmann::ordered_json jsonOf(const ReportResult& result);

/// Writes error_vs_time.csv and .json, and the coloured mesh of the last scene, if there is one. Throws InputError.
void writeReport(const ReportResult& result, const ReportOptions& options,
                 const std::optional<std::string>& colouredMesh);

}  // namespace tetskin::report
