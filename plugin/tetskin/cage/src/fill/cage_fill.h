// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/split/split_lattice.h>

#include <cstdint>
#include <vector>

namespace tetskin::cage_detail {

/// The volume fractions of a cage.
struct CageFill {
  std::vector<double> fill;        ///< see `Cage::volumeFraction`
  std::vector<std::uint8_t> fine;  ///< see `Cage::fineVolumeFraction`; empty if no calibration could use it
};

/// Computed by sampling, with 256 samples per tet at the surface, or 32 in a cage too large to be calibrated. Material
/// of another component in the tet does not count.
///
/// cage  with its current node positions, fitted or not
CageFill fillOf(const CageTets& cage, const LatticeFrame& frame, const LatticeSet& set, const LatticeMesh& lattice);

/// Masses of the nodes, with the sum `volume`: a quarter of each tet's material, but at least a tenth of the mean. The
/// difference is taken from neighbouring nodes: a node of almost no mass would be thrown about by the others.
///
/// fill  volume fraction by tet, or empty: 1
std::vector<double> nodeMasses(const TetMesh& mesh, const std::vector<double>& fill, double volume);

}  // namespace tetskin::cage_detail
