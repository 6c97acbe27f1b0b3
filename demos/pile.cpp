// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Soft bodies of three models fall into a bowl, some of them across thin poles, or many of them into a heap, and lie on
// each other as drawn. Prints their penetration depth and run time once per second.
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/threads/thread_pool.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <set>

#include "scenes/caged_mesh.h"
#include "scenes/command_line.h"
#include "scenes/deepest_vertex.h"
#include "scenes/frame_writer.h"
#include "scenes/input_error.h"
#include "scenes/joined_mesh.h"
#include "scenes/placement.h"
#include "scenes/playback.h"
#include "scenes/printed_table.h"
#include "scenes/recording.h"
#include "scenes/stage_times.h"
#include "scenes/summary.h"
#include "scenes/timer.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;
using Eigen::Vector3d;

constexpr int kFramesPerSecond = 60;
constexpr int kMaxThreads = 256;

/// Of the scene "heap": 330,000 vertices in all.
constexpr int kHeapBodies = 26;
constexpr std::size_t kHeapTriangles = 24700;
/// Pairs of bodies that touch in a heap.
constexpr std::size_t kManyPairs = 40;

struct PileOptions {
  std::string scene = "column";  ///< one body above the other, over poles; or "heap": layers of four
  int bodies = 10;
  int depthEvery = kFramesPerSecond;  ///< frames between two measurements of the deepest vertex
  int seed = 1;                       ///< of the bodies' rotations before they fall
  int threads = 1;                    ///< threads of the solver and of the skins, including the calling one
  ModelOptions model;                 ///< if it has no mesh: the options common to all of kModels
  Contact contact = Contact::Surface;
  SelfContactWish selfContact = SelfContactWish::WherePossible;
  OutputOptions output{"out/pile", "", 600, 1, false};

  bool isHeap() const { return scene == "heap"; }

  bool touchThemselves() const { return wishBeside(contact, selfContact) != SelfContactWish::Off; }
};

constexpr double kFrame = 1.0 / kFramesPerSecond;
constexpr std::array<BuiltIn, 3> kModels = {BuiltIn::Serpent, BuiltIn::Hand, BuiltIn::Bar};
/// Lengths in the world; the largest side of each body is kSize.
constexpr double kApart = 1.1 * kSize, kFloorY = 0.0, kSide = 1.1 * kSize, kPole = 0.02 * kSize;
/// A body farther from the bowl than any can be thrown has exploded.
constexpr double kMaxCoordinate = 100.0 * kSize;

/// A model scaled to the world about the origin, and what all bodies of it share.
struct PileModel {
  explicit PileModel(const ModelOptions& options) : model(loadModel(options)) {
    putInWorld(model.mesh, model.cage);
    auto made = ContactShape::create(model.cage, model.mesh);
    if (!made.ok()) throw InputError(model.name + ": " + made.status().message);
    shape = made.value();
    binding = boundTo(model.cage, model.mesh);
  }

  Model model;
  std::shared_ptr<const ContactShape> shape;
  std::shared_ptr<const SoftBodyBinding> binding;
};

/// A floor inside four walls, two of which lean outwards.
void addBowl(World& world) {
  const double height = kSize, thick = 0.25 * kSize;
  world.addBox({0, kFloorY - thick, 0}, {4 * kSide, thick, 4 * kSide});
  for (const double side : {-1.0, 1.0}) {
    world.addBox({side * (kSide + thick + 0.35 * height), 0.5 * height, 0}, {thick, height, kSide}, -side * 0.45);
    world.paint("wall");
    world.addBox({0, 0.5 * height, side * (kSide + thick)}, {2 * kSide, height, thick});
    world.paint("wall");
  }
}

/// Two poles across the bowl.
void addPoles(World& world) {
  for (const double side : {-1.0, 1.0}) {
    world.addBox({side * 0.45 * kSize, 1.6 * kSize, 0}, {kPole, kPole, kSide});
    world.paint("pole");
  }
}

/// Centre of the k-th body before it falls: above the one before.
Vector3d placeInColumn(int k) {
  return {0.12 * kSize * (k % 2 ? 1 : -1), kFloorY + 2.4 * kSize + kApart * k, 0.1 * kSize * (k / 2 % 2)};
}

