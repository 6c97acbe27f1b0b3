// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/report_options.h"

#include <algorithm>

#include "scenes/input_error.h"
#include "scenes/table.h"

namespace tetskin::report {
namespace {

constexpr std::size_t kFullTets = 300000;

/// Known to the table, and in its order.
std::vector<std::string> inOrder(const std::vector<std::string>& wanted) {
  for (const std::string& name : wanted) (void)scenes::sceneNamed(name);
  std::vector<std::string> sorted;
  for (const scenes::SceneEntry& entry : scenes::sceneTable()) {
    if (std::count(wanted.begin(), wanted.end(), entry.name) > 0) sorted.push_back(entry.name);
  }
  return sorted;
}

}  // namespace

std::string shownScene(const ReportOptions& options) {
  const std::vector<std::string>& scenes = options.scenes;
  if (std::count(scenes.begin(), scenes.end(), "sag") > 0) return "sag";
  const auto first =
      std::find_if(scenes.begin(), scenes.end(), [](const std::string& scene) { return scene != "exact"; });
  return first == scenes.end() ? std::string() : *first;
}

void requireFiner(const ReportOptions& options, std::size_t referenceTets) {
  if (options.tets.back() < referenceTets) return;
  throw scenes::InputError("--tets: cages must have fewer tets than the reference, which has " +
                           std::to_string(referenceTets));
}

ReportCommandLine::ReportCommandLine(scenes::CommandLine& line) : line_(line) {
  ReportOptions& o = options_;
  line.addSurfaceOptions(o.model);
  line.addWords("--scene", o.scenes, "With commas (default: sag,twist,drop,exact), of: " + scenes::sceneNames());
  line.addCounts("--tets", o.tets, "Tets of the cages, with commas");
  line.addCount("--reference-tets", o.referenceTets, "Tets of the cage that counts as right",
                static_cast<int>(kLargestTargetTets));
  line.addInput(
      "--reference", o.reference,
      "Tets that count as right, and fuse no parts of the mesh that are near to each other: .vtk, .ele/.node or "
      ".msh, in the mesh's space (default: by formula for a built-in model that has one, otherwise a built cage)");
  line.addFlag("--full", full_, "A reference of 300,000 tets");
  line.addFlag("--quick", quick_, "A small report, in half a minute");
  line.addWord("--interpolation", interpolation_, {"linear", "quadratic"},
               "Only linear, or only quadratic (default: both, and Bullet's own)");
  line.addWord("--force", force_, {"bullet", "tetskin"},
               "Whose elastic forces (default: tetskin, with its solver, and compared with both references)");
  line.addFlag("--implicit", o.implicit, "With --force bullet: implicit elasticity as well, beside the explicit one");
  line.addWords("--cages", cages_,
                "Kinds of cages, with commas (default: same,calibrated), of: same (bare tets), same_calibrated, split "
                "(bare, with tets of their own for parts of the mesh), filled (by the mesh, not split), calibrated "
                "(split, filled and calibrated), all");
  line.addFlag("--no-calibration", noCalibration_, "No cages of calibrated stiffness");
  line.addCounts("--modes", o.modes, "Modes of reduced bodies in sag and drop, with commas");
  line.addFlag("--no-reduction", noReduction_, "No reduced bodies");
  line.addCount("--frames", o.frames, "Frames of 1/60 s (default: the scene's)", 100000);
  line.addPositive("--stiffness", o.stiffness, "Young's modulus over density x gravity x size (default: the scene's)");
  line.addPositive("--target-error", o.targetError, "Print the cheapest setting below this, in box diagonals");
  line.addCount("--show-tets", o.shownTets, "The cage nearest to this colours a mesh by its errors");
  line.addOutput(
      "--view", o.view,
      "Write a page that plays, in a browser, that cage beside the reference, in sag or the first other scene");
  line.addFolder(
      "--out", o.out, "Folder of the report, and of what an interrupted run had finished",
      [&o](const std::string& name) {  // tables, plots, coloured meshes, and the results unless --json has them
        return name.rfind("error_", 0) == 0 && (o.json.empty() || name != "error_vs_time.json");
      });
  line.addSummaryOption(o.json, "File of the results (default: error_vs_time.json in the folder)");
  line.addQuietOption(o.quiet);
}

void ReportCommandLine::chooseCages() {
  std::vector<CageKind>& kinds = options_.cages;
  if (line_.given("--cages")) kinds = cageKindsOf(cages_);
  if (noCalibration_) kinds.erase(std::remove_if(kinds.begin(), kinds.end(), isCalibrated), kinds.end());
  if (kinds.empty()) throw scenes::InputError("--cages: there must be one, and --no-calibration leaves none");
}

const ReportOptions& ReportCommandLine::finish() {
  ReportOptions& o = options_;
  if (quick_ && full_) throw scenes::InputError("--quick and --full exclude each other");
  if (!o.reference.empty() && (full_ || line_.given("--reference-tets"))) {
    throw scenes::InputError("--reference excludes --reference-tets and --full: the file tells how many");
  }
  const auto preset = [&](const char* option, auto& value, const auto& instead) {
    if (!line_.given(option)) value = instead;
  };
  if (full_) preset("--reference-tets", o.referenceTets, kFullTets);
  if (quick_) {
    preset("--triangles", o.model.triangles, std::size_t{6000});
    preset("--tets", o.tets, std::vector<std::size_t>{300, 1000, 3000});
    preset("--reference-tets", o.referenceTets, std::size_t{8000});
    preset("--frames", o.frames, 24);
    preset("--modes", o.modes, std::vector<std::size_t>{5, 20});
  }
  o.scenes = inOrder(o.scenes);
  if (interpolation_ == "linear") o.surfaces = {SurfaceKind::Linear};
  if (interpolation_ == "quadratic") o.surfaces = {SurfaceKind::Quadratic};
  chooseCages();
  if (noReduction_) o.modes.clear();
  if (!o.view.empty() && shownScene(o).empty()) throw scenes::InputError("--view: no scene of --scene is simulated");
  std::sort(o.modes.begin(), o.modes.end());
  o.modes.erase(std::unique(o.modes.begin(), o.modes.end()), o.modes.end());
  o.bullet = force_ == "bullet";
  if (o.implicit && !o.bullet) throw scenes::InputError("--implicit is about Bullet's forces: add --force bullet");
  std::sort(o.tets.begin(), o.tets.end());
  o.tets.erase(std::unique(o.tets.begin(), o.tets.end()), o.tets.end());
  if (o.tets.empty()) throw scenes::InputError("--tets: there must be one");
  if (o.reference.empty()) requireFiner(o, o.referenceTets);
  if (o.json.empty()) o.json = o.out + "/error_vs_time.json";
  return o;
}

}  // namespace tetskin::report
