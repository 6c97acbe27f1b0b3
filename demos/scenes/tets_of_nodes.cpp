// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/tets_of_nodes.h"

#include <tetskin/core/embedding.h>

#include <limits>

#include "scenes/input_error.h"

namespace tetskin::scenes {
namespace {

/// For each node, the nearest of the mesh's vertices that its tets contain. Nodes whose tets contain none take a
/// neighbour's.
class NearVertices {
 public:
  NearVertices(const TriangleMesh& mesh, const Cage& cage)
      : mesh_(mesh), cage_(cage), nearest_(cage.mesh.nodeCount(), -1), distances_(cage.mesh.nodeCount(), kFar) {
    for (std::size_t v = 0; v < cage.vertexTets.size(); ++v) {
      for (const int node : cage.mesh.tets[cage.vertexTets[v]]) offer(node, static_cast<int>(v));
    }
    const auto edges = uniqueEdges(cage.mesh);
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& [a, b] : edges) {
        changed = offer(a, nearest_[b]) || changed;
        changed = offer(b, nearest_[a]) || changed;
      }
    }
  }
  int operator[](std::size_t node) const { return nearest_[node]; }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  bool offer(int node, int vertex) {
    if (vertex < 0) return false;
    const double distance = (cage_.mesh.nodes[node] - mesh_.positions[vertex]).norm();
    if (!(distance < distances_[node])) return false;
    nearest_[node] = vertex;
    distances_[node] = distance;
    return true;
  }

  const TriangleMesh& mesh_;
  const Cage& cage_;
  std::vector<int> nearest_;
  std::vector<double> distances_;
};

std::vector<int> tetsByPosition(const Cage& driver, const Cage& cage) {
  const auto embedding = embed(static_cast<const TetMesh&>(driver.mesh), viewOf(cage.mesh.nodes));
  require(embedding.status());
  std::vector<int> tets;
  for (const VertexBinding& binding : embedding.value().bindings()) tets.push_back(binding.tet);
  return tets;
}

std::vector<int> tetsByMap(const TriangleMesh& mesh, const Cage& driver, const Cage& cage) {
  const NearVertices vertices(mesh, cage);
  const CageLocator locator(driver);
  std::vector<int> tets;
  for (std::size_t n = 0; n < cage.mesh.nodeCount(); ++n) {
    const int vertex = vertices[n];
    tets.push_back(locator.locate(cage.mesh.nodes[n], {vertex, vertex, vertex}));
  }
  return tets;
}

}  // namespace

std::vector<int> tetsOfNodes(const TriangleMesh& mesh, const Cage& driver, const Cage& cage) {
  // If neither has duplicate elements, the nearest tet is the correct one more often than the one where a search
  // through faces ends.
  const bool byPosition = cage.vertexTets.empty() || !(cage.hasDuplicates() || driver.hasDuplicates());
  return byPosition ? tetsByPosition(driver, cage) : tetsByMap(mesh, driver, cage);
}

}  // namespace tetskin::scenes
