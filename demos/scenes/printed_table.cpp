// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/printed_table.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

namespace tetskin::scenes {

PrintedTable::PrintedTable(std::vector<TableColumn> columns) : header_(2) {
  for (TableColumn& column : columns) {
    widths_.push_back(column.width);
    header_[0].push_back(std::move(column.title));
    header_[1].push_back(std::move(column.unit));
  }
}

void PrintedTable::add(std::vector<std::string> cells) {
  assert(cells.size() == widths_.size());
  rows_.push_back(std::move(cells));
}

std::string PrintedTable::text() const {
  std::vector<std::vector<std::string>> lines = header_;
  lines.insert(lines.end(), rows_.begin(), rows_.end());
  std::vector<std::size_t> widths = widths_;
  for (const std::vector<std::string>& line : lines) {
    for (std::size_t k = 0; k < widths.size(); ++k) widths[k] = std::max(widths[k], line[k].size());
  }
  std::string text;
  for (const std::vector<std::string>& line : lines) {
    std::string row = " ";
    for (std::size_t k = 0; k < widths.size(); ++k) {
      const std::string blanks(widths[k] - line[k].size(), ' ');
      row += k == 0 ? " " + line[k] + blanks : "  " + blanks + line[k];
    }
    const std::size_t end = row.find_last_not_of(' ');
    if (end != std::string::npos) text += row.substr(0, end + 1) + "\n";
  }
  return text;
}

std::string formatted(const char* format, double number) {
  char text[128];
  std::snprintf(text, sizeof text, format, number);
  return text;
}

std::string formatted(const char* format, const nlohmann::ordered_json& json, const char* key) {
  return formatted(format, json.at(key).get<double>());
}

void printValue(const char* name, const std::string& value) {
  std::printf("  %-22s %s\n", name, value.c_str());
}

void printSolve(const nlohmann::ordered_json& json) {
  if (json.at("iterations_per_step").is_null()) return;
  printValue("solver", formatted("%.1f iterations in ", json, "iterations_per_step") +
                           formatted("%.2f passes per step; steps that did not converge: ", json, "passes_per_step") +
                           formatted("%.0f", json, "steps_unconverged"));
}

}  // namespace tetskin::scenes
