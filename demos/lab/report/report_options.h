// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "report/cage_kind.h"
#include "report/simulation.h"
#include "report/solver.h"
#include "scenes/command_line.h"

namespace tetskin::report {

/// What to measure, and where to write it.
struct ReportOptions {
  scenes::ModelOptions model;
  std::vector<std::string> scenes = {"sag", "twist", "drop", "exact"};
  std::vector<std::size_t> tets = {300, 1000, 3000, 10000};
  std::size_t referenceTets = 30000;
  /// Per frame, ascending: the recommended kind of cage is simulated with all of these, everything else with one of
  /// them (see usualSubsteps). The reference with Bullet's forces has as many as these need to be stable.
  std::vector<std::size_t> substeps = {1, 2, 4, 8};
  std::size_t referenceSubsteps = 64;
  std::string reference;  ///< file of tets that count as exact, in the mesh's space; empty: they are made
  std::vector<SurfaceKind> surfaces = {SurfaceKind::Linear, SurfaceKind::Quadratic};
  std::vector<CageKind> cages = {CageKind::Same, CageKind::Calibrated};
  std::vector<std::size_t> modes = {5, 10, 20, 50};  ///< of reduced bodies, besides the cages; empty: no reduced bodies
  /// Not empty: these solvers in the recommended kind of cage, instead of kinds of cages. `substeps` are tetskin's.
  std::vector<Solver> solvers;
  std::vector<std::size_t> xpbdSubsteps = {4, 10, 20, 50};
  std::vector<std::size_t> bulletSubsteps = {1, 2, 4, 8};
  std::size_t repetitions = 3;   ///< of each run of a solver that is timed
  int frames = 0;                ///< 0: the scene's own
  double stiffness = 0.0;        ///< Young's modulus over density x gravity x size; 0: the scene's own
  std::size_t shownTets = 3000;  ///< of the cage whose errors colour a mesh
  double targetError = 0.0;      ///< in diagonals of the mesh's box; 0: none
  std::string out = "out/error_vs_time", json;
  std::string view;  ///< file of a page that plays the cage of `shownTets` next to the reference; empty: none
  bool quiet = false;
};

/// The scene that a page plays: sag, or the first one that is simulated; empty if none is.
std::string shownScene(const ReportOptions& options);

/// The one of the substeps that is nearest to what all demos take.
int usualSubsteps(const ReportOptions& options);

/// Throws InputError unless a reference with this many tets is finer than every cage.
void requireFiner(const ReportOptions& options, std::size_t referenceTets);

/// The options of the command line, among them --quick and --full, which preset others. Call `finish` after parsing.
class ReportCommandLine {
 public:
  explicit ReportCommandLine(scenes::CommandLine& line);
  /// Throws InputError.
  const ReportOptions& finish();

 private:
  ReportOptions options_;
  scenes::CommandLine& line_;
  void chooseCages();
  void chooseSolvers();
  void chooseSubsteps();

  std::vector<std::string> cages_, solvers_;
  std::string interpolation_ = "all";
  bool quick_ = false, full_ = false, noCalibration_ = false, noReduction_ = false;
};

}  // namespace tetskin::report
