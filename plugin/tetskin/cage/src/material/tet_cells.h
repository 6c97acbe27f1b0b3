// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A tet of the lattice cut into 64 cells: the tets of the same lattice at a quarter of the spacing, which nest in it.
// Which of them a body fills is one 64-bit word.
#pragma once

#include <tetskin/cage/src/lattice/bcc_lattice.h>

#include <array>
#include <cstdint>

namespace tetskin::cage_detail {

constexpr int kCellsPerTet = 64;
/// Cells along a face of a tet.
constexpr int kCellsPerFace = 16;
/// Of the lattice over that of the cells.
constexpr int kCellDivision = 4;

/// Bit k is set for cell k of a tet.
using CellMask = std::uint64_t;
constexpr CellMask kAllCells = ~CellMask{0};
constexpr CellMask cellBit(int cell) {
  return CellMask{1} << cell;
}

/// By cell of a tet: the cells of the same tet that it shares a face with.
using CellGraph = std::array<CellMask, kCellsPerTet>;

/// By tet of a cube, `LatticeTet::local`.
struct CellTables {
  struct Crossing {
    std::uint8_t own = 0;     ///< cell of the tet
    std::uint8_t beyond = 0;  ///< cell of the tet beyond, on the other side of the same face of a cell
  };

  std::array<std::array<Eigen::Vector3d, kCellsPerTet>, kTetsPerCube> centroids;  ///< lattice, relative to the cube
  std::array<CellGraph, kTetsPerCube> adjacent;
  std::array<std::array<std::array<Crossing, kCellsPerFace>, 4>, kTetsPerCube> crossings;  ///< by corner opposite
};
const CellTables& cellTables();

struct CellPlace {
  LatticeTet tet;
  int cell = 0;
};
/// The cell that holds a point in lattice coordinates. O(1)
CellPlace locateCell(const Eigen::Vector3d& p);

/// The cells of a mask that hang together with the lowest one.
CellMask componentOf(CellMask cells, const CellGraph& graph);

int countCells(CellMask cells);

}  // namespace tetskin::cage_detail
