// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <array>
#include <cstddef>
#include <vector>

namespace tetskin {

/// Which tet carries a vertex that lies in none. Vertices inside are bound the same under both.
enum class OutsideRule {
  Nearest,      ///< the tet closest in distance, but for slivers: a thin layer of tets keeps the vertices just above it
  Barycentric,  ///< the tet of the smallest barycentric distance: the tutorial's rule, and Bullet's
};

/// Four node indices. A tet is positive when node 3 lies on the side of triangle (0, 1, 2) towards which
/// (p1-p0) x (p2-p0) points.
using Tet = std::array<int, 4>;

/// The cage at rest, as flat arrays. Nothing is checked on construction; see `checkTetMesh` and `repairTetMesh`.
struct TetMesh {
  std::vector<Eigen::Vector3d> nodes;  ///< nodeCount x 3, rest space
  std::vector<Tet> tets;               ///< tetCount x 4 node indices

  std::size_t nodeCount() const { return nodes.size(); }  ///< of `nodes`
  std::size_t tetCount() const { return tets.size(); }    ///< of `tets`
};

/// What is wrong with a tet mesh: how many of each, and where the first one is (undefined where the count is 0).
/// The first two make a mesh unusable. The others are survivable and reported, as long as not every tet repeats a node
/// or has no volume.
struct TETSKIN_CORE_API TetMeshReport {
  /// One kind of fault.
  struct Fault {
    std::size_t count = 0;  ///< how many tets (or nodes) have it
    std::size_t first = 0;  ///< index of the first tet (or node) concerned
  };
  Fault indexOutOfRange;    ///< tets that name a node that does not exist
  Fault nonFiniteNodes;     ///< nodes with a coordinate that is not finite
  Fault repeatedNode;       ///< tets that name one node twice
  Fault zeroVolume;         ///< tets of six-fold volumes below 1e-9 of their longest edge cubed
  Fault negativeVolume;     ///< tets with the orientation reversed
  Fault duplicateTets;      ///< tets that name the same four nodes as an earlier one
  Fault unreferencedNodes;  ///< nodes that no tet names

  /// True when no count is above 0.
  bool clean() const;
  /// The faults in words, one a line, for people; empty when clean.
  std::string describe() const;
};

/// Counts the faults of a mesh. Cost O(T log T) for T tets.
TETSKIN_CORE_API TetMeshReport checkTetMesh(const TetMesh& mesh);

/// The part of `checkTetMesh` that `usable` needs: everything but duplicate tets and unreferenced nodes. Cost O(N + T)
/// for N nodes, allocates nothing.
TETSKIN_CORE_API TetMeshReport checkForUse(const TetMesh& mesh);

/// Most nodes, and most tets: the lists of neighbours of all of them, up to 32 each, are counted by 32 bits.
constexpr std::size_t kMostTets = 0xFFFFFFFFu / 32;

/// Ok if a mesh may have so many. Error: TooLarge
TETSKIN_CORE_API Status checkTetCounts(std::size_t nodes, std::size_t tets);

/// Ok if the mesh can be used, by a report of either check: it has tets, not too many, all indices exist, all
/// coordinates are finite, at least one tet has a volume.
TETSKIN_CORE_API Status usable(const TetMesh& mesh, const TetMeshReport& report);

/// Reverses the orientation of negative tets by exchanging their last two nodes. Returns the report of the mesh as it
/// was. A mesh with indices out of range or non-finite nodes is left untouched.
TETSKIN_CORE_API TetMeshReport repairTetMesh(TetMesh& mesh);

/// Sum of the tets' volumes, whatever their orientation. Indices must be in range.
TETSKIN_CORE_API double totalVolume(const TetMesh& mesh);

/// The distinct edges, each as (a, b) in the direction of the tet that names it first, in order of first appearance:
/// (0,1) (1,2) (2,0) (0,3) (1,3) (2,3) of tet 0, then of tet 1, ... Cost O(T log T). Indices must be in range.
TETSKIN_CORE_API std::vector<std::array<int, 2>> uniqueEdges(const TetMesh& mesh);

/// The faces that belong to an odd number of tets, that is the boundary, oriented outwards on positive tets and sorted
/// by their sorted node indices. Cost O(T log T). Indices must be in range.
TETSKIN_CORE_API std::vector<std::array<int, 3>> boundaryFaces(const TetMesh& mesh);

}  // namespace tetskin
