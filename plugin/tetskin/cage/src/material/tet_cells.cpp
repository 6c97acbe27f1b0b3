// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/material/tet_cells.h>

#include <bitset>
#include <cassert>

namespace tetskin::cage_detail {
namespace {

/// Number of cubes of cells along each axis around a lattice cube that its tets may reach, and how far below it they
/// begin.
constexpr int kReach = 3 * kCellDivision;
constexpr int kBelow = kCellDivision;

bool same(const LatticeTet& a, const LatticeTet& b) {
  return a.cube == b.cube && a.local == b.local;
}

/// The tet of the lattice in which a cell lies.
LatticeTet tetOfCell(const LatticeTet& cell) {
  return locate(centroid(cell) / kCellDivision);
}

/// Numbers of cells by their position around the cube of their tet.
class CellNumbers {
 public:
  CellNumbers() {
    for (auto& numbers : numbers_) numbers.fill(-1);
    std::array<int, kTetsPerCube> next{};
    for (int z = -kBelow; z < kReach - kBelow; ++z) {
      for (int y = -kBelow; y < kReach - kBelow; ++y) {
        for (int x = -kBelow; x < kReach - kBelow; ++x) {
          for (int local = 0; local < kTetsPerCube; ++local) {
            const LatticeTet cell{{x, y, z}, local};
            const LatticeTet tet = tetOfCell(cell);
            if (tet.cube != Cube{}) continue;
            const int number = next[tet.local]++;
            numbers_[tet.local][place(cell, tet.cube)] = static_cast<std::int8_t>(number);
            cells_[tet.local][number] = cell;
          }
        }
      }
    }
    for ([[maybe_unused]] const int count : next) assert(count == kCellsPerTet);
  }

  const LatticeTet& cell(int local, int number) const { return cells_[local][number]; }
  int numberOf(const LatticeTet& cell, const LatticeTet& tet) const {
    return numbers_[tet.local][place(cell, tet.cube)];
  }

 private:
  static std::size_t place(const LatticeTet& cell, const Cube& cube) {
    assert(cell.local >= 0 && cell.local < kTetsPerCube);
    std::size_t index = 0;
    for (int axis = 2; axis >= 0; --axis) {
      index = kReach * index + static_cast<std::size_t>(cell.cube[axis] - kCellDivision * cube[axis] + kBelow);
    }
    return kTetsPerCube * index + static_cast<std::size_t>(cell.local);
  }

  std::array<std::array<std::int8_t, kReach * kReach * kReach * kTetsPerCube>, kTetsPerCube> numbers_;
  std::array<std::array<LatticeTet, kCellsPerTet>, kTetsPerCube> cells_;
};

const CellNumbers& cellNumbers() {
  static const CellNumbers numbers;
  return numbers;
}

int cornerTowards(int local, const LatticeTet& beyond) {
  for (int corner = 0; corner < 4; ++corner) {
    if (same(Cube{} + latticeTables().neighbours[local][corner], beyond)) return corner;
  }
  assert(false);
  return 0;
}

CellTables makeCellTables() {
  CellTables tables{};
  const CellNumbers& numbers = cellNumbers();
  for (int local = 0; local < kTetsPerCube; ++local) {
    std::array<int, 4> crossings{};
    for (int k = 0; k < kCellsPerTet; ++k) {
      const LatticeTet& cell = numbers.cell(local, k);
      tables.centroids[local][k] = centroid(cell) / kCellDivision;
      for (const LatticeStep& step : latticeTables().neighbours[cell.local]) {
        const LatticeTet other = cell.cube + step;
        const LatticeTet tet = tetOfCell(other);
        const int number = numbers.numberOf(other, tet);
        if (same(tet, {Cube{}, local})) {
          tables.adjacent[local][k] |= cellBit(number);
          continue;
        }
        const int corner = cornerTowards(local, tet);
        tables.crossings[local][corner][crossings[corner]++] = {static_cast<std::uint8_t>(k),
                                                                static_cast<std::uint8_t>(number)};
      }
    }
    for ([[maybe_unused]] const int count : crossings) assert(count == kCellsPerFace);
  }
  return tables;
}

int lowestCell(CellMask cells) {
  assert(cells != 0);
  return countCells((cells & (~cells + 1)) - 1);
}

}  // namespace

const CellTables& cellTables() {
  static const CellTables tables = makeCellTables();
  return tables;
}

CellPosition locateCell(const Eigen::Vector3d& p) {
  const LatticeTet cell = locate(p * kCellDivision);
  const LatticeTet tet = tetOfCell(cell);
  assert(cellNumbers().numberOf(cell, tet) >= 0);
  return {tet, cellNumbers().numberOf(cell, tet)};
}

CellMask componentOf(CellMask cells, const CellGraph& graph) {
  CellMask component = cells & (~cells + 1);
  for (CellMask fresh = component; fresh != 0;) {
    CellMask around = 0;
    for (; fresh != 0; fresh &= fresh - 1) around |= graph[lowestCell(fresh)];
    fresh = around & cells & ~component;
    component |= fresh;
  }
  return component;
}

int countCells(CellMask cells) {
  return static_cast<int>(std::bitset<kCellsPerTet>(cells).count());
}

}  // namespace tetskin::cage_detail
