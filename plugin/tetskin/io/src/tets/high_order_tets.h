// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/io/files.h>

#include <array>
#include <string>
#include <vector>

namespace tetskin::io {

struct HighOrderTet {
  std::size_t tet = 0;           ///< its index among all tets of the file
  std::array<int, 6> middles{};  ///< the nodes on the edges 01, 02, 03, 12, 13, 23
  std::size_t line = 0;          ///< of the file; 0 if it is binary
};

/// A cage as stored in a file.
struct FileCage {
  std::string path;                     ///< of the file with the tets
  Cage cage;                            ///< all tets by their corners; its arrays are those of the file
  std::vector<HighOrderTet> highOrder;  ///< ascending
};

/// How a file is read: as tets alone, with nodes on edges where the file has them; or as a cage, with the data that
/// `saveCage` writes, and with nodes on edges at their middles, for quadratic tets.
enum class ReadAs { Tets, Cage };

/// Cuts tets of second order into eight, which become quadratic tets unless they are flat.
/// Errors  Malformed, with the line: nodes that cannot be on the edges; UnsupportedFormat: tets of first order with
///         such an edge: a node would be on an edge of a tet that does not use it; TooLarge
Status cutHighOrderTets(ReadAs as, FileCage& file, TetFileReport& report);

}  // namespace tetskin::io
