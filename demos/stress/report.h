// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

#include "stress/skin_judge.h"

namespace tetskin::stress {

struct Row {
  StressCase stressCase;
  Verdict verdict;
};

/// Whether a body with the library's force stayed bounded while none of its counterparts with Bullet's forces among the
/// rows did. Empty if there are no counterparts.
std::optional<bool> bulletCannot(const Row& ours, const std::vector<Row>& rows);

/// A list with one object per case.
nlohmann::ordered_json toJson(const std::vector<Row>& rows);
/// One table per group.
std::string toMarkdown(const std::vector<Row>& rows);
/// Prints a line per case, and a header before the first one of a kind.
class RowPrinter {
 public:
  /// hash  print that of each case's nodes
  explicit RowPrinter(bool hash) : hash_(hash) {}
  void print(const Row& row);

 private:
  bool hash_;
  std::optional<bool> headed_;  ///< whether the last header was that of claims
};
/// Prints the stability maps as letters.
void printMap(const std::vector<Row>& rows);

}  // namespace tetskin::stress
