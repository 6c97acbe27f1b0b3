// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Closed tubes as grids of triangles: every component of the serpent is meshed in this way.
#pragma once

#include <tetskin/core/mesh.h>

#include <cstddef>
#include <functional>

namespace tetskin::scenes {

/// A closed tube: a pole at either end, rings of columns + 1 vertices between them. The first and the last vertex of a
/// ring are at the same position, with u = 0 and u = 1: the texture seam.
struct TubeGrid {
  int rings = 1;    ///< at least 1
  int columns = 3;  ///< at least 3

  /// The number of triangles between the first pole and ring `ring` > 0.
  std::size_t trianglesUpTo(int ring) const;
  std::size_t triangleCount() const { return trianglesUpTo(rings + 1); }
};

/// The grid with about `triangles` triangles, each as long as it is wide if the length of the tube is `slenderness`
/// times its circumference.
TubeGrid tubeGrid(double triangles, double slenderness);

/// Position of column j of a ring. Rings 0 and rings + 1 are the poles, which are asked for column 0 only. Seen from
/// outside with the last pole at the top, columns run to the right.
using TubeSurface = std::function<Eigen::Vector3d(int ring, int column)>;

/// Appends a tube with normals and texcoords. Its triangles are in order from the first pole to the last.
void appendTube(TriangleMesh& mesh, const TubeGrid& grid, const TubeSurface& surface);

}  // namespace tetskin::scenes
