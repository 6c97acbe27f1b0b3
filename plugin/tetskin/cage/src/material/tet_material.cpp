// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/lattice/surface_cover.h>
#include <tetskin/cage/src/material/tet_material.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::cage_detail {
namespace {

/// Half the view: the winding number from which a point is inside.
constexpr double kInside = 0.5;
constexpr double kMostWinding = 100.0;

/// A triangle as seen from a point: tells by how much the winding number changes on a way from there.
class SeenTriangle {
 public:
  /// corners  relative to the point
  SeenTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
      : edges_{a.cross(b), b.cross(c), c.cross(a)}, volume_(a.dot(edges_[1])) {}

  /// -1 where the straight way to `end` leaves through the triangle, 1 where it enters, else 0. An edge that two
  /// triangles share, and run along opposite ways, gives both the same numbers but for the sign: none slips between.
  int change(const Eigen::Vector3d& end) const {
    const double x = end.dot(edges_[0]), y = end.dot(edges_[1]), z = end.dot(edges_[2]);
    const double slope = x + y + z;
    if (x > 0.0 && y > 0.0 && z > 0.0) return volume_ > 0.0 && volume_ < slope ? -1 : 0;
    if (x < 0.0 && y < 0.0 && z < 0.0) return volume_ < 0.0 && volume_ > slope ? 1 : 0;
    return 0;
  }

 private:
  std::array<Eigen::Vector3d, 3> edges_;
  double volume_;
};

class MaterialFinder {
 public:
  MaterialFinder(const Surface& surface, const WindingTree& winding, const LatticeFrame& frame)
      : surface_(surface), winding_(winding), frame_(frame) {}

  /// Of a tet that these triangles touch.
  CellMask cellsOf(const LatticeTet& tet, const std::uint32_t* begin, const std::uint32_t* end,
                   std::array<std::int16_t, kCellsPerTet>& windings) {
    // Off the centroid, which is where a lattice's planes and a mesh's may meet.
    const Eigen::Vector3d offset = centroid(tet) - cubeOrigin(tet.cube) + Eigen::Vector3d(0.0131, 0.0173, -0.0117);
    const Eigen::Vector3d from = frame_.toRest(cubeOrigin(tet.cube) + offset);
    seen_.clear();
    for (const std::uint32_t* t = begin; t != end; ++t) {
      const auto& [a, b, c] = surface_.triangles[*t];
      seen_.emplace_back(relative(a, from), relative(b, from), relative(c, from));
    }
    const double number = winding_.windingNumber(from);
    CellMask cells = 0;
    for (int k = 0; k < kCellsPerTet; ++k) {
      const Eigen::Vector3d way = frame_.half * (cellTables().centroids[tet.local][k] - offset);
      double there = number;
      for (const SeenTriangle& triangle : seen_) there += triangle.change(way);
      windings[k] = static_cast<std::int16_t>(std::clamp(std::round(there), -kMostWinding, kMostWinding));
      if (std::abs(there) >= kInside) cells |= cellBit(k);
    }
    return cells;
  }

  bool inside(const LatticeTet& tet) const {
    return std::abs(winding_.windingNumber(frame_.toRest(centroid(tet)))) >= kInside;
  }

 private:
  Eigen::Vector3d relative(int point, const Eigen::Vector3d& from) const { return surface_.points[point] - from; }

  const Surface& surface_;
  const WindingTree& winding_;
  const LatticeFrame& frame_;
  std::vector<SeenTriangle> seen_;
};

}  // namespace

TetMaterial findMaterial(const Surface& surface, const WindingTree& winding, const LatticeFrame& frame,
                         const LatticeSet& set, const LatticeMesh& lattice) {
  assert(lattice.openFaces.size() == lattice.mesh.tetCount());
  TetMaterial material;
  material.cells.assign(lattice.mesh.tetCount(), kAllCells);
  material.windings.resize(lattice.mesh.tetCount());
  for (auto& windings : material.windings) windings.fill(1);
  material.triangles = trianglesByTet(surface, frame, set, lattice);
  if (!surface.oriented) return material;
  if (!(surface.volume > 0.0)) {
    material.cells.assign(lattice.mesh.tetCount(), 0);
    return material;
  }
  MaterialFinder finder(surface, winding, frame);
  const std::uint32_t* values = material.triangles.values.data();
  for (std::size_t cube = 0; cube < set.cubeCount(); ++cube) {
    for (int local = 0; local < kTetsPerCube; ++local) {
      const int t = lattice.tetOf[kTetsPerCube * cube + static_cast<std::size_t>(local)];
      if (t < 0) continue;
      const std::uint32_t first = material.triangles.starts[t], last = material.triangles.starts[t + 1];
      const LatticeTet tet{set.cube(cube), local};
      if (first < last) {
        material.cells[t] = finder.cellsOf(tet, values + first, values + last, material.windings[t]);
      } else if (lattice.openFaces[t] != 0 && !finder.inside(tet)) {
        material.cells[t] = 0;  // it joins others
      }
    }
  }
  return material;
}

}  // namespace tetskin::cage_detail
