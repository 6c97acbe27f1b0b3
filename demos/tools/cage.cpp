// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Builds a cage of tets around any mesh, or makes one of tets that fill it, as a file for Bullet, tetskin or a meshing
// program.
#include <tetskin/cage/create_cage.h>
#include <tetskin/cage/painted_maps.h>
#include <tetskin/core/cage.h>
#include <tetskin/io/files.h>

#include <nlohmann/json.hpp>

#include "scenes/command_line.h"
#include "scenes/input_error.h"
#include "scenes/summary.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;

struct CageCommand {
  ModelOptions model;
  std::string filled;                                ///< tets that fill the mesh; empty: the cage is built
  bool quadratic = false;                            ///< each of these becomes a quadratic tet
  bool hasMesh = false;                              ///< the cage of --filled is checked against a mesh
  std::string stiffnessMap, densityMap, dampingMap;  ///< see `mapOf`; empty: none
  std::string output;
  std::string json;
  bool loose = false;
  bool quiet = false;
};

/// The map that an option names: NAME, or NAME:LOW:HIGH, where 0 stands for LOW and 1 for HIGH.
std::vector<double> mapOf(const CageCommand& command, const std::string& option) {
  if (option.empty()) return {};
  if (command.model.mesh.empty()) throw InputError("a map is read from a file of --mesh");
  const std::size_t range = option.find(':');
  double low = 0.0, high = 1.0;
  char after = 0;
  if (range != std::string::npos && std::sscanf(option.c_str() + range, ":%lf:%lf%c", &low, &high, &after) != 2)
    throw InputError("'" + option + "' is not NAME:LOW:HIGH, such as red:1:4");
  Result<std::vector<double>> map = loadVertexMap(command.model.mesh, option.substr(0, range));
  require(map.status());
  for (double& value : map.value()) value = low + value * (high - low);
  return std::move(map).value();
}

PaintedMaps mapsOf(const CageCommand& command) {
  return {mapOf(command, command.stiffnessMap), mapOf(command, command.densityMap), mapOf(command, command.dampingMap)};
}

nlohmann::ordered_json summarise(const Surface& surface, const CageReport& report, const EmbedReport& fit,
                                 const CalibrationReport& calibration) {
  nlohmann::ordered_json json;
  json["model"] = surface.name;
  json["vertices"] = surface.mesh.vertexCount();
  json["triangles"] = surface.mesh.triangleCount();
  json["target_tets"] = report.targetTets;
  json["tets"] = report.tets;
  json["nodes"] = report.nodes;
  json["vertices_outside"] = fit.outside;
  json["min_dihedral_deg"] = report.minDihedralDegrees;
  json["max_dihedral_deg"] = report.maxDihedralDegrees;
  json["components"] = report.components;
  json["mesh_components"] = report.meshComponents;
  json["loose_vertices"] = report.looseVertices;
  json["copies"] = report.duplicateTets;
  json["fused_parts"] = report.fusedComponents;
  json["stiffness_factor"] = calibration.stiffnessFactor;
  json["spacing"] = report.spacing;
  json["volume_ratio"] = report.volumeRatio;
  json["volume_ratio_unfitted"] = report.volumeRatioUnfitted;
  json["build_ms"] = report.milliseconds;
  return json;
}

/// How a mesh fits its cage: as an application would see it, not as the builder reports it.
EmbedReport fitOf(const Cage& cage, const Surface& surface) {
  EmbedReport fit;
  const auto embedded = embed(cage, surface.mesh, {}, &fit);
  if (!embedded.ok()) throw InputError(surface.name + ": " + embedded.status().message);
  return fit;
}

int statusOf(const EmbedReport& fit) {
  if (fit.outside == 0) return kDone;
  std::fprintf(stderr,
               "tetskin_cage: %zu vertices lie outside the cage, the farthest is vertex %zu at a distance of %g\n",
               fit.outside, fit.maxDistanceVertex, fit.maxDistance);
  return kRunFailed;
}

int run(CageCommand command) {
  Surface surface = loadSurface(command.model);
  CageReport report;
  CageOptions options = cageOptionsOf(command.model);
  options.fit = !command.loose;
  PaintedMaps maps = mapsOf(command);
  options.stiffness = std::move(maps.stiffness);
  options.density = std::move(maps.density);
  options.damping = std::move(maps.damping);
  announceCage(options.targetTets, command.model);
  Cage cage = cageFor(surface, options, &report);
  CalibrationReport calibration;
  if (command.model.calibrate) calibration = calibrated(cage, surface.name);
  require(saveCage(cage, command.output));

  gatherLooseVertices(surface, cage, true);  // the report has told of them
  const EmbedReport fit = fitOf(cage, surface);
  if (!command.json.empty()) writeJson(summarise(surface, report, fit, calibration), command.json);
  if (!command.quiet) {
    std::printf("%s%s%s\n", report.describe().c_str(), command.model.calibrate ? calibration.describe().c_str() : "",
                command.output.c_str());
  }
  return statusOf(fit);
}

