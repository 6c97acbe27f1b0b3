// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Surfaces whose parts lie near to each other, with the number of parts that a cage must keep apart.
#pragma once

#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>

#include <optional>
#include <string>
#include <vector>

namespace tetskin::test {

using Plane = Eigen::Hyperplane<double, 3>;

/// Number of parts, connected by nodes, of the tets whose centroids lie beyond the plane, on the side to which its
/// normal points; without a plane, of all tets.
int countPartsBeyond(const TetMesh& cage, const std::optional<Plane>& plane = {});
/// The same of a surface's triangles, connected by vertices.
int countPartsBeyond(const TriangleMesh& mesh, const std::optional<Plane>& plane = {});
/// By tet: its part beyond the plane, an arbitrary number from 0; -1 if it is not beyond.
std::vector<int> partsBeyond(const TetMesh& cage, const Plane& plane);

/// A mesh, and into how many parts it falls beyond a plane, or as a whole. The plane passes well clear of where they
/// hang together: a cage that keeps them apart may do so there less exactly.
struct PartModel {
  std::string name;
  TriangleMesh mesh;
  std::optional<Plane> plane;
  int parts = 1;
  double gap = 0.0;  ///< least distance between the parts beyond the plane
};

/// Two plates of 2 x 0.3 x 2, face to face.
PartModel twoPlates(double gap);
/// Pliers 4 long: two prongs that meet in a hinge; their inner sides are rows of teeth that fit into each other.
PartModel jaw(double gap);
/// A hook: all of a tapering ring but for the gap between its tip and its root.
PartModel claw(double gap);
/// Rings of radii 1 and 0.25, each through the next and perpendicular to it.
PartModel chain(int rings, double gap);
/// A helical spring of radii 1 and 0.2 about z.
PartModel coil(int turns, double gap);
/// An open square of side 2: one layer of triangles.
PartModel sheet();
/// Two of them, face to face.
PartModel twoSheets(double gap);
/// Two boxes that pass through each other: one part, though their triangles share nothing.
PartModel crossedBoxes();

/// All of them, gaps a fiftieth of their size.
std::vector<PartModel> partModels();

}  // namespace tetskin::test
