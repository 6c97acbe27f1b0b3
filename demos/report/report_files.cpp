// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/report_files.h"

#include <tetskin/io/src/text/atomic_file.h>
#include <tetskin/io/src/text/number_text.h>

#include "report/advice.h"
#include "scenes/counted.h"
#include "scenes/options.h"

namespace tetskin::report {
namespace {

template <class... Values>
void append(std::string& text, const char* format, Values... values) {
  char line[512];
  std::snprintf(line, sizeof line, format, values...);
  text += line;
}

nlohmann::ordered_json toJson(const ObservedOrder& order) {
  return {{"coarse_tets", order.coarseTets},
          {"fine_tets", order.fineTets},
          {"total", order.total},
          {"embedding", order.embedding}};
}

nlohmann::ordered_json ordersOf(const SceneResult& scene) {
  auto json = nlohmann::ordered_json::array();
  for (const char* interpolation : {"linear", "quadratic"}) {
    for (const char* material : {"same", "calibrated"}) {
      nlohmann::ordered_json one = {{"interpolation", interpolation}, {"material", material}};
      one["overall"] = toJson(overallOrder(scene.rows, interpolation, material));
      one["steps"] = nlohmann::ordered_json::array();
      for (const ObservedOrder& order : observedOrders(scene.rows, interpolation, material)) {
        one["steps"].push_back(toJson(order));
      }
      if (!one["steps"].empty()) json.push_back(std::move(one));
    }
  }
  return json;
}

void appendTable(std::string& text, const SceneResult& scene) {
  text +=
      "| tets | surface | error, RMS | largest | embedding alone | at the nodes | normals, degrees | simulation, ms | "
      "skin, µs | total, ms | speed-up | attach, ms | memory, MB "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Row& row : scene.rows) {
    const std::string tets = scenes::withThousands(static_cast<std::size_t>(row.tets));
    std::string surface = row.interpolation + (row.material == "calibrated" ? ", calibrated" : "");
    if (row.pareto) surface = "**" + surface + "**";
    if (row.isReference()) {
      append(text, "| %s | %s | about %.1e | | | | | %.3g | | %.3g | 1 | | %.1f |\n", tets.c_str(), surface.c_str(),
             scene.referenceError, row.simulationMs, row.totalMs, row.memoryBytes / 1e6);
      continue;
    }
    append(text, "| %s | %s%s | %.2e | %.1e | %.1e | %.1e | %.2f | %.3g | %.0f | %.3g | %.3g | %.3g | %.1f |\n",
           tets.c_str(), surface.c_str(), row.finite != 0.0 ? "" : " (exploded)", row.errorTotalRms, row.errorTotalMax,
           row.errorEmbeddingRms, row.errorSimulationRms, row.normalErrorMeanDeg, row.simulationMs, row.skinUs,
           row.totalMs, row.speedup, row.attachMs, row.memoryBytes / 1e6);
  }
}

void appendOrders(std::string& text, const SceneResult& scene) {
  text += "\nObserved orders (error over edge length; total / embedding alone):\n\n";
  for (const char* interpolation : {"linear", "quadratic"}) {
    const std::vector<ObservedOrder> orders = observedOrders(scene.rows, interpolation, "same");
    if (orders.empty()) continue;
    const ObservedOrder all = overallOrder(scene.rows, interpolation, "same");
    append(text, "- %s: %.1f / %.1f over all;", interpolation, all.total, all.embedding);
    for (const ObservedOrder& o : orders) {
      append(text, " %.1f / %.1f (%s to %s tets)%s", o.total, o.embedding,
             scenes::withThousands(static_cast<std::size_t>(o.coarseTets)).c_str(),
             scenes::withThousands(static_cast<std::size_t>(o.fineTets)).c_str(), &o == &orders.back() ? "\n" : ",");
    }
  }
  text += scene.integrator == "none"
              ? "\nOn a smooth map the theory's orders are 2 (linear) and 3 (quadratic).\n"
              : "\nThe theory's orders, 2 for linear embedding and 3 for quadratic, are those of smooth maps; here the "
                "body is clamped along edges, where its strain is not smooth, the reference is itself linear in each "
                "tet, and coarse cages have another shape: they are fatter, and parts that lie close together are "
                "fused.\n";
}

void appendTarget(std::string& text, const SceneResult& scene, double targetError) {
  if (targetError <= 0.0) return;
  const Row* best = cheapest(scene.rows, targetError);
  if (best) {
    append(text, "\nCheapest below an error of %g: %s: %.3g ms a frame, error %.2e.\n", targetError,
           describe(*best).c_str(), best->totalMs, best->errorTotalRms);
  } else {
    append(text, "\nNo setting stays below an error of %g.\n", targetError);
  }
}

}  // namespace

std::string csvOf(const ReportResult& result) {
  std::string text = "scene,integrator,material,interpolation";
  for (const Column& column : columns()) text += std::string(",") + column.name;
  text += ",pareto\n";
  for (const SceneResult& scene : result.scenes) {
    for (const Row& row : scene.rows) {
      text += row.scene + "," + row.integrator + "," + row.material + "," + row.interpolation;
      for (const Column& column : columns()) {
        text += ",";
        io::appendNumber(text, row.*column.value);
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
  json["units"] =
      "errors and edge: diagonals of the mesh's box; _ms, _us: processor time in one thread, medians; "
      "simulation, skin and total: a frame";
  json["scenes"] = nlohmann::ordered_json::array();
  for (const SceneResult& scene : result.scenes) {
    nlohmann::ordered_json one;
    one["scene"] = scene.scene;
    one["integrator"] = scene.integrator;
    one["reference_error"] = scene.referenceError;
    one["orders"] = ordersOf(scene);
    for (const Row& row : scene.rows) one["rows"].push_back(toJson(row));
    json["scenes"].push_back(std::move(one));
  }
  return json;
}

std::string markdownOf(const ReportResult& result, double targetError) {
  std::string text = "# Error against run time: " + result.model + "\n\n";
  text += scenes::withThousands(result.vertices) + " vertices, " + scenes::withThousands(result.triangles) +
          " triangles. Errors in diagonals of the mesh's box, over all vertices and frames; times of the processor in "
          "one thread, medians over the frames. Bold: nothing is both faster and more accurate.\n";
  for (const SceneResult& scene : result.scenes) {
    text += "\n## " + scene.scene + (scene.integrator == "none" ? "" : ", " + scene.integrator) + "\n\n";
    appendTable(text, scene);
    if (scene.referenceError > 0.0) {
      append(text,
             "\nThe reference itself is wrong by about %.1e: smaller differences mean nothing. Calibrated cages aim at "
             "the "
             "body itself, not at the reference, which is too stiff as well: judge them by a fine one (--full).\n",
             scene.referenceError);
    }
    appendOrders(text, scene);
    appendTarget(text, scene, targetError);
  }
  return text;
}

void writeReport(const ReportResult& result, const ReportOptions& options,
                 const std::optional<std::string>& colouredMesh) {
  const std::string base = options.out + "/error_vs_time";
  scenes::require(io::writeFile(base + ".csv", csvOf(result)));
  scenes::require(io::writeFile(base + ".md", markdownOf(result, options.targetError)));
  scenes::require(io::writeFile(options.json, jsonOf(result).dump(2) + "\n"));
  if (!colouredMesh) return;
  const SceneResult& last = result.scenes.back();
  const std::string name = last.integrator == "none" ? last.scene : last.scene + "_" + last.integrator;
  scenes::require(io::writeFile(options.out + "/error_" + name + ".ply", *colouredMesh));
}

}  // namespace tetskin::report
