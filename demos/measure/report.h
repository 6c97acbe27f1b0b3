// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What was measured, scene by scene, beside what is promised.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

#include "measure/run.h"
#include "scenes/command_line.h"

namespace tetskin::measure {

/// The result of one scene.
struct SceneResult {
  std::string scene;
  long steps = 0;
  double iterationsPerStep = 0.0;  ///< iterations of the library's solver
  double seconds = 0.0;
  std::vector<Figure> figures;
};

using SceneResults = std::vector<SceneResult>;

SceneResult runScene(const MeasuredScene& scene, Kind kind);

/// What is wrong with a figure: "energy: 1.2, not <= 1.02"; empty if it lies within what is promised, or if nothing is.
std::string faultOf(const std::string& scene, const Figure& figure);
/// The number of figures that are outside their limits.
std::size_t brokenIn(const SceneResults& results);
/// A figure as it stands in tables; "-" where it was not measured.
std::string textOf(const std::vector<Figure>& figures, const std::string& name);

void print(const SceneResult& result);
nlohmann::ordered_json toJson(const SceneResults& results);
/// Figures with their limits.
nlohmann::ordered_json toJson(const std::string& scene, const std::vector<Figure>& figures);
/// Reads a file of such results. Throws InputError if it is not one.
SceneResults readResults(const std::string& path);

/// All results in one column.
struct ResultColumn {
  std::string title;
  SceneResults results;
};
/// A table with one line per promise. Each column shows, for each stiffness of the scenes, the figure that comes
/// closest to breaking the promise, or breaks it by most.
std::string toMarkdown(const std::vector<ResultColumn>& columns);

/// What becomes of the results.
struct ReportOptions {
  std::string json, markdown;
  bool quiet = false;
};
/// Adds --json, --markdown and --quiet.
/// note  on the Markdown; may be empty
void addReportOptions(scenes::CommandLine& line, ReportOptions& options, const std::string& note = "");
/// Writes the files that are asked for.
void write(const ReportOptions& options, const nlohmann::ordered_json& json, const std::string& markdown);
/// The same, and what the results amount to. Returns the exit status: whether all promises are kept.
int finish(const SceneResults& results, const std::string& markdown, const ReportOptions& options);

}  // namespace tetskin::measure
