// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "gaps/gap_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>

namespace tetskin::gaps {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%+.4f", value);
  return std::isfinite(value) ? text : "explodes";
}

/// "-": the body has fallen off; "~": it still moves.
std::string wordOf(const Rest& rest) {
  if (!rest.finite) return "explodes";
  if (!rest.touches()) return "-";
  return (rest.still() ? "" : "~") + number(rest.gap);
}

std::string restCell(const GapRow& row) {
  return wordOf(row.surface) + " (" + wordOf(row.cage) + ")";
}
std::string impactCell(const GapRow& row) {
  return number(row.deepest) + " (" + number(row.deepestByCage) + ")";
}

void appendNew(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::string columnOf(const GapRow& row) {
  return row.body + " " + std::to_string(row.tets);
}

std::string tableOf(const std::vector<GapRow>& rows, const std::function<std::string(const GapRow&)>& cell) {
  std::vector<std::string> lines, columns;
  for (const GapRow& row : rows) {
    appendNew(lines, row.obstacle);
    appendNew(columns, columnOf(row));
  }
  std::string text = "| obstacle |", rule = "|---|";
  for (const std::string& column : columns) {
    text += " " + column + " |";
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (const std::string& line : lines) {
    text += "| " + line + " |";
    for (const std::string& column : columns) {
      const auto found = std::find_if(
          rows.begin(), rows.end(), [&](const GapRow& row) { return row.obstacle == line && columnOf(row) == column; });
      text += " " + (found == rows.end() ? std::string() : cell(*found)) + " |";
    }
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json jsonOf(const Rest& rest) {
  nlohmann::ordered_json json;
  json["finite"] = rest.finite;
  json["touches"] = rest.touches();
  json["gap"] = rest.gap;
  json["speed"] = rest.speed;
  return json;
}

}  // namespace

bool holds(const GapRow& row) {
  const Rest& rest = row.surface;
  return rest.finite && (!rest.touches() || std::abs(rest.gap) <= kPromised);
}

nlohmann::ordered_json toJson(const std::vector<GapRow>& rows) {
  auto json = nlohmann::ordered_json::array();
  for (const GapRow& row : rows) {
    nlohmann::ordered_json one;
    one["obstacle"] = row.obstacle;
    one["body"] = row.body;
    one["tets"] = row.tets;
    one["surface"] = jsonOf(row.surface);
    one["cage"] = jsonOf(row.cage);
    one["deepest_surface"] = row.deepest;
    one["deepest_cage"] = row.deepestByCage;
    one["passed"] = holds(row);
    json.push_back(std::move(one));
  }
  return json;
}

std::string toMarkdown(const std::vector<GapRow>& rows) {
  return "Gap at rest with contact at the surface (at the cage's nodes), in body lengths:\n\n" +
         tableOf(rows, restCell) +
         "\nLeast gap of an impact with contact at the surface (at the cage's nodes), in body lengths:\n\n" +
         tableOf(rows, impactCell);
}

}  // namespace tetskin::gaps
