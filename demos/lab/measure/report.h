// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The measurements, scene by scene, compared with the promises.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

#include "measure/run.h"

namespace tetskin::measure {

/// The result of one scene.
struct SceneResult {
  std::string scene;
  long steps = 0;
  double iterationsPerStep = 0.0;  ///< iterations of the library's solver
  double seconds = 0.0;
  std::vector<Figure> figures;
  std::vector<std::string> broken;  ///< in words: expectations, and promises of figures
  std::string promised;             ///< the scene by whose name promises are found
  std::string status;
  std::uint64_t hash = 0;
};

using SceneResults = std::vector<SceneResult>;

SceneResult runScene(const MeasuredScene& scene, Kind kind);

void print(const SceneResult& result);
nlohmann::ordered_json toJson(const SceneResults& results);

}  // namespace tetskin::measure
