// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Surfaces beside a cage's boundary, and where the boundary carries them.
#pragma once

#include <tetskin/core/mesh.h>

#include <array>
#include <vector>

namespace tetskin::test {

/// The cage's boundary with separate vertices: each face is cut in four `cuts` times, then moved outwards along its
/// vertex normals by `distance`. The tets must be positive.
TriangleMesh surfaceBeside(const TetMesh& cage, double distance, int cuts = 2);

/// The expected motion of a surface near a cage: each vertex keeps its rest offset from the point of the boundary that
/// was closest to it at rest.
class BoundaryFollower {
 public:
  BoundaryFollower(const TetMesh& cage, const std::vector<Eigen::Vector3d>& vertices);
  /// The positions that the vertices should have when the cage's nodes are at `nodes`.
  std::vector<Eigen::Vector3d> positions(const std::vector<Eigen::Vector3d>& nodes) const;

 private:
  struct Position {
    std::array<int, 3> face;
    Eigen::Vector3d weights;
    Eigen::Vector3d offset;
  };
  std::vector<Position> positions_;
};

/// Moves each point by `length` in a random direction; reproducible.
std::vector<Eigen::Vector3d> movedAtRandom(std::vector<Eigen::Vector3d> points, double length, unsigned seed);

}  // namespace tetskin::test
