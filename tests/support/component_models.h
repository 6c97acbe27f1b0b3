// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Surfaces whose components or limbs lie close to each other, with the number of components that a cage must keep
// apart.
#pragma once

#include <tetskin/core/mesh.h>

#include <optional>
#include <string>
#include <vector>

namespace tetskin::test {

using Plane = Eigen::Hyperplane<double, 3>;

/// Number of components, connected by nodes, among the tets whose centroids lie beyond the plane, on the side to which
/// its normal points; without a plane, among all tets.
int countComponentsBeyond(const TetMesh& cage, const std::optional<Plane>& plane = {});
/// Number of components, connected by vertices, of those triangles whose centroids lie beyond the plane; without a
/// plane, of all triangles.
int countComponentsBeyond(const TriangleMesh& mesh, const std::optional<Plane>& plane = {});
/// By tet: its component beyond the plane, as an arbitrary number from 0; -1 for a tet that is not beyond it.
std::vector<int> componentsBeyond(const TetMesh& cage, const Plane& plane);

/// A mesh, and the number of components that it has beyond a plane, or as a whole. The plane passes well clear of the
/// region where these are joined: there, a cage that keeps them apart may be less exact.
struct ComponentModel {
  std::string name;
  TriangleMesh mesh;
  std::optional<Plane> plane;
  int components = 1;
  double gap = 0.0;  ///< least distance between the components beyond the plane
};

/// Two plates of 2 x 0.3 x 2, face to face.
ComponentModel twoPlates(double gap);
/// Pliers, 4 long: two prongs that meet in a hinge; their inner sides are rows of teeth that fit into each other.
ComponentModel jaw(double gap);
/// A hook: a tapering ring, complete except for the gap between its tip and its root.
ComponentModel claw(double gap);
/// Rings of radii 1 and 0.25, each passing through the next and perpendicular to it.
ComponentModel chain(int rings, double gap);
/// A helical spring of radii 1 and 0.2 about z.
ComponentModel coil(int turns, double gap);
/// An open square of side 2: one layer of triangles.
ComponentModel sheet();
/// Two such sheets, face to face.
ComponentModel twoSheets(double gap);
/// Two boxes that pass through each other: one component, although their triangles share no vertices.
ComponentModel crossedBoxes();

/// All of these models, with gaps of a fiftieth of their size.
std::vector<ComponentModel> componentModels();

}  // namespace tetskin::test
