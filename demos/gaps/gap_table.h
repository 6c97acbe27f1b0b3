// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

#include "gaps/gap_run.h"

namespace tetskin::gaps {

/// One body on one obstacle, with contact by its surface and by its cage's nodes.
struct GapRow {
  std::string obstacle, body;
  std::size_t tets = 0;  ///< as requested
  Rest surface, cage;
  double deepest = 0.0, deepestByCage = 0.0;  ///< deepest penetration of the impact
};

/// The largest gap, or penetration, with which a body is promised to rest on an obstacle.
constexpr double kPromised = 0.003;

/// True if the body rests by its surface within what is promised, or has fallen off the obstacle.
bool holds(const GapRow& row);

nlohmann::ordered_json toJson(const std::vector<GapRow>& rows);
/// A table of gaps at rest and one of impacts: one line per obstacle and setting, one column per body and cage. Values
/// are for contact by the surface; those in brackets are for contact by the cage.
std::string toMarkdown(const std::vector<GapRow>& rows);

}  // namespace tetskin::gaps
