// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Runs tetskin_error_vs_time, and reads its report.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "command.h"

namespace tetskin::test {

class ErrorVsTimeRun : public testing::Test {
 protected:
  /// Runs as if no Python had matplotlib, because plots take seconds.
  CommandResult run(const std::vector<std::string>& arguments) const { return runWith("raise ImportError", arguments); }
  /// Runs with the test's own matplotlib in place of the real one.
  CommandResult runWith(const std::string& matplotlib, std::vector<std::string> arguments,
                        const std::string& program = TETSKIN_ERROR_VS_TIME) const {
    std::filesystem::create_directories(folder.path("python"));
    folder.write("python/matplotlib.py", matplotlib);
    arguments.insert(arguments.begin(), {"PYTHONPATH=" + folder.path("python"), program});
    return folder.run("env", arguments);
  }
  /// Options for the small scene of the tests below.
  std::vector<std::string> small(const std::string& scene, const std::vector<std::string>& more = {},
                                 const std::string& out = "out") const {
    std::vector<std::string> all = {
        "--quick", "--quiet",     "--scenes", scene,      "--tets", "300,900", "--reference-tets",
        "2700",    "--triangles", "2000",     "--frames", "6",      "--out",   out};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  CommandFolder folder;
};

inline const nlohmann::json& sceneOf(const nlohmann::json& json, const std::string& name) {
  return *std::find_if(json.at("scenes").begin(), json.at("scenes").end(),
                       [&](const auto& scene) { return scene.at("scene") == name; });
}

/// The rows of one kind, from the coarsest to the finest cage, fewest substeps first.
inline std::vector<nlohmann::json> rowsOf(const nlohmann::json& scene, const std::string& interpolation,
                                          const std::string& material = "same") {
  std::vector<nlohmann::json> rows;
  for (const auto& row : scene.at("rows")) {
    if (row.at("interpolation") == interpolation && row.at("material") == material) rows.push_back(row);
  }
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return std::make_pair(a.at("tets"), a.at("substeps")) < std::make_pair(b.at("tets"), b.at("substeps"));
  });
  return rows;
}

/// Those of them in the substeps in which every kind is simulated.
inline std::vector<nlohmann::json> usualRowsOf(const nlohmann::json& scene, const std::string& interpolation,
                                               const std::string& material = "same") {
  std::vector<nlohmann::json> rows = rowsOf(scene, interpolation, material);
  const auto other = [&](const auto& row) { return row.at("substeps") != scene.at("substeps"); };
  rows.erase(std::remove_if(rows.begin(), rows.end(), other), rows.end());
  return rows;
}

inline double number(const nlohmann::json& row, const char* key) {
  return row.at(key).get<double>();
}

/// The exponent of the edge length with which an error falls, from the coarsest to the finest of these cages.
inline double orderOf(const std::vector<nlohmann::json>& rows, const char* error) {
  const auto [fine, coarse] = std::minmax_element(
      rows.begin(), rows.end(), [](const auto& a, const auto& b) { return number(a, "edge") < number(b, "edge"); });
  return std::log(number(*coarse, error) / number(*fine, error)) /
         std::log(number(*coarse, "edge") / number(*fine, "edge"));
}

}  // namespace tetskin::test