/// In layers of four.
Vector3d placeInHeap(int k) {
  const double half = 0.5 * kApart;
  return {k % 2 ? half : -half, kFloorY + kSize + kApart * (k / 4), k / 2 % 2 ? half : -half};
}

/// Rotation of the k-th body before it falls. Piles are chaotic: what holds in one need not hold in another.
Eigen::Quaterniond turnOf(int seed, int k) {
  if (seed == 1) return Eigen::Quaterniond(Eigen::AngleAxisd(1.1 * k, Vector3d(0.3, 1.0, 0.2).normalized()));
  std::seed_seq numbers{seed, k};
  std::mt19937 random(numbers);
  Eigen::Vector4d turn;
  do {
    for (double& part : turn) part = 2.0 * static_cast<double>(random()) / std::mt19937::max() - 1.0;
  } while (turn.norm() < 0.1 || turn.norm() > 1.0);  // uniform among all rotations
  return Eigen::Quaterniond(turn.normalized());
}

Cage placedAt(const Vector3d& at, const Eigen::Quaterniond& turn, Cage cage) {
  for (Vector3d& p : cage.mesh.nodes) p = turn * p + at;
  return cage;
}

class Pile {
 public:
  explicit Pile(const PileOptions& options) : world_(Force::Elastic, btVector3(0, btScalar(-kEarth), 0)) {
    ModelOptions model = options.model;
    if (!model.mesh.empty()) models_.emplace_back(model);
    for (const BuiltIn builtIn : kModels) {
      model.builtIn = builtIn;
      if (model.mesh.empty()) models_.emplace_back(model);
    }
    world_.leaveOutNodeNormals();
    addBowl(world_);
    if (!options.isHeap()) addPoles(world_);
    if (options.threads > 1) world_.setThreads(&threads_.emplace(static_cast<std::size_t>(options.threads)));
    for (int k = 0; k < options.bodies; ++k) add(models_[static_cast<std::size_t>(k) % models_.size()], k, options);
  }

  const World& world() const { return world_; }
  const TriangleMesh& mesh() const { return mesh_; }
  const TriangleMesh& obstacles() const { return world_.obstacles(); }
  /// Returns false if a body has exploded.
  bool step();
  /// The surfaces of all bodies, one after the other.
  std::vector<Vector3d> surface() const;
  /// Tests every vertex against the surfaces of all other bodies; the depth is in units of the body's size.
  DeepestVertex deepestVertex() const;
  /// Distance at the deepest contact between bodies, over the body's size; 0 or negative.
  double deepest() const;
  std::size_t tetCount() const { return bodyTets_; }
  std::size_t contactCount() const { return world_.softContacts().size(); }
  /// Pairs of bodies that touch each other.
  std::size_t pairCount() const;
  /// Root mean square of the nodes' speeds, in body lengths per second.
  double nodeSpeed() const { return scenes::nodeSpeed(bodies_) / kSize; }
  /// Of all steps so far.
  StageTimes stageTimes() const;

  /// Records the run that follows. Bodies of one model share it there.
  Recording record(const PileOptions& options, const std::string& view) const;
  ViewMoment moment() const;

 private:
  void add(const PileModel& model, int k, const PileOptions& options);

  std::optional<ThreadPool> threads_;
  World world_;
  std::deque<PileModel> models_;
  std::vector<btSoftBody*> bodies_;
  std::size_t bodyTets_ = 0;
  std::deque<SoftBodySkin> skins_;
  std::vector<SoftBodySkin*> skinPointers_;
  std::vector<StatusCode> statuses_;  ///< of the last updates
  double skinSeconds_ = 0.0;          ///< of all updates so far
  TriangleMesh mesh_;
};

void Pile::add(const PileModel& model, int k, const PileOptions& options) {
  const Vector3d at = options.isHeap() ? placeInHeap(k) : placeInColumn(k);
  btSoftBody& body = world_.add(placedAt(at, turnOf(options.seed, k), model.model.cage), oneKilogram());
  if (options.contact == Contact::Surface) world_.touchBySurface(body, *model.binding, model.model.mesh);
  world_.touchEachOther(body, model.shape, options.touchThemselves());
  bodies_.push_back(&body);
  require(skins_.emplace_back().bind(body, model.binding));
  skinPointers_.push_back(&skins_.back());
  bodyTets_ += model.model.cage.mesh.tetCount();
  (void)append(model.model.mesh, mesh_, model.model.name);
}

