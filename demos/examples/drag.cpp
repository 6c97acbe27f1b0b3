// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A scripted pointer picks the serpent by a horn, or another mesh by its highest point, swings it, and hangs it on a
// ring; an explosion pushes it, and a hat rides on its head. Prints a table of these phases.
#include <btBulletDynamicsCommon.h>
#include <tetskin/touch/surface_joint.h>
#include <tetskin/touch/surface_point.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "drag/props.h"
#include "scenes/caged_mesh.h"
#include "scenes/command_line.h"
#include "scenes/frame_writer.h"
#include "scenes/input_error.h"
#include "scenes/joined_mesh.h"
#include "scenes/placement.h"
#include "scenes/playback.h"
#include "scenes/printed_table.h"
#include "scenes/recording.h"
#include "scenes/summary.h"
#include "scenes/timer.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;
using Eigen::Vector3d;

struct DragOptions {
  ModelOptions model;
  double stiffness = 10;
  SelfContactWish selfContact = SelfContactWish::WherePossible;
  OutputOptions output{"out/drag", "", 600, 1, false};
};

constexpr double kFrame = 1.0 / 60.0;
constexpr int kSubsteps = 4;
/// A body with a coordinate beyond this has exploded.
constexpr double kMaxCoordinate = 100.0 * kSize;
/// Times of the script, in seconds: the body lies, is lifted, is swung one turn per second, is carried to the ring, is
/// let go there, is pushed.
constexpr double kPicked = 0.25, kLifted = 1.5, kSwung = 4.5, kThere = 5.5, kPushed = 7.0;
/// The phases, and the time at which each begins.
constexpr std::pair<const char*, double> kPhases[] = {{"lies on the floor", 0.0},    {"is lifted", kPicked},
                                                      {"is swung", kLifted},         {"is carried to the ring", kSwung},
                                                      {"hangs on the ring", kThere}, {"is pushed", kPushed}};
/// Lengths in the world.
constexpr double kLift = 1.7 * kSize, kSwing = 0.25 * kSize, kRing = 0.12 * kSize, kHat = 0.045 * kSize;

