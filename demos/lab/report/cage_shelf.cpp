// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/cage_shelf.h"

#include <tetskin/bullet/soft_body.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/core/cage.h>

#include <algorithm>
#include <set>

#include "scenes/caged_mesh.h"
#include "scenes/input_error.h"

namespace tetskin::report {
namespace {

/// Makes all tets full; which of them contain the vertices is still known.
void makeBare(Cage& cage) {
  cage.volumeFraction.clear();
  cage.fineVolumeFraction.clear();
  cage.masses.clear();
  cage.stiffnessFactor.clear();
}

}  // namespace

double meanEdge(const Cage& cage) {
  const std::vector<std::array<int, 2>> edges = uniqueEdges(cage.mesh);
  double sum = 0.0;
  for (const auto& [a, b] : edges) sum += (cage.mesh.nodes[a] - cage.mesh.nodes[b]).norm();
  return sum / static_cast<double>(edges.size());
}

std::size_t copiesIn(const Cage& cage) {
  return cage.sourceTet.size() - std::set<int>(cage.sourceTet.begin(), cage.sourceTet.end()).size();
}

ShelvedCage shelved(Cage cage, bool calibrated) {
  ShelvedCage result{std::move(cage), {}};
  if (!calibrated) return result;
  CalibrationOptions options;
  options.poissonRatio = SoftBodyOptions().poissonRatio;
  Result<CalibrationReport> calibration = calibrate(result.cage, options);
  scenes::require(calibration.status());
  result.calibration = std::move(calibration).value();
  return result;
}

Filling fillingFor(const scenes::ModelOptions& model, const scenes::Placement& placement) {
  const std::size_t fewest = scenes::fewestConformingTets(model.builtIn);
  if (!model.mesh.empty() || fewest == 0) return {};
  return [builtIn = model.builtIn, fewest, placement](std::size_t tets) {
    return placement.toWorld(*scenes::conformingTets(builtIn, std::max(tets, fewest)));
  };
}

Cage CageShelf::made(std::size_t tets, CageKind kind) const {
  CageOptions options;
  options.targetTets = tets;
  options.duplicateElements = isSplit(kind);
  Cage cage = scenes::builtCage(mesh_, options);
  if (!isFilled(kind)) makeBare(cage);
  return cage;
}

const ShelvedCage& CageShelf::at(std::size_t tets, CageKind kind) {
  const auto found = cages_.find({tets, kind});
  if (found != cages_.end()) return found->second;
  return cages_[{tets, kind}] = shelved(made(tets, kind), isCalibrated(kind));
}

}  // namespace tetskin::report
