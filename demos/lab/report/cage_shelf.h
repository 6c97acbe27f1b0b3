// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>
#include <tetskin/elastic/calibration.h>

#include <cstddef>
#include <functional>
#include <map>
#include <utility>

#include "report/cage_kind.h"
#include "scenes/model.h"
#include "scenes/placement.h"

namespace tetskin::report {

/// Mean length of a cage's edges.
double meanEdge(const Cage& cage);
/// The number of duplicate tets: those beyond the first at their position.
std::size_t copiesIn(const Cage& cage);

struct ShelvedCage {
  Cage cage;
  CalibrationReport calibration;  ///< of the cage as built, without calibration: a factor of 1
};

/// A cage with its stiffness corrected, or as it is. Throws InputError.
ShelvedCage shelved(Cage cage, bool calibrated);

/// About this many tets that fill the body of a mesh, in the space where cages are compared.
using Filling = std::function<Cage(std::size_t tets)>;
/// The filling of a built-in model that has one by formula; otherwise none.
/// placement  from the model's space to where cages are compared
Filling fillingFor(const scenes::ModelOptions& model, const scenes::Placement& placement);

/// The cages of one mesh by the requested number of tets and their kind. Each is made when it is first asked for.
/// Throws InputError.
class CageShelf {
 public:
  /// mesh  outlives this object
  explicit CageShelf(const TriangleMesh& mesh) : mesh_(mesh) {}

  const ShelvedCage& at(std::size_t tets, CageKind kind);

 private:
  Cage made(std::size_t tets, CageKind kind) const;

  const TriangleMesh& mesh_;
  std::map<std::pair<std::size_t, CageKind>, ShelvedCage> cages_;
};

}  // namespace tetskin::report
