// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The data of a cage in a legacy VTK file, beside its nodes and tets, as arrays by these names:
//
//   behind the mesh        FIELD    mesh_hash    2 x 1             unsigned_int: upper and lower 32 bits of meshHash
//                                   vertex_tets  1 x vertexCount   int
//   CELL_DATA              SCALARS  fill         tetCount          double
//                                   factor       tetCount          double
//                                   part         tetCount          int
//                                   lattice_tet  tetCount          int
//                                   quadratic_tet  tetCount        int
//                          FIELD    fine_fill    kFineTets x tetCount  unsigned_char
//   POINT_DATA             SCALARS  mass         nodeCount         double
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/io/src/tets/vtk_text.h>

#include <string>
#include <vector>

namespace tetskin::io {

/// Reads these arrays into a cage, whether they are SCALARS or in a FIELD of their owner, because programs that save
/// the file again may exchange the two. All other arrays are skipped.
class VtkCageData {
 public:
  VtkCageData(VtkText& file, Cage& cage) : file_(file), cage_(cage) {}

  /// Reads a FIELD of the file itself, whose keyword has been read.
  Status readField();
  /// Reads everything from the first CELL_DATA or POINT_DATA on, whose keyword has been read.
  Status readSections(std::string keyword, std::size_t cells, std::size_t nodes);
  /// Removes values of cells that are not tets.
  /// isTet  by cell
  void keepTets(const std::vector<bool>& isTet);

 private:
  /// The elements to which the arrays of a section belong.
  enum class Owner { File, Cells, Nodes };

  Status beginSection(const std::string& keyword, std::size_t cells, std::size_t nodes);
  Status readAttribute(const std::string& keyword);
  Status readScalars();
  /// Reads an array whose header has been read.
  Status readArray(const VtkArray& array);
  Status readHash(const VtkArray& array);
  template <class Number>
  Status readInto(const VtkArray& array, std::uint64_t components, std::vector<Number>& values);
  Status fault(const std::string& what) const;

  VtkText& file_;
  Cage& cage_;
  Owner owner_ = Owner::File;
  std::uint64_t tuples_ = 0;  ///< of each array of the section, except those of the file
};

/// Appends the arrays of a cage to the text of its mesh; nothing if the cage has no such data.
void appendCageData(std::string& text, const Cage& cage);

}  // namespace tetskin::io