/// Makes a cage of tets that fill a mesh: quadratic ones where the file has such; otherwise of each tet, if wanted.
int runFilled(const CageCommand& command) {
  Cage cage = scenes::loadCage(command.filled);
  const auto quadraticTetsOf = [](const Cage& made) {
    const auto tets = quadraticTets(made);
    require(tets.status());
    return tets.value().size();
  };
  std::size_t count = quadraticTetsOf(cage);
  if (count == 0 && command.quadratic) {
    Result<Cage> refined = refineQuadratic(cage);
    if (!refined.ok()) throw InputError(command.filled + ": " + refined.status().message);
    cage = std::move(refined).value();
    count = quadraticTetsOf(cage);
  }
  const PaintedMaps maps = mapsOf(command);  // refuses any without a mesh
  EmbedReport fit;
  Surface surface;
  if (command.hasMesh) {
    surface = loadSurface(command.model);
    if (const Status painted = paintCage(cage, surface.mesh, maps); !painted.ok())
      throw InputError(surface.name + ": " + painted.message);
  }
  require(saveCage(cage, command.output));

  if (command.hasMesh) {
    gatherLooseVertices(surface, cage, command.quiet);
    fit = fitOf(cage, surface);
  }
  nlohmann::ordered_json json;
  json["tets"] = cage.mesh.tetCount();
  json["quadratic_tets"] = count;
  json["nodes"] = cage.mesh.nodeCount();
  json["vertices_outside"] = fit.outside;
  if (!command.json.empty()) writeJson(json, command.json);
  if (!command.quiet) {
    std::printf("%zu tets, %zu nodes: %zu quadratic tets, %zu linear ones\n%s\n", cage.mesh.tetCount(),
                cage.mesh.nodeCount(), count, cage.mesh.tetCount() - kSubTets * count, command.output.c_str());
  }
  return statusOf(fit);
}

}  // namespace

int main(int argc, char** argv) {
  CageCommand command;
  CommandLine line("Builds a cage of tetrahedra around any triangle mesh, watertight or not.",
                   {{{"tetskin_cage --mesh yours.obj -o yours_cage.vtk", "a cage of about 3,000 tets around your mesh"},
                     {"tetskin_cage --mesh yours.obj --tets 300 --calibrate -o yours_cage.vtk --json cage.json",
                      "about 300 tets, calibrated to the stiffness of the mesh, and a JSON file of their quality"},
                     {"tetskin_cage --mesh painted.obj --stiffness-map red:1:4 -o yours_cage.vtk",
                      "four times as stiff where the mesh's vertices are red"},
                     {"tetskin_cage --filled yours.vtk --quadratic -o yours_cage.vtk",
                      "a cage of quadratic tets, one for each tet of a mesh that fills the body"}},
                    "a vertex lies outside the cage"});
  line.addMeshOptions(command.model);
  line.addInput("--filled", command.filled,
                "Tets that fill the mesh, to be the cage: those of second order become quadratic tets");
  line.addFlag("--quadratic", command.quadratic,
               "With --filled: a quadratic tet, of eight tets, for each tet, unless the file has some");
  line.addText("--stiffness-map", command.stiffnessMap,
               "Map of the mesh's file, of factors of the stiffness: a PLY property, a glTF attribute, or red, green, "
               "blue or alpha; NAME:LOW:HIGH takes 0 as LOW and 1 as HIGH");
  line.addText("--density-map", command.densityMap, "The same for the density");
  line.addText("--damping-map", command.dampingMap, "The same for the damping");
  line.addOutput("-o,--output", command.output,
                 ".vtk for the cage with all its data; .ele with .node for the tets alone", CommandLine::Need::Required,
                 {".vtk", ".node", ".ele"});
  line.addSummaryOption(command.json);
  line.addFlag("--no-fit", command.loose);
  line.addQuietOption(command.quiet);
  return line.run(argc, argv, [&] {
    command.model.quiet = command.quiet;
    if (command.filled.empty()) {
      if (command.quadratic) throw InputError("--quadratic is for the tets of --filled");
      return run(command);
    }
    for (const char* option : {"--tets", "--no-fit", "--no-duplicate-elements", "--calibrate"}) {
      if (line.given(option)) throw InputError(std::string("--filled takes no ") + option + ", as nothing is built");
    }
    command.hasMesh = line.given("--mesh") || line.given("--model");
    return runFilled(command);
  });
}
