// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <cstddef>
#include <vector>

namespace tetskin {

/// Limits of a cage's dihedral angles, degrees. Outside of them explicit integration needs smaller steps (a thin tet is
/// stiff along its shortest altitude) and linear tets lock.
constexpr double kMinDihedralDeg = 10.0;
constexpr double kMaxDihedralDeg = 165.0;

/// Smallest and largest dihedral angle, degrees.
struct DihedralRange {
  double minDeg = 180.0;
  double maxDeg = 0.0;
};
/// The range over all tets of a mesh, none of them flat. Cost O(tets).
DihedralRange dihedralRange(const TetMesh& mesh);

namespace cage_detail {

/// Cosines of the six dihedral angles of a positive tet, at the edges between any two faces, in the order (0,1) (0,2)
/// (0,3) (1,2) (1,3) (2,3) of the corners opposite to the faces.
std::array<double, 6> dihedralCosines(const TetCorners& p);

/// By tet, the number of its component; tets of a component are connected by nodes. Cost O(tets).
std::vector<int> componentNumbers(const TetMesh& mesh);

}  // namespace cage_detail
}  // namespace tetskin
