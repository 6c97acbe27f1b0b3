// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The main job: a mesh falls on obstacles in Bullet's deformable world, carried by a coarse cage.
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include <tetskin/reduced/reduced_body.h>

#include "scenes/frame_writer.h"
#include "scenes/input_error.h"
#include "scenes/materials.h"
#include "scenes/obstacles.h"
#include "scenes/player.h"
#include "scenes/printed_table.h"
#include "scenes/recording.h"
#include "scenes/summary.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;

struct DropOptions {
  ModelOptions model;
  Force force = Force::Elastic;
  Contact contact = Contact::Surface;
  SelfContactWish selfContact = SelfContactWish::WherePossible;
  std::string body = "elastic";
  std::size_t modes = 20;
  SkinOptions skin;
  OutputOptions output{"out/drop", "", 240, 1, false, {}, true};
  bool writeCage = false;

  bool reduced() const { return body == "reduced"; }
  /// Bodies in Bullet's solvers have contact only at their nodes.
  bool touchesBySurface() const { return !reduced() && force == Force::Elastic; }
  Contact contactPossible() const { return touchesBySurface() ? contact : Contact::Cage; }
};

/// An explicit request is fulfilled or refused: only the default is replaced by what a body in Bullet's solver can do.
void requireContact(const DropOptions& options, bool given) {
  if (options.touchesBySurface()) return;
  const std::string fault = options.reduced()
                                ? ": a reduced body has contact at its cage's nodes only; "
                                : ": with --elasticity bullet a body has contact at its cage's nodes only; ";
  const std::string cure = options.reduced() ? ", or --body elastic" : ", or --elasticity tetskin";
  if (given && options.contact == Contact::Surface) {
    throw InputError("--contact surface" + fault + "use --contact cage" + cure);
  }
  if (options.selfContact == SelfContactWish::On) {
    throw InputError("--self-contact on" + fault + "use --self-contact off" + cure);
  }
}

/// Seconds. Bullet's neo-Hookean force also damps rocking; with the library's force, only the material itself damps it.
constexpr double kDamping = 0.04;

SceneOptions howOf(const DropOptions& options) {
  SceneOptions how;
  how.force = options.force;
  if (options.force == Force::Elastic) how.body.stiffnessDamping = kDamping;
  if (options.reduced()) how.force = Force::Reduced;
  how.modes = static_cast<int>(options.modes);
  return how;
}

/// A body slower than this over the last half second is at rest, in body lengths per second.
constexpr double kRestSpeed = 0.05;

/// Measurements during the run.
struct Totals {
  double extentMax = 1.0;
  double lowest = HUGE_VAL;
  std::vector<double> speeds;  ///< per frame, in body lengths per second

  double restSpeed() const {
    const std::size_t half = std::min(speeds.size(), static_cast<std::size_t>(kFrameRate / 2));
    double squared = 0.0;
    for (std::size_t k = speeds.size() - half; k < speeds.size(); ++k) squared += speeds[k] * speeds[k];
    return half == 0 ? 0.0 : std::sqrt(squared / static_cast<double>(half));
  }
};

/// The mesh in the scene, with its figures in the mesh's own space.
class Drop {
 public:
  explicit Drop(const DropOptions& options)
      : options_(options),
        player_(options.model, makeObstacles, howOf(options)),
        surface_(player_.carry(options.skin)),
        restExtent_(bounds().sizes().maxCoeff()) {
    if (options.contactPossible() == Contact::Surface) player_.touchBySurface();
    player_.touchItself(wishBeside(options.contactPossible(), options.selfContact));
  }

  const ObjLayout& layout() const { return player_.model().layout; }
  const TriangleMesh& mesh() const { return player_.model().mesh; }
  TriangleMesh obstacles() {
    TriangleMesh mesh = player_.scene().world().obstacles();
    player_.placement().toModel(mesh.positions);
    return mesh;
  }
  double floorY() { return player_.placement().toModel(Eigen::Vector3d(0.0, player_.scene().floorY, 0.0)).y(); }
  const Totals& totals() const { return totals_; }

