// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The demos' printed output: tables with aligned columns, and summaries with one line per value.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace tetskin::scenes {

struct TableColumn {
  std::string title;
  std::string unit = {};  ///< second line of the header
  std::size_t width = 0;  ///< at least this many characters
};

/// Rows are gathered, and printed at the end, so that they do not mix with the progress of the run.
class PrintedTable {
 public:
  explicit PrintedTable(std::vector<TableColumn> columns);
  /// cells  one per column; "-" stands for a value that was not measured
  void add(std::vector<std::string> cells);
  /// A line of titles, one of units, then the rows, each indented by two blanks. The first column is aligned to the
  /// left, all others to the right. Header lines without any text are left out.
  std::string text() const;

 private:
  std::vector<std::size_t> widths_;
  std::vector<std::vector<std::string>> header_, rows_;
};

/// A number in a format of printf.
std::string formatted(const char* format, double number);
/// The number that a summary has under this key, in a format of printf.
std::string formatted(const char* format, const nlohmann::ordered_json& json, const char* key);

/// Prints a line of a summary.
void printValue(const char* name, const std::string& value);
/// Prints what `tellSolve` wrote, if anything.
void printSolve(const nlohmann::ordered_json& json);

}  // namespace tetskin::scenes
