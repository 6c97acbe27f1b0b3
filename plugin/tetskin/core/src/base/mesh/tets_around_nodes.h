// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/lists.h>

namespace tetskin {

/// By node: its tets, ascending; all of them, or those for which `counts` is true. Cost O(N + T).
template <class Counts>
Lists<> tetsAroundNodes(const TetMesh& mesh, Counts&& counts) {
  return packLists(mesh.nodeCount(), [&](auto&& add) {
    for (std::uint32_t t = 0; t < mesh.tetCount(); ++t) {
      if (!counts(t)) continue;
      for (const int n : mesh.tets[t]) add(static_cast<std::size_t>(n), t);
    }
  });
}
inline Lists<> tetsAroundNodes(const TetMesh& mesh) {
  return tetsAroundNodes(mesh, [](std::uint32_t) { return true; });
}

}  // namespace tetskin
