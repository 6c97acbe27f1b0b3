// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// One row of the report, and the names of its columns.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace tetskin::report {

struct Row {
  std::string scene;
  std::string integrator;  ///< tetskin: by the library's force; by Bullet's: explicit, implicit; none where nothing is
                           ///< simulated; or the name of a Solver
  std::string material;    ///< kind of the cage: see CageKind; same for the reference, whatever it is;
                           ///< reduced: a reduced body's
  std::string interpolation;  ///< linear, quadratic; reference for the reference itself

  double tets = 0, nodes = 0;
  double edge = 0;    ///< mean length of the cage's edges
  double copies = 0;  ///< duplicate tets beyond the first at their position
  double stiffnessFactor = 1;
  double calibrationLeft = 0;                   ///< estimated remaining error, as a share of the displacement
  double errorAgainstBullet = 0;                ///< total, RMS, against a reference with Bullet's forces; 0 without one
  double substeps = 0;                          ///< per frame; 0 where nothing is simulated
  double errorTotalRms = 0, errorTotalMax = 0;  ///< against the reference: in space and in time
  double errorOfMotion = 0;                     ///< RMS, over the RMS distance of the reference's surface from rest
  double errorSpaceRms = 0;                     ///< of this cage in the reference's substeps, against the reference
  /// Against this cage in the reference's substeps; the total is at most space plus time. 0 with Bullet's forces, where
  /// the reference has the row's own substeps.
  /// In rows of compared solvers: against this cage with tetskin's solver in the reference's substeps, so that it
  /// contains everything that the solver adds, by its steps, iterations and model.
  double errorTimeRms = 0;
  double errorEmbeddingRms = 0;   ///< if the nodes were where the reference would take them
  double errorSimulationRms = 0;  ///< of the nodes, against where the reference would take them: in space and in time
  double normalErrorMeanDeg = 0;
  double resolved = 1;  ///< 0: the total error is less than three times that of the reference, as far as is known
  double simulationMs = 0, skinUs = 0, totalMs = 0;  ///< per frame
  double attachMs = 0, calibrateMs = 0;              ///< once
  double dampingMs = 0;                              ///< in rows of solvers: that of the material
  double xpbdStiffness = 0, xpbdVolume = 0;          ///< see XpbdConstants; the second -1: rigid
  double modes = 0;                                  ///< used by a reduced body; 0: the body is simulated by its tets
  double modesLeftOut = 0;                           ///< left out as too fast for the substep
  double modesMs = 0;                                ///< once: to find the modes
  double projectionError = 0;                        ///< the largest of the modes in use: see ReductionReport
  double speedup = 0;                                ///< over the reference's total time; 0 where nothing is simulated
  double speedupAgainstBullet = 0;  ///< over the total time of a reference with Bullet's forces; 0 without one
  double memoryBytes = 0;
  double frames = 0;    ///< number of frames compared
  double finite = 1;    ///< 0: it exploded; errors are those of the frames before that
  double diagonal = 0;  ///< of the mesh's box, in the mesh's unit: the unit of errors and edge

  std::vector<double> errorByFrame;      ///< total, RMS
  std::vector<double> amplitudeByFrame;  ///< how far the reference's surface is from rest, RMS
  bool pareto = false;                   ///< no other row of the scene is both faster and more accurate

  bool isReduced() const { return modes != 0; }
  bool isReference() const { return interpolation == "reference"; }
  /// True for a setting that a user of the library may choose.
  bool isChoice() const { return !isReference() && finite != 0; }
};

/// A column of numbers: its name, which ends in the unit if it has one, and the member of Row that it shows.
struct Column {
  const char* name;
  double Row::*value;
};
/// The columns in the order of all tables.
const std::vector<Column>& columns();

nlohmann::ordered_json toJson(const Row& row);

}  // namespace tetskin::report
