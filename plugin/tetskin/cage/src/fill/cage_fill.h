// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/split/split_lattice.h>

#include <cstdint>
#include <vector>

namespace tetskin::cage_detail {

/// How much of a cage is material.
struct CageFill {
  std::vector<double> fill;        ///< see `Cage::fill`
  std::vector<std::uint8_t> fine;  ///< see `Cage::fineFill`; empty where no calibration could use it
};

/// By samples, 256 a tet at the surface, or 32 of a cage too large to be calibrated. What a tet holds of another part
/// of the body does not count.
///
/// cage  with its nodes where they are now, fitted or not
CageFill fillOf(const CageTets& cage, const LatticeFrame& frame, const LatticeSet& set, const LatticeMesh& lattice);

/// Masses of the nodes that add up to `volume`: a quarter of each tet's material, but at least a tenth of the mean,
/// which is taken from the nodes around: one that is next to nothing would be thrown about by the rest.
///
/// fill  by tet, or empty: 1
std::vector<double> nodeMasses(const TetMesh& mesh, const std::vector<double>& fill, double volume);

}  // namespace tetskin::cage_detail
