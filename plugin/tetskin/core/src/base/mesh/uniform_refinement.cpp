// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/uniform_refinement.h>

#include <algorithm>
#include <cassert>
#include <map>

namespace tetskin {

Refinement refineUniformly(const TetMesh& coarse) {
  Refinement result;
  result.edges = uniqueEdges(coarse);
  result.mesh.nodes = coarse.nodes;
  std::map<std::array<int, 2>, int> midpointOf;
  for (const auto& [a, b] : result.edges) {
    midpointOf[{std::min(a, b), std::max(a, b)}] = static_cast<int>(result.mesh.nodeCount());
    result.mesh.nodes.emplace_back(0.5 * (coarse.nodes[a] + coarse.nodes[b]));
  }
  result.mesh.tets.reserve(8 * coarse.tetCount());
  for (const Tet& tet : coarse.tets) {
    std::array<int, 6> midpoints{};
    std::size_t next = 0;
    for (int a = 0; a < 4; ++a) {
      for (int b = a + 1; b < 4; ++b) {
        midpoints[next++] = midpointOf.at({std::min(tet[a], tet[b]), std::max(tet[a], tet[b])});
      }
    }
    const std::array<Tet, 8> eight = refinedTet(tet, midpoints, result.mesh.nodes);
    result.mesh.tets.insert(result.mesh.tets.end(), eight.begin(), eight.end());
  }
  assert(result.mesh.tetCount() == 8 * coarse.tetCount());
  return result;
}

}  // namespace tetskin
