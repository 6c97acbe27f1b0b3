// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The main job: a mesh falls on obstacles in Bullet's deformable world, carried by a coarse cage.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "scenes/drop_scene.h"
#include "scenes/frame_writer.h"
#include "scenes/options.h"
#include "scenes/progress.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;

struct DropOptions {
  ModelOptions model;
  SkinOptions skin;
  OutputOptions output{"out/drop", "", 240, 1, false};
  bool writeCage = false;
};

/// Beyond this many times its rest size a body has exploded: Bullet clamps such a body to finite coordinates.
constexpr double kExploded = 20.0;
/// The surface may pass the floor by the collision margin and this fraction of its size: contacts are at the cage's
/// nodes.
constexpr double kFloorTolerance = 0.01;
/// Slower than this many sizes a second over the last half second is at rest.
constexpr double kRestSpeed = 0.05;

/// What is measured on the way.
struct Totals {
  int frames = 0;
  int written = 0;
  double simulationMs = 0.0;
  double skinUs = 0.0;
  double writeMs = 0.0;
  bool finite = true;
  double extentMax = 1.0;
  double lowest = HUGE_VAL;
  std::vector<double> speeds;  ///< a frame, in sizes a second

  double restSpeed() const {
    const std::size_t half = std::min(speeds.size(), static_cast<std::size_t>(DropScene::kFrameRate / 2));
    double squared = 0.0;
    for (std::size_t k = speeds.size() - half; k < speeds.size(); ++k) squared += speeds[k] * speeds[k];
    return half == 0 ? 0.0 : std::sqrt(squared / static_cast<double>(half));
  }
};

void writeFrame(const DropScene& scene, const DropOptions& options, int frame, FrameWriter& writer, Totals& totals) {
  const auto start = std::chrono::steady_clock::now();
  writer.write(frame, scene.surface(), scene.bounds(), scene.normals());
  if (options.writeCage) writer.writeCage(frame, scene.currentCage());
  totals.writeMs += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (totals.written++ == 0 && !options.output.quiet) std::printf("%s\n", writer.announcement().c_str());
}

void measure(const DropScene& scene, double restExtent, Totals& totals) {
  const Box3 bounds = scene.bounds();
  totals.extentMax = std::max(totals.extentMax, bounds.sizes().maxCoeff() / restExtent);
  totals.lowest = std::min(totals.lowest, bounds.min().y());
  totals.speeds.push_back(scene.nodeSpeed());
}

Totals simulate(DropScene& scene, const DropOptions& options, FrameWriter& writer) {
  Totals totals;
  const double restExtent = scene.bounds().sizes().maxCoeff();
  Progress progress("simulating", options.output.frames, options.output.quiet);
  for (int frame = 0; frame < options.output.frames; ++frame) {
    if (frame > 0) {
      totals.finite = scene.step();
      totals.simulationMs += scene.simulationMs();
      totals.skinUs += scene.skinUs();
    }
    if (totals.finite) measure(scene, restExtent, totals);
    totals.finite = totals.finite && totals.extentMax < kExploded;
    if (!totals.finite) break;
    if (frame % options.output.every == 0) writeFrame(scene, options, frame, writer, totals);
    totals.frames = frame + 1;
    progress.show(frame + 1);
  }
  return totals;
}

nlohmann::ordered_json summarise(const Model& model, const DropScene& scene, const DropOptions& options,
                                 const Totals& totals) {
  const double steps = std::max(1, totals.frames - 1);
  const double tolerance = scene.margin() + kFloorTolerance * scene.size();
  nlohmann::ordered_json json = summaryOf(model, scene.fit());
  json["simulation_ms_per_frame"] = totals.simulationMs / steps;
  json["skin_us_per_frame"] = totals.skinUs / steps;
  json["write_ms_per_frame"] = totals.writeMs / std::max(1, totals.written);
  json["frames"] = totals.frames;
  json["frames_written"] = totals.written;
  json["floor_y"] = scene.floorY();
  json["margin"] = scene.margin();
  json["lowest_y"] = totals.lowest;
  json["floor_tolerance"] = tolerance;
  json["above_floor"] = totals.lowest >= scene.floorY() - tolerance;
  json["extent_max"] = totals.extentMax;
  json["rest_speed"] = totals.restSpeed();
  json["at_rest"] = totals.restSpeed() < kRestSpeed;
  json["finite"] = totals.finite;
  json["out"] = options.output.out;
  return json;
}

