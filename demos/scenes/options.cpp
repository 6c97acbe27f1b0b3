// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/options.h"

#include <tetskin/io/mesh_loader.h>
#include <tetskin/io/tet_mesh_reader.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <new>

#include "scenes/bar.h"
#include "scenes/serpent.h"

namespace tetskin::scenes {
namespace {

/// With more than this share of a mesh's vertices outside a cage, one of them farther out than this share of the mesh's
/// diagonal, the cage is another model's. One that lies within its mesh has many vertices outside, but near.
constexpr double kManyOutside = 0.5, kFarOutside = 0.1;

constexpr const char* kNotWritable = ": cannot be written; does its folder exist?";

std::string nameOf(BuiltIn model) {
  return model == BuiltIn::Bar ? "bar" : "serpent";
}

/// An option that takes one of some words.
template <class Choice>
void addChoice(CLI::App& app, const std::string& name, Choice& choice,
               const std::vector<std::pair<std::string, Choice>>& words, const std::string& description) {
  std::vector<std::string> known;
  std::string preset;
  for (const auto& [word, value] : words) {
    known.push_back(word);
    if (value == choice) preset = word;
  }
  const auto choose = [&choice, words](const std::string& wanted) {
    for (const auto& [word, value] : words) {
      if (word == wanted) choice = value;
    }
  };
  app.add_option_function<std::string>(name, choose, description)->check(CLI::IsMember(known))->default_str(preset);
}

CLI::Validator isFinite(const char* demand, bool (*holds)(double)) {
  const auto check = [=](std::string& text) {
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    const bool good = !text.empty() && *end == '\0' && std::isfinite(number) && holds(number);
    return good ? std::string() : "'" + text + "' is not " + demand;
  };
  return CLI::Validator(check, "");
}

}  // namespace

CLI::Validator isFileName() {
  return CLI::Validator(
      [](std::string& text) { return std::string(text.empty() ? "the name of a file is empty" : ""); }, "");
}

CLI::Validator isCount() {
  return CLI::Range(1, std::numeric_limits<int>::max());
}

CLI::Validator isPositive() {
  return isFinite("a finite, positive number", [](double number) { return number > 0.0; });
}

CLI::Validator isNotNegative() {
  return isFinite("a finite, non-negative number", [](double number) { return number >= 0.0; });
}

void addSurfaceOptions(CLI::App& app, ModelOptions& options) {
  const std::string builtIn = "built-in " + nameOf(options.builtIn);
  CLI::Option* mesh =
      app.add_option("--mesh", options.mesh, "Render mesh, any format assimp reads (default: a " + builtIn + ")")
          ->check(isFileName());
  app.add_option("--triangles", options.triangles, "Triangles of the " + builtIn)
      ->check(CLI::Range(kMinSerpentTriangles, kMaxSerpentTriangles))
      ->capture_default_str()
      ->excludes(mesh);
}

void addMeshOptions(CLI::App& app, ModelOptions& options) {
  addSurfaceOptions(app, options);
  app.add_option("--tets", options.tets, "Tets of a built cage")->check(isCount())->capture_default_str();
}

void addModelOptions(CLI::App& app, ModelOptions& options) {
  addMeshOptions(app, options);
  app.add_option("--cage", options.cage, "Tet mesh: .vtk, .ele/.node or .msh (default: built from the mesh)")
      ->check(isFileName())
      ->excludes("--tets");
}

void addInterpolationOption(CLI::App& app, SkinOptions& options) {
  addChoice(app, "--interpolation", options.interpolation,
            {{"linear", Interpolation::Linear}, {"quadratic", Interpolation::Quadratic}},
            "How the surface follows the cage");
}

void addSkinOptions(CLI::App& app, SkinOptions& options) {
  addChoice(app, "--normals", options.normals,
            {{"none", Normals::None}, {"transformed", Normals::Transformed}, {"recomputed", Normals::Recomputed}},
            "Current normals of the surface");
  addChoice(app, "--outside", options.outside,
            {{"nearest", OutsideRule::Nearest}, {"barycentric", OutsideRule::Barycentric}},
            "Which tet carries a vertex outside the cage");
  app.add_option("--max-distance", options.maxDistance,
                 "Refuse a mesh with a vertex farther than this from the cage, in the mesh's unit")
      ->check(isNotNegative());
}

void addSummaryOption(CLI::App& app, std::string& path, const std::string& description) {
  app.add_option("--json", path, description)->check(isFileName());
}

void addOutputOptions(CLI::App& app, OutputOptions& options) {
  app.add_option("--frames", options.frames, "Frames of 1/60 s")->check(CLI::Range(1, 1000000))->capture_default_str();
  app.add_option("--every", options.every, "Write every so many frames")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--out", options.out, "Folder of the OBJ sequence")->check(isFileName())->capture_default_str();
  addSummaryOption(app, options.json, "File of the summary (default: summary.json in the folder)");
  app.add_flag("--quiet", options.quiet, "Print nothing but errors");
}

Surface loadSurface(const ModelOptions& options) {
  if (options.mesh.empty()) {
    const bool bar = options.builtIn == BuiltIn::Bar;
    return {nameOf(options.builtIn), bar ? makeBar(options.triangles) : makeSerpent({options.triangles})};
  }
  Result<TriangleMesh> mesh = loadMesh(options.mesh);
  require(mesh.status());
  return {options.mesh, std::move(mesh).value()};
}

TetMesh loadCage(const std::string& path) {
  Result<TetMesh> cage = loadTetMesh(path);
  require(cage.status());
  if (const Status status = usable(cage.value(), checkTetMesh(cage.value())); !status.ok()) {
    throw InputError(path + ": " + status.message);
  }
  return std::move(cage).value();
}

TetMesh cageFor(const Surface& surface, const CageOptions& options, CageReport* report) {
  Result<TetMesh> cage = buildCage(surface.mesh, options, report);
  if (!cage.ok()) throw InputError(surface.name + ": " + cage.status().message);
  return std::move(cage).value();
}

Model loadModel(const ModelOptions& options) {
  Model model;
  static_cast<Surface&>(model) = loadSurface(options);
  if (options.mesh.empty()) {
    model.layout = ObjLayout::fromMesh(model.mesh);
  } else {
    Result<ObjLayout> layout = objLayoutFor(options.mesh, model.mesh);
    require(layout.status());
    model.layout = std::move(layout).value();
  }
  CageOptions cage;
  cage.targetTets = options.tets;
  model.cage = options.cage.empty() ? cageFor(model, cage) : loadCage(options.cage);
  (void)repairTetMesh(model.cage);
  return model;
}

nlohmann::ordered_json summaryOf(const Model& model) {
  nlohmann::ordered_json json;
  json["model"] = model.name;
  json["vertices"] = model.mesh.vertexCount();
  json["triangles"] = model.mesh.triangleCount();
  json["nodes"] = model.cage.nodeCount();
  json["tets"] = model.cage.tetCount();
  return json;
}

nlohmann::ordered_json summaryOf(const Model& model, const EmbedReport& fit) {
  nlohmann::ordered_json json = summaryOf(model);
  json["inside"] = fit.inside;
  json["outside"] = fit.outside;
  json["unbound"] = fit.unbound;
  json["attach_ms"] = fit.milliseconds;
  json["rest_error_max"] = fit.restErrorMax;
  json["worst_distance"] = fit.worstDistance;
  json["worst_vertex"] = fit.worstVertex;
  return json;
}

void writeJson(const nlohmann::ordered_json& json, const std::string& path) {
  std::ofstream file(path);
  file << json.dump(2) << "\n";
  if (!file.flush()) throw InputError(path + kNotWritable);
}

void requireWritable(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::file_type before = fs::status(path, none).type();
  if (before != fs::file_type::not_found && before != fs::file_type::regular && before != fs::file_type::directory) {
    return;  // /dev/stdout, a pipe: not to be touched before its time
  }
  if (!std::ofstream(path, std::ios::app)) throw InputError(path + kNotWritable);
  if (before == fs::file_type::not_found) fs::remove(fs::canonical(path, none), none);  // not the link to it
}

std::string summaryPath(const OutputOptions& options) {
  const std::string path =
      options.json.empty() ? (std::filesystem::path(options.out) / "summary.json").string() : options.json;
  requireWritable(path);
  return path;
}

void requireFit(const EmbedReport& report, const ModelOptions& options) {
  const std::string mesh = options.mesh.empty() ? nameOf(options.builtIn) : options.mesh;
  if (!report.ok()) throw InputError(mesh + ": " + report.status.message);
  const double size = report.meshBox.diagonal().norm();
  char text[256];
  if (report.unitsDiffer()) {
    std::snprintf(text, sizeof text,
                  "their boxes have diagonals of %.4g and %.4g and %s; are they in different units? Scale one of them",
                  size, report.cageBox.diagonal().norm(),
                  report.meshBox.intersects(report.cageBox) ? "overlap" : "lie apart");
  } else if (static_cast<double>(report.outside) > kManyOutside * static_cast<double>(report.vertexCount) &&
             report.worstDistance > kFarOutside * size) {
    std::snprintf(
        text, sizeof text,
        "%zu of %zu vertices lie outside it, vertex %zu by %.3g, and the mesh's diagonal is %.3g; take a cage "
        "made for this mesh, such as tetskin_cage builds",
        report.outside, report.vertexCount, report.worstVertex, report.worstDistance, size);
  } else {
    return;
  }
  throw InputError(mesh + " does not fit its cage " + options.cage + ": " + text);
}

ObjLayout layoutWith(Normals normals, const ObjLayout& layout) {
  return normals == Normals::None ? layout : layout.withNormals();
}

int runDemo(CLI::App& app, int argc, char** argv, const std::function<int()>& run) {
  const std::string name = std::filesystem::path(argv[0]).filename().string();
  try {
    app.parse(argc, argv);
    return run();
  } catch (const CLI::CallForHelp&) {
    std::fputs(app.help().c_str(), stdout);
    return kDone;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "%s: out of memory; ask for fewer tets or triangles\n", name.c_str());
  } catch (const std::exception& error) {  // CLI::Error and InputError among them
    std::fprintf(stderr, "%s: %s\n", name.c_str(), error.what());
  }
  return kBadInput;
}

}  // namespace tetskin::scenes
