// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Meshes of solids that are given by a formula: tets of a body-centred lattice, cut at the surface.
//
// This work is based on:
//   François Labelle and Jonathan Richard Shewchuk, "Isosurface Stuffing: Fast Tetrahedral Meshes with Good Dihedral
//   Angles", ACM Transactions on Graphics 26(3), 2007
#pragma once

#include <tetskin/core/mesh.h>

#include <cstddef>
#include <functional>

namespace tetskin::scenes {

struct ImplicitSolid {
  Box3 box;                                             ///< in lattice space; contains the solid
  std::function<double(const Eigen::Vector3d&)> value;  ///< negative inside, for a point of lattice space
  /// From there to the mesh's space; keeps orientation.
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> position;
};

/// A conforming mesh of positive tets with the nodes of its boundary on the surface. Components or limbs of the solid
/// that are farther apart than the spacing, in lattice space, share no node.
/// spacing  side of the lattice's cubes
TetMesh tetsOf(const ImplicitSolid& solid, double spacing);

/// The boundary of the same mesh: closed, welded, all vertices on the surface, no slivers.
TriangleMesh surfaceOf(const ImplicitSolid& solid, double spacing);

/// The same with about this many tets or triangles, of a lattice with at most this spacing.
TetMesh tetsOf(const ImplicitSolid& solid, std::size_t tets, double maxSpacing);
TriangleMesh surfaceOf(const ImplicitSolid& solid, std::size_t triangles, double maxSpacing);

/// Moves the nodes of the boundary, which are on the surface, so that the tets around each have the volume of the solid
/// there. Their flat faces cut pieces off round shapes: with four tets around it, a limb is a third too thin.
/// mesh      positive tets, in the solid's space
/// distance  of a point near the surface from it, in the same space; negative inside
void matchVolume(TetMesh& mesh, const std::function<double(const Eigen::Vector3d&)>& distance);

}  // namespace tetskin::scenes