bool Pile::step() {
  constexpr int kSubsteps = 4;
  for (int s = 0; s < kSubsteps; ++s) world_.step(kFrame / kSubsteps);
  statuses_.resize(skins_.size());
  const WallTimer timer;
  (void)SoftBodySkin::updateAll(skinPointers_.data(), skins_.size(), statuses_.data(), 1,
                                threads_ ? &*threads_ : nullptr);
  skinSeconds_ += timer.seconds();
  const bool followed = std::all_of(statuses_.begin(), statuses_.end(), [](StatusCode status) {
    return status == StatusCode::Ok || status == StatusCode::Asleep;
  });
  return followed && std::all_of(skins_.begin(), skins_.end(), [](const SoftBodySkin& skin) {
           return maxCoordinate(skin.bounds()) < kMaxCoordinate;
         });
}

StageTimes Pile::stageTimes() const {
  StageTimes times = world_.stageTimes();
  times.skin = skinSeconds_;
  return times;
}

std::vector<Vector3d> Pile::surface() const {
  std::vector<Vector3d> points;
  for (const SoftBodySkin& skin : skins_) {
    for (std::size_t v = 0; v < skin.positions().size(); ++v) {
      const btScalar* p = skin.positions()[v];
      points.emplace_back(p[0], p[1], p[2]);
    }
  }
  return points;
}

DeepestVertex Pile::deepestVertex() const {
  std::vector<TriangleMesh> surfaces;
  for (std::size_t k = 0; k < skins_.size(); ++k) {
    TriangleMesh& surface = surfaces.emplace_back();
    surface.triangles = models_[k % models_.size()].model.mesh.triangles;
    for (std::size_t v = 0; v < skins_[k].positions().size(); ++v) {
      const btScalar* p = skins_[k].positions()[v];
      surface.positions.emplace_back(p[0], p[1], p[2]);
    }
  }
  DeepestVertex deepest = scenes::deepestVertex(surfaces);
  deepest.depth /= kSize;
  return deepest;
}

double Pile::deepest() const {
  double deepest = 0.0;
  for (const SoftContact& c : world_.softContacts()) deepest = std::min(deepest, static_cast<double>(c.distance));
  return deepest / kSize;
}

std::size_t Pile::pairCount() const {
  std::set<std::pair<const btSoftBody*, const btSoftBody*>> pairs;
  for (const SoftContact& c : world_.softContacts()) {
    if (c.body != c.other) pairs.insert(std::minmax(c.body, c.other));
  }
  return pairs.size();
}

Recording Pile::record(const PileOptions& options, const std::string& view) const {
  const Contact contact = options.contact;
  Recording recording(options.output, view, "pile",
                      {std::to_string(bodies_.size()) + " soft bodies", withCommas(mesh_.vertexCount()) + " vertices",
                       withCommas(bodyTets_) + " tets",
                       contact == Contact::Surface ? factOf(contact, options.touchThemselves())
                                                   : "contact with the bowl at the cages' nodes"},
                      Interpolation::Linear);
  if (!recording.wanted()) return recording;
  for (const PileModel& model : models_) {
    recording.addModel(titleOf(model.model.name), model.model.cage, model.model.mesh, model.binding->embedding());
  }
  for (std::size_t k = 0; k < bodies_.size(); ++k) recording.addBody({k % models_.size(), "", ""});
  recording.setObstacles(obstacles());
  recording.setFocus({Vector3d(-1.5 * kSide, kFloorY, -kSide), Vector3d(1.5 * kSide, kFloorY + 2.0 * kSize, kSide)});
  return recording;
}

ViewMoment Pile::moment() const {
  ViewMoment moment;
  for (const btSoftBody* body : bodies_) moment.bodies.push_back(nodesOf(*body));
  return moment;
}

/// Of a frame, or the mean of several.
struct FrameTime {
  double wall = 0.0;       ///< milliseconds
  double processor = 0.0;  ///< milliseconds of all threads together
};

