// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/triangle_mesh.h>
#include <tetskin/elastic/calibration.h>

#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "report/cage_kind.h"

namespace tetskin::report {

/// Mean length of a cage's edges.
double meanEdge(const Cage& cage);
/// Tets beyond the first at their place.
std::size_t copiesIn(const Cage& cage);

struct ShelvedCage {
  Cage cage;
  CalibrationReport calibration;  ///< as made by default where there was none: a factor of 1
};

/// The cages of one mesh by the number of tets wished for and their kind, and that of the reference, each made when it
/// is first asked for. Throws InputError.
class CageShelf {
 public:
  /// mesh  outlives this object
  CageShelf(const TriangleMesh& mesh, std::size_t referenceTets) : mesh_(mesh), referenceTets_(referenceTets) {}

  const ShelvedCage& at(std::size_t tets, CageKind kind);
  /// Split and filled, so that it approaches the mesh itself; not fitted, whose tets of many shapes are stiffer; and
  /// calibrated where it is not too fine for that: what it is too stiff by would count as the cages' error.
  const ShelvedCage& reference();
  /// Takes a cage for the reference, instead of building it.
  void putReference(Cage cage, bool calibrated);

 private:
  const TriangleMesh& mesh_;
  std::size_t referenceTets_;
  std::map<std::pair<std::size_t, CageKind>, ShelvedCage> cages_;
  std::optional<ShelvedCage> reference_;
};

}  // namespace tetskin::report
