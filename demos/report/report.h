// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The report of error against run time.
//
//   material           what cages are made of (scenes/table.h: the scenes)
//   cage_kind          what a cage knows of the mesh in it
//   cage_shelf         the cages, built and calibrated
//   simulation         a cage's motion in a scene, and what step and surfaces cost
//   reference          what is compared with
//   reference_cage     the tets whose motion that is
//   driven_nodes       where it would take the nodes of other cages
//   surface_errors     how far surfaces and nodes are from it
//   scene_runner       all cages of a scene, or what an earlier run has left of them (result_store)
//   advice             orders, Pareto front, the reference's own error
//   report_files       results for programs
//   plot_program       has demos/plots make tables and plots of them
#pragma once

#include <memory>
#include <vector>

#include "report/report_options.h"
#include "report/scene_runner.h"

namespace tetskin::report {

/// One scene with one integrator.
struct SceneResult {
  std::string scene, integrator;
  std::vector<Row> rows;
  double referenceError = 0.0;  ///< estimated; in box diagonals; 0: not known
};

struct ReportResult {
  std::string model;
  std::size_t vertices = 0, triangles = 0;
  ReferenceCage reference;  ///< without the cage
  std::vector<SceneResult> scenes;
};

/// Measures everything, and writes all files after every scene. Throws InputError.
ReportResult makeReport(const ReportOptions& options);

/// True if every simulation stayed finite.
bool allFinite(const ReportResult& result);

}  // namespace tetskin::report