FrameTime meanOf(const std::vector<FrameTime>& frames, std::size_t first, std::size_t count) {
  FrameTime mean;
  for (std::size_t k = first; k < first + count; ++k) {
    mean.wall += frames[k].wall / static_cast<double>(count);
    mean.processor += frames[k].processor / static_cast<double>(count);
  }
  return mean;
}

struct SlowestSecond {
  FrameTime mean;
  StageTimes stages;
};

/// What is measured during the run, and the table of it.
class Measurements {
 public:
  Measurements(const Pile& pile, const PileOptions& options) : pile_(pile), options_(options) {}

  /// time  that the frame has taken; frame 0 took none
  void measure(int frame, const FrameTime& time) {
    stages_.push_back(pile_.stageTimes());
    if (frame > 0) {
      times_.push_back(time);
      pairs_.push_back(pile_.pairCount());
    }
    deepestContact = std::min(deepestContact, pile_.deepest());
    const bool asked = frame % options_.depthEvery == 0, second = frame % kFramesPerSecond == 0;
    const bool last = frame + 1 == options_.output.frames;
    if (!asked && !second && !last) return;
    latest = pile_.deepestVertex();
    if (latest.depth > deepest.depth) {
      deepest = latest;
      deepestFrame = frame;
    }
    if (second || last) addRow(frame);
  }
  std::string table() const { return table_.text(); }
  FrameTime meanTime() const { return meanOf(times_, 0, times_.size()); }
  /// The slowest second in all of which kManyPairs bodies touch; nothing if there is none.
  std::optional<SlowestSecond> slowestSecond() const;

  double deepestContact = 0.0;  ///< over all frames, in units of the body's size; 0 or negative
  DeepestVertex deepest, latest;
  int deepestFrame = 0;

 private:
  /// Times are those of the frames since the previous row.
  void addRow(int frame) {
    const SolveTotals totals = pile_.world().solveTotals();
    const int steps = totals.steps - before_.steps;
    const FrameTime time = meanOf(times_, told_, times_.size() - told_);
    const auto perStep = [&](const char* format, double number) {
      return steps == 0 ? "-" : formatted(format, number);
    };
    table_.add({formatted("%.2f", frame * kFrame), std::to_string(pile_.contactCount()),
                std::to_string(pile_.pairCount()), formatted("%.2f", 100.0 * latest.depth),
                std::to_string(latest.count), formatted("%.2f", 100.0 * std::abs(pile_.deepest())),
                formatted("%.3f", pile_.nodeSpeed()),
                perStep("%.1f", static_cast<double>(totals.iterations - before_.iterations) / steps),
                perStep("%.2f", time.wall), perStep("%.2f", time.processor)});
    before_ = totals;
    told_ = times_.size();
  }

  const Pile& pile_;
  const PileOptions& options_;
  PrintedTable table_{{{"time", "s"},
                       {"contacts", ""},
                       {"pairs", ""},
                       {"deepest vertex", "% of size"},
                       {"vertices inside", ""},
                       {"deepest contact", "% of size"},
                       {"RMS node speed", "body lengths/s"},
                       {"iterations", "per step"},
                       {"simulation", "ms/frame"},
                       {"processor", "ms/frame"}}};
  SolveTotals before_;
  std::vector<FrameTime> times_;    ///< of frames from 1 on
  std::vector<std::size_t> pairs_;  ///< of bodies that touch, in the same frames
  std::vector<StageTimes> stages_;  ///< until the end of each frame, 0 included
  std::size_t told_ = 0;            ///< number of times that are in the table
};

std::optional<SlowestSecond> Measurements::slowestSecond() const {
  std::optional<SlowestSecond> slowest;
  std::size_t touching = 0;  // the last frames in a row in which many pairs touch
  for (std::size_t k = 0; k < times_.size(); ++k) {
    touching = pairs_[k] < kManyPairs ? 0 : touching + 1;
    if (touching < kFramesPerSecond) continue;
    const FrameTime mean = meanOf(times_, k + 1 - kFramesPerSecond, kFramesPerSecond);
    if (slowest && mean.wall <= slowest->mean.wall) continue;
    slowest = SlowestSecond{mean, stages_[k + 1] - stages_[k + 1 - kFramesPerSecond]};
  }
  return slowest;
}

