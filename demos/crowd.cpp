// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Hundreds of bodies share one binding, most of them asleep or hidden: the cost of each part of a skin's work, and the
// saving if it is left out. Skins are timed separately from Bullet's step, each pass with cold caches, and the variants
// take turns.
#include <tetskin/bullet/soft_body_skin.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <nlohmann/json.hpp>

#include "scenes/caged_mesh.h"
#include "scenes/command_line.h"
#include "scenes/crowd.h"
#include "scenes/files.h"
#include "scenes/input_error.h"
#include "scenes/memory.h"
#include "scenes/progress.h"
#include "scenes/statistics.h"
#include "scenes/summary.h"
#include "scenes/system.h"
#include "scenes/table.h"
#include "scenes/timer.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;

/// Simulated before anything is measured: sleeping bodies must stay asleep, and must not move.
constexpr int kSimulatedFrames = 2;
constexpr int kSubsteps = 4;  ///< per frame

struct CrowdOptions {
  ModelOptions model;
  std::size_t bodies = 500;
  int frames = 15;
  std::string json;
  bool quiet = false;
};

/// A check failed: exit status 1.
struct CheckFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A skin for each of several bodies.
struct Skins {
  std::vector<SoftBodySkin> all;
  std::vector<SoftBodySkin*> pointers;  ///< to all of these skins
  double bindMs = 0.0;
  std::size_t bytes = 0;  ///< of the skins and their bindings

  std::size_t update() { return SoftBodySkin::updateAll(pointers.data(), pointers.size()); }
};

/// Leaves out everything that a scene may leave out.
SkinOptions minOptions() {
  SkinOptions options;
  options.order = VertexOrder::Sorted;
  options.bounds = false;
  return options;
}

/// bindingEach  a separate binding for every body; otherwise they share the first one's
Skins bindAll(const std::vector<btSoftBody*>& bodies, const Model& model, const SkinOptions& options,
              bool bindingEach) {
  const InstanceOptions& instance = options;
  const std::size_t before = heapBytes();
  const WallTimer timer;
  Skins skins;
  skins.all.resize(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    skins.pointers.push_back(&skins.all[i]);
    if (i == 0 || bindingEach) {
      require(skins.all[i].bind(*bodies[i], model.cage, model.mesh, options).status());
    } else {
      require(skins.all[i].bind(*bodies[i], skins.all[0].binding(), instance));
    }
  }
  skins.bindMs = timer.milliseconds();
  skins.bytes = heapBytes() - before;
  return skins;
}

/// What is timed, and the results.
struct Variant {
  std::string name;
  Skins* skins;
  bool asleep = false;  ///< nine of ten bodies are asleep
  bool hidden = false;  ///< the skins of nine of ten bodies are hidden
  bool everySubstep = false;
  bool stepped = true;  ///< false: the frame had no substep
  std::vector<double> microseconds = {};
  std::size_t updates = 0;  ///< in one frame
};

/// Brings bodies and skins into the variant's state, and does everything that happens only once: the last update of a
/// body that fell asleep, the update of a skin that is shown again.
void prepare(Variant& variant, Scene& crowd) {
  setAsleep(crowd, variant.asleep);
  for (std::size_t i = 0; i < variant.skins->all.size(); ++i) {
    variant.skins->all[i].setVisible(alwaysAwake(i) || !variant.hidden);
  }
  (void)variant.skins->update();
}

void timeOnce(Variant& variant, Scene& crowd, CacheEviction& caches) {
  prepare(variant, crowd);
  const int substeps = variant.stepped ? kSubsteps : crowd.world().step(0.0);
  variant.updates = 0;
  double total = 0.0;
  for (int k = 0; k < (variant.everySubstep ? substeps : 1); ++k) {
    caches.evict();
    const WallTimer timer;
    if (substeps > 0) variant.updates += variant.skins->update();
    total += timer.microseconds();
  }
  variant.microseconds.push_back(total);
}

/// The expected number of updates per frame of the variant.
std::size_t expectedUpdates(const Variant& variant) {
  const std::size_t bodies = variant.skins->all.size();
  if (!variant.stepped) return 0;
  return (variant.asleep || variant.hidden ? awakeAmong(bodies) : bodies) * (variant.everySubstep ? kSubsteps : 1);
}

/// A row of the table: a measured variant, named after what it leaves out, and the variant that does not leave it out.
struct Row {
  const char* name;
  const char* measured;
  const char* against;  ///< name of another row, or null
};

constexpr Row kRows[] = {
    {"all awake, every substep", "every substep", nullptr},
    {"all awake, once per frame", "once per frame", "all awake, every substep"},
    {"sleeping bodies skipped", "asleep", "all awake, once per frame"},
    {"hidden skins skipped", "hidden", "all awake, once per frame"},
    {"no substep, no update", "no substep", "all awake, once per frame"},
    {"one binding per body", "binding each", nullptr},
    {"one shared binding", "once per frame", "one binding per body"},
    {"only awake bodies", "alone", nullptr},
    {"normals recomputed", "recomputed", nullptr},
    {"normals transformed", "transformed", "normals recomputed"},
    {"normals none", "alone", "normals transformed"},
    {"quadratic", "quadratic", nullptr},
    {"linear", "alone", "quadratic"},
    {"mesh order", "mesh order", nullptr},
    {"sorted order", "alone", "mesh order"},
    {"bounds on", "bounds", nullptr},
    {"bounds off", "alone", "bounds on"},
    {"previous positions on", "previous", nullptr},
    {"previous positions off", "alone", "previous positions on"},
};

