// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The report of error against run time.
//
// material           what cages are made of (for the scenes themselves see scenes/table.h)
// cage_kind          how much a cage knows of the mesh in it
//   cage_shelf         the cages, built and calibrated
// simulation         a cage's motion in a scene, and the time of steps and surfaces
// reference          the motion that counts as exact
// reference_cage     the tets that have this motion, and coarser ones, which tell its own error
//   quadratic_cage     a cage of quadratic tets
// driven_nodes       where it would take the nodes of other cages
// surface_errors     errors of surfaces and nodes against it
// solver             what else simulates the same cage
//   xpbd_fit           the constants that suit XPBD best
// scene_runner       all cages of a scene
//   advice             Pareto front, the reference's own errors
//   report_files       results for programs
// plot_program       runs demos/lab/plots, which makes tables and plots of them
#pragma once

#include <vector>

#include "report/report_options.h"
#include "report/scene_runner.h"

namespace tetskin::report {

/// One scene with one integrator.
struct SceneResult {
  std::string scene, integrator;
  std::vector<Row> rows;
  double referenceError = 0.0, referenceTimeError = 0.0;  ///< in space and in time, estimated; in diagonals of the
                                                          ///< mesh's box; 0: not known
};

struct ReportResult {
  std::string model;
  std::size_t vertices = 0, triangles = 0;
  ReferenceSource reference;
  std::vector<SceneResult> scenes;
};

/// Measures everything, and writes all files after every scene. Throws InputError.
ReportResult makeReport(const ReportOptions& options);

/// True if every simulation stayed finite.
bool allFinite(const ReportResult& result);

}  // namespace tetskin::report
