// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/io/files.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace tetskin::io {

/// The nodes that tets of higher order have beside their corners, of which only the corners are read.
class EdgeNodes {
 public:
  bool empty() const { return nodes_.empty(); }
  /// Indices that name no node are ignored: nothing is read of them.
  void add(std::int64_t node) { nodes_.push_back(node); }
  template <class Iterator>
  void add(Iterator first, Iterator last) {
    nodes_.insert(nodes_.end(), first, last);
  }

  /// Removes those that no tet names as a corner, and their masses; counts them.
  void drop(Cage& cage, TetFileReport& report) const {
    if (nodes_.empty()) return;
    TetMesh& mesh = cage.mesh;
    const std::size_t count = mesh.nodeCount();
    std::vector<bool> dropped(count, false);
    for (const std::int64_t node : nodes_) {
      if (node >= 0 && static_cast<std::uint64_t>(node) < count) dropped[static_cast<std::size_t>(node)] = true;
    }
    for (const Tet& tet : mesh.tets) {
      for (const int node : tet) dropped[static_cast<std::size_t>(node)] = false;
    }
    std::vector<int> numbers(count, -1);
    std::size_t kept = 0;
    for (std::size_t n = 0; n < count; ++n) {
      if (dropped[n]) continue;
      mesh.nodes[kept] = mesh.nodes[n];
      if (!cage.masses.empty()) cage.masses[kept] = cage.masses[n];
      numbers[n] = static_cast<int>(kept++);
    }
    report.droppedNodes += count - kept;
    mesh.nodes.resize(kept);
    if (!cage.masses.empty()) cage.masses.resize(kept);
    for (Tet& tet : mesh.tets) {
      for (int& node : tet) node = numbers[static_cast<std::size_t>(node)];
    }
  }

 private:
  std::vector<std::int64_t> nodes_;
};

}  // namespace tetskin::io
