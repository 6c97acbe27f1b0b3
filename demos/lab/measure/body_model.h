// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies at rest: a ball and boxes, in cages that lie around them or are their own lattice.
#pragma once

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

#include <Eigen/Core>
#include <memory>

namespace tetskin::measure {

/// A body about the origin, in metres.
struct BodyModel {
  TriangleMesh mesh;
  Cage cage;
  std::shared_ptr<const SoftBodyBinding> binding;
  double size = 1.0;    ///< largest side of the mesh's box
  double volume = 1.0;  ///< volume of the mesh
};

using ModelPtr = std::shared_ptr<const BodyModel>;

/// How often each vertex of a mesh is repeated. Copies lie 1e-6 of the size beside it, as contact samples no position
/// twice.
struct Copies {
  int count = 1;
};

/// A mesh in a given cage.
ModelPtr makeModel(TriangleMesh mesh, Cage cage);

/// A mesh in a cage that is built for it, without copies.
ModelPtr inBuiltCage(TriangleMesh mesh, std::size_t tets, Copies copies = {});

/// A ball of radius 0.5 in a built cage: an icosphere of 10 x 4^level + 2 vertices, turned so that no vertex is at its
/// lowest point.
ModelPtr makeBall(std::size_t tets = 1000, int level = 4, Copies copies = {});

/// A box in a built cage of some 1,000 tets; its surface is a grid.
/// divisions  of its longest edge
ModelPtr makeBox(const Eigen::Vector3d& halfExtents, int divisions = 16, Copies copies = {});

/// The same with waves on its upper side, two divisions apart from crest to trough.
/// wave  from trough to crest, metres
ModelPtr makeWavyBox(const Eigen::Vector3d& halfExtents, int divisions, double wave);

/// A box of twelve triangles in a built cage.
ModelPtr makeCoarseBox(const Eigen::Vector3d& halfExtents, std::size_t tets = 500);

/// A box of this many cubes of six tets each, with a surface grid four times as fine as the cubes.
ModelPtr makeLattice(const Eigen::Vector3i& cubes, double edge);

}  // namespace tetskin::measure
