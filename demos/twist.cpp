// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A bar held at both ends in Bullet's deformable world, twisted a full turn and released; a linear and a quadratic
// surface on the same coarse cage, side by side, and the errors of both.
#include <tetskin/bullet/soft_body_skin.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "scenes/command_line.h"
#include "scenes/frame_writer.h"
#include "scenes/input_error.h"
#include "scenes/progress.h"
#include "scenes/summary.h"
#include "scenes/table.h"
#include "scenes/timer.h"
#include "scenes/wring.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;

constexpr double kFullTurn = 6.28318530717958647692;

struct TwistOptions {
  ModelOptions model;
  SkinOptions skin;
  OutputOptions output{"out/twist", "", 240, 1, false};
};

/// How far a surface is from the exact image of the mesh under a map that its cage's nodes follow exactly.
struct Accuracy {
  double rms = 0.0, max = 0.0;  ///< in diagonals of the mesh's box
  double normalDegrees = 0.0;   ///< mean angle of the transformed normals to the exact ones
};

/// Without Bullet, whose body finds its own shape: the nodes are set to a full turn from end to end.
Accuracy measure(const Model& model, SkinOptions options, Interpolation interpolation) {
  const Twist twist = twistOf(boundingBox(model.cage.nodes), kFullTurn);
  options.interpolation = interpolation;
  options.normals = Normals::Transformed;
  MeshSkin<double> skin;
  require(skin.bind(model.cage, model.mesh, options).status);
  std::vector<Eigen::Vector3d> nodes;
  for (const Eigen::Vector3d& p : model.cage.nodes) nodes.push_back(twist.point(p));
  if (skin.update(viewOf(std::as_const(nodes))) < nodes.size()) throw InputError("the cage's nodes are not finite");

  const std::vector<Eigen::Vector3d> normals = restNormals(model.mesh);
  const double diagonal = boundingBox(model.mesh.positions).diagonal().norm();
  const auto count = static_cast<double>(model.mesh.vertexCount());
  Accuracy result;
  for (std::size_t v = 0; v < model.mesh.vertexCount(); ++v) {
    const Eigen::Vector3d& rest = model.mesh.positions[v];
    const Eigen::Map<const Eigen::Vector3d> position(skin.positions()[v]);
    const double distance = (position - twist.point(rest)).norm() / diagonal;
    result.rms += distance * distance / count;
    result.max = std::max(result.max, distance);
    const Eigen::Vector3d normal = Eigen::Map<const Eigen::Vector3f>(skin.normals()[v]).cast<double>();
    const double cosine = std::clamp(normal.dot(twist.normal(rest, normals[v])), -1.0, 1.0);
    result.normalDegrees += 360.0 / kFullTurn * std::acos(cosine) / count;
  }
  result.rms = std::sqrt(result.rms);
  return result;
}

/// A skin, and its surface in the model's space.
struct Carried {
  SoftBodySkin skin;
  std::vector<Eigen::Vector3d> surface;
};

/// Two copies of a mesh in one, as the groups `linear` and `quadratic`, the second beside the first.
class SideBySide {
 public:
  explicit SideBySide(const TriangleMesh& mesh) {
    const Eigen::Vector3d sides = boundingBox(mesh.positions).sizes();
    int longest = 0;
    sides.maxCoeff(&longest);
    const int beside = (longest + 1) % 3, deep = (longest + 2) % 3;
    offset_[beside] = -kGap * std::hypot(sides[beside], sides[deep]);
    for (const char* name : {"linear", "quadratic"}) append(mesh, name);
  }

  ObjLayout layout() const { return ObjLayout::fromMesh(mesh_); }

  void write(const Carried& linear, const Carried& quadratic, int frame, FrameWriter& writer) {
    surface_ = linear.surface;
    for (const Eigen::Vector3d& p : quadratic.surface) surface_.push_back(p + offset_);
    normals_.clear();
    for (const PointView<const float>& half : {linear.skin.normals(), quadratic.skin.normals()}) {
      for (std::size_t v = 0; v < half.size(); ++v) normals_.emplace_back(half[v]);
    }
    writer.write(frame, surface_, boundingBox(surface_), viewOf(std::as_const(normals_)));
  }

 private:
  static constexpr double kGap = 1.1;  ///< of the centres, over the widest that a turned section can be

  void append(const TriangleMesh& mesh, const char* name) {
    const int first = static_cast<int>(mesh_.vertexCount());
    mesh_.groups.push_back({name, "", mesh_.triangleCount(), mesh.triangleCount()});
    mesh_.positions.insert(mesh_.positions.end(), mesh.positions.begin(), mesh.positions.end());
    mesh_.texcoords.insert(mesh_.texcoords.end(), mesh.texcoords.begin(), mesh.texcoords.end());
    for (const auto& t : mesh.triangles) mesh_.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }

  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  TriangleMesh mesh_;
  std::vector<Eigen::Vector3d> surface_;
  std::vector<Eigen::Vector3f> normals_;
};

