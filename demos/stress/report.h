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
/// Prints to standard output: a line per case, with the hash of its nodes if requested; and the stability maps as
/// letters.
void printRow(const Row& row, bool hash);
void printMap(const std::vector<Row>& rows);

}  // namespace tetskin::stress
