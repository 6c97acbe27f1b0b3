// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/report_options.h"

#include <algorithm>
#include <cmath>

#include "scenes/input_error.h"
#include "scenes/table.h"

namespace tetskin::report {
namespace {

constexpr std::size_t kFullTets = 300000;
constexpr int kMaxReferenceSubsteps = 1024;

void sortUniquely(std::vector<std::size_t>& counts) {
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
}

/// The names that the table knows, in its order.
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

int usualSubsteps(const ReportOptions& options) {
  const auto distance = [](std::size_t substeps) {
    return std::abs(std::log(static_cast<double>(substeps) / scenes::SceneOptions().substeps));
  };
  return static_cast<int>(*std::min_element(options.substeps.begin(), options.substeps.end(),
                                            [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); }));
}

void requireFiner(const ReportOptions& options, std::size_t referenceTets) {
  if (options.tets.back() < referenceTets) return;
  throw scenes::InputError("--tets: the cages must have fewer tets than the reference, which has " +
                           std::to_string(referenceTets));
}

ReportCommandLine::ReportCommandLine(scenes::CommandLine& line) : line_(line) {
  ReportOptions& o = options_;
  line.addSurfaceOptions(o.model);
  line.addWords("--scenes", o.scenes, "Scenes, a list of: " + scenes::sceneNames());
  line.addCounts("--tets", o.tets, "a list");
  line.addCount("--reference-tets", o.referenceTets, "Approximate number of tets of the reference",
                static_cast<int>(Limits::kMaxTargetTets));
  line.addCounts("--substeps", o.substeps,
                 "Steps of the simulation per frame, a list: the recommended kind of cage is simulated with each of "
                 "them, everything else with the one nearest to " +
                     std::to_string(scenes::SceneOptions().substeps));
  line.addCount("--reference-substeps", o.referenceSubsteps, "Steps of the reference per frame", kMaxReferenceSubsteps);
  line.addInput("--reference", o.reference,
                "Tet mesh to use as the reference, in which no components of the mesh are fused: .vtk, or .ele "
                "with .node, in the mesh's coordinates",
                scenes::CommandLine::Need::Optional, "by formula for a built-in model that has one, else a built cage");
  line.addFlag("--full", full_, "Use a reference of 300,000 tets");
  line.addFlag("--quick", quick_, "a small report, in half a minute");
  line.addWord("--interpolation", interpolation_, {"all", "linear", "quadratic"});
  line.addWords(
      "--cages", cages_,
      "Kinds of cages, a list of: same (bare tets), same_calibrated, split (bare tets, elements duplicated), "
      "filled (weighted by how much of the mesh each tet contains), calibrated (elements duplicated, weighted "
      "and calibrated), all",
      "same,calibrated");
  line.addWords(
      "--solvers", solvers_,
      "Compare solvers in calibrated cages, in sag, instead of kinds of cages; a list of: tetskin, xpbd, "
      "xpbd_unfitted, bullet_neo_hookean, bullet_linear, bullet_neo_hookean_implicit, bullet_linear_implicit, all",
      "none");
  line.addCounts("--xpbd-substeps", o.xpbdSubsteps, "a list, for --solvers");
  line.addCounts("--bullet-substeps", o.bulletSubsteps, "a list, for --solvers; of those that explode, rows say so");
  line.addCount("--repetitions", o.repetitions, "How often each variant is timed; the median is printed", 1000);
  line.addFlag("--no-calibration", noCalibration_, "Leave out cages of calibrated stiffness");
  line.addCounts("--modes", o.modes, "a list, for sag and drop");
  line.addFlag("--no-reduction", noReduction_, "Leave out reduced bodies");
  line.addCount("--frames", o.frames, "", 100000, "as the scene has");
  line.addPositive("--stiffness", o.stiffness, "Young's modulus divided by density x gravity x body size",
                   "as the scene has");
  line.addPositive("--target-error", o.targetError,
                   "Print the cheapest setting with a smaller error, as a fraction of the box's diagonal", "none");
  line.addCount("--show-tets", o.shownTets, "Write a mesh coloured by the errors of the cage nearest to this size");
  line.addOutput("--view", o.view, "the cage of --show-tets beside the reference, in sag or else the first scene");
  line.addFolder("--out", o.out, "",
                 [&o](const std::string& name) {  // all files, except results that --json names
                   return name.rfind("error_", 0) == 0 && (o.json.empty() || name != "error_vs_time.json");
                 });
  line.addSummaryOption(o.json, o.out + "/error_vs_time.json");
  line.addQuietOption(o.quiet);
}

void ReportCommandLine::chooseCages() {
  std::vector<CageKind>& kinds = options_.cages;
  if (line_.given("--cages")) kinds = cageKindsOf(cages_);
  if (noCalibration_) kinds.erase(std::remove_if(kinds.begin(), kinds.end(), isCalibrated), kinds.end());
  if (kinds.empty())
    throw scenes::InputError("--cages: no kind of cage is left with --no-calibration; name another kind");
}

void ReportCommandLine::chooseSolvers() {
  ReportOptions& o = options_;
  if (!line_.given("--solvers")) {
    for (const char* option : {"--xpbd-substeps", "--bullet-substeps", "--repetitions"}) {
      if (line_.given(option)) throw scenes::InputError(std::string(option) + " needs --solvers");
    }
    return;
  }
  o.solvers = solversOf(solvers_);
  if (o.solvers.empty()) throw scenes::InputError("--solvers: name at least one solver");
  for (const char* option : {"--cages", "--no-calibration", "--modes", "--no-reduction", "--view"}) {
    if (line_.given(option)) throw scenes::InputError(std::string(option) + " cannot be used with --solvers");
  }
  if (!line_.given("--scenes")) o.scenes = {"sag"};
  if (o.scenes != std::vector<std::string>{"sag"})
    throw scenes::InputError("--solvers: solvers are compared in sag only, as XPBD here has no contact");
  if (!line_.given("--tets")) o.tets = {3000};
  o.cages = {CageKind::Calibrated};
  o.modes.clear();
  if (o.surfaces.size() > 1) o.surfaces = {SurfaceKind::Linear};
  for (std::vector<std::size_t>* counts : {&o.xpbdSubsteps, &o.bulletSubsteps}) {
    if (counts->empty()) throw scenes::InputError("--xpbd-substeps, --bullet-substeps: name at least one number");
    sortUniquely(*counts);
  }
}

void ReportCommandLine::chooseSubsteps() {
  ReportOptions& o = options_;
  if (o.substeps.empty()) throw scenes::InputError("--substeps: name at least one number");
  sortUniquely(o.substeps);
  if (o.substeps.back() <= o.referenceSubsteps) return;
  throw scenes::InputError("--substeps: the cages must have no more substeps than the reference, which has " +
                           std::to_string(o.referenceSubsteps));
}

const ReportOptions& ReportCommandLine::finish() {
  ReportOptions& o = options_;
  if (quick_ && full_) throw scenes::InputError("--quick and --full cannot be used together");
  if (!o.reference.empty() && (full_ || line_.given("--reference-tets"))) {
    throw scenes::InputError(
        "--reference cannot be used with --reference-tets or --full: the number of tets is that of the file");
  }
  const auto preset = [&](const char* option, auto& value, const auto& instead) {
    if (!line_.given(option)) value = instead;
  };
  if (full_) preset("--reference-tets", o.referenceTets, kFullTets);
  if (quick_) {
    preset("--triangles", o.model.triangles, std::size_t{6000});
    preset("--tets", o.tets, std::vector<std::size_t>{300, 1000, 3000});
    preset("--reference-tets", o.referenceTets, std::size_t{8000});
    preset("--substeps", o.substeps, std::vector<std::size_t>{1, 2, 4});
    preset("--reference-substeps", o.referenceSubsteps, std::size_t{16});
    preset("--frames", o.frames, 24);
    preset("--modes", o.modes, std::vector<std::size_t>{5, 20});
    preset("--xpbd-substeps", o.xpbdSubsteps, std::vector<std::size_t>{4, 10});
    preset("--bullet-substeps", o.bulletSubsteps, std::vector<std::size_t>{4, 8});
    preset("--repetitions", o.repetitions, std::size_t{1});
  }
  o.scenes = inOrder(o.scenes);
  if (interpolation_ == "linear") o.surfaces = {SurfaceKind::Linear};
  if (interpolation_ == "quadratic") o.surfaces = {SurfaceKind::Quadratic};
  chooseCages();
  if (noReduction_) o.modes.clear();
  if (!o.view.empty() && shownScene(o).empty())
    throw scenes::InputError("--view: none of the scenes in --scenes is simulated; add sag, for example");
  sortUniquely(o.modes);
  chooseSolvers();
  chooseSubsteps();
  sortUniquely(o.tets);
  if (o.tets.empty()) throw scenes::InputError("--tets: name at least one number");
  if (o.reference.empty()) requireFiner(o, o.referenceTets);
  if (o.json.empty()) o.json = o.out + "/error_vs_time.json";
  return o;
}

}  // namespace tetskin::report
