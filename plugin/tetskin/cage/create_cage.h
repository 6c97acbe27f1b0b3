// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace tetskin {

/// Options of `createCage`.
struct CageOptions {
  /// Requested number of tets, 1 to Limits::kMaxTargetTets. Met within 10 % except for very small numbers, see
  /// `CageReport::targetMet`.
  std::size_t targetTets = 3000;
  /// Virtual-node method: where regions of the mesh are nearer to each other than the size of a tet, or the mesh folds
  /// back on itself, each region gets its own copy of the tet; see Cage. No effect if no duplicates are needed.
  bool duplicateElements = true;
  /// Move boundary nodes towards the surface: a smaller cage, whose tets are no longer all congruent.
  bool fit = true;
  /// vertexCount factors above 0 of Young's modulus, painted on the mesh; empty: 1. They are spread inside, and stored
  /// in the cage: see `paintCage`.
  std::vector<double> stiffness{};
  std::vector<double> density{};  ///< the same for the density
  std::vector<double> damping{};  ///< vertexCount factors of the material's damping, 0 or more; empty: 1
  /// Called now and then with the fraction done, an estimate from 0 to 1, never decreasing; returns false to cancel.
  /// May be empty.
  std::function<bool(double fraction)> progress{};
};

/// The cage that was built, and how well it fits. Lengths and volumes are in rest space, in the unit of the mesh.
struct TETSKIN_CAGE_API CageReport {
  std::size_t targetTets = 0;     ///< number of tets requested
  std::size_t tets = 0;           ///< number of tets in the cage, duplicates included
  std::size_t nodes = 0;          ///< number of nodes in the cage
  std::size_t bridgingTets = 0;   ///< tets that neither touch the surface nor lie inside, but join regions that would
                                  ///< otherwise be connected by only one node or edge; included in `tets`
  double spacing = 0.0;           ///< side of the lattice's cubes, equal to a tet's longest edge before fitting
  std::size_t latticesTried = 0;  ///< number of lattices tried

  std::size_t verticesOutside = 0;  ///< distinct positions of vertices that triangles use, in no tet: 0
  double minDihedralDegrees = 0.0;  ///< smallest dihedral angle of a tet, degrees
  double maxDihedralDegrees = 0.0;  ///< largest dihedral angle of a tet, degrees
  std::size_t duplicateTets = 0;    ///< tets beyond the first at their position, from duplicating elements
  std::size_t components = 0;       ///< components of the cage, connected through shared nodes
  std::size_t fusedComponents = 0;  ///< components of the mesh, minus components of the cage
  std::size_t meshComponents = 0;   ///< sets of triangles connected through coincident vertices
  std::size_t looseVertices = 0;    ///< vertices at positions that no triangle uses: the nearest tet carries them
  std::size_t openEdges = 0;        ///< edges of the mesh with a triangle on one side only: holes

  double meshVolume = 0.0;           ///< 0 for an open sheet; a hole is closed by a cone from the centre of the box
  double cageVolume = 0.0;           ///< sum of the tets' volumes
  double cageVolumeUnfitted = 0.0;   ///< sum of the tets' volumes before fitting
  double volumeRatio = 0.0;          ///< cage volume over mesh volume; 0 for an open sheet
  double volumeRatioUnfitted = 0.0;  ///< cage volume before fitting over mesh volume; 0 for an open sheet
  double milliseconds = 0.0;         ///< wall time of the whole build

  /// True if the number of tets is within 10 % of the requested one.
  bool targetMet() const;
  /// Readable summary, one line per item.
  std::string describe() const;
};

/// Builds a cage of about `options.targetTets` tets that contains every vertex of the mesh's triangles: `embed` in it
/// reports 0 vertices outside. Vertices that no triangle uses, which modellers often leave in a file, do not shape the
/// cage: `Cage::vertexTets` names the nearest tet for them, `embed` counts those outside, and
/// `CageReport::looseVertices` counts all of them. The tets are positive and conforming, with dihedral angles between
/// 10 and 165 degrees (observed: 25 to 140); every node is used. Features thinner than a tet are never lost.
///
/// Where regions of the mesh are nearer to each other than the size of a tet, the cage has duplicate elements, one for
/// each region (Molino, Bao, Fedkiw, "A Virtual Node Algorithm for Changing Mesh Topology During Simulation", SIGGRAPH
/// 2004; see Cage). Regions thicker than an eighth of a tet, and farther apart than that, are never fused, except where
/// a cleft ends within a tet; what triangles of the mesh connect is never separated. Components of the mesh that lie
/// inside each other, or nearer than an eighth of a tet, stay together. Without duplicates, and if `duplicateElements`
/// is false, regions nearer to each other than a tet are fused; the boundary is then a manifold, no two nodes share a
/// position, and a triangle between vertices of the mesh lies wholly inside an unfitted cage. It may protrude by a few
/// hundredths of the spacing from a cage that is fitted or has duplicates.
///
/// The same input gives the same cage.
///
/// mesh     at least one triangle, and triangles of some extent; a sheet, a single triangle or a line gets a thin cage.
///          A triangle whose corners are at one point does not count
/// report   written if not null, also on failure
/// Cost     about proportional to triangles + tets: some five seconds per million triangles, up to ten if so few tets
///          are requested that many lattices are tried, and ten seconds and 300 MB per million tets
/// Errors   Empty (no vertices or triangles), NonFinite, IndexOutOfRange, InvalidOption (targetTets 0 or above
///          Limits::kMaxTargetTets; a painted value that is not above 0), SizeMismatch (a map of another number of
///          values), Degenerate (all triangles are points, or so near to each other, or so far apart, that double
///          cannot represent a lattice), Cancelled (by `options.progress`)
TETSKIN_CAGE_API Result<Cage> createCage(const TriangleMesh& mesh, const CageOptions& options = {},
                                         CageReport* report = nullptr);

}  // namespace tetskin
