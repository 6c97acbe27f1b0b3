// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/report_files.h"

#include <nlohmann/json.hpp>

#include "report/advice.h"
#include "scenes/files.h"
#include "scenes/table.h"

namespace tetskin::report {

std::string csvOf(const ReportResult& result) {
  std::string text = "scene,integrator,material,interpolation";
  for (const Column& column : columns()) text += std::string(",") + column.name;
  text += ",pareto\n";
  for (const SceneResult& scene : result.scenes) {
    for (const Row& row : scene.rows) {
      text += row.scene + "," + row.integrator + "," + row.material + "," + row.interpolation;
      for (const Column& column : columns()) {
        text += ",";
        scenes::appendNumber(text, row.*column.value);
      }
      text += row.pareto ? ",1\n" : ",0\n";
    }
  }
  return text;
}

nlohmann::ordered_json jsonOf(const ReportResult& result) {
  nlohmann::ordered_json json;
  json["model"] = result.model;
  json["vertices"] = result.vertices;
  json["triangles"] = result.triangles;
  json["reference"] = {{"from", result.reference.from}, {"tets", result.reference.tets}};
  json["units"] =
      "errors and edge: fractions of the diagonal of the mesh's bounding box; _ms, _us: processor time in one thread, "
      "medians; simulation, skin and total: per frame";
  json["scenes"] = nlohmann::ordered_json::array();
  for (const SceneResult& scene : result.scenes) {
    nlohmann::ordered_json one;
    one["scene"] = scene.scene;
    one["about"] = scenes::sceneNamed(scene.scene).about;
    one["integrator"] = scene.integrator;
    one["substeps"] = scene.rows.front().substeps;
    one["reference_error"] = scene.referenceError;
    one["reference_time_error"] = scene.referenceTimeError;
    one["reduction_advice"] = reductionAdvice(scene.rows);
    const ReductionLimit limit = reductionLimit(scene.rows);
    one["reduction_limit"] = {{"modes", limit.modes}, {"amplitude", limit.amplitude}};
    for (const Row& row : scene.rows) one["rows"].push_back(toJson(row));
    json["scenes"].push_back(std::move(one));
  }
  return json;
}

void writeReport(const ReportResult& result, const ReportOptions& options,
                 const std::optional<std::string>& colouredMesh) {
  const std::string base = options.out + "/error_vs_time";
  scenes::writeFile(base + ".csv", csvOf(result));
  scenes::writeFile(options.json, jsonOf(result).dump(2) + "\n");
  if (!colouredMesh) return;
  const SceneResult& last = result.scenes.back();
  const std::string name = last.integrator == "none" ? last.scene : last.scene + "_" + last.integrator;
  scenes::writeFile(options.out + "/error_" + name + ".ply", *colouredMesh);
}

}  // namespace tetskin::report