/// What is measured on the way.
struct Totals {
  int frames = 0;
  int written = 0;
  double simulationMs = 0.0, linearUs = 0.0, quadraticUs = 0.0;
  double extentMax = 1.0;
  double nodesOffTwist = 0.0;                     ///< at the last frame before the release
  double differenceRms = 0.0, differenceMax = 0;  ///< of the two surfaces, likewise, in box diagonals
  bool finite = true;
};

/// The model in the scene, with a linear and a quadratic surface. It may have any size and be anywhere: results are in
/// its own space.
class Wringing {
 public:
  explicit Wringing(const TwistOptions& options)
      : options_(options),
        model_(loadModel(options.model)),
        box_(boundingBox(model_.mesh.positions)),
        place_(placementOf(boundingBox(model_.cage.nodes))),
        scene_(sceneNamed("wring").make(place_.toWorld(model_.cage))) {
    SkinOptions skin = options.skin;
    skin.interpolation = Interpolation::Quadratic;
    fit_ = quadratic_.skin.bind(scene_->body(), model_.cage, model_.mesh, skin);
    requireFit(fit_, options.model);
    skin.interpolation = Interpolation::Linear;
    require(linear_.skin.bind(scene_->body(), quadratic_.skin.binding(), skin));
    for (Carried* carried : {&linear_, &quadratic_}) place_.readSurface(carried->skin, carried->surface);
  }

  const Model& model() const { return model_; }
  const EmbedReport& fit() const { return fit_; }
  Totals simulate(FrameWriter& writer, SideBySide& pair);

 private:
  bool step(int frame, Totals& totals);
  bool update(Carried& carried, double& microseconds) const;
  double nodesOffTwist(int frame) const;
  void compareSurfaces(int frame, Totals& totals) const;

  const TwistOptions& options_;
  const Model model_;
  const Box3 box_;  ///< of the mesh
  const Placement place_;
  const std::unique_ptr<Scene> scene_;
  Carried linear_, quadratic_;
  EmbedReport fit_;
};

/// Returns false if node positions are not finite.
bool Wringing::step(int frame, Totals& totals) {
  const WallTimer timer;
  scene_->step(frame);
  totals.simulationMs += timer.milliseconds();
  const bool linear = update(linear_, totals.linearUs), quadratic = update(quadratic_, totals.quadraticUs);
  return linear && quadratic;
}

bool Wringing::update(Carried& carried, double& microseconds) const {
  const WallTimer timer;
  const UpdateStatus status = carried.skin.update();
  microseconds += timer.microseconds();
  place_.readSurface(carried.skin, carried.surface);
  return status == UpdateStatus::Updated;
}

/// Root mean square distance of the nodes to an even twist between the held ends, in diagonals of the mesh's box.
double Wringing::nodesOffTwist(int frame) const {
  const std::vector<Eigen::Vector3d>& rest = model_.cage.nodes;
  const Twist twist = wringAt(boundingBox(rest), frame);
  double squared = 0.0;
  for (std::size_t n = 0; n < rest.size(); ++n) {
    const Eigen::Vector3d now = place_.toModel(toEigen(scene_->body().m_nodes[static_cast<int>(n)].m_x));
    squared += (now - twist.point(rest[n])).squaredNorm();
  }
  return std::sqrt(squared / static_cast<double>(rest.size())) / box_.diagonal().norm();
}

void Wringing::compareSurfaces(int frame, Totals& totals) const {
  totals.nodesOffTwist = nodesOffTwist(frame);
  double squared = 0.0, farthest = 0.0;
  for (std::size_t v = 0; v < linear_.surface.size(); ++v) {
    const double distance = (linear_.surface[v] - quadratic_.surface[v]).norm() / box_.diagonal().norm();
    squared += distance * distance;
    farthest = std::max(farthest, distance);
  }
  totals.differenceRms = std::sqrt(squared / static_cast<double>(linear_.surface.size()));
  totals.differenceMax = farthest;
}

Totals Wringing::simulate(FrameWriter& writer, SideBySide& pair) {
  const OutputOptions& output = options_.output;
  Totals totals;
  Progress progress("twisting", output.frames, output.quiet);
  for (int frame = 0; frame < output.frames; ++frame) {
    totals.finite = (frame == 0 || step(frame, totals)) && !scene_->check(linear_.skin.positions()).exploded;
    const double extent = boundingBox(linear_.surface).sizes().maxCoeff() / box_.sizes().maxCoeff();
    totals.extentMax = std::max(totals.extentMax, extent);
    if (!totals.finite) break;
    if (frame < kReleased) compareSurfaces(frame, totals);
    if (frame % output.every == 0) {
      pair.write(linear_, quadratic_, frame, writer);
      if (totals.written++ == 0 && !output.quiet) std::printf("%s\n", writer.announcement().c_str());
    }
    totals.frames = frame + 1;
    progress.show(frame + 1);
  }
  return totals;
}

