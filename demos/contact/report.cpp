// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "contact/report.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "contact/promise.h"
#include "contact/scene_list.h"
#include "scenes/files.h"
#include "scenes/input_error.h"

namespace tetskin::contact_demo {
namespace {

nlohmann::ordered_json toJson(const SceneResult& result, const Figure& figure) {
  nlohmann::ordered_json json;
  json["name"] = figure.name;
  json["value"] = figure.value;
  if (const Promise* promise = promiseFor(result.scene, figure.name)) {
    if (std::isfinite(promise->minimum)) json["least"] = promise->minimum;
    if (std::isfinite(promise->maximum)) json["most"] = promise->maximum;
  }
  json["passed"] = holds(result, figure);
  return json;
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
    char digits[32];
    const bool tiny = value != 0.0 && std::abs(value) < 1e-3;
    std::snprintf(digits, sizeof digits, tiny ? "%.1e" : "%.4g", value);
    cell += (cell.empty() ? "" : ", ") + (promise.holds(value) ? digits : "**" + std::string(digits) + "**");
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

bool holds(const SceneResult& result, const Figure& figure) {
  const Promise* promise = promiseFor(result.scene, figure.name);
  return !promise || promise->holds(figure.value);
}

void print(const SceneResult& result) {
  std::printf("%-42s %6ld steps  %5.1f iterations per step  %6.2f s\n", result.scene.c_str(), result.steps,
              result.iterationsPerStep, result.seconds);
  for (const Figure& figure : result.figures) {
    const Promise* promise = promiseFor(result.scene, figure.name);
    std::printf("    %-32s %12.6g   %-16s %s\n", figure.name.c_str(), figure.value,
                promise ? text(*promise).c_str() : "",
                !promise                       ? ""
                : promise->holds(figure.value) ? "passed"
                                               : "FAILED");
  }
  std::fflush(stdout);
}

nlohmann::ordered_json toJson(const SceneResults& results) {
  auto json = nlohmann::ordered_json::array();
  for (const SceneResult& result : results) {
    nlohmann::ordered_json one;
    one["scene"] = result.scene;
    one["steps"] = result.steps;
    one["iterations_per_step"] = result.iterationsPerStep;
    one["seconds"] = result.seconds;
    auto& figures = one["figures"] = nlohmann::ordered_json::array();
    for (const Figure& figure : result.figures) figures.push_back(toJson(result, figure));
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
  std::string table = "| scenes | figure | promised |", rule = "|---|---|---|";
  for (const ResultColumn& column : columns) {
    table += " " + column.title + " |";
    rule += "---|";
  }
  table += "\n" + rule + "\n";
  for (const Promise& promise : promises()) {
    std::string cells;
    WorstFigures first;
    for (const ResultColumn& column : columns) {
      const WorstFigures worst = worstFor(promise, column.results);
      if (first.empty()) first = worst;
      cells += " " + cell(promise, worst) + " |";
    }
    if (first.empty()) continue;
    table += "| " + heading(promise, first) + " | " + promise.figure + " | " + text(promise) + " |" + cells + "\n";
  }
  return table;
}

}  // namespace tetskin::contact_demo
