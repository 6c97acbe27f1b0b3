// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/report_options.h"

#include <algorithm>

namespace tetskin::report {
namespace {

constexpr std::size_t kFullTets = 300000;
constexpr SceneKind kAllScenes[] = {SceneKind::Sag, SceneKind::Twist, SceneKind::Drop, SceneKind::Exact};

}  // namespace

ReportCommandLine::ReportCommandLine(CLI::App& app) : app_(app) {
  ReportOptions& o = options_;
  std::vector<std::string> names;
  for (const SceneKind kind : kAllScenes) names.push_back(nameOf(kind));
  scenes::addSurfaceOptions(app, o.model);
  app.add_option("--scene", scenes_, "sag, twist, drop, exact, with commas (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  app.add_option("--tets", o.tets, "Tets of the cages, with commas")
      ->delimiter(',')
      ->check(scenes::isCount())
      ->capture_default_str();
  app.add_option("--reference-tets", o.referenceTets, "Tets of the cage that counts as right")
      ->check(scenes::isCount())
      ->capture_default_str();
  app.add_flag("--full", full_, "A reference of 300,000 tets");
  app.add_flag("--quick", quick_, "A small report, in half a minute");
  app.add_option("--interpolation", interpolation_, "Only linear, or only quadratic (default: both, and Bullet's own)")
      ->check(CLI::IsMember({"linear", "quadratic"}));
  app.add_flag("--implicit", o.implicit, "Implicit elasticity as well, beside the explicit one");
  app.add_flag("--no-calibration", noCalibration_, "No rows with calibrated stiffness");
  app.add_option("--frames", o.frames, "Frames of 1/60 s (default: the scene's)")->check(CLI::Range(1, 100000));
  app.add_option("--stiffness", o.stiffness, "Young's modulus over density x gravity x size (default: the scene's)")
      ->check(scenes::isPositive());
  app.add_option("--target-error", o.targetError, "Print the cheapest setting below this, in box diagonals")
      ->check(scenes::isPositive());
  app.add_option("--show-tets", o.shownTets, "The cage nearest to this colours a mesh by its errors")
      ->check(scenes::isCount())
      ->capture_default_str();
  app.add_option("--out", o.out, "Folder of the report, and of what an interrupted run had finished")
      ->check(scenes::isFileName())
      ->capture_default_str();
  scenes::addSummaryOption(app, o.json, "File of the results (default: error_vs_time.json in the folder)");
  app.add_flag("--quiet", o.quiet, "Print nothing but errors");
}

const ReportOptions& ReportCommandLine::finish() {
  ReportOptions& o = options_;
  if (quick_ && full_) throw scenes::InputError("--quick and --full exclude each other");
  const auto preset = [&](const char* option, auto& value, const auto& instead) {
    if (app_.count(option) == 0) value = instead;
  };
  if (full_) preset("--reference-tets", o.referenceTets, kFullTets);
  if (quick_) {
    preset("--triangles", o.model.triangles, std::size_t{6000});
    preset("--tets", o.tets, std::vector<std::size_t>{300, 1000, 3000});
    preset("--reference-tets", o.referenceTets, std::size_t{8000});
    preset("--frames", o.frames, 24);
  }
  if (!scenes_.empty()) {
    o.sceneKinds.clear();
    for (const SceneKind kind : kAllScenes) {
      if (std::count(scenes_.begin(), scenes_.end(), nameOf(kind)) > 0) o.sceneKinds.push_back(kind);
    }
  }
  if (interpolation_ == "linear") o.surfaces = {SurfaceKind::Linear};
  if (interpolation_ == "quadratic") o.surfaces = {SurfaceKind::Quadratic};
  o.calibrated = !noCalibration_;
  std::sort(o.tets.begin(), o.tets.end());
  o.tets.erase(std::unique(o.tets.begin(), o.tets.end()), o.tets.end());
  if (o.tets.empty() || o.tets.back() >= o.referenceTets) {
    throw scenes::InputError("--tets: cages must have fewer tets than the reference, which has " +
                             std::to_string(o.referenceTets));
  }
  if (o.json.empty()) o.json = o.out + "/error_vs_time.json";
  return o;
}

}  // namespace tetskin::report
