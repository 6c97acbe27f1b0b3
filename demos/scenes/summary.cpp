// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/summary.h"

#include <nlohmann/json.hpp>

#include "scenes/files.h"

namespace tetskin::scenes {

nlohmann::ordered_json summaryOf(const Model& model) {
  nlohmann::ordered_json json;
  json["model"] = model.name;
  json["vertices"] = model.mesh.vertexCount();
  json["triangles"] = model.mesh.triangleCount();
  json["nodes"] = model.cage.mesh.nodeCount();
  json["tets"] = model.cage.mesh.tetCount();
  return json;
}

nlohmann::ordered_json summaryOf(const Model& model, const EmbedReport& fit) {
  nlohmann::ordered_json json = summaryOf(model);
  json["inside"] = fit.inside;
  json["outside"] = fit.outside;
  json["unbound"] = fit.unbound;
  json["attach_ms"] = fit.milliseconds;
  json["rest_error_max"] = fit.restErrorMax;
  json["worst_distance"] = fit.maxDistance;
  json["worst_vertex"] = fit.maxDistanceVertex;
  return json;
}

void tellSolve(const SolveTotals& totals, nlohmann::ordered_json& json) {
  using Value = nlohmann::ordered_json;
  const bool solved = totals.steps > 0;
  json["steps_solved"] = totals.steps;
  json["iterations_per_step"] = solved ? Value(totals.iterationsPerStep()) : Value();
  json["passes_per_step"] = solved ? Value(totals.passesPerStep()) : Value();
  json["steps_unconverged"] = solved ? Value(totals.unconverged) : Value();
}

void writeJson(const nlohmann::ordered_json& json, const std::string& path) {
  writeFile(path, json.dump(2) + "\n");
}

}  // namespace tetskin::scenes