nlohmann::ordered_json summarise(const PileOptions& options, const Pile& pile, const Measurements& measured,
                                 const Playback& run) {
  nlohmann::ordered_json json;
  json["scene"] = options.scene;
  json["bodies"] = options.bodies;
  json["vertices"] = pile.mesh().vertexCount();
  json["tets"] = pile.tetCount();
  json["contact"] = options.contact == Contact::Surface ? "surface" : "cage";
  json["self_contact"] = options.touchThemselves() ? "on" : "off";
  json["seed"] = options.seed;
  json["threads"] = options.threads;
  json["simulation_ms_per_frame"] = run.simulationMs / run.steps();
  json["processor_ms_per_frame"] = measured.meanTime().processor;
  const std::optional<SlowestSecond> slowest = measured.slowestSecond();
  json["slowest_second_ms_per_frame"] = slowest ? nlohmann::ordered_json(slowest->mean.wall) : nullptr;
  json["slowest_second_processor_ms_per_frame"] = slowest ? nlohmann::ordered_json(slowest->mean.processor) : nullptr;
  json["stages_ms_per_frame"] = toJson(pile.stageTimes(), run.steps());
  json["slowest_second_stages_ms_per_frame"] =
      slowest ? toJson(slowest->stages, kFramesPerSecond) : nlohmann::ordered_json();
  tellSolve(pile.world().solveTotals(), json);
  json["deepest_vertex"] = -measured.deepest.depth;
  json["deepest_vertex_frame"] = measured.deepestFrame;
  json["deepest_vertex_bodies"] = {measured.deepest.body, measured.deepest.other};
  json["deepest_vertex_at_end"] = -measured.latest.depth;
  json["deepest_vertex_at_end_bodies"] = {measured.latest.body, measured.latest.other};
  json["vertices_inside_at_end"] = measured.latest.count;
  json["deepest_contact"] = measured.deepestContact;
  json["deepest_contact_at_end"] = pile.deepest();
  json["contacts_at_end"] = pile.contactCount();
  json["pairs_at_end"] = pile.pairCount();
  json["node_speed_at_end"] = pile.nodeSpeed();
  return json;
}

/// 0 to bodies - 1, in the order in which they were added.
std::string bodiesOf(const nlohmann::ordered_json& pair) {
  if (pair[0] == pair[1]) return "";
  return ", of body " + pair[0].dump() + " in body " + pair[1].dump();
}

void printSummary(const nlohmann::ordered_json& json, const PileOptions& options) {
  const auto percent = [&](const char* key) {
    return formatted("%.2f %% of the body's size", 100.0 * std::abs(json.at(key).get<double>()));
  };
  const std::string measured =
      options.depthEvery == 1 ? "in every frame" : "every " + std::to_string(options.depthEvery) + " frames";
  printValue("bodies", formatted("%.0f", json, "bodies") + formatted(", %.0f vertices", json, "vertices") +
                           formatted(", %.0f tets", json, "tets"));
  printValue("contact", json.at("contact").get<std::string>());
  printValue("self-contact", json.at("self_contact").get<std::string>());
  printValue("simulation", formatted("%.2f ms per frame, ", json, "simulation_ms_per_frame") +
                               formatted("%.2f ms of processor time", json, "processor_ms_per_frame"));
  if (!json.at("slowest_second_ms_per_frame").is_null()) {
    printValue("slowest second", formatted("%.2f ms per frame, ", json, "slowest_second_ms_per_frame") +
                                     formatted("%.2f ms of processor time; of those in which ", json,
                                               "slowest_second_processor_ms_per_frame") +
                                     std::to_string(kManyPairs) + " pairs of bodies touch");
  }
  printStages(json.at("stages_ms_per_frame"), json.at("slowest_second_stages_ms_per_frame"));
  printSolve(json);
  printValue("deepest vertex", percent("deepest_vertex") + formatted(", in frame %.0f", json, "deepest_vertex_frame") +
                                   bodiesOf(json.at("deepest_vertex_bodies")) + " (measured " + measured + "); " +
                                   percent("deepest_vertex_at_end") + " at the end");
  printValue("deepest contact", percent("deepest_contact") + ", as the solver measures it; " +
                                    percent("deepest_contact_at_end") + " at the end");
  printValue("speed at the end", formatted("%.3f body lengths per second", json, "node_speed_at_end"));
  printValue("frames", formatted("%.0f", json, "frames"));
  printValue("files", firstFileOf(options.output) + " ... " + summaryPath(options.output));
}