  /// Records the run that follows.
  Recording& record(const std::string& view);
  Playback simulate(FrameWriter& writer) {
    return player_.play(
        "simulating", options_.output, [&](int) { measure(); }, [&](int frame) { write(frame, writer); });
  }
  nlohmann::ordered_json summarise(const Playback& run);

 private:
  Box3 bounds() const {
    const Box3& box = surface_.skin.bounds();
    return {player_.placement().toModel(box.min()), player_.placement().toModel(box.max())};
  }
  void measure() {
    totals_.extentMax = std::max(totals_.extentMax, bounds().sizes().maxCoeff() / restExtent_);
    totals_.lowest = std::min(totals_.lowest, bounds().min().y());
    totals_.speeds.push_back(player_.scene().nodeSpeed());
    if (recording_ && recording_->wanted()) recording_->keep({{player_.nodes()}, {}});
  }
  void write(int frame, FrameWriter& writer) {
    TetMesh cage;
    if (options_.writeCage) {
      cage = readTetMesh(player_.scene().body());
      player_.placement().toModel(cage.nodes);
    }
    writer.write(frame, surface_.surface, bounds(), surface_.skin.normals(), options_.writeCage ? &cage : nullptr);
  }

  const DropOptions& options_;
  Player player_;
  const Carried& surface_;
  double restExtent_;
  Totals totals_;
  std::optional<Recording> recording_;
};

Recording& Drop::record(const std::string& view) {
  const Model& model = player_.model();
  std::vector<std::string> facts = factsOf(model);
  facts.push_back(factOf(options_.contactPossible(), player_.selfContact().shape != nullptr));
  const std::string title = titleOf(model.name);
  recording_.emplace(options_.output, view, title, facts, options_.skin.interpolation);
  if (!recording_->wanted()) return *recording_;
  const Embedding& embedding = surface_.skin.binding()->embedding();
  recording_->addBody({recording_->addModel(title, model.cage, model.mesh, embedding), "", ""});
  recording_->setObstacles(obstacles());
  return *recording_;
}

nlohmann::ordered_json Drop::summarise(const Playback& run) {
  const double scale = player_.placement().scale, margin = player_.scene().margin() / scale;
  nlohmann::ordered_json json = summaryOf(player_.model(), player_.fit());
  json["body"] = options_.body;
  if (const ReductionReport* reduction = player_.scene().world().reduction()) {
    json["modes"] = reduction->projectionErrors.size();
    json["modes_left_out"] = reduction->skippedModes;
  }
  json["elasticity"] = options_.force == Force::Elastic ? "tetskin" : "bullet";
  json["contact"] = options_.contactPossible() == Contact::Surface ? "surface" : "cage";
  player_.selfContact().tell(json);
  json["simulation_ms_per_frame"] = run.simulationMs / run.steps();
  tellSolve(player_.scene().world().solveTotals(), json);
  StageTimes stages = player_.scene().world().stageTimes();
  stages.skin = 1e-6 * surface_.microseconds;
  json["stages_ms_per_frame"] = toJson(stages, run.steps());
  json["skin_us_per_frame"] = surface_.microseconds / run.steps();
  json["write_ms_per_frame"] = run.writeMs / std::max(1, run.written);
  json["glb_ms"] = recording_->glbMilliseconds();
  json["floor_y"] = floorY();
  json["margin"] = margin;
  json["lowest_y"] = totals_.lowest;
  json["floor_tolerance"] = margin + kFloorTolerance * (kSize / scale);
  json["above_floor"] = run.aboveFloor;
  json["extent_max"] = totals_.extentMax;
  json["rest_speed"] = totals_.restSpeed();
  json["at_rest"] = totals_.restSpeed() < kRestSpeed;
  return json;
}

