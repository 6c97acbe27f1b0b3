// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/io/files.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tetskin::io {

/// A tet of a file that has more nodes than its corners.
struct HighOrderTet {
  std::size_t tet = 0;  ///< its index among all tets of the file
  /// Of second order: the nodes on the edges 01, 02, 03, 12, 13, 23. Of higher order, -1: they have to be made.
  std::array<int, 6> middles{-1, -1, -1, -1, -1, -1};
  std::size_t line = 0;  ///< of the file; 0 where it is binary
};

/// A cage as it stands in a file.
struct FileCage {
  std::string path;                     ///< of the file with the tets; empty: the one that was asked for
  Cage cage;                            ///< all tets by their corners; its arrays are those of the file
  std::vector<HighOrderTet> highOrder;  ///< ascending
  /// The format does not say in which order nodes are on edges: each is on the edge whose middle it is nearest to.
  bool anyOrder = false;
  std::vector<std::int64_t> spareNodes;  ///< of tets above second order; indices that name no node are ignored

  /// Adds a tet of second order.
  /// nodes  indices in range: corners, then the nodes on the edges
  /// order  by edge 01, 02, 03, 12, 13, 23: its place among the nodes on the edges
  void addQuadratic(const std::array<int, 10>& nodes, const std::array<std::size_t, 6>& order, std::size_t line) {
    HighOrderTet& added = highOrder.emplace_back();
    added.tet = cage.mesh.tetCount();
    added.line = line;
    for (std::size_t e = 0; e < 6; ++e) added.middles[e] = nodes[4 + order[e]];
    cage.mesh.tets.push_back({nodes[0], nodes[1], nodes[2], nodes[3]});
  }
};

/// For formats without an order; and that of VTK: 01, 12, 02, 03, 13, 23; and of Gmsh: 01, 12, 02, 03, 23, 13.
constexpr std::array<std::size_t, 6> kNoOrder = {0, 1, 2, 3, 4, 5}, kVtkOrder = {0, 2, 3, 1, 4, 5},
                                     kGmshOrder = {0, 2, 3, 1, 5, 4};

/// Where nodes on edges are to be.
enum class CurvedEdges {
  Kept,          ///< as in the file, for tets alone
  Straightened,  ///< at the middles of their edges, for quadratic tets
};

/// Cuts tets of second or higher order into eight, which become quadratic tets unless they are flat. Tets of first
/// order stay, unless one of them shares an edge with those: then all are cut, so that no node is on the edge of a tet
/// that does not have it. Nodes above second order that no tet has any more are removed.
/// Errors  Malformed, with the line: nodes that cannot be on the edges; TooLarge
Status cutHighOrderTets(CurvedEdges curved, FileCage& file, TetFileReport& report);

}  // namespace tetskin::io
