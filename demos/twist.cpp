// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A bar pinned at both ends in Bullet's deformable world, twisted a full turn and released; a linear and a quadratic
// surface on the same coarse cage, side by side, and the errors of both.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "scenes/frame_writer.h"
#include "scenes/input_error.h"
#include "scenes/joined_mesh.h"
#include "scenes/materials.h"
#include "scenes/player.h"
#include "scenes/printed_table.h"
#include "scenes/recording.h"
#include "scenes/summary.h"
#include "scenes/table.h"
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

/// The error of a surface against the exact image of the mesh under a map that its cage's nodes follow exactly.
struct Accuracy {
  double rms = 0.0, max = 0.0;  ///< in diagonals of the mesh's box
  double normalDegrees = 0.0;   ///< mean angle between transformed and exact normals
};

/// Without Bullet, whose body takes a shape of its own: the nodes are set to a full turn from end to end.
Accuracy accuracyOf(const Model& model, SkinOptions options, Interpolation interpolation) {
  const Twist twist = twistOf(boundingBox(model.cage.mesh.nodes), kFullTurn);
  options.interpolation = interpolation;
  options.normals = Normals::Transformed;
  MeshSkin<double> skin;
  require(skin.bind(model.cage, model.mesh, options).status());
  std::vector<Eigen::Vector3d> nodes;
  for (const Eigen::Vector3d& p : model.cage.mesh.nodes) nodes.push_back(twist.point(p));
  if (skin.update(viewOf(std::as_const(nodes))) != StatusCode::Ok)
    throw InputError("the cage has a node position that is not finite");

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

/// Two copies of a mesh in one, as the groups `linear` and `quadratic`, side by side.
class SideBySide {
 public:
  explicit SideBySide(const TriangleMesh& mesh) {
    const Eigen::Vector3d sides = boundingBox(mesh.positions).sizes();
    int longest = 0;
    sides.maxCoeff(&longest);
    const int beside = (longest + 1) % 3, deep = (longest + 2) % 3;
    offset_[beside] = -kGap * std::hypot(sides[beside], sides[deep]);
    for (const char* name : {"linear", "quadratic"}) (void)append(mesh, mesh_, name);
  }

  const TriangleMesh& mesh() const { return mesh_; }
  ObjLayout layout() const { return ObjLayout::create(mesh_); }
  /// Moves points to the position of the second mesh, beside the first.
  std::vector<Eigen::Vector3d> beside(std::vector<Eigen::Vector3d> points) const {
    for (Eigen::Vector3d& p : points) p += offset_;
    return points;
  }

  void write(const Carried& linear, const Carried& quadratic, int frame, FrameWriter& writer) {
    surface_ = linear.surface;
    const std::vector<Eigen::Vector3d> second = beside(quadratic.surface);
    surface_.insert(surface_.end(), second.begin(), second.end());
    normals_.clear();
    for (const PointView<const float>& half : {linear.skin.normals(), quadratic.skin.normals()}) {
      for (std::size_t v = 0; v < half.size(); ++v) normals_.emplace_back(half[v]);
    }
    writer.write(frame, surface_, boundingBox(surface_), viewOf(std::as_const(normals_)));
  }

 private:
  static constexpr double kGap = 1.1;  ///< distance of the centres, over the greatest width of a rotated cross-section

  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  TriangleMesh mesh_;
  std::vector<Eigen::Vector3d> surface_;
  std::vector<Eigen::Vector3f> normals_;
};

/// What is measured during the run; lengths are in diagonals of the mesh's box.
struct Totals {
  double extentMax = 1.0;
  double nodesOffTwist = 0.0;                     ///< at the last frame before the release
  double differenceRms = 0.0, differenceMax = 0;  ///< between the two surfaces, at the last frame before the release
};

/// Root mean square distance of the nodes from an even twist between the pinned ends.
double nodesOffTwist(Player& player, int frame) {
  const std::vector<Eigen::Vector3d>& rest = player.model().cage.mesh.nodes;
  const Twist twist = wringAt(boundingBox(rest), frame);
  double squared = 0.0;
  for (std::size_t n = 0; n < rest.size(); ++n) {
    const btVector3& node = player.scene().body().m_nodes[static_cast<int>(n)].m_x;
    squared += (player.placement().toModel(toEigen(node)) - twist.point(rest[n])).squaredNorm();
  }
  return std::sqrt(squared / static_cast<double>(rest.size()));
}

void measure(Player& player, const Carried& linear, const Carried& quadratic, int frame, Totals& totals) {
  const Box3 rest = boundingBox(player.model().mesh.positions);
  const double diagonal = rest.diagonal().norm();
  const double extent = boundingBox(linear.surface).sizes().maxCoeff() / rest.sizes().maxCoeff();
  totals.extentMax = std::max(totals.extentMax, extent);
  if (frame >= kReleased) return;
  totals.nodesOffTwist = nodesOffTwist(player, frame) / diagonal;
  double squared = 0.0, farthest = 0.0;
  for (std::size_t v = 0; v < linear.surface.size(); ++v) {
    const double distance = (linear.surface[v] - quadratic.surface[v]).norm() / diagonal;
    squared += distance * distance;
    farthest = std::max(farthest, distance);
  }
  totals.differenceRms = std::sqrt(squared / static_cast<double>(linear.surface.size()));
  totals.differenceMax = farthest;
}

nlohmann::ordered_json summarise(const Player& player, const TwistOptions& options, const Totals& totals,
                                 const Playback& run, const Carried& linear, const Carried& quadratic) {
  const Accuracy linearError = accuracyOf(player.model(), options.skin, Interpolation::Linear);
  const Accuracy quadraticError = accuracyOf(player.model(), options.skin, Interpolation::Quadratic);
  nlohmann::ordered_json json = summaryOf(player.model(), player.fit());
  json["error_linear_rms"] = linearError.rms;
  json["error_quadratic_rms"] = quadraticError.rms;
  json["error_linear_max"] = linearError.max;
  json["error_quadratic_max"] = quadraticError.max;
  json["normal_error_linear_deg"] = linearError.normalDegrees;
  json["normal_error_quadratic_deg"] = quadraticError.normalDegrees;
  json["frame_turned"] = kTurned;
  json["frame_released"] = kReleased;
  json["nodes_off_twist_rms"] = totals.nodesOffTwist;
  json["difference_rms"] = totals.differenceRms;
  json["difference_max"] = totals.differenceMax;
  json["simulation_ms_per_frame"] = run.simulationMs / run.steps();
  json["skin_linear_us_per_frame"] = linear.microseconds / run.steps();
  json["skin_quadratic_us_per_frame"] = quadratic.microseconds / run.steps();
  json["extent_max"] = totals.extentMax;
  return json;
}

void printTable(const nlohmann::ordered_json& json, const OutputOptions& output) {
  const auto number = [&](const std::string& key) { return json.at(key).get<double>(); };
  PrintedTable table({{"nodes set to a full turn"}, {"linear"}, {"quadratic"}});
  const auto both = [&](const char* what, const char* format, const std::string& key, const char* end) {
    table.add(
        {what, formatted(format, number(key + "linear" + end)), formatted(format, number(key + "quadratic" + end))});
  };
  std::printf("\n%s: %.0f vertices, %.0f tets\n", json.at("model").get<std::string>().c_str(), number("vertices"),
              number("tets"));
  if (json.at("outside") > 0) {
    std::printf("  %.0f vertices outside the cage, the farthest is vertex %.0f at a distance of %.3g\n",
                number("outside"), number("worst_vertex"), number("worst_distance"));
  }
  both("error, RMS, of the box's diagonal", "%.2e", "error_", "_rms");
  both("error, largest, of the box's diagonal", "%.2e", "error_", "_max");
  both("error of normals, mean, degrees", "%.2f", "normal_error_", "_deg");
  both("update, us per frame", "%.1f", "skin_", "_us_per_frame");
  std::printf("%s", table.text().c_str());
  printValue("distance of both",
             formatted("%.2e of the box's diagonal, RMS, when Bullet has turned the end", json, "difference_rms"));
  printValue("nodes off even twist",
             formatted("%.2e of the box's diagonal, RMS, at the same time", json, "nodes_off_twist_rms"));
  printValue("simulation", formatted("%.2f ms per frame", json, "simulation_ms_per_frame"));
  printValue("files", firstFileOf(output) + " ... " + summaryPath(output));
}

/// Both surfaces on one cage, as they are in the frames.
Recording record(const OutputOptions& output, const std::string& view, const Model& model, const Embedding& embedding) {
  const std::string title = titleOf(model.name);
  Recording recording(output, view, title + ", a full turn", factsOf(model), Interpolation::Quadratic);
  if (!recording.wanted()) return recording;
  const std::size_t shared = recording.addModel(title, model.cage, model.mesh, embedding);
  for (const char* name : {"linear", "quadratic"}) recording.addBody({shared, name, name});
  return recording;
}

int run(const TwistOptions& options) {
  const std::string view = viewPath(options.output);
  Player player(options.model, makerOf("wring"));
  const auto carry = [&](Interpolation interpolation) -> const Carried& {
    SkinOptions skin = options.skin;
    skin.interpolation = interpolation;
    return player.carry(skin);
  };
  const Carried& quadratic = carry(Interpolation::Quadratic);
  const Carried& linear = carry(Interpolation::Linear);
  SideBySide pair(player.model().mesh);
  FramePlan plan = framePlanOf(options.output);
  if (options.model.mesh.empty()) plan.materials = materialLibrary(pair.mesh());
  FrameWriter writer(plan, layoutWith(options.skin.normals, pair.layout()));
  Recording recording = record(options.output, view, player.model(), quadratic.skin.binding()->embedding());
  if (recording.hasGlb()) writer.addOther(Recording::kGlbName, recording.glbBytes());
  Totals totals;
  const Playback run = player.play(
      "twisting", options.output,
      [&](int frame) {
        measure(player, linear, quadratic, frame, totals);
        if (recording.wanted()) recording.keep({{player.nodes(), pair.beside(player.nodes())}, {}});
      },
      [&](int frame) { pair.write(linear, quadratic, frame, writer); });
  return finishRun(
      "tetskin_twist", options.output, run, writer, recording,
      [&] { return summarise(player, options, totals, run, linear, quadratic); },
      [&](const nlohmann::ordered_json& json) { printTable(json, options.output); });
}

}  // namespace

int main(int argc, char** argv) {
  TwistOptions options;
  options.model.builtIn = BuiltIn::Bar;
  options.model.tets = 600;
  options.skin.normals = Normals::Transformed;
  CommandLine line(
      "Twists a body, pinned at both ends of its longest side, by a full turn and releases it, in Bullet's deformable "
      "world. One cage carries a linear and a quadratic surface; prints the errors of both.",
      {{{"tetskin_twist", "a bar in a cage of about 600 tets: out/twist/frame_0000.obj, ..., and summary.json"},
        {"tetskin_twist --model serpent --tets 300", "the serpent in a coarser cage"}},
       "the simulation exploded"});
  line.addModelOptions(options.model);
  line.addSkinOptions(options.skin);
  line.addOutputOptions(options.output);
  return line.run(argc, argv, [&] {
    options.model.quiet = options.output.quiet;
    return run(options);
  });
}