nlohmann::ordered_json summarise(const Wringing& wringing, const TwistOptions& options, const Accuracy& linear,
                                 const Accuracy& quadratic, const Totals& totals) {
  const double steps = std::max(1, totals.frames - 1);
  nlohmann::ordered_json json = summaryOf(wringing.model(), wringing.fit());
  json["error_linear_rms"] = linear.rms;
  json["error_quadratic_rms"] = quadratic.rms;
  json["error_linear_max"] = linear.max;
  json["error_quadratic_max"] = quadratic.max;
  json["normal_error_linear_deg"] = linear.normalDegrees;
  json["normal_error_quadratic_deg"] = quadratic.normalDegrees;
  json["frames"] = totals.frames;
  json["frames_written"] = totals.written;
  json["frame_turned"] = kTurned;
  json["frame_released"] = kReleased;
  json["nodes_off_twist_rms"] = totals.nodesOffTwist;
  json["difference_rms"] = totals.differenceRms;
  json["difference_max"] = totals.differenceMax;
  json["simulation_ms_per_frame"] = totals.simulationMs / steps;
  json["skin_linear_us_per_frame"] = totals.linearUs / steps;
  json["skin_quadratic_us_per_frame"] = totals.quadraticUs / steps;
  json["extent_max"] = totals.extentMax;
  json["finite"] = totals.finite;
  json["out"] = options.output.out;
  return json;
}

void printTable(const nlohmann::ordered_json& json, const std::string& summaryPath) {
  const auto number = [&](const std::string& key) { return json.at(key).get<double>(); };
  const auto both = [&](const char* what, const char* format, const std::string& key, const char* end,
                        const char* unit) {
    std::printf("  %-26s", what);
    for (const char* kind : {"linear", "quadratic"}) std::printf(format, number(key + kind + end));
    std::printf("  %s\n", unit);
  };
  const auto one = [&](const char* what, const char* format, const char* key, const char* unit) {
    std::printf("  %-26s", what);
    std::printf(format, number(key));
    std::printf("  %s\n", unit);
  };
  std::printf("\n%s: %.0f vertices, %.0f tets\n", json.at("model").get<std::string>().c_str(), number("vertices"),
              number("tets"));
  if (json.at("outside") > 0) {
    std::printf("  %.0f vertices outside the cage, the farthest, vertex %.0f, by %.3g\n", number("outside"),
                number("worst_vertex"), number("worst_distance"));
  }
  std::printf("  %-26s%11s%11s\n", "", "linear", "quadratic");
  both("error, RMS", "%11.2e", "error_", "_rms", "box diagonals, with the nodes set to a full turn");
  both("error, largest", "%11.2e", "error_", "_max", "box diagonals");
  both("error of normals, mean", "%11.2f", "normal_error_", "_deg", "degrees");
  both("update", "%11.1f", "skin_", "_us_per_frame", "us a frame");
  one("apart, RMS", "%22.2e", "difference_rms", "box diagonals, when Bullet has turned the end");
  one("nodes off an even twist", "%22.2e", "nodes_off_twist_rms", "box diagonals, likewise");
  one("simulation", "%22.2f", "simulation_ms_per_frame", "ms a frame");
  std::printf("  %s/frame_0000.obj ... %s\n", json.at("out").get<std::string>().c_str(), summaryPath.c_str());
}

int run(const TwistOptions& options) {
  Wringing wringing(options);
  const Accuracy linear = measure(wringing.model(), options.skin, Interpolation::Linear);
  const Accuracy quadratic = measure(wringing.model(), options.skin, Interpolation::Quadratic);
  SideBySide pair(wringing.model().mesh);
  FrameWriter writer({options.output.out, options.output.frames, options.output.every},
                     layoutWith(options.skin.normals, pair.layout()));
  const std::string path = summaryPath(options.output);
  const Totals totals = wringing.simulate(writer, pair);
  const nlohmann::ordered_json json = summarise(wringing, options, linear, quadratic, totals);
  writeJson(json, path);
  if (!options.output.quiet) printTable(json, path);
  if (totals.finite) return kDone;
  std::fprintf(stderr, "tetskin_twist: the simulation exploded after frame %d\n", totals.frames - 1);
  return kRunFailed;
}

}  // namespace

int main(int argc, char** argv) {
  TwistOptions options;
  options.model.builtIn = BuiltIn::Bar;
  options.model.tets = 600;
  options.skin.normals = Normals::Transformed;
  CommandLine line(
      "A body held at both ends of its longest side is twisted a full turn and released, in Bullet's deformable "
      "world. One cage carries a linear and a quadratic surface; the errors of both are printed.");
  line.addModelOptions(options.model);
  line.addSkinOptions(options.skin);
  line.addOutputOptions(options.output);
  return line.run(argc, argv, [&] { return run(options); });
}
