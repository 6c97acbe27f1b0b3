// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "report/cage_kind.h"
#include "report/simulation.h"
#include "scenes/command_line.h"

namespace tetskin::report {

/// What is to be measured, and where it goes.
struct ReportOptions {
  scenes::ModelOptions model;
  std::vector<std::string> scenes = {"sag", "twist", "drop", "exact"};
  std::vector<std::size_t> tets = {300, 1000, 3000, 10000};
  std::size_t referenceTets = 30000;
  std::string reference;  ///< file of tets that count as right, in the mesh's space; empty: made
  std::vector<SurfaceKind> surfaces = {SurfaceKind::Linear, SurfaceKind::Quadratic, SurfaceKind::Bullet};
  std::vector<CageKind> cages = {CageKind::Same, CageKind::Calibrated};
  std::vector<std::size_t> modes = {5, 10, 20, 50};  ///< of reduced bodies, beside the cages; none: there are none
  bool bullet = false;                               ///< bodies by Bullet's forces instead of the library's
  bool implicit = false;                             ///< with Bullet's forces: implicit rows beside the explicit ones
  int frames = 0;                                    ///< 0: the scene's own
  double stiffness = 0.0;                            ///< over density x gravity x size; 0: the scene's own
  std::size_t shownTets = 3000;                      ///< of the cage whose errors colour a mesh
  double targetError = 0.0;                          ///< in box diagonals; 0: none
  std::string out = "out/error_vs_time", json;
  std::string view;  ///< file of a page that plays that cage beside the reference; empty: none
  bool quiet = false;
};

/// Of the scenes, the one that a page plays: sag, or the first that is simulated; empty if none is.
std::string shownScene(const ReportOptions& options);

/// Throws InputError unless a reference of so many tets has more than all cages.
void requireFiner(const ReportOptions& options, std::size_t referenceTets);

/// The command line's options, among them --quick and --full, which preset others. Call `finish` after parsing.
class ReportCommandLine {
 public:
  explicit ReportCommandLine(scenes::CommandLine& line);
  /// Throws InputError.
  const ReportOptions& finish();

 private:
  ReportOptions options_;
  scenes::CommandLine& line_;
  void chooseCages();

  std::vector<std::string> cages_;
  std::string interpolation_, force_ = "tetskin";
  bool quick_ = false, full_ = false, noCalibration_ = false, noReduction_ = false;
};

}  // namespace tetskin::report
