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

/// Whether a body of the library's force stayed bounded, and none of its twins did that are among the rows. Empty:
/// there are none.
std::optional<bool> bulletCannot(const Row& ours, const std::vector<Row>& rows);

/// A list of one object a case.
nlohmann::ordered_json toJson(const std::vector<Row>& rows);
/// A table a group.
std::string toMarkdown(const std::vector<Row>& rows);
/// On standard output: a line per case, if wished with the hash of its nodes, and the stability maps in letters.
void printRow(const Row& row, bool hash);
void printMap(const std::vector<Row>& rows);

}  // namespace tetskin::stress
