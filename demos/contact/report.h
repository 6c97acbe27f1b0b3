// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What was measured, scene by scene, beside what is promised.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

#include "contact/run.h"

namespace tetskin::contact_demo {

/// A scene that was run.
struct SceneResult {
  std::string scene;
  long steps = 0;
  double iterationsPerStep = 0.0;  ///< of the library's solver
  double seconds = 0.0;
  std::vector<Figure> figures;
};

using SceneResults = std::vector<SceneResult>;

/// It lies within what is promised, or nothing is.
bool holds(const SceneResult& result, const Figure& figure);

void print(const SceneResult& result);
nlohmann::ordered_json toJson(const SceneResults& results);
/// Of such a file. Throws InputError if it is none.
SceneResults readResults(const std::string& path);

/// All results of one column.
struct ResultColumn {
  std::string title;
  SceneResults results;
};
/// A table: a line a promise; in each column, and for each stiffness of the scenes, the figure that comes nearest to
/// breaking it, or breaks it by most.
std::string toMarkdown(const std::vector<ResultColumn>& columns);

}  // namespace tetskin::contact_demo
