// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/triangle_mesh.h>
#include <tetskin/elastic/calibration.h>

#include <cstddef>
#include <map>

namespace tetskin::report {

/// Mean length of a cage's edges.
double meanEdge(const Cage& cage);

/// The cages of one mesh by the number of tets wished for, each built, and calibrated, when it is first asked for.
/// Throws InputError.
class CageShelf {
 public:
  /// mesh  outlives this object
  explicit CageShelf(const TriangleMesh& mesh) : mesh_(mesh) {}

  const Cage& cage(std::size_t tets);
  /// Takes a cage for that of so many tets, instead of building it.
  void put(std::size_t tets, Cage cage) { cages_[tets] = std::move(cage); }
  const CalibrationReport& calibration(std::size_t tets, double poissonRatio);

 private:
  const TriangleMesh& mesh_;
  std::map<std::size_t, Cage> cages_;
  std::map<std::size_t, CalibrationReport> calibrations_;
};

}  // namespace tetskin::report
