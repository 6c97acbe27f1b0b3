// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Solids given by a formula, as meshes: tets of a body-centred lattice, cut where the surface is.
//
// This work is based on:
//   François Labelle and Jonathan Richard Shewchuk, "Isosurface Stuffing: Fast Tetrahedral Meshes with Good Dihedral
//   Angles", ACM Transactions on Graphics 26(3), 2007
#pragma once

#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>

#include <functional>

namespace tetskin::scenes {

struct ImplicitSolid {
  Box3 box;                                                      ///< lattice space; the solid lies within
  std::function<double(const Eigen::Vector3d&)> value;           ///< of a point of lattice space: below 0 inside
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> place;  ///< from there to the mesh's space; keeps orientation
};

/// A conforming mesh of positive tets, the nodes of its boundary on the surface. Parts of the solid farther from each
/// other than the spacing, in lattice space, share no node.
/// spacing  side of the lattice's cubes
TetMesh tetsOf(const ImplicitSolid& solid, double spacing);

/// The boundary of the same mesh: closed, welded, all vertices on the surface, no slivers.
TriangleMesh surfaceOf(const ImplicitSolid& solid, double spacing);

}  // namespace tetskin::scenes
