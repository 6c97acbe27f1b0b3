// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "measure/report.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "measure/promise.h"
#include "scenes/files.h"
#include "scenes/input_error.h"
#include "scenes/printed_table.h"
#include "scenes/summary.h"
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

/// A figure's present name, for results of versions in which it had another one.
std::string presentFigure(const std::string& name) {
  static const std::map<std::string, std::string> renamed = {
      {"stretch over that by hand", "stretch over analytic value"},
      {"below its place, m", "downward displacement, m"},
      {"box leaves its place, S", "box displacement, S"},
      {"top box below its place, S", "downward displacement of the top box, S"},
      {"the same of 10,000 tets", "the same with 10,000 tets"},
      {"inverted tets, at most", "most inverted tets"},
      {"turn, rad", "rotation, rad"},
      {"turn, rad/s", "angular speed, rad/s"},
      {"10 of each: distance off", "10 of each: distance error"},
      {"300 of each: distance off", "300 of each: distance error"},
  };
  const auto found = renamed.find(name);
  return found == renamed.end() ? name : found->second;
}

SceneResult resultFrom(const nlohmann::json& json) {
  SceneResult result;
  result.scene = json.at("scene").get<std::string>();
  for (const auto& figure : json.at("figures")) {
    const auto& value = figure.at("value");
    // JSON has no other way to represent NaN.
    result.figures.push_back(
        {presentFigure(figure.at("name").get<std::string>()), value.is_null() ? std::nan("") : value.get<double>()});
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
      if (promiseFor(result.scene, figure.name) != &promise) continue;
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
  const double iterations = static_cast<double>(run.iterations) / static_cast<double>(std::max(1L, run.steps));
  return {scene.name, run.steps, iterations, timer.seconds(), std::move(run.figures)};
}

std::string faultOf(const std::string& scene, const Figure& figure) {
  const Promise* promise = promiseFor(scene, figure.name);
  return holds(promise, figure.value) ? "" : figure.name + ": " + textOf(figure.value) + ", not " + text(*promise);
}

std::string textOf(const std::vector<Figure>& figures, const std::string& name) {
  const auto found = std::find_if(figures.begin(), figures.end(), [&](const Figure& f) { return f.name == name; });
  return found == figures.end() ? "-" : textOf(found->value);
}

std::size_t brokenIn(const SceneResults& results) {
  std::size_t broken = 0;
  for (const SceneResult& result : results) {
    for (const Figure& figure : result.figures) broken += !faultOf(result.scene, figure).empty();
  }
  return broken;
}

void print(const SceneResult& result) {
  std::printf("%-42s %6ld steps  %5.1f iterations per step  %6.2f s\n", result.scene.c_str(), result.steps,
              result.iterationsPerStep, result.seconds);
  PrintedTable table({{"", "", 34}, {"", "", 12}, {"", "", 14}, {}});
  for (const Figure& figure : result.figures) {
    const Promise* promise = promiseFor(result.scene, figure.name);
    const char* verdict = holds(promise, figure.value) ? "passed" : "FAILED";
    table.add(
        {"  " + figure.name, formatted("%.6g", figure.value), promise ? text(*promise) : "", promise ? verdict : ""});
  }
  std::printf("%s", table.text().c_str());
  std::fflush(stdout);
}

nlohmann::ordered_json toJson(const std::string& scene, const std::vector<Figure>& figures) {
  auto all = nlohmann::ordered_json::array();
  for (const Figure& figure : figures) {
    const Promise* promise = promiseFor(scene, figure.name);
    nlohmann::ordered_json json;
    json["name"] = figure.name;
    json["value"] = figure.value;
    if (promise && std::isfinite(promise->minimum)) json["least"] = promise->minimum;
    if (promise && std::isfinite(promise->maximum)) json["most"] = promise->maximum;
    json["passed"] = holds(promise, figure.value);
    all.push_back(std::move(json));
  }
  return all;
}

nlohmann::ordered_json toJson(const SceneResults& results) {
  auto json = nlohmann::ordered_json::array();
  for (const SceneResult& result : results) {
    nlohmann::ordered_json one;
    one["scene"] = result.scene;
    one["steps"] = result.steps;
    one["iterations_per_step"] = result.iterationsPerStep;
    one["seconds"] = result.seconds;
    one["figures"] = toJson(result.scene, result.figures);
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
    throw scenes::InputError(path + ": not a results file of tetskin_contact (--json): " + error.what());
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

void addReportOptions(scenes::CommandLine& line, ReportOptions& options, const std::string& note) {
  line.addSummaryOption(options.json);
  line.addOutput("--markdown", options.markdown, note);
  line.addQuietOption(options.quiet);
}

void write(const ReportOptions& options, const nlohmann::ordered_json& json, const std::string& markdown) {
  if (!options.json.empty()) scenes::writeJson(json, options.json);
  if (!options.markdown.empty()) scenes::writeFile(options.markdown, markdown);
}

int finish(const SceneResults& results, const std::string& markdown, const ReportOptions& options) {
  write(options, toJson(results), markdown);
  const std::size_t broken = brokenIn(results);
  if (!options.quiet) {
    std::printf("\n%zu scenes; %zu figures outside the limits promised for contact at the surface\n", results.size(),
                broken);
  }
  return broken == 0 ? scenes::kDone : scenes::kRunFailed;
}

}  // namespace tetskin::measure
