// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Soft bodies of three models fall into a bowl, some of them across thin poles, and lie on each other as drawn.
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/contact/soft_contacts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>

#include "scenes/command_line.h"
#include "scenes/frame_writer.h"
#include "scenes/input_error.h"
#include "scenes/joined_mesh.h"
#include "scenes/placement.h"
#include "scenes/playback.h"
#include "scenes/summary.h"
#include "scenes/timer.h"
#include "scenes/view_page.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;
using Eigen::Vector3d;

struct PileOptions {
  int bodies = 10;
  ModelOptions model;  ///< without a mesh: what all of kModels have in common
  Contact contact = Contact::Surface;
  SelfContactWish selfContact = SelfContactWish::WherePossible;
  OutputOptions output{"out/pile", "", 600, 1, false};

  bool touchThemselves() const { return wishBeside(contact, selfContact) != SelfContactWish::Off; }
};

constexpr double kFrame = 1.0 / 60.0;
constexpr std::array<BuiltIn, 3> kModels = {BuiltIn::Serpent, BuiltIn::Hand, BuiltIn::Bar};
/// World lengths; the largest side of each body is kSize.
constexpr double kApart = 1.1 * kSize, kFloorY = 0.0, kSide = 1.1 * kSize, kPole = 0.02 * kSize;
/// Farther from the bowl than any body can be thrown: it has exploded.
constexpr double kFarthest = 100.0 * kSize;

/// A model in the world's size about the origin, and what all bodies of it share.
struct PileModel {
  explicit PileModel(const ModelOptions& options) : model(loadModel(options)) {
    const Placement place = placementOf(boundingBox(model.cage.nodes));
    model.cage = place.toWorld(model.cage);
    place.toWorld(model.mesh.positions);
    auto made = makeContactShape(model.cage, model.mesh);
    if (!made.ok()) throw InputError(model.name + ": " + made.status().message);
    shape = made.value();
    auto bound = SoftBodyBinding::make(model.cage, model.mesh);
    require(bound.status());
    binding = bound.value();
  }

  Model model;
  std::shared_ptr<const ContactShape> shape;
  std::shared_ptr<const SoftBodyBinding> binding;
};

/// A floor within four walls, two of which lean outwards, and two poles across it.
void addBowl(World& world) {
  const double height = kSize, thick = 0.25 * kSize;
  world.addBox({0, kFloorY - thick, 0}, {4 * kSide, thick, 4 * kSide});
  for (const double side : {-1.0, 1.0}) {
    world.addBox({side * (kSide + thick + 0.35 * height), 0.5 * height, 0}, {thick, height, kSide}, -side * 0.45);
    world.paint("wall");
    world.addBox({0, 0.5 * height, side * (kSide + thick)}, {2 * kSide, height, thick});
    world.paint("wall");
    world.addBox({side * 0.45 * kSize, 1.6 * kSize, 0}, {kPole, kPole, kSide});
    world.paint("pole");
  }
}

Cage placedAt(Cage cage, int k) {
  const Eigen::AngleAxisd turn(1.1 * k, Vector3d(0.3, 1.0, 0.2).normalized());
  const Vector3d at(0.12 * kSize * (k % 2 ? 1 : -1), kFloorY + 2.4 * kSize + kApart * k, 0.1 * kSize * (k / 2 % 2));
  for (Vector3d& p : cage.nodes) p = turn * p + at;
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
    addBowl(world_);
    for (int k = 0; k < options.bodies; ++k) add(models_[static_cast<std::size_t>(k) % models_.size()], k, options);
  }

  const World& world() const { return world_; }
  const TriangleMesh& mesh() const { return mesh_; }
  const TriangleMesh& obstacles() const { return world_.obstacles(); }
  /// False if a body has exploded.
  bool step();
  /// Of all bodies, one after the other.
  std::vector<Vector3d> surface() const;
  /// Of the deepest contact between bodies, in sizes; 0 or below.
  double deepest() const;
  std::size_t contactCount() const { return world_.softContacts().size(); }
  /// Root of the mean square over all nodes, in sizes a second.
  double nodeSpeed() const;

  /// Of the run to come: bodies of one model share it.
  ViewPage page(const PileOptions& options) const;
  ViewMoment moment() const;

 private:
  void add(const PileModel& of, int k, const PileOptions& options);

  World world_;
  std::deque<PileModel> models_;
  std::vector<btSoftBody*> bodies_;
  std::size_t bodyTets_ = 0;
  std::deque<SoftBodySkin> skins_;
  TriangleMesh mesh_;
};

void Pile::add(const PileModel& of, int k, const PileOptions& options) {
  btSoftBody& body = world_.add(placedAt(of.model.cage, k), oneKilogram());
  if (options.contact == Contact::Surface) world_.touchBySurface(body, *of.binding, of.model.mesh);
  world_.touchEachOther(body, of.shape, options.touchThemselves());
  bodies_.push_back(&body);
  require(skins_.emplace_back().bind(body, of.binding));
  bodyTets_ += of.model.cage.tetCount();
  (void)append(of.model.mesh, mesh_, of.model.name);
}

