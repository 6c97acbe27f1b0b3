// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>
#include <tetskin/elastic/calibration.h>

#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "report/cage_kind.h"

namespace tetskin::report {

/// Mean length of a cage's edges.
double meanEdge(const Cage& cage);
/// The number of duplicate tets: those beyond the first at their position.
std::size_t copiesIn(const Cage& cage);

struct ShelvedCage {
  Cage cage;
  CalibrationReport calibration;  ///< of the cage as built, without calibration: a factor of 1
};

/// The cages of one mesh by the requested number of tets and their kind, and the reference's cage. Each is made when it
/// is first asked for. Throws InputError.
class CageShelf {
 public:
  /// mesh  outlives this object
  CageShelf(const TriangleMesh& mesh, std::size_t referenceTets) : mesh_(mesh), referenceTets_(referenceTets) {}

  const ShelvedCage& at(std::size_t tets, CageKind kind);
  /// The cage of a reference has duplicate elements and volume fractions, so that it approaches the mesh itself. It is
  /// not fitted, as fitted tets of many shapes are stiffer. It is calibrated where it is not too fine for that: its
  /// excess stiffness would otherwise count as the cages' error.
  const ShelvedCage& reference();
  /// Uses a given cage as the reference's, instead of building one.
  void putReference(Cage cage, bool calibrated);

 private:
  const TriangleMesh& mesh_;
  std::size_t referenceTets_;
  std::map<std::pair<std::size_t, CageKind>, ShelvedCage> cages_;
  std::optional<ShelvedCage> reference_;
};

}  // namespace tetskin::report
