// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Surfaces beside a cage's boundary, and where the boundary takes them.
#pragma once

#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>

#include <array>
#include <vector>

namespace tetskin::test {

/// The cage's boundary, each face cut in four `cuts` times, with vertices of its own; then moved along its vertex
/// normals, outwards by `distance`. The tets must be positive.
TriangleMesh surfaceBeside(const TetMesh& cage, double distance, int cuts = 2);

/// What a surface beside a cage should do, whatever carries it: each vertex keeps its rest offset from the point of the
/// boundary that was closest to it at rest.
class BoundaryFollower {
 public:
  BoundaryFollower(const TetMesh& cage, const std::vector<Eigen::Vector3d>& vertices);
  /// Where the vertices belong when the nodes are here.
  std::vector<Eigen::Vector3d> positions(const std::vector<Eigen::Vector3d>& nodes) const;

 private:
  struct Place {
    std::array<int, 3> face;
    Eigen::Vector3d weights;
    Eigen::Vector3d offset;
  };
  std::vector<Place> places_;
};

/// Each point moved by `length` in a random direction, reproducible.
std::vector<Eigen::Vector3d> movedAtRandom(std::vector<Eigen::Vector3d> points, double length, unsigned seed);

}  // namespace tetskin::test
