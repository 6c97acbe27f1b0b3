// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/lattice/surface_cover.h>
#include <tetskin/cage/src/material/tet_material.h>
#include <tetskin/cage/src/surface/triangle_crossing.h>
#include <tetskin/core/src/base/progress.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::cage_detail {
namespace {

/// More layers than any mesh has around a point; the number must fit 16 bits.
constexpr double kMaxWinding = 100.0;

class MaterialFinder {
 public:
  MaterialFinder(const Surface& surface, const WindingTree& winding, const LatticeFrame& frame)
      : surface_(surface), winding_(winding), frame_(frame) {}

  /// The cells of a tet that these triangles touch.
  CellMask cellsOf(const LatticeTet& tet, const std::uint32_t* begin, const std::uint32_t* end,
                   std::array<std::int16_t, kCellsPerTet>& windings) {
    assert(begin != end);
    // The point is off the centroid, where planes of the lattice and of the mesh may coincide.
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
      const Eigen::Vector3d direction = frame_.half * (cellTables().centroids[tet.local][k] - offset);
      double there = number;
      for (const SeenTriangle& triangle : seen_) there += triangle.crossing(direction).change();
      windings[k] = static_cast<std::int16_t>(std::clamp(std::round(there), -kMaxWinding, kMaxWinding));
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
  material.windingsAt.assign(lattice.mesh.tetCount(), -1);
  material.triangles = trianglesByTet(surface, frame, set, lattice);
  if (!surface.oriented) return material;
  if (!(surface.volume > 0.0)) {
    material.cells.assign(lattice.mesh.tetCount(), 0);
    return material;
  }
  MaterialFinder finder(surface, winding, frame);
  const std::uint32_t* values = material.triangles.values.data();
  for (std::size_t cube = 0; cube < set.cubeCount(); ++cube) {
    Progress::goOn(cube);
    for (int local = 0; local < kTetsPerCube; ++local) {
      const int t = lattice.tetOf[kTetsPerCube * cube + static_cast<std::size_t>(local)];
      if (t < 0) continue;
      const std::uint32_t first = material.triangles.starts[t], last = material.triangles.starts[t + 1];
      const LatticeTet tet{set.cube(cube), local};
      if (first < last) {
        material.windingsAt[t] = static_cast<int>(material.windings.size());
        material.cells[t] = finder.cellsOf(tet, values + first, values + last, material.windings.emplace_back());
      } else if (lattice.openFaces[t] != 0 && !finder.inside(tet)) {
        material.cells[t] = 0;  // the tet only joins others
      }
    }
  }
  return material;
}

}  // namespace tetskin::cage_detail