class Measurement {
 public:
  explicit Measurement(const CrowdOptions& options) : options_(options), model_(loadModel(options.model)) {
    EmbedReport fit;
    const Status embedded = embed(model_.cage, model_.mesh, {}, &fit).status();
    requireFit(embedded, fit, options.model);
    putInWorld(model_.mesh, model_.cage);
    SceneOptions scene;
    scene.bodies = options.bodies;
    scene.substeps = kSubsteps;
    crowd_ = sceneNamed("crowd").make(model_.cage, scene);
    for (std::size_t i = 0; i < crowd_->bodyCount(); ++i) {
      everybody_.push_back(&crowd_->body(i));
      if (alwaysAwake(i)) awake_.push_back(&crowd_->body(i));
    }
  }

  nlohmann::ordered_json run() {
    addVariants();
    simulate();
    Progress progress("measuring", options_.frames, options_.quiet);
    for (int frame = 0; frame < options_.frames; ++frame) {
      for (Variant& variant : variants_) {
        timeOnce(variant, *crowd_, caches_);
        if (variant.updates != expectedUpdates(variant)) {
          throw CheckFailed(variant.name + ": " + std::to_string(variant.updates) + " updates in one frame, expected " +
                            std::to_string(expectedUpdates(variant)));
        }
      }
      progress.show(frame + 1);
    }
    return summarise();
  }

 private:
  Skins* add(const std::vector<btSoftBody*>& bodies, const SkinOptions& skin, bool bindingEach = false) {
    skins_.push_back(bindAll(bodies, model_, skin, bindingEach));
    return &skins_.back();
  }

  void addVariants() {
    const SkinOptions least = minOptions();
    Skins* everybody = add(everybody_, least);
    variants_.push_back({"alone", add(awake_, least)});
    variants_.push_back({"asleep", everybody, true});
    variants_.push_back({"every substep", everybody, false, false, true});
    variants_.push_back({"once per frame", everybody});
    variants_.push_back({"hidden", everybody, false, true});
    variants_.push_back({"no substep", everybody, false, false, false, false});
    variants_.push_back({"binding each", add(everybody_, least, true)});
    const auto aloneWith = [&](const char* name, const auto& change) {
      SkinOptions skin = least;
      change(skin);
      variants_.push_back({name, add(awake_, skin)});
    };
    aloneWith("recomputed", [](SkinOptions& skin) { skin.normals = Normals::Recomputed; });
    aloneWith("transformed", [](SkinOptions& skin) { skin.normals = Normals::Transformed; });
    aloneWith("quadratic", [](SkinOptions& skin) { skin.interpolation = Interpolation::Quadratic; });
    aloneWith("mesh order", [](SkinOptions& skin) { skin.order = VertexOrder::Mesh; });
    aloneWith("bounds", [](SkinOptions& skin) { skin.bounds = true; });
    aloneWith("previous", [](SkinOptions& skin) { skin.previousPositions = true; });
  }

  /// Measures Bullet's own cost, and checks that sleep is Bullet's: its steps leave sleeping bodies asleep and in
  /// place.
  void simulate() {
    Skins& everybody = *variants_.front().skins;
    setAsleep(*crowd_, true);
    (void)everybody.update();
    const std::size_t awake = awakeAmong(crowd_->bodyCount());
    const WallTimer timer;
    for (int frame = 1; frame <= kSimulatedFrames; ++frame) {
      if (crowd_->step(frame) == 0) throw CheckFailed("Bullet made no substep in one frame");
    }
    simulationMs_ = timer.milliseconds() / kSimulatedFrames;
    if (asleepCount(*crowd_) != crowd_->bodyCount() - awake || everybody.update() != awake) {
      throw CheckFailed("bodies that were put to sleep woke up");
    }
    if (crowd_->world().step(0.0) != 0) throw CheckFailed("Bullet made a substep although no time passed");
  }

  const Variant& measured(const std::string& name) const {
    return *std::find_if(variants_.begin(), variants_.end(), [&](const Variant& v) { return v.name == name; });
  }

  /// Compares frames next to each other, so that a slow moment of the machine affects both.
  double asleepOverheadPercent() const {
    std::vector<double> ratios;
    for (std::size_t k = 0; k < static_cast<std::size_t>(options_.frames); ++k) {
      ratios.push_back(measured("asleep").microseconds[k] / measured("alone").microseconds[k]);
    }
    return 100.0 * (median(ratios) - 1.0);
  }