bool Pile::step() {
  constexpr int kSubsteps = 4;
  for (int s = 0; s < kSubsteps; ++s) world_.step(kFrame / kSubsteps);
  return std::all_of(skins_.begin(), skins_.end(), [](SoftBodySkin& skin) {
    const UpdateStatus status = skin.update();
    const bool followed = status == UpdateStatus::Updated || status == UpdateStatus::Asleep;
    return followed && largestCoordinate(skin.bounds()) < kFarthest;
  });
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

double Pile::deepest() const {
  double deepest = 0.0;
  for (const SoftContact& c : world_.softContacts()) deepest = std::min(deepest, static_cast<double>(c.distance));
  return deepest / kSize;
}

double Pile::nodeSpeed() const {
  double squared = 0.0, count = 0.0;
  for (const btSoftBody* body : bodies_) {
    for (int n = 0; n < body->m_nodes.size(); ++n) squared += static_cast<double>(body->m_nodes[n].m_v.length2());
    count += body->m_nodes.size();
  }
  return std::sqrt(squared / count) / kSize;
}

ViewPage Pile::page(const PileOptions& options) const {
  const Contact contact = options.contact;
  ViewPage page("pile",
                {std::to_string(bodies_.size()) + " soft bodies", withCommas(mesh_.vertexCount()) + " vertices",
                 withCommas(bodyTets_) + " tets",
                 contact == Contact::Surface ? factOf(contact, options.touchThemselves())
                                             : "contact with the bowl at the cages' nodes"},
                Interpolation::Linear);
  for (const PileModel& of : models_) page.addModel(of.model.cage, of.model.mesh, of.binding->embedding());
  for (std::size_t k = 0; k < bodies_.size(); ++k) page.addBody({k % models_.size(), "", ""});
  page.setObstacles(obstacles());
  page.setFocus({Vector3d(-1.5 * kSide, kFloorY, -kSide), Vector3d(1.5 * kSide, kFloorY + 2.0 * kSize, kSide)});
  return page;
}

ViewMoment Pile::moment() const {
  ViewMoment moment;
  for (const btSoftBody* body : bodies_) moment.bodies.push_back(nodesOf(*body));
  return moment;
}

int run(const PileOptions& options) {
  const OutputOptions& output = options.output;
  const std::string summary = summaryPath(output), view = viewPath(output);
  Pile pile(options);
  FrameWriter writer(framePlanOf(output, pile.mesh(), pile.obstacles()), ObjLayout::fromMesh(pile.mesh()));
  std::optional<ViewPage> page;
  if (!view.empty()) page = pile.page(options);
  double deepest = 0.0;
  const auto step = [&](int frame, Playback& run) {
    const WallTimer timer;
    const bool finite = frame == 0 || pile.step();
    run.simulationMs += timer.milliseconds();
    return finite;
  };
  const auto measure = [&](int) {
    deepest = std::min(deepest, pile.deepest());
    if (page) page->keep(pile.moment());
  };
  const auto write = [&](int frame) {
    const std::vector<Vector3d> surface = pile.surface();
    writer.write(frame, surface, boundingBox(surface), {});
  };
  const Playback run = playFrames("simulating", output, pile.world(), step, measure, write);
  nlohmann::ordered_json json;
  json["bodies"] = options.bodies;
  json["contact"] = options.contact == Contact::Surface ? "surface" : "cage";
  json["self_contact"] = options.touchThemselves() ? "on" : "off";
  json["simulation_ms_per_frame"] = run.simulationMs / run.steps();
  tellSolve(pile.world().solveTotals(), json);
  json["deepest_contact"] = deepest;
  json["deepest_contact_at_end"] = pile.deepest();
  json["contacts_at_end"] = pile.contactCount();
  json["node_speed_at_end"] = pile.nodeSpeed();
  json["finite"] = run.finite;
  writeJson(json, summary);
  if (!output.quiet) std::printf("%s\n", json.dump(2).c_str());
  if (page) page->write(view, output.quiet);
  if (run.finite) return kDone;
  std::fprintf(stderr, "tetskin_pile: the simulation exploded\n");
  return kRunFailed;
}

}  // namespace

int main(int argc, char** argv) {
  PileOptions options;
  options.model.tets = 500;
  options.model.triangles = 20000;
  CommandLine line(
      "Soft bodies of three models, or of your mesh, fall into a bowl, some across thin poles, and lie on each other.",
      {{{"tetskin_pile", "ten bodies: out/pile/frame_0000.obj, ..., and summary.json"},
        {"tetskin_pile --mesh yours.obj", "ten of a mesh of yours, which must be closed"},
        {"tetskin_pile --bodies 3 --contact cage", "three that meet by their cages' nodes: they float"}},
       "the simulation exploded"});
  line.addCount("--bodies", options.bodies, "How many bodies", 100);
  line.addInput("--mesh", options.model.mesh,
                "Closed mesh of all bodies, any format assimp reads (default: three models)");
  line.addCount("--tets", options.model.tets, "Tets of each model's cage", 20000);
  line.addCount("--triangles", options.model.triangles, "Triangles of each built-in model", 500000);
  line.addContactOption(options.contact);
  line.addSelfContactOption(options.selfContact);
  line.addOutputOptions(options.output);
  return line.run(argc, argv, [&] {
    options.model.quiet = options.output.quiet;
    return run(options);
  });
}