int run(const PileOptions& options) {
  const OutputOptions& output = options.output;
  const std::string view = viewPath(output);
  Pile pile(options);
  FrameWriter writer(framePlanOf(output, pile.mesh(), pile.obstacles()), ObjLayout::create(pile.mesh()));
  Recording recording = pile.record(options, view);
  if (recording.hasGlb()) writer.addOther(Recording::kGlbName, recording.glbBytes());
  Measurements measured(pile, options);
  FrameTime time;
  const auto step = [&](int frame, Playback& run) {
    const WallTimer wall;
    const ProcessTimer processor;
    const bool finite = frame == 0 || pile.step();
    time = {wall.milliseconds(), processor.milliseconds()};
    run.simulationMs += time.wall;
    return finite;
  };
  const auto measure = [&](int frame) {
    measured.measure(frame, time);
    if (recording.wanted()) recording.keep(pile.moment());
  };
  const auto write = [&](int frame) {
    const std::vector<Vector3d> surface = pile.surface();
    writer.write(frame, surface, boundingBox(surface), {});
  };
  const Playback run = playFrames("simulating", output, pile.world(), step, measure, write);
  return finishRun(
      "tetskin_pile", output, run, writer, recording, [&] { return summarise(options, pile, measured, run); },
      [&](const nlohmann::ordered_json& json) {
        std::printf("\n%s\n", measured.table().c_str());
        printSummary(json, options);
      });
}

}  // namespace

int main(int argc, char** argv) {
  PileOptions options;
  options.model.tets = 500;
  options.model.triangles = 20000;
  CommandLine line(
      "Drops soft bodies of three models, or of your mesh, into a bowl, some across thin poles and onto each other. "
      "Prints contacts, depths and run time once per second.",
      {{{"tetskin_pile", "ten bodies: out/pile/frame_0000.obj, ..., and summary.json"},
        {"tetskin_pile --scene heap",
         "26 bodies with 330,000 vertices, in calibrated cages, in layers and without poles"},
        {"tetskin_pile --mesh yours.obj", "ten copies of your mesh, which must be closed"},
        {"tetskin_pile --frames 100 --depth-every 1", "the impacts, with the deepest vertex of every frame"},
        {"tetskin_pile --bodies 3 --contact cage", "three bodies that touch the bowl by the nodes of their cages"}},
       "the simulation exploded"});
  line.addInput("--mesh", options.model.mesh, "closed", CommandLine::Need::Optional, "three built-in models");
  line.addWord(
      "--scene", options.scene, {"column", "heap"},
      "column: bodies fall one after the other, some across poles; heap: in layers of four, 26 bodies of 24,700 "
      "triangles in calibrated cages where nothing else is given");
  line.addCount("--triangles", options.model.triangles, "each", 500000);
  line.addCount("--tets", options.model.tets, "each", 20000);
  line.addFlag("--calibrate", options.model.calibrate);
  line.addCount("--bodies", options.bodies, "", 100);
  line.addCount("--seed", options.seed, "Of the bodies' rotations before they fall; 1: fixed ones", 1000000);
  line.addCount("--threads", options.threads, "Threads of the solver and of the surfaces; they change no result",
                kMaxThreads);
  line.addContactOption(options.contact);
  line.addSelfContactOption(options.selfContact);
  line.addCount("--depth-every", options.depthEvery,
                "Measure the deepest vertex every Nth frame, as well as once per second: each vertex against the "
                "surfaces of all other bodies",
                1000000);
  line.addOutputOptions(options.output);
  return line.run(argc, argv, [&] {
    options.model.quiet = options.output.quiet;
    if (options.isHeap()) {
      if (!line.given("--bodies")) options.bodies = kHeapBodies;
      if (!line.given("--triangles")) options.model.triangles = kHeapTriangles;
      options.model.calibrate = true;
    }
    return run(options);
  });
}
