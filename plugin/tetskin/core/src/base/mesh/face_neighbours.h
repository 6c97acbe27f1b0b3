// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/lists.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <vector>

namespace tetskin {

/// By face of a tet, 4 t + the opposite corner: the other tets with its three nodes, ascending; more than one where
/// duplicates of a tet meet. Cost O(T log T).
inline Lists<> faceNeighbours(const TetMesh& mesh) {
  assert(mesh.tetCount() < 0xFFFFFFFFu / 4);
  struct Face {
    std::array<int, 3> nodes;
    std::uint32_t index;
  };
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tetCount());
  for (std::uint32_t t = 0; t < mesh.tetCount(); ++t) {
    for (std::uint32_t c = 0; c < 4; ++c) {
      const Tet& tet = mesh.tets[t];
      std::array<int, 3> nodes = {tet[(c + 1) % 4], tet[(c + 2) % 4], tet[(c + 3) % 4]};
      std::sort(nodes.begin(), nodes.end());
      faces.push_back({nodes, 4 * t + c});
    }
  }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.nodes != b.nodes ? a.nodes < b.nodes : a.index < b.index; });
  return packLists(faces.size(), [&](auto&& add) {
    for (std::size_t first = 0, last = 0; first < faces.size(); first = last) {
      while (last < faces.size() && faces[last].nodes == faces[first].nodes) ++last;
      for (std::size_t a = first; a < last; ++a) {
        for (std::size_t b = first; b < last; ++b) {
          if (a != b) add(static_cast<std::size_t>(faces[a].index), faces[b].index / 4);
        }
      }
    }
  });
}

}  // namespace tetskin