double eased(double from, double to, double t) {
  const double x = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// The displacement of the pointer from the point where it picked.
Vector3d pointerAt(double t) {
  const double angle = 2 * EIGEN_PI * std::clamp(t - kLifted, 0.0, kSwung - kLifted);
  return kLift * eased(kPicked, kLifted, t) * Vector3d::UnitY() +
         kSwing * Vector3d(std::sin(angle), 0, 1 - std::cos(angle)) +
         0.3 * kSize * eased(kSwung, kThere, t) * Vector3d::UnitX();
}

/// A rigid ring that hangs on a pin at its top.
class Ring {
 public:
  Ring(World& world, const Vector3d& lowest)
      : world_(world.bullet()),
        body_(world.addRigid(std::make_unique<btCylinderShapeZ>(btVector3(kRadius, kRadius, btScalar(0.02))),
                             btTransform(btMatrix3x3::getIdentity(), toBullet(lowest + kRing * Vector3d::UnitY())),
                             0.5)),
        pin_(body_, btVector3(0, kRadius, 0)) {
    body_.setFriction(btScalar(0.5));
    body_.setActivationState(DISABLE_DEACTIVATION);
    world_.addConstraint(&pin_);
  }
  ~Ring() { world_.removeConstraint(&pin_); }
  Ring(const Ring&) = delete;
  Ring& operator=(const Ring&) = delete;
  btRigidBody& body() { return body_; }
  static btVector3 lowest() { return {0, -kRadius, 0}; }

 private:
  static constexpr auto kRadius = static_cast<btScalar>(kRing);
  btDiscreteDynamicsWorld& world_;
  btRigidBody& body_;
  btPoint2PointConstraint pin_;
};

/// A height just above the floor.
Model placedModel(const ModelOptions& options) {
  Model model = loadModel(options);
  putInWorld(model.mesh, model.cage);
  const double lift = 0.01 * kSize - boundingBox(model.mesh.positions).min().y();
  for (auto* points : {&model.cage.mesh.nodes, &model.mesh.positions}) {
    for (Vector3d& p : *points) p.y() += lift;
  }
  return model;
}

int highest(const TriangleMesh& mesh) {
  const auto lower = [](const Vector3d& a, const Vector3d& b) { return a.y() < b.y(); };
  return static_cast<int>(std::max_element(mesh.positions.begin(), mesh.positions.end(), lower) -
                          mesh.positions.begin());
}

class Drag {
 public:
  explicit Drag(const DragOptions& options);
  /// Returns false if the body has exploded.
  bool step(int frame);
  World& world() { return world_; }
  const World& world() const { return world_; }
  const TriangleMesh& drawn() const { return drawn_; }
  std::vector<Vector3d> surface() const;
  const TriangleMesh& floor() const { return world_.obstacles(); }
  void tell(nlohmann::ordered_json& json) const;
  /// The stretch of the spring, over the body's size; nothing if there is no spring.
  std::optional<double> stretch() const;
  /// Root mean square of the nodes' speeds, in body lengths per second.
  double nodeSpeed() const { return scenes::nodeSpeed({&body_}) / kSize; }
  /// Records the run that follows.
  Recording record(const std::string& view) const;
  ViewMoment moment() const;

 private:
  void pick();
  void hang();
  void push();
  void measure(double t);
  /// The present transforms of the hat, the ring and the pointer.
  std::array<btTransform, 3> propPositions() const;

  DragOptions options_;
  Model model_;
  World world_;
  btSoftBody& body_;
  std::shared_ptr<const SoftBodyBinding> binding_;
  SelfContact selfContact_;
  SurfaceTree tree_;
  SoftBodySkin skin_;
  SurfacePoint horn_, crown_;
  std::unique_ptr<SurfaceSpring> spring_;
  std::unique_ptr<Ring> ring_;
  std::array<TriangleMesh, 3> props_ = {makeHat(kHat), makeRing(kRing, 0.02 * kSize), makePointer(0.02 * kSize)};
  TriangleMesh drawn_;                    ///< the body and the props
  std::array<std::size_t, 3> propFirst_;  ///< index of each prop's first vertex there
  btVector3 picked_{0, 0, 0};
  double lag_ = 0, hangs_ = 0;
  ImpulseResult pushed_;
  double rayMicroseconds_ = 0;
  Vector3d pointerNow_ = Vector3d::Zero();
};

Drag::Drag(const DragOptions& options)
    : options_(options),
      model_(placedModel(options.model)),
      world_(Force::Elastic, btVector3(0, btScalar(-kEarth), 0)),
      body_(world_.add(model_.cage, oneKilogram())),
      binding_(boundTo(model_.cage, model_.mesh)),
      selfContact_(selfContactOf(model_.name, model_.cage, model_.mesh, options.selfContact, options.output.quiet)),
      tree_(SurfaceTree::create(binding_, model_.mesh).value()) {
  body_.setActivationState(DISABLE_DEACTIVATION);
  world_.addBox({0, -0.25 * kSize, 0}, {3 * kSize, 0.25 * kSize, 3 * kSize});
  world_.touchBySurface(body_, *binding_, model_.mesh);
  if (selfContact_.shape) world_.touchEachOther(body_, selfContact_.shape, true);
  require(skin_.bind(body_, binding_));
  const Vector3d tip = model_.mesh.positions[static_cast<std::size_t>(highest(model_.mesh))];
  // In front of the horns, seen from above.
  const btVector3 over = toBullet(tip + kSize * Vector3d(0.035, 0.1, 0.035)), under = over - btVector3(0, kSize, 0);
  const SurfaceHit top = tree_.raycast(skin_, over, under);
  auto crown = top ? tree_.pointAt(body_, top) : tree_.pointAtVertex(body_, highest(model_.mesh));
  require(crown.status());
  crown_ = crown.value();
  const Vector3d ringAt = tip + pointerAt(kThere);
  ring_ = std::make_unique<Ring>(world_, ringAt);
  (void)append(model_.mesh, drawn_);
  for (std::size_t k = 0; k < props_.size(); ++k) propFirst_[k] = append(props_[k], drawn_);
  pointerNow_ = tip;
}

/// The centroid of the horn's tip.
btVector3 tipOf(const SoftBodySkin& skin, const btVector3& tip) {
  btVector3 sum(0, 0, 0);
  int count = 0;
  for (std::size_t v = 0; v < skin.positions().size(); ++v) {
    const btScalar* p = skin.positions()[v];
    const btVector3 at(p[0], p[1], p[2]);
    if ((at - tip).length() > static_cast<btScalar>(0.02 * kSize)) continue;
    sum += at;
    ++count;
  }
  return sum / static_cast<btScalar>(count);
}

/// Picks as a mouse would: by a ray through the horn.
void Drag::pick() {
  const btVector3 tip = *tree_.pointAtVertex(body_, highest(model_.mesh)).value().position();
  const btVector3 aim = tipOf(skin_, tip), eye = aim + btVector3(1, 1, 6);
  const WallTimer timer;
  const SurfaceHit hit = tree_.raycast(skin_, eye, aim + (aim - eye));
  rayMicroseconds_ = 1e3 * timer.milliseconds();
  // With few triangles, a horn ends in one vertex, which a ray may just miss.
  auto point = hit ? tree_.pointAt(body_, hit) : tree_.pointAtVertex(body_, highest(model_.mesh));
  require(point.status());
  horn_ = point.value();
  picked_ = *horn_.position();
  SurfaceSpringOptions options;
  options.stiffness = options_.stiffness;
  auto spring = SurfaceSpring::add(world_.bullet(), horn_, options);
  require(spring.status());
  spring_ = std::move(spring).value();
}

void Drag::hang() {
  spring_.reset();
  auto spring = SurfaceSpring::add(world_.bullet(), horn_, ring_->body(), Ring::lowest());
  require(spring.status());
  spring_ = std::move(spring).value();
}

void Drag::push() {
  const Box3& box = skin_.bounds();
  const Vector3d below(box.min().x(), box.min().y(), box.center().z());
  pushed_ = tree_.applyImpulse(body_, {toBullet(below), static_cast<btScalar>(0.8 * kSize), 4});
}

bool Drag::step(int frame) {
  const double t = frame * kFrame;
  const auto starts = [&](double when) { return t >= when && t - kFrame < when; };
  if (starts(kPicked)) pick();
  if (starts(kThere)) hang();
  if (starts(kPushed)) push();
  if (spring_ && t < kThere) {
    const btVector3 target = picked_ + toBullet(pointerAt(t));
    (void)spring_->setTarget(target);
    pointerNow_ = toEigen(target);
  }
  for (int s = 0; s < kSubsteps; ++s) world_.step(kFrame / kSubsteps);
  measure(t);
  return skin_.update() == StatusCode::Ok && maxCoordinate(skin_.bounds()) < kMaxCoordinate;
}

std::optional<double> Drag::stretch() const {
  if (!spring_) return {};
  return static_cast<double>(spring_->stretch()) / kSize;
}

void Drag::measure(double t) {
  if (!spring_) return;
  if (t > kLifted + 0.5 && t < kSwung) lag_ = std::max(lag_, *stretch());
  if (t > kThere + 0.5) hangs_ = std::max(hangs_, *stretch());
}

std::array<btTransform, 3> Drag::propPositions() const {
  const auto hat = crown_.frame(skin_);
  return {hat ? hat->transform() : btTransform::getIdentity(), ring_->body().getWorldTransform(),
          btTransform(btMatrix3x3::getIdentity(), toBullet(pointerNow_))};
}

std::vector<Vector3d> Drag::surface() const {
  std::vector<Vector3d> points = drawn_.positions;
  for (std::size_t v = 0; v < skin_.positions().size(); ++v) {
    const btScalar* p = skin_.positions()[v];
    points[v] = Vector3d(p[0], p[1], p[2]);
  }
  const std::array<btTransform, 3> positions = propPositions();
  for (std::size_t k = 0; k < props_.size(); ++k) {
    for (std::size_t v = 0; v < props_[k].vertexCount(); ++v) {
      points[propFirst_[k] + v] = toEigen(positions[k] * toBullet(props_[k].positions[v]));
    }
  }
  return points;
}

Recording Drag::record(const std::string& view) const {
  std::vector<std::string> facts = factsOf(model_);
  facts.emplace_back("picked at the top, swung, hung on a ring, pushed");
  const std::string title = titleOf(model_.name);
  Recording recording(options_.output, view, title, facts, Interpolation::Linear);
  if (!recording.wanted()) return recording;
  recording.addBody({recording.addModel(title, model_.cage, model_.mesh, binding_->embedding()), "", ""});
  for (const TriangleMesh& prop : props_) recording.addProp(prop);
  recording.setObstacles(floor());
  return recording;
}

ViewMoment Drag::moment() const {
  ViewMoment moment;
  moment.bodies = {nodesOf(body_)};
  for (const btTransform& position : propPositions()) moment.props.push_back(affineOf(position));
  return moment;
}

void Drag::tell(nlohmann::ordered_json& json) const {
  json["model"] = model_.name;
  json["vertices"] = model_.mesh.vertexCount();
  json["triangles"] = model_.mesh.triangleCount();
  json["tets"] = model_.cage.mesh.tetCount();
  json["stiffness"] = options_.stiffness;
  selfContact_.tell(json);
  json["first_ray_us"] = rayMicroseconds_;
  json["lag_swinging"] = lag_;
  json["stretch_hanging"] = hangs_;
  json["pushed_vertices"] = pushed_.vertices;
  json["push"] = {pushed_.linear.x(), pushed_.linear.y(), pushed_.linear.z()};
}

/// The table, with a row for each phase.
class Phases {
 public:
  void measure(int frame, const Drag& drag, double simulationMs) {
    const double t = frame * kFrame;
    std::size_t phase = 0;
    while (phase + 1 < std::size(kPhases) && t >= kPhases[phase + 1].second) ++phase;
    if (phase != phase_) {
      addRow();
      phase_ = phase;
      frames_ = 0;
      speed_ = 0.0;
      stretch_.reset();
      msBefore_ = msNow_;
      totalsBefore_ = totalsNow_;
    }
    if (frame > 0) ++frames_;
    if (const std::optional<double> stretch = drag.stretch()) stretch_ = std::max(stretch_.value_or(0.0), *stretch);
    speed_ = std::max(speed_, drag.nodeSpeed());
    msNow_ = simulationMs;
    totalsNow_ = drag.world().solveTotals();
    end_ = t;
  }
  /// Called after the last frame.
  std::string table() {
    addRow();
    return table_.text();
  }

 private:
  void addRow() {
    const int steps = totalsNow_.steps - totalsBefore_.steps;
    const double iterations = static_cast<double>(totalsNow_.iterations - totalsBefore_.iterations);
    const bool whole = phase_ + 1 < std::size(kPhases);
    const double end = whole ? std::min(end_ + kFrame, kPhases[phase_ + 1].second) : end_;
    table_.add({kPhases[phase_].first, formatted("%.2f", kPhases[phase_].second), formatted("%.2f", end),
                stretch_ ? formatted("%.3f", 100.0 * *stretch_) : "-", formatted("%.3f", speed_),
                steps == 0 ? "-" : formatted("%.1f", iterations / steps),
                frames_ == 0 ? "-" : formatted("%.2f", (msNow_ - msBefore_) / frames_)});
  }

  PrintedTable table_{{{"phase", ""},
                       {"from", "s"},
                       {"to", "s"},
                       {"largest stretch", "% of size"},
                       {"largest RMS node speed", "body lengths/s"},
                       {"iterations", "per step"},
                       {"simulation", "ms/frame"}}};
  std::size_t phase_ = 0;
  int frames_ = 0;
  double speed_ = 0.0, end_ = 0.0, msBefore_ = 0.0, msNow_ = 0.0;
  std::optional<double> stretch_;
  SolveTotals totalsBefore_, totalsNow_;
};

void printSummary(const nlohmann::ordered_json& json, const OutputOptions& output) {
  const auto percent = [&](const char* key) {
    return formatted("%.3f %% of the body's size", 100.0 * json.at(key).get<double>());
  };
  const auto ifSo = [](bool reached, const std::string& value) { return reached ? value : "not reached"; };
  printValue("model", json.at("model").get<std::string>());
  printValue("vertices", formatted("%.0f", json, "vertices"));
  printValue("triangles", formatted("%.0f", json, "triangles"));
  printValue("tets", formatted("%.0f", json, "tets"));
  printValue("spring stiffness", formatted("%g (240 Hz)^2 times the mass of the picked point", json, "stiffness"));
  printValue("self-contact", json.at("self_contact").get<std::string>());
  printValue("simulation", formatted("%.2f ms per frame", json, "simulation_ms_per_frame"));
  printSolve(json);
  printValue("first ray", formatted("%.1f us, with the update of the tree", json, "first_ray_us"));
  printValue("lag while swung", ifSo(json.at("lag_swinging") > 0.0, percent("lag_swinging")));
  printValue("stretch while hanging", ifSo(json.at("stretch_hanging") > 0.0, percent("stretch_hanging")));
  const std::string pushed = formatted("%.0f vertices", json, "pushed_vertices");
  printValue("push", ifSo(json.at("pushed_vertices") > 0, pushed));
  printValue("frames", formatted("%.0f", json, "frames"));
  printValue("files", firstFileOf(output) + " ... " + summaryPath(output));
}

int run(const DragOptions& options) {
  const OutputOptions& output = options.output;
  const std::string view = viewPath(output);
  Drag drag(options);
  FrameWriter writer(framePlanOf(output, drag.drawn(), drag.floor()), ObjLayout::create(drag.drawn()));
  Recording recording = drag.record(view);
  if (recording.hasGlb()) writer.addOther(Recording::kGlbName, recording.glbBytes());
  Phases phases;
  double simulationMs = 0.0;
  const auto step = [&](int frame, Playback& run) {
    const WallTimer timer;
    const bool finite = frame == 0 || drag.step(frame);
    run.simulationMs += timer.milliseconds();
    simulationMs = run.simulationMs;
    return finite;
  };
  const auto keep = [&](int frame) {
    phases.measure(frame, drag, simulationMs);
    if (recording.wanted()) recording.keep(drag.moment());
  };
  const auto write = [&](int frame) {
    const std::vector<Vector3d> surface = drag.surface();
    writer.write(frame, surface, boundingBox(surface), {});
  };
  const Playback run = playFrames("simulating", output, drag.world(), step, keep, write);
  const auto summarise = [&] {
    nlohmann::ordered_json json;
    drag.tell(json);
    json["simulation_ms_per_frame"] = run.simulationMs / run.steps();
    tellSolve(drag.world().solveTotals(), json);
    return json;
  };
  return finishRun("tetskin_drag", output, run, writer, recording, summarise, [&](const nlohmann::ordered_json& json) {
    std::printf("\n%s\n", phases.table().c_str());
    printSummary(json, output);
  });
}

}  // namespace

int main(int argc, char** argv) {
  DragOptions options;
  options.model.tets = 1000;
  CommandLine line(
      "A scripted pointer picks up the serpent, or your mesh, at its highest point, swings it and hangs it on a ring. "
      "Prints the lag behind the pointer and other figures for each phase.",
      {{{"tetskin_drag", "the built-in serpent: out/drag/frame_0000.obj, ..., and summary.json"},
        {"tetskin_drag --mesh yours.obj", "your mesh, picked at its highest point"},
        {"tetskin_drag --spring-stiffness 1 --out soft", "a soft spring: the serpent lags behind the pointer"}},
       "the simulation exploded"});
  line.addMeshOptions(options.model);
  line.addPositive(
      "--spring-stiffness", options.stiffness,
      "Stiffness of the pointer's spring, divided by the mass of the picked point, in units of (240 Hz)^2");
  line.addSelfContactOption(options.selfContact);
  line.addOutputOptions(options.output);
  return line.run(argc, argv, [&] {
    options.model.quiet = options.output.quiet;
    options.model.loaded = [&](const TriangleMesh& mesh, const ObjLayout& layout) {
      requireRoomFor(mesh, layout, options.output);
    };
    return run(options);
  });
}
