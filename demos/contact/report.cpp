// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "contact/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

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
    if (std::isfinite(promise->least)) json["least"] = promise->least;
    if (std::isfinite(promise->most)) json["most"] = promise->most;
  }
  json["held"] = holds(result, figure);
  return json;
}

SceneResult resultFrom(const nlohmann::json& json) {
  SceneResult result;
  result.scene = json.at("scene").get<std::string>();
  for (const auto& figure : json.at("figures")) {
    const auto& value = figure.at("value");
    // JSON has no other way to say that it is not a number.
    result.figures.push_back(
        {figure.at("name").get<std::string>(), value.is_null() ? std::nan("") : value.get<double>()});
  }
  return result;
}

/// The worst of the figures of which this is promised; none if none of these was measured.
std::optional<double> worstFor(const Promise& promise, const SceneResults& results) {
  std::optional<double> worst;
  for (const SceneResult& result : results) {
    for (const Figure& figure : result.figures) {
      if (promiseFor(result.scene, figure.name) != &promise) continue;
      if (!worst || !(promise.slack(figure.value) >= promise.slack(*worst))) worst = figure.value;
    }
  }
  return worst;
}

std::string cell(const Promise& promise, const std::optional<double>& worst) {
  if (!worst) return "";
  char digits[32];
  std::snprintf(digits, sizeof digits, std::abs(*worst) < 1e-3 ? "%.1e" : "%.3g", *worst);
  return promise.holds(*worst) ? digits : "**" + std::string(digits) + "**";
}

}  // namespace

bool holds(const SceneResult& result, const Figure& figure) {
  const Promise* promise = promiseFor(result.scene, figure.name);
  return !promise || promise->holds(figure.value);
}

void print(const SceneResult& result) {
  std::printf("%-42s %6ld steps  %5.1f iterations a step  %6.2f s\n", result.scene.c_str(), result.steps,
              result.iterationsPerStep, result.seconds);
  for (const Figure& figure : result.figures) {
    const Promise* promise = promiseFor(result.scene, figure.name);
    std::printf("    %-32s %12.6g   %-16s %s\n", figure.name.c_str(), figure.value,
                promise ? text(*promise).c_str() : "",
                !promise                       ? ""
                : promise->holds(figure.value) ? "holds"
                                               : "NOT HELD");
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
  if (!text) throw scenes::InputError(path + ": cannot be read");
  try {
    SceneResults results;
    for (const auto& json : nlohmann::json::parse(*text)) results.push_back(resultFrom(json));
    return results;
  } catch (const nlohmann::json::exception& error) {
    throw scenes::InputError(path + ": no results of this program: " + error.what());
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
    bool any = false;
    for (const ResultColumn& column : columns) {
      const auto worst = worstFor(promise, column.results);
      any = any || worst;
      cells += " " + cell(promise, worst) + " |";
    }
    if (any)
      table += std::string("| ") + promise.scene + " | " + promise.figure + " | " + text(promise) + " |" + cells + "\n";
  }
  return table;
}

}  // namespace tetskin::contact_demo
