// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/shared/base/lists.h>
#include <tetskin/core/tet_mesh.h>

namespace tetskin {

/// By node, its tets, ascending; of all tets, or of those that `counts`. Cost O(N + T).
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
