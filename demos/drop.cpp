// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The main job: a mesh falls on obstacles in Bullet's deformable world, carried by a coarse cage.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "scenes/command_line.h"
#include "scenes/frame_writer.h"
#include "scenes/input_error.h"
#include "scenes/progress.h"
#include "scenes/summary.h"
#include "scenes/table.h"
#include "scenes/timer.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;

struct DropOptions {
  ModelOptions model;
  SkinOptions skin;
  OutputOptions output{"out/drop", "", 240, 1, false};
  bool writeCage = false;
};

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
  bool aboveFloor = true;
  double extentMax = 1.0;
  double lowest = HUGE_VAL;
  std::vector<double> speeds;  ///< a frame, in sizes a second

  double restSpeed() const {
    const std::size_t half = std::min(speeds.size(), static_cast<std::size_t>(kFrameRate / 2));
    double squared = 0.0;
    for (std::size_t k = speeds.size() - half; k < speeds.size(); ++k) squared += speeds[k] * speeds[k];
    return half == 0 ? 0.0 : std::sqrt(squared / static_cast<double>(half));
  }
};

/// The model in the scene. It may have any size and be anywhere: results are in its own space. Frame 0 is the model at
/// rest.
class Drop {
 public:
  explicit Drop(const DropOptions& options)
      : options_(options),
        model_(loadModel(options.model)),
        place_(placementOf(boundingBox(model_.cage.nodes))),
        scene_(sceneNamed("obstacles").make(place_.toWorld(model_.cage))),
        fit_(skin_.bind(scene_->body(), model_.cage, model_.mesh, options.skin)) {
    requireFit(fit_, options.model);
    place_.offset = scene_->offset;
  }

  const ObjLayout& layout() const { return model_.layout; }
  TriangleMesh obstacles() const {
    TriangleMesh mesh = scene_->world().obstacles();
    place_.toModel(mesh.positions);
    return mesh;
  }
  double floorY() const { return place_.toModel(Eigen::Vector3d(0.0, scene_->floorY, 0.0)).y(); }

  Totals simulate(FrameWriter& writer);
  nlohmann::ordered_json summarise(const Totals& totals) const;

 private:
  bool step(int frame, Totals& totals);
  void measure(double restExtent, Totals& totals);
  void write(int frame, FrameWriter& writer, Totals& totals);
  Box3 bounds() const { return {place_.toModel(skin_.bounds().min()), place_.toModel(skin_.bounds().max())}; }

  const DropOptions& options_;
  const Model model_;
  Placement place_;
  const std::unique_ptr<Scene> scene_;
  SoftBodySkin skin_;
  const EmbedReport fit_;
  std::vector<Eigen::Vector3d> surface_;
};

/// Returns false if the skin found node positions that are not finite.
bool Drop::step(int frame, Totals& totals) {
  const WallTimer simulation;
  const int substeps = scene_->step(frame);
  totals.simulationMs += simulation.milliseconds();
  const WallTimer skin;
  const UpdateStatus status = substeps > 0 ? skin_.update() : UpdateStatus::Asleep;
  totals.skinUs += skin.microseconds();
  return status == UpdateStatus::Updated || status == UpdateStatus::Asleep;
}

void Drop::measure(double restExtent, Totals& totals) {
  const Findings found = scene_->check(skin_.positions());
  totals.finite = !found.exploded;
  totals.aboveFloor = totals.aboveFloor && found.aboveFloor;
  totals.extentMax = std::max(totals.extentMax, bounds().sizes().maxCoeff() / restExtent);
  totals.lowest = std::min(totals.lowest, bounds().min().y());
  totals.speeds.push_back(scene_->nodeSpeed());
}

void Drop::write(int frame, FrameWriter& writer, Totals& totals) {
  const WallTimer timer;
  place_.readSurface(skin_, surface_);
  writer.write(frame, surface_, bounds(), skin_.normals());
  if (options_.writeCage) {
    TetMesh cage = tetMeshOf(scene_->body());
    place_.toModel(cage.nodes);
    writer.writeCage(frame, cage);
  }
  totals.writeMs += timer.milliseconds();
  if (totals.written++ == 0 && !options_.output.quiet) std::printf("%s\n", writer.announcement().c_str());
}

Totals Drop::simulate(FrameWriter& writer) {
  const OutputOptions& output = options_.output;
  const double restExtent = bounds().sizes().maxCoeff();
  Totals totals;
  Progress progress("simulating", output.frames, output.quiet);
  for (int frame = 0; frame < output.frames; ++frame) {
    if (frame > 0) totals.finite = step(frame, totals);
    if (totals.finite) measure(restExtent, totals);
    if (!totals.finite) break;
    if (frame % output.every == 0) write(frame, writer, totals);
    totals.frames = frame + 1;
    progress.show(frame + 1);
  }
  return totals;
}

nlohmann::ordered_json Drop::summarise(const Totals& totals) const {
  const double steps = std::max(1, totals.frames - 1), margin = scene_->margin() / place_.scale;
  nlohmann::ordered_json json = summaryOf(model_, fit_);
  json["simulation_ms_per_frame"] = totals.simulationMs / steps;
  json["skin_us_per_frame"] = totals.skinUs / steps;
  json["write_ms_per_frame"] = totals.writeMs / std::max(1, totals.written);
  json["frames"] = totals.frames;
  json["frames_written"] = totals.written;
  json["floor_y"] = floorY();
  json["margin"] = margin;
  json["lowest_y"] = totals.lowest;
  json["floor_tolerance"] = margin + kFloorTolerance * (kSize / place_.scale);
  json["above_floor"] = totals.aboveFloor;
  json["extent_max"] = totals.extentMax;
  json["rest_speed"] = totals.restSpeed();
  json["at_rest"] = totals.restSpeed() < kRestSpeed;
  json["finite"] = totals.finite;
  json["out"] = options_.output.out;
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
  Drop drop(options);
  const OutputOptions& output = options.output;
  FrameWriter writer({output.out, output.frames, output.every, options.writeCage},
                     layoutWith(options.skin.normals, drop.layout()));
  const std::string path = summaryPath(output);
  const TriangleMesh obstacles = drop.obstacles();
  const std::string obstaclesPath = (std::filesystem::path(output.out) / "obstacles.obj").string();
  require(ObjLayout::fromMesh(obstacles).writeTo(obstaclesPath, viewOf(obstacles.positions)));

  const Totals totals = drop.simulate(writer);
  const nlohmann::ordered_json json = drop.summarise(totals);
  writeJson(json, path);
  if (!output.quiet) printTable(json, path);
  if (!totals.finite) {
    std::fprintf(stderr, "tetskin_drop: the simulation exploded after frame %d\n", totals.frames - 1);
    return kRunFailed;
  }
  if (!totals.aboveFloor) {
    std::fprintf(stderr, "tetskin_drop: the surface passed through the floor at y = %g, down to y = %g\n",
                 drop.floorY(), totals.lowest);
    return kRunFailed;
  }
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  DropOptions options;
  CommandLine line("A mesh falls on obstacles in Bullet's deformable world, carried by a coarse cage of tetrahedra.");
  line.addModelOptions(options.model);
  line.addInterpolationOption(options.skin);
  line.addSkinOptions(options.skin);
  line.addOutputOptions(options.output);
  line.addFlag("--write-cage", options.writeCage, "Write the cage beside each frame, as cage_0000.vtk, ...");
  return line.run(argc, argv, [&] { return run(options); });
}
