// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "measure/report.h"

#include <algorithm>
#include <cctype>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "measure/promise.h"
#include "scenes/files.h"
#include "scenes/input_error.h"
#include "scenes/printed_table.h"
#include "scenes/timer.h"

namespace tetskin::measure {
namespace {

using scenes::formatted;
using scenes::PrintedTable;
using scenes::TableColumn;

bool holds(const Promise* promise, double value) {
  return !promise || promise->holds(value);
}

std::string textOf(double value) {
  return formatted(value != 0.0 && std::abs(value) < 1e-3 ? "%.1e" : "%.4g", value);
}

SceneResult resultFrom(const nlohmann::json& json) {
  SceneResult result;
  result.scene = json.at("scene").get<std::string>();
  result.promised = json.value("promised_as", result.scene);
  for (const auto& figure : json.at("figures")) {
    const auto& value = figure.at("value");
    // JSON has no other way to represent NaN.
    result.figures.push_back(
        {figure.at("name").get<std::string>(), value.is_null() ? std::nan("") : value.get<double>()});
  }
  return result;
}

/// The end of a scene's name if there are several of its kind: "k50", "1e9Pa"; otherwise empty.
std::string stiffnessIn(const std::string& scene) {
  const std::string last = scene.substr(scene.rfind('/') + 1);
  const bool isRelative = last.size() > 1 && last[0] == 'k' && std::isdigit(static_cast<unsigned char>(last[1]));
  const bool isPressure = last.size() > 2 && last.compare(last.size() - 2, 2, "Pa") == 0;
  return isRelative || isPressure ? last : "";
}

/// The worst of the figures that a promise covers, by stiffness, in the order in which they were run.
using WorstFigures = std::vector<std::pair<std::string, double>>;

WorstFigures worstFor(const Promise& promise, const SceneResults& results) {
  WorstFigures worst;
  for (const SceneResult& result : results) {
    const std::string stiffness = stiffnessIn(result.scene);
    for (const Figure& figure : result.figures) {
      if (promiseFor(result.promised, figure.name) != &promise) continue;
      const auto found = std::find_if(worst.begin(), worst.end(), [&](const auto& w) { return w.first == stiffness; });
      if (found == worst.end()) {
        worst.emplace_back(stiffness, figure.value);
      } else if (!(promise.slack(figure.value) >= promise.slack(found->second))) {
        found->second = figure.value;
      }
    }
  }
  return worst;
}

std::string cell(const Promise& promise, const WorstFigures& worst) {
  std::string cell;
  for (const auto& [stiffness, value] : worst) {
    const std::string number = textOf(value);
    cell += (cell.empty() ? "" : ", ") + (promise.holds(value) ? number : "**" + number + "**");
  }
  return cell;
}

/// A list of scenes such as "roll/undamped, k300, k3000".
std::string heading(const Promise& promise, const WorstFigures& worst) {
  std::string heading = promise.scene;
  for (const auto& [stiffness, value] : worst) {
    const bool isNamed = stiffness.empty() || heading.find("/" + stiffness) != std::string::npos;
    if (!isNamed) heading += ", " + stiffness;
  }
  return heading;
}

}  // namespace

SceneResult runScene(const MeasuredScene& scene, Kind kind) {
  const scenes::WallTimer timer;
  Run run(kind);
  scene.run(run);
  SceneResult result;
  result.scene = scene.name;
  result.steps = run.steps;
  result.iterationsPerStep = static_cast<double>(run.iterations) / static_cast<double>(std::max(1L, run.steps));
  result.seconds = timer.seconds();
  result.promised = run.promised.empty() ? scene.name : run.promised;
  result.broken = std::move(run.broken);
  for (const Figure& figure : run.figures) {
    const Promise* promise = promiseFor(result.promised, figure.name);
    if (!holds(promise, figure.value))
      result.broken.push_back(figure.name + ": " + textOf(figure.value) + ", not " + text(*promise));
  }
  result.figures = std::move(run.figures);
  result.status = std::move(run.status);
  result.hash = run.hash;
  return result;
}

void print(const SceneResult& result) {
  std::printf("%-42s %6ld steps  %5.1f iterations per step  %6.2f s  %s\n", result.scene.c_str(), result.steps,
              result.iterationsPerStep, result.seconds, result.status.c_str());
  PrintedTable table({{"", "", 34}, {"", "", 12}, {"", "", 14}, {}});
  for (const Figure& figure : result.figures) {
    const Promise* promise = promiseFor(result.promised, figure.name);
    if (!result.status.empty() && !promise) continue;
    const char* verdict = holds(promise, figure.value) ? "passed" : "FAILED";
    table.add(
        {"  " + figure.name, formatted("%.6g", figure.value), promise ? text(*promise) : "", promise ? verdict : ""});
  }
  std::printf("%s", table.text().c_str());
  for (const std::string& fault : result.broken) std::printf("    FAILED: %s\n", fault.c_str());
  std::fflush(stdout);
}

nlohmann::ordered_json toJson(const SceneResults& results) {
  auto json = nlohmann::ordered_json::array();
  for (const SceneResult& result : results) {
    nlohmann::ordered_json one;
    one["scene"] = result.scene;
    if (result.promised != result.scene) one["promised_as"] = result.promised;
    one["steps"] = result.steps;
    one["iterations_per_step"] = result.iterationsPerStep;
    one["seconds"] = result.seconds;
    one["figures"] = nlohmann::ordered_json::array();
    for (const Figure& figure : result.figures) {
      const Promise* promise = promiseFor(result.promised, figure.name);
      nlohmann::ordered_json row;
      row["name"] = figure.name;
      row["value"] = figure.value;
      if (promise && std::isfinite(promise->minimum)) row["least"] = promise->minimum;
      if (promise && std::isfinite(promise->maximum)) row["most"] = promise->maximum;
      row["passed"] = holds(promise, figure.value);
      one["figures"].push_back(std::move(row));
    }
    one["broken"] = result.broken;
    if (!result.status.empty()) {
      one["status"] = result.status;
      char hash[17];
      std::snprintf(hash, sizeof hash, "%016" PRIx64, result.hash);
      one["hash"] = hash;
    }
    json.push_back(std::move(one));
  }
  return json;
}

SceneResults readResults(const std::string& path) {
  const std::optional<std::string> text = scenes::contentsOf(path);
  if (!text) throw scenes::InputError(path + ": cannot be read; check the path and its permissions");
  try {
    SceneResults results;
    for (const auto& json : nlohmann::json::parse(*text)) results.push_back(resultFrom(json));
    return results;
  } catch (const nlohmann::json::exception& error) {
    throw scenes::InputError(path + ": not a results file of tetskin_measure (--json): " + error.what());
  }
}

std::string toMarkdown(const std::vector<ResultColumn>& columns) {
  std::vector<TableColumn> titles = {{"scenes"}, {"figure"}, {"promised"}};
  for (const ResultColumn& column : columns) titles.push_back({column.title});
  PrintedTable table(std::move(titles));
  for (const Promise& promise : promises()) {
    std::vector<std::string> cells = {"", promise.figure, text(promise)};
    WorstFigures first;
    for (const ResultColumn& column : columns) {
      const WorstFigures worst = worstFor(promise, column.results);
      if (first.empty()) first = worst;
      cells.push_back(cell(promise, worst));
    }
    if (first.empty()) continue;
    cells[0] = heading(promise, first);
    table.add(std::move(cells));
  }
  return table.markdown();
}

}  // namespace tetskin::measure
