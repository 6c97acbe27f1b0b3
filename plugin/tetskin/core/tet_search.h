// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to embedding: which tet carries which point.
#pragma once

#include <tetskin/core/embedding.h>
#include <tetskin/core/tet_geometry.h>
#include <tetskin/core/types.h>

#include <cstddef>
#include <vector>

namespace tetskin {

/// A tet with all that testing a point against it needs.
struct SearchTet {
  int index;           ///< in the cage
  double size;         ///< longest edge
  TetCorners corners;  ///< rest space
  BarycentricMap map;
  Box3 box;  ///< of the corners

  SearchTet(int tetIndex, const TetCorners& p);
};

/// The tets of a usable cage that are not flat, in its order.
std::vector<SearchTet> searchTets(const TetMesh& cage);

struct TetHit {
  int tet = -1;              ///< place in the list of search tets
  double barycentric = 0.0;  ///< barycentric distance; at most 0 inside
  double distance = 0.0;     ///< distance to the tet; 0 inside
};

struct TetSearch {
  std::vector<TetHit> hits;     ///< one a point
  std::size_t overlapping = 0;  ///< points deeper than kOverlapDepth in two tets or more
  std::size_t candidates = 0;   ///< pairs tested
};

/// Finds the tet of every point by the rule that `embed` states. There must be a tet; points must be finite.
/// tableSize  of the spatial hash, see there; only the cost depends on it
TetSearch findTets(const std::vector<SearchTet>& tets, const std::vector<Eigen::Vector3d>& points, OutsideRule rule,
                   std::size_t tableSize = 0);

}  // namespace tetskin
