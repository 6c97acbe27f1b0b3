// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/triangle_mesh.h>

#include <cstddef>
#include <string>

namespace tetskin {

/// Largest number of tets that may be asked for; takes some 6 GB and four minutes.
constexpr std::size_t kLargestTargetTets = 20'000'000;

/// What cage to build.
struct CageOptions {
  /// How many tets the cage should have. Met within 10 % but for very small numbers, see `CageReport::targetMet`.
  std::size_t targetTets = 3000;
  /// Where parts of the mesh lie nearer to each other than a tet, or it folds back on itself, give each a tet of its
  /// own: see Cage. Nothing changes where nothing splits.
  bool split = true;
  /// Pull boundary nodes towards the surface: a smaller cage, of tets that are no longer all alike.
  bool fit = true;
};

/// What was built, and how well it fits. Lengths and volumes are in rest space, the mesh's unit.
struct TETSKIN_CAGE_API CageReport {
  std::size_t targetTets = 0;   ///< how many were asked for
  std::size_t tets = 0;         ///< how many there are, copies included
  std::size_t nodes = 0;        ///< of the cage
  std::size_t joiningTets = 0;  ///< tets that neither touch the surface nor lie inside, but join parts that would hang
                                ///< together by one node or edge; included in `tets`
  double spacing = 0.0;         ///< side of the lattice's cubes, which is a tet's longest edge before fitting
  std::size_t lattices = 0;     ///< how many were tried

  std::size_t verticesOutside = 0;  ///< distinct positions of the mesh's vertices in no tet: 0
  double minDihedralDeg = 0.0;      ///< smallest angle between two faces of a tet, degrees
  double maxDihedralDeg = 0.0;      ///< largest one
  std::size_t copies = 0;           ///< tets beyond the first at their place: splitting made them
  std::size_t parts = 0;            ///< of the cage, connected by nodes
  std::size_t fusedParts = 0;       ///< components and loose vertices of the mesh, less the cage's parts
  std::size_t meshComponents = 0;   ///< sets of triangles connected by coincident vertices
  std::size_t looseVertices = 0;    ///< distinct positions that no triangle uses; inside the cage as well
  std::size_t openEdges = 0;        ///< edges of the mesh without a partner triangle on the other side: holes

  double meshVolume = 0.0;           ///< 0 for a sheet; a hole is closed by a cone from the box's centre
  double cageVolume = 0.0;           ///< sum of the tets' volumes
  double cageVolumeUnfitted = 0.0;   ///< the same before fitting
  double volumeRatio = 0.0;          ///< cage over mesh; 0 for a sheet
  double volumeRatioUnfitted = 0.0;  ///< the same before fitting
  double milliseconds = 0.0;         ///< wall time of the whole build

  /// True if the number of tets is within 10 % of what was asked for.
  bool targetMet() const;
  /// One line a fact, for people.
  std::string describe() const;
};

/// Builds a cage of about `options.targetTets` tets that holds every vertex of the mesh: `embed` of it reports 0
/// outside. Its tets are positive, conforming, with dihedral angles between 10 and 165 degrees (seen: 25 and 140);
/// every node is used. Parts thinner than a tet are never lost.
///
/// Where parts of the mesh lie nearer to each other than a tet, there are copies of tets, one for each part (see Cage):
/// parts thicker than an eighth of a tet, and farther apart than that, are never fused but where a cleft ends within a
/// tet; what the mesh joins by edges is never torn. Components of the mesh that lie in each other, or nearer than an
/// eighth of a tet, stay together. Where nothing splits, and with `split = false`, parts nearer to each other than a
/// tet have fused; the boundary is a manifold, no two nodes are at one place, and between its vertices, a triangle lies
/// wholly inside an unfitted cage. Out of a fitted or split one it may stick by a few hundredths of the spacing.
///
/// The same input gives the same cage.
///
/// mesh     at least one triangle and some extent; a sheet, a single triangle or a line gets a thin cage. Vertices that
///          no triangle uses get tets of their own, however far away.
/// report   written if not null, on failure too
/// Cost     about proportional to triangles + tets: some five seconds per million triangles, up to ten if so few tets
/// are
///          asked for that many lattices are tried, and ten seconds and 300 MB per million tets
/// Errors   Empty (no vertices or triangles), NonFinite, IndexOutOfRange, InvalidOption (targetTets 0 or above
///          kLargestTargetTets), Degenerate (all vertices in one point, or so near each other, or so far apart, that
///          double cannot hold a lattice)
TETSKIN_CAGE_API Result<Cage> buildCage(const TriangleMesh& mesh, const CageOptions& options = {},
                                        CageReport* report = nullptr);

}  // namespace tetskin