void printTable(const nlohmann::ordered_json& json, const std::string& summaryPath) {
  const auto row = [](const char* name, const std::string& value) { std::printf("  %-22s %s\n", name, value.c_str()); };
  const auto number = [&](const char* key, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, json.at(key).get<double>());
    return std::string(text);
  };
  std::printf("\n%s\n", json.at("model").get<std::string>().c_str());
  row("vertices", number("vertices", "%.0f"));
  row("triangles", number("triangles", "%.0f"));
  row("nodes", number("nodes", "%.0f"));
  row("tets", number("tets", "%.0f"));
  row("inside / outside", number("inside", "%.0f") + " / " + number("outside", "%.0f"));
  if (json.at("outside") > 0) {
    row("farthest outside", "vertex " + number("worst_vertex", "%.0f") + ", by " + number("worst_distance", "%.3g"));
  }
  row("attach", number("attach_ms", "%.2f ms"));
  row("rest error", number("rest_error_max", "%.1e box diagonals"));
  row("simulation", number("simulation_ms_per_frame", "%.2f ms a frame"));
  row("skin", number("skin_us_per_frame", "%.1f us a frame"));
  row("write", number("write_ms_per_frame", "%.2f ms a frame"));
  row("speed at the end", number("rest_speed", "%.3f sizes a second"));
  row("lowest point", "y = " + number("lowest_y", "%.4g") + "; floor: y = " + number("floor_y", "%.4g") +
                          ", less a tolerance of " + number("floor_tolerance", "%.2g"));
  row("frames", number("frames", "%.0f"));
  row("files", json.at("out").get<std::string>() + "/frame_0000.obj ... " + summaryPath);
}

int run(const DropOptions& options) {
  const Model model = loadModel(options.model);
  DropScene scene(model.mesh, model.cage, options.skin);
  requireFit(scene.fit(), options.model);
  const OutputOptions& output = options.output;
  FrameWriter writer({output.out, output.frames, output.every, options.writeCage},
                     layoutWith(options.skin.normals, model.layout));
  const std::string path = summaryPath(output);
  const TriangleMesh obstacles = scene.obstacles();
  const std::string obstaclesPath = (std::filesystem::path(output.out) / "obstacles.obj").string();
  require(ObjLayout::fromMesh(obstacles).writeTo(obstaclesPath, viewOf(obstacles.positions)));

  const Totals totals = simulate(scene, options, writer);
  const nlohmann::ordered_json json = summarise(model, scene, options, totals);
  writeJson(json, path);
  if (!output.quiet) printTable(json, path);
  if (!totals.finite) {
    std::fprintf(stderr, "tetskin_drop: the simulation exploded after frame %d\n", totals.frames - 1);
    return kRunFailed;
  }
  if (!json.at("above_floor").get<bool>()) {
    std::fprintf(stderr, "tetskin_drop: the surface passed through the floor at y = %g, down to y = %g\n",
                 scene.floorY(), totals.lowest);
    return kRunFailed;
  }
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  DropOptions options;
  CLI::App app("A mesh falls on obstacles in Bullet's deformable world, carried by a coarse cage of tetrahedra.");
  addModelOptions(app, options.model);
  addInterpolationOption(app, options.skin);
  addSkinOptions(app, options.skin);
  addOutputOptions(app, options.output);
  app.add_flag("--write-cage", options.writeCage, "Write the cage beside each frame, as cage_0000.vtk, ...");
  return runDemo(app, argc, argv, [&] { return run(options); });
}
