// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/slotted_beam.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <unordered_map>

#include "scenes/angles.h"
#include "scenes/serpent.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kLength = 4.0, kWidth = 1.0, kProng = 0.48, kSlot = 0.04, kSolid = 1.6;
constexpr double kPlanePosition = 1.85;  ///< along the beam, from its solid end
/// Angle from upright. Gravity bends both prongs equally; the nodes of the lower end that the scenes pin are below the
/// slot.
constexpr double kBeamLean = 35.0 * kDegree;

/// Maps (along the beam, across the slot, along the slot's edge) to the model's space.
Vector3d inSpace(const Vector3d& p) {
  const double along = p.x() - 0.5 * kLength, across = p.y() - 0.5 * kWidth;
  return {std::sin(kBeamLean) * along + std::cos(kBeamLean) * across,
          std::cos(kBeamLean) * along - std::sin(kBeamLean) * across, 0.5 * kWidth - p.z()};
}

/// The beam as a grid of cells, where those in the slot are empty: the sides of the slot are planes of the grid.
struct Cells {
  int solid, free;  ///< cells along the solid end, and along the slot
  int prong, slot;  ///< cells across a prong, and across the slot
  int wide;

  explicit Cells(double edge)
      : solid(cellsAlong(kSolid, edge)),
        free(cellsAlong(kLength - kSolid, edge)),
        prong(cellsAlong(kProng, edge)),
        slot(cellsAlong(kSlot, edge)),
        wide(cellsAlong(kWidth, edge)) {}

  static int cellsAlong(double length, double edge) {
    return std::max(1, static_cast<int>(std::lround(length / edge)));
  }

  Vector3i size() const { return {solid + free, 2 * prong + slot, wide}; }
  bool filled(const Vector3i& c) const {
    if ((c.array() < 0).any() || (c.array() >= size().array()).any()) return false;
    return c.x() < solid || c.y() < prong || c.y() >= prong + slot;
  }
  std::size_t count() const {
    return static_cast<std::size_t>(wide) * static_cast<std::size_t>(size().x() * size().y() - free * slot);
  }
  std::size_t outerFaces() const {
    const Vector3i n = size();
    const int alongAndAcross = n.x() * n.y() - free * slot;
    return 2 * static_cast<std::size_t>(alongAndAcross + (n.x() + n.y() + free) * wide);
  }

  /// The position of a cell corner, in the model's space.
  Vector3d place(const Vector3i& c) const {
    const double along = c.x() <= solid ? kSolid * c.x() / solid : kSolid + (kLength - kSolid) * (c.x() - solid) / free;
    const double across = c.y() <= prong          ? kProng * c.y() / prong
                          : c.y() <= prong + slot ? kProng + kSlot * (c.y() - prong) / slot
                                                  : kProng + kSlot + kProng * (c.y() - prong - slot) / prong;
    return inSpace({along, across, kWidth * c.z() / wide});
  }
};

/// The coarsest grid for which a count reaches a minimum.
Cells cellsWith(std::size_t wish, const std::function<std::size_t(const Cells&)>& count) {
  constexpr double kCoarsest = 0.3, kStep = 0.995, kAtMost = 0.9;
  // From here on by the same steps; coarser grids serve a few tets.
  double edge = count(Cells(kCoarsest)) < wish ? kCoarsest : kAtMost;
  while (count(Cells(edge)) < wish) edge *= kStep;
  return Cells(edge);
}

/// Assigns indices to the corners in use.
class Corners {
 public:
  Corners(const Cells& cells, std::vector<Vector3d>& positions) : cells_(cells), positions_(positions) {}

  int operator()(const Vector3i& c) {
    const Vector3i size = cells_.size();
    const std::uint64_t key = (static_cast<std::uint64_t>(c.z()) * (size.y() + 1) + c.y()) * (size.x() + 1) + c.x();
    const auto [found, isNew] = numbers_.try_emplace(key, static_cast<int>(positions_.size()));
    if (isNew) positions_.push_back(cells_.place(c));
    return found->second;
  }

 private:
  const Cells& cells_;
  std::vector<Vector3d>& positions_;
  std::unordered_map<std::uint64_t, int> numbers_;
};

void forEachFilled(const Cells& cells, const std::function<void(const Vector3i&)>& visit) {
  const Vector3i size = cells.size();
  for (int z = 0; z < size.z(); ++z) {
    for (int y = 0; y < size.y(); ++y) {
      for (int x = 0; x < size.x(); ++x) {
        if (cells.filled({x, y, z})) visit({x, y, z});
      }
    }
  }
}

}  // namespace

TriangleMesh makeSlottedBeam(std::size_t triangles) {
  const std::size_t wish = std::clamp(triangles, kMinSerpentTriangles, kMaxSerpentTriangles);
  const Cells cells = cellsWith((wish + 1) / 2, [](const Cells& c) { return c.outerFaces(); });
  TriangleMesh mesh;
  Corners corner(cells, mesh.positions);
  forEachFilled(cells, [&](const Vector3i& c) {
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2, side = face % 2;
      const Vector3i normal = Vector3i::Unit(axis), u = Vector3i::Unit((axis + 1) % 3),
                     v = Vector3i::Unit((axis + 2) % 3);
      if (cells.filled(c + (2 * side - 1) * normal)) continue;
      const Vector3i first = c + side * normal;
      std::array<int, 4> quad = {corner(first), corner(first + u), corner(first + u + v), corner(first + v)};
      if (side == 0) std::swap(quad[1], quad[3]);
      // Diagonals alternate, so that no direction is favoured.
      if (first.sum() % 2 != 0) std::rotate(quad.begin(), quad.begin() + 1, quad.end());
      mesh.triangles.push_back({quad[0], quad[1], quad[2]});
      mesh.triangles.push_back({quad[0], quad[2], quad[3]});
    }
  });
  mesh.groups.push_back({"slotted_beam", "slotted_beam", 0, mesh.triangleCount()});
  return mesh;
}

TetMesh makeSlottedBeamTets(std::size_t tets) {
  constexpr std::size_t kTetsOfCell = 5;
  const std::size_t wish = std::max(tets, kMinSlottedBeamTets);
  const Cells cells = cellsWith((wish + kTetsOfCell - 1) / kTetsOfCell, [](const Cells& c) { return c.count(); });
  TetMesh mesh;
  Corners corner(cells, mesh.nodes);
  forEachFilled(cells, [&](const Vector3i& c) {
    const bool odd = c.sum() % 2 != 0;
    // Corners as bits; mirrored in every other cell, so that faces have the same diagonal on both sides.
    const auto at = [&](int bits) {
      return corner(c + Vector3i(((bits & 1) != 0) != odd, (bits >> 1) & 1, (bits >> 2) & 1));
    };
    for (const Tet& tet : {Tet{0, 3, 5, 6}, Tet{1, 0, 3, 5}, Tet{2, 0, 3, 6}, Tet{4, 0, 5, 6}, Tet{7, 3, 5, 6}}) {
      mesh.tets.push_back({at(tet[0]), at(tet[1]), at(tet[2]), at(tet[3])});
    }
  });
  (void)repairTetMesh(mesh);
  return mesh;
}

Eigen::Hyperplane<double, 3> slottedBeamPlane() {
  const Vector3d along = inSpace({1.0, 0.0, 0.0}) - inSpace({0.0, 0.0, 0.0});
  return {along, inSpace({kPlanePosition, 0.5 * kWidth, 0.5 * kWidth})};
}

}  // namespace tetskin::scenes
