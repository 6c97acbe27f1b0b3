// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/cage_shelf.h"

#include <tetskin/cage/cage_builder.h>

#include "scenes/input_error.h"

namespace tetskin::report {

double meanEdge(const Cage& cage) {
  const std::vector<std::array<int, 2>> edges = uniqueEdges(cage);
  double sum = 0.0;
  for (const auto& [a, b] : edges) sum += (cage.nodes[a] - cage.nodes[b]).norm();
  return sum / static_cast<double>(edges.size());
}

const Cage& CageShelf::cage(std::size_t tets) {
  const auto found = cages_.find(tets);
  if (found != cages_.end()) return found->second;
  CageOptions options;
  options.targetTets = tets;
  Result<Cage> cage = buildCage(mesh_, options);
  scenes::require(cage.status());
  return cages_[tets] = std::move(cage).value();
}

const CalibrationReport& CageShelf::calibration(std::size_t tets, double poissonRatio) {
  const auto found = calibrations_.find(tets);
  if (found != calibrations_.end()) return found->second;
  CalibrationOptions options;
  options.poissonRatio = poissonRatio;
  Cage calibrated = cage(tets);
  Result<CalibrationReport> calibration = calibrate(calibrated, options);
  scenes::require(calibration.status());
  return calibrations_[tets] = std::move(calibration).value();
}

}  // namespace tetskin::report
