// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "measure/report.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "measure/promise.h"
#include "scenes/printed_table.h"
#include "scenes/timer.h"

namespace tetskin::measure {
namespace {

using scenes::formatted;
using scenes::PrintedTable;

bool holds(const Promise* promise, double value) {
  return !promise || promise->holds(value);
}

std::string textOf(double value) {
  return formatted(value != 0.0 && std::abs(value) < 1e-3 ? "%.1e" : "%.4g", value);
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

}  // namespace tetskin::measure