void printSummary(const nlohmann::ordered_json& json, const OutputOptions& output) {
  const auto number = [&](const char* key, const char* format) { return formatted(format, json, key); };
  std::printf("\n");
  printValue("model", json.at("model").get<std::string>());
  printValue("vertices", number("vertices", "%.0f"));
  printValue("triangles", number("triangles", "%.0f"));
  printValue("nodes", number("nodes", "%.0f"));
  printValue("tets", number("tets", "%.0f"));
  printValue("inside / outside", number("inside", "%.0f") + " / " + number("outside", "%.0f") + " vertices");
  if (json.at("outside") > 0) {
    printValue("farthest outside",
               "vertex " + number("worst_vertex", "%.0f") + ", at a distance of " + number("worst_distance", "%.3g"));
  }
  printValue("embedding", number("attach_ms", "%.2f ms"));
  printValue("rest error", number("rest_error_max", "%.1e of the bounding box's diagonal"));
  printValue("body", json.at("body").get<std::string>() +
                         (json.contains("modes") ? ", " + number("modes", "%.0f modes") : std::string()));
  printValue("elasticity", json.at("elasticity").get<std::string>());
  printValue("contact", json.at("contact").get<std::string>());
  printValue("self-contact", json.at("self_contact").get<std::string>());
  printValue("simulation", number("simulation_ms_per_frame", "%.2f ms per frame"));
  printStages(json.at("stages_ms_per_frame"), nullptr);
  printSolve(json);
  printValue("writing", number("write_ms_per_frame", "%.2f ms per frame"));
  printValue("speed at the end", number("rest_speed", "%.3f body lengths per second"));
  printValue("lowest point", "y = " + number("lowest_y", "%.4g") + "; floor at y = " + number("floor_y", "%.4g") +
                                 ", tolerance " + number("floor_tolerance", "%.2g"));
  printValue("frames", number("frames", "%.0f"));
  printValue("files", firstFileOf(output) + " ... " + summaryPath(output));
}

int run(const DropOptions& options) {
  const OutputOptions& output = options.output;
  const std::string view = viewPath(output);
  Drop drop(options);
  FramePlan plan = framePlanOf(output);
  plan.cages = options.writeCage;
  plan.obstacles = drop.obstacles();
  if (options.model.mesh.empty()) plan.materials = materialLibrary(drop.mesh());
  FrameWriter writer(plan, layoutWith(options.skin.normals, drop.layout()));
  Recording& recording = drop.record(view);
  if (recording.hasGlb()) writer.addOther(Recording::kGlbName, recording.glbBytes());

  const Playback run = drop.simulate(writer);
  const int status = finishRun(
      "tetskin_drop", output, run, writer, recording, [&] { return drop.summarise(run); },
      [&](const nlohmann::ordered_json& json) { printSummary(json, output); });
  if (status == kDone && !run.aboveFloor) {
    std::fprintf(stderr, "tetskin_drop: the surface passed through the floor at y = %g, down to y = %g\n",
                 drop.floorY(), drop.totals().lowest);
    return kRunFailed;
  }
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  DropOptions options;
  CommandLine line(
      "Drops a mesh onto obstacles in Bullet's deformable world, embedded in a coarse cage of tetrahedra.",
      {{{"tetskin_drop", "the built-in serpent: out/drop/frame_0000.obj, ..., and summary.json"},
        {"tetskin_drop --mesh yours.obj --tets 1000 --calibrate", "your mesh, in a coarser and calibrated cage"},
        {"tetskin_drop --interpolation quadratic --normals transformed --write-cage",
         "a smoother surface with normals, and the cage of each frame"}},
       "the simulation exploded, or the surface passed through the floor"});
  line.addModelOptions(options.model);
  line.addElasticityOption(options.force, "bullet: neo-Hookean force, with contact at the cage's nodes");
  line.addWord("--body", options.body, {"elastic", "reduced"});
  line.addCount("--modes", options.modes);
  line.addCount("--fine-tets", options.model.fineTets, "", static_cast<int>(Limits::kMaxTargetTets));
  line.addContactOption(options.contact);
  line.addSelfContactOption(options.selfContact);
  line.addInterpolationOption(options.skin);
  line.addSkinOptions(options.skin);
  line.addOutputOptions(options.output);
  line.addFlag("--write-cage", options.writeCage);
  return line.run(argc, argv, [&] {
    requireContact(options, line.given("--contact"));
    for (const char* name : {"--modes", "--fine-tets"}) {
      if (line.given(name) && !options.reduced()) throw InputError(std::string(name) + " needs --body reduced");
    }
    options.model.quiet = options.output.quiet;
    options.model.loaded = [&](const TriangleMesh& mesh, const ObjLayout& layout) {
      requireRoomFor(mesh, layout, options.output);
    };
    return run(options);
  });
}
