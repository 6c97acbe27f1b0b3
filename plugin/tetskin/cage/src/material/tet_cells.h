// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A lattice tet is divided into 64 cells: the tets of the same lattice at a quarter of the spacing, which nest in it.
// One 64-bit word stores which of them are inside a body.
#pragma once

#include <tetskin/cage/src/lattice/bcc_lattice.h>

#include <array>
#include <cstdint>

namespace tetskin::cage_detail {

/// Two uniform refinements, and the bits of a CellMask.
constexpr int kCellsPerTet = 64;
/// Cells along a face of a tet.
constexpr int kCellsPerFace = 16;
/// Spacing of the lattice divided by that of the cells.
constexpr int kCellDivision = 4;

/// Bit k is set for cell k of a tet.
using CellMask = std::uint64_t;
/// A full tet.
constexpr CellMask kAllCells = ~CellMask{0};
constexpr CellMask cellBit(int cell) {
  return CellMask{1} << cell;
}

/// By cell of a tet: the cells of the same tet with which it shares a face.
using CellGraph = std::array<CellMask, kCellsPerTet>;

/// By tet of a cube, `LatticeTet::local`.
struct CellTables {
  struct Crossing {
    std::uint8_t own = 0;     ///< cell of the tet
    std::uint8_t beyond = 0;  ///< adjacent cell of the tet beyond, on the other side of that face
  };

  /// Lattice coordinates relative to the cube.
  std::array<std::array<Eigen::Vector3d, kCellsPerTet>, kTetsPerCube> centroids;
  std::array<CellGraph, kTetsPerCube> adjacent;
  /// By the corner opposite to the face.
  std::array<std::array<std::array<Crossing, kCellsPerFace>, 4>, kTetsPerCube> crossings;
};
const CellTables& cellTables();

struct CellPosition {
  LatticeTet tet;
  int cell = 0;
};
/// The cell that holds a point in lattice coordinates. O(1)
CellPosition locateCell(const Eigen::Vector3d& p);

/// The cells of a mask that are connected with the lowest one.
CellMask componentOf(CellMask cells, const CellGraph& graph);

int countCells(CellMask cells);

}  // namespace tetskin::cage_detail
