// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

#include "gaps/gap_run.h"

namespace tetskin::gaps {

/// One body on one obstacle, by its surface and by its cage's nodes.
struct GapRow {
  std::string obstacle, body;
  std::size_t tets = 0;  ///< as asked for
  Rest surface, cage;
  double deepest = 0.0, deepestByCage = 0.0;  ///< of the impact
};

/// The largest gap, either way, by which a body is promised to rest from what it lies on.
constexpr double kPromised = 0.003;

/// Rests by its surface within what is promised, or nowhere on the obstacle.
bool holds(const GapRow& row);

nlohmann::ordered_json toJson(const std::vector<GapRow>& rows);
/// A table of gaps at rest and one of impacts: a line an obstacle and setting, a column a body and cage; by the
/// surface, and in brackets by the cage.
std::string toMarkdown(const std::vector<GapRow>& rows);

}  // namespace tetskin::gaps
