// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Closed tubes as grids of triangles: the one way in which every part of the serpent is meshed.
#pragma once

#include <tetskin/core/triangle_mesh.h>

#include <cstddef>
#include <functional>

namespace tetskin::scenes {

/// A closed tube: a pole at either end, rings of columns + 1 vertices between. The first and the last vertex of a ring
/// are at the same position, with u = 0 and u = 1: the texture seam.
struct TubeGrid {
  int rings = 1;    ///< at least 1
  int columns = 3;  ///< at least 3

  /// Between the first pole and ring `ring` > 0.
  std::size_t trianglesUpTo(int ring) const;
  std::size_t triangleCount() const { return trianglesUpTo(rings + 1); }
};

/// The grid of about `triangles` triangles, each as long as it is wide if the tube is `slenderness` times as long as
/// its girth.
TubeGrid tubeGrid(double triangles, double slenderness);

/// Position of column j of a ring. Ring 0 and rings + 1 are the poles, asked for column 0 only. Seen from outside with
/// the last pole on top, columns run to the right.
using TubeSurface = std::function<Eigen::Vector3d(int ring, int column)>;

/// Appends a tube with normals and texcoords. Its triangles run from the first pole to the last.
void appendTube(TriangleMesh& mesh, const TubeGrid& grid, const TubeSurface& surface);

}  // namespace tetskin::scenes
