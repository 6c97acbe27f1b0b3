// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/crowd_cases.h"

#include <benchmark/benchmark.h>
#include <tetskin/bullet/soft_body_skin.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenes/caged_mesh.h"
#include "scenes/crowd.h"
#include "scenes/input_error.h"
#include "scenes/memory.h"
#include "scenes/system.h"
#include "scenes/table.h"
#include "scenes/timer.h"

namespace tetskin::bench {
namespace {

using benchmark::State;

constexpr int kStepsOfCrowd = 4;  ///< per frame
constexpr int kFramesOfCrowd = 15;

enum class Left { Nothing, Sleepers, Hidden, Updates };

/// Which bodies have skins, the features of these, and the parts that a frame leaves out.
struct CrowdCase {
  std::string name;
  bool all = false;  ///< skins for all bodies, instead of for those alone that are always awake
  Left left = Left::Nothing;
  int updates = 1;           ///< per frame
  bool bindingEach = false;  ///< a binding for every body; otherwise they share the first one's
  std::function<void(SkinOptions&)> change = [](SkinOptions&) {};
};

/// The bodies, made when a case first asks for them.
struct Crowd {
  Crowd(const scenes::ModelOptions& options, std::size_t bodies) : model(scenes::loadModel(options)) {
    scenes::putInWorld(model.mesh, model.cage);
    scenes::SceneOptions scene;
    scene.bodies = bodies;
    scene.substeps = kStepsOfCrowd;
    crowd = scenes::sceneNamed("crowd").make(model.cage, scene);
  }

  scenes::Model model;
  std::unique_ptr<scenes::Scene> crowd;
  scenes::CacheEviction caches;
};

class CrowdSkins {
 public:
  CrowdSkins(Crowd& crowd, const CrowdCase& made) : crowd_(*crowd.crowd), case_(made), skins_(crowd_.bodyCount()) {
    SkinOptions options;
    options.order = VertexOrder::Sorted;
    options.bounds = false;
    made.change(options);
    const InstanceOptions& instance = options;
    for (std::size_t i = 0; i < crowd_.bodyCount(); ++i) {
      if (!made.all && !scenes::alwaysAwake(i)) continue;
      const bool shared = !pointers_.empty() && !made.bindingEach;
      scenes::require(shared ? skins_[i].bind(crowd_.body(i), skins_[0].binding(), instance)
                             : skins_[i].bind(crowd_.body(i), crowd.model.cage, crowd.model.mesh, options).status());
      pointers_.push_back(&skins_[i]);
    }
  }

  /// Brings bodies and skins into the case's state, and does what happens only once: the last update of a body that
  /// fell asleep, the update of a skin that is shown again.
  void prepare() {
    scenes::setAsleep(crowd_, case_.left == Left::Sleepers);
    for (std::size_t i = 0; i < skins_.size(); ++i)
      skins_[i].setVisible(scenes::alwaysAwake(i) || case_.left != Left::Hidden);
    (void)update();
  }
  std::size_t update() { return SoftBodySkin::updateAll(pointers_.data(), pointers_.size()); }
  /// The number of updates that are due.
  std::size_t due() const {
    if (case_.left == Left::Updates) return 0;
    return case_.left == Left::Nothing ? pointers_.size() : scenes::awakeAmong(pointers_.size());
  }

 private:
  scenes::Scene& crowd_;
  const CrowdCase& case_;
  std::vector<SoftBodySkin> skins_;
  std::vector<SoftBodySkin*> pointers_;
};

void frameOf(State& state, Crowd& crowd, const CrowdCase& made) {
  const std::size_t before = scenes::heapBytes();
  CrowdSkins skins(crowd, made);
  state.counters["bytes"] = static_cast<double>(scenes::heapBytes() - before);
  const int substeps = made.left == Left::Updates ? crowd.crowd->world().step(0.0) : kStepsOfCrowd;
  for (auto _ : state) {
    skins.prepare();
    double seconds = 0.0;
    for (int k = 0; k < made.updates; ++k) {
      crowd.caches.evict();
      const scenes::WallTimer timer;
      const std::size_t updated = substeps > 0 ? skins.update() : 0;
      seconds += timer.seconds();
      if (updated != skins.due()) return state.SkipWithError("other skins were updated than those that are due");
    }
    state.SetIterationTime(seconds);
  }
  state.counters["updates"] = static_cast<double>(skins.due()) * made.updates;
}

const std::vector<CrowdCase>& crowdCases() {
  static const std::vector<CrowdCase> all = {
      {"all/every_substep", true, Left::Nothing, kStepsOfCrowd},
      {"all/once_per_frame", true},
      {"all/asleep", true, Left::Sleepers},
      {"all/hidden", true, Left::Hidden},
      {"all/no_substep", true, Left::Updates},
      {"all/binding_each", true, Left::Nothing, 1, true},
      {"awake"},
      {"awake/recomputed", false, Left::Nothing, 1, false, [](SkinOptions& o) { o.normals = Normals::Recomputed; }},
      {"awake/transformed", false, Left::Nothing, 1, false, [](SkinOptions& o) { o.normals = Normals::Transformed; }},
      {"awake/quadratic", false, Left::Nothing, 1, false,
       [](SkinOptions& o) { o.interpolation = Interpolation::Quadratic; }},
      {"awake/mesh_order", false, Left::Nothing, 1, false, [](SkinOptions& o) { o.order = VertexOrder::Mesh; }},
      {"awake/bounds", false, Left::Nothing, 1, false, [](SkinOptions& o) { o.bounds = true; }},
      {"awake/previous", false, Left::Nothing, 1, false, [](SkinOptions& o) { o.previousPositions = true; }}};
  return all;
}

}  // namespace

void registerCrowdCases(const scenes::ModelOptions& model, std::size_t bodies) {
  constexpr std::size_t kTets = 200;  // of each body, independent of the other cases
  const auto crowd = [model, bodies, made = std::make_shared<std::unique_ptr<Crowd>>()]() -> Crowd& {
    scenes::ModelOptions options = model;
    if (options.cage.empty()) options.tets = kTets;
    options.quiet = true;
    if (!*made) *made = std::make_unique<Crowd>(options, bodies);
    return **made;
  };
  for (const CrowdCase& one : crowdCases()) {
    benchmark::RegisterBenchmark(("Crowd/" + one.name).c_str(),
                                 [crowd, &one](State& state) { frameOf(state, crowd(), one); })
        ->UseManualTime()
        ->Iterations(kFramesOfCrowd)
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace tetskin::bench
