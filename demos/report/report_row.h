// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// One line of the report, and what its columns are called.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace tetskin::report {

struct Row {
  std::string scene;
  std::string integrator;  ///< tetskin: by the library's force; by Bullet's: explicit, implicit; none where nothing is
                           ///< simulated
  std::string material;    ///< kind of the cage: see CageKind; same for the reference, whatever it is;
                           ///< reduced: a reduced body's
  std::string interpolation;  ///< linear, quadratic, bullet; reference for the reference itself

  double tets = 0, nodes = 0;
  double edge = 0;    ///< mean length of the cage's edges
  double copies = 0;  ///< tets beyond the first at their place, where the cage is split
  double stiffnessFactor = 1;
  double calibrationLeft = 0;     ///< of the displacement: what calibration has left, by its own estimate
  double errorAgainstBullet = 0;  ///< total, RMS, against a reference by Bullet's forces; 0 without
  double errorTotalRms = 0, errorTotalMax = 0, errorEmbeddingRms = 0, errorSimulationRms = 0;
  double normalErrorMeanDeg = 0;
  double simulationMs = 0, skinUs = 0, totalMs = 0;  ///< a frame
  double attachMs = 0, calibrateMs = 0;              ///< once
  double modes = 0;                                  ///< in use by a reduced body; 0: it is simulated by its tets
  double modesLeftOut = 0;                           ///< too fast for the substep
  double modesMs = 0;                                ///< once: to find the modes
  double projectionError = 0;                        ///< of the modes in use, the largest: see ReductionReport
  double speedup = 0;                                ///< against the reference's total; 0 where nothing is simulated
  double speedupAgainstBullet = 0;                   ///< the same against a reference by Bullet's forces; 0 without
  double memoryBytes = 0;
  double frames = 0;    ///< compared
  double finite = 1;    ///< 0: it exploded; errors are those of the frames before
  double diagonal = 0;  ///< of the mesh's box, in the mesh's unit: the unit of errors and edge

  std::vector<double> errorByFrame;      ///< total, RMS
  std::vector<double> amplitudeByFrame;  ///< how far the reference's surface is from rest, RMS
  bool pareto = false;                   ///< nothing in its scene is both faster and more accurate

  bool isReduced() const { return modes != 0; }
  bool isReference() const { return interpolation == "reference"; }
  /// A setting that a user of this library may choose.
  bool isChoice() const { return !isReference() && interpolation != "bullet" && finite != 0; }
};

/// A column of numbers: its name, which ends in its unit where that is one, and its place in a row.
struct Column {
  const char* name;
  double Row::*value;
};
/// In the order of all tables.
const std::vector<Column>& columns();

nlohmann::ordered_json toJson(const Row& row);
Row rowFrom(const nlohmann::ordered_json& json);

}  // namespace tetskin::report