  nlohmann::ordered_json rowJson(const Row& row) const {
    const Variant& variant = measured(row.measured);
    const double microseconds = median(variant.microseconds);
    nlohmann::ordered_json json;
    json["variant"] = row.name;
    json["bodies"] = variant.skins->all.size();
    json["bodies_updated"] = variant.updates / (variant.everySubstep ? kSubsteps : 1);
    json["updates"] = variant.updates;
    json["us_per_frame"] = microseconds;
    json["compared_with"] = row.against ? nlohmann::ordered_json(row.against) : nullptr;
    json["saved_percent"] = nullptr;
    if (row.against) {
      const Row& against = *std::find_if(std::begin(kRows), std::end(kRows),
                                         [&](const Row& r) { return std::string(r.name) == row.against; });
      json["saved_percent"] = 100.0 * (1.0 - microseconds / median(measured(against.measured).microseconds));
    }
    json["bytes"] = variant.skins->bytes;
    json["bind_ms"] = variant.skins->bindMs;
    return json;
  }

  nlohmann::ordered_json summarise() const {
    nlohmann::ordered_json json = summaryOf(model_);
    json["bodies"] = crowd_->bodyCount();
    json["asleep"] = everybody_.size() - awake_.size();
    json["substeps"] = kSubsteps;
    json["frames"] = options_.frames;
    json["evicted_bytes"] = caches_.bytes();
    json["simulation_ms_per_frame"] = simulationMs_;
    json["asleep_overhead_percent"] = asleepOverheadPercent();
    for (const Row& row : kRows) json["rows"].push_back(rowJson(row));
    return json;
  }

  const CrowdOptions& options_;
  Model model_;
  std::unique_ptr<Scene> crowd_;
  std::vector<btSoftBody*> everybody_, awake_;  ///< the always awake ones
  std::deque<Skins> skins_;                     // destroyed before the bodies
  std::vector<Variant> variants_;
  CacheEviction caches_;
  double simulationMs_ = 0.0;
};

void printTable(const nlohmann::ordered_json& json) {
  const auto count = [](const nlohmann::ordered_json& item, const char* key) {
    return item.at(key).get<std::size_t>();
  };
  std::printf("\n%s: %zu vertices, %zu tets; %zu bodies, of which %zu are asleep or hidden where skipped\n",
              json.at("model").get<std::string>().c_str(), count(json, "vertices"), count(json, "tets"),
              count(json, "bodies"), count(json, "asleep"));
  std::printf("  %-26s%8s%13s%9s%11s%11s  %s\n", "", "updates", "us/frame", "saved", "memory MB", "bind ms",
              "compared with");
  for (const auto& row : json.at("rows")) {
    std::printf("  %-26s%8zu%13.1f", row.at("variant").get<std::string>().c_str(), count(row, "updates"),
                row.at("us_per_frame").get<double>());
    if (row.at("compared_with").is_null()) {
      std::printf("%9s", "");
    } else {
      std::printf("%7.1f %%", row.at("saved_percent").get<double>());
    }
    std::printf("%11.1f%11.1f", static_cast<double>(count(row, "bytes")) / 1e6, row.at("bind_ms").get<double>());
    if (!row.at("compared_with").is_null()) std::printf("  %s", row.at("compared_with").get<std::string>().c_str());
    std::printf("\n");
  }
  std::printf("  %-26s%+21.1f %%  relative to the %zu awake bodies only\n", "cost of sleeping bodies",
              json.at("asleep_overhead_percent").get<double>(), count(json, "bodies") - count(json, "asleep"));
  std::printf("  %-26s%21.1f ms per frame, with most bodies asleep\n", "Bullet's step",
              json.at("simulation_ms_per_frame").get<double>());
}

int run(const CrowdOptions& options) {
  try {
    const nlohmann::ordered_json json = Measurement(options).run();
    if (!options.json.empty()) writeJson(json, options.json);
    if (!options.quiet) printTable(json);
    return kDone;
  } catch (const CheckFailed& failure) {
    std::fprintf(stderr, "tetskin_crowd: %s\n", failure.what());
    return kRunFailed;
  }
}

}  // namespace

int main(int argc, char** argv) {
  CrowdOptions options;
  options.model.tets = 200;
  CommandLine line(
      "Many bodies in Bullet's deformable world share one binding; nine of ten are asleep or hidden. Prints what their "
      "skins cost per frame, with cold caches and without Bullet's step, and what each part that is left out saves.",
      {{{"tetskin_crowd", "500 bodies: a table"},
        {"tetskin_crowd --bodies 100 --triangles 20000 --json crowd.json",
         "fewer and smaller bodies, and a JSON file of the rows"}},
       "a check of the measurement failed"});
  line.addModelOptions(options.model);
  line.addCount("--bodies", options.bodies, "", 100000);
  line.addCount("--repetitions", options.frames, "How often each variant is timed; the median is printed", 1000000);
  line.addSummaryOption(options.json);
  line.addQuietOption(options.quiet);
  return line.run(argc, argv, [&] {
    options.model.quiet = options.quiet;
    return run(options);
  });
}
