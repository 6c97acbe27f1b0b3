// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Of a refined tet, four of the eight tets surround an edge: a diagonal of the octahedron between the midpoints. The
// other four are their neighbours across every second face of the octahedron. So every edge with a ring of four tets,
// and either half of the faces, is tried; where several attempts claim the same tets, the larger group wins.
#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/mesh/face_neighbours.h>
#include <tetskin/core/src/base/mesh/quadratic_assembly.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <optional>
#include <tuple>

namespace tetskin {
namespace {

/// An edge of a tet, its ends ascending.
struct EdgeOfTet {
  std::array<int, 2> ends;
  int tet;
  bool operator<(const EdgeOfTet& other) const { return ends != other.ends ? ends < other.ends : tet < other.tet; }
};

std::vector<EdgeOfTet> sortedEdges(const TetMesh& mesh) {
  std::vector<EdgeOfTet> edges;
  edges.reserve(kTetEdges.size() * mesh.tetCount());
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
    for (const auto& [a, b] : kTetEdges) {
      const Tet& tet = mesh.tets[t];
      edges.push_back({{std::min(tet[a], tet[b]), std::max(tet[a], tet[b])}, static_cast<int>(t)});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Four tets around an edge. Tet k has the nodes k and k + 1 (modulo 4) of the ring.
struct Octahedron {
  std::array<int, 2> ends{};
  std::array<int, 4> ring{}, tets{-1, -1, -1, -1};
};

/// The two nodes of a tet that are not the ends of one of its edges.
std::array<int, 2> oppositeEdge(const Tet& tet, const std::array<int, 2>& ends) {
  std::array<int, 2> rest{-1, -1};
  std::size_t count = 0;
  for (const int node : tet) {
    if (node != ends[0] && node != ends[1] && count < 2) rest[count++] = node;
  }
  return rest;
}

/// The octahedron of the four tets of an edge, if they close a ring.
std::optional<Octahedron> octahedronAround(const TetMesh& mesh, const EdgeOfTet* four) {
  Octahedron found;
  found.ends = four[0].ends;
  std::array<bool, 4> taken{true};
  const std::array<int, 2> first = oppositeEdge(mesh.tets[four[0].tet], found.ends);
  found.tets[0] = four[0].tet;
  found.ring = {first[0], first[1], -1, -1};
  for (std::size_t k = 1; k < 4; ++k) {
    for (std::size_t j = 1; j < 4 && found.tets[k] < 0; ++j) {
      if (taken[j]) continue;
      const auto [a, b] = oppositeEdge(mesh.tets[four[j].tet], found.ends);
      if (a != found.ring[k] && b != found.ring[k]) continue;
      taken[j] = true;
      found.tets[k] = four[j].tet;
      found.ring[(k + 1) % 4] = a == found.ring[k] ? b : a;
    }
  }
  const bool closed = std::all_of(taken.begin(), taken.end(), [](bool t) { return t; }) && found.ring[0] == first[0];
  return closed ? std::optional(found) : std::nullopt;
}

/// Finds the groups of eight tets that are a refined one, and chooses among them.
class RefinedTets {
 public:
  explicit RefinedTets(const TetMesh& mesh) : mesh_(mesh), beyond_(faceNeighbours(mesh)) { findAll(); }

  /// By tet: the number of its group, or -1; groups are numbered in the order of their first tets.
  std::vector<int> choose(std::size_t& count) const;

 private:
  void findAll();
  void addAround(const Octahedron& octahedron, std::size_t side);
  int neighbour(int tet, int oppositeNode) const;
  std::vector<std::size_t> byGroup() const;

  const TetMesh& mesh_;
  Lists<> beyond_;
  std::vector<QuadraticTet> found_;
};

/// The tet across the face opposite to a node; -1 if there is none, or more than one.
int RefinedTets::neighbour(int tet, int oppositeNode) const {
  const Tet& nodes = mesh_.tets[tet];
  const std::size_t corner =
      static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), oppositeNode) - nodes.begin());
  const std::size_t face = 4 * static_cast<std::size_t>(tet) + corner;
  assert(corner < 4);
  if (beyond_.starts[face + 1] != beyond_.starts[face] + 1) return -1;
  return static_cast<int>(beyond_.values[beyond_.starts[face]]);
}

void RefinedTets::findAll() {
  const std::vector<EdgeOfTet> edges = sortedEdges(mesh_);
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
    while (last < edges.size() && edges[last].ends == edges[first].ends) ++last;
    if (last - first != 4) continue;
    const std::optional<Octahedron> octahedron = octahedronAround(mesh_, &edges[first]);
    for (std::size_t side = 0; octahedron && side < 2; ++side) addAround(*octahedron, side);
  }
}

/// side  the end of the diagonal whose faces with tets 0 and 2 lead to corners; those of the other end are with 1 and 3
void RefinedTets::addAround(const Octahedron& octahedron, std::size_t side) {
  std::array<int, kSubTets> tets{};
  for (std::size_t k = 0; k < 4; ++k) {
    tets[k] = octahedron.tets[k];
    tets[4 + k] = neighbour(tets[k], octahedron.ends[(side + k + 1) % 2]);
    if (tets[4 + k] < 0) return;
  }
  std::sort(tets.begin(), tets.end());
  if (const auto whole = assembleQuadraticTet(mesh_, tets)) found_.push_back(*whole);
}

/// The order in which groups are taken: those first that hang together, by whole faces, with the most others. In a mesh
/// that was refined twice, for example, groups across the borders of the right ones are fewer, and scattered.
std::vector<std::size_t> RefinedTets::byGroup() const {
  struct Face {
    std::array<int, 3> corners;
    int group;
  };
  std::vector<Face> faces;
  for (std::size_t k = 0; k < found_.size(); ++k) {
    for (std::size_t c = 0; c < 4; ++c) {
      const auto& n = found_[k].nodes;
      Face face{{n[(c + 1) % 4], n[(c + 2) % 4], n[(c + 3) % 4]}, static_cast<int>(k)};
      std::sort(face.corners.begin(), face.corners.end());
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.corners < b.corners; });
  DisjointSets together(found_.size());
  for (std::size_t k = 1; k < faces.size(); ++k) {
    if (faces[k].corners == faces[k - 1].corners) together.unite(faces[k - 1].group, faces[k].group);
  }
  std::vector<std::size_t> setOf, sizes(found_.size(), 0), order(found_.size());
  for (std::size_t k = 0; k < found_.size(); ++k) {
    setOf.push_back(static_cast<std::size_t>(together.find(static_cast<int>(k))));
    ++sizes[setOf[k]];
  }
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (sizes[setOf[a]] != sizes[setOf[b]]) return sizes[setOf[a]] > sizes[setOf[b]];
    return std::tie(setOf[a], a) < std::tie(setOf[b], b);
  });
  return order;
}

std::vector<int> RefinedTets::choose(std::size_t& count) const {
  std::vector<const QuadraticTet*> groupOf(mesh_.tetCount(), nullptr);
  for (const std::size_t k : byGroup()) {
    const auto& tets = found_[k].tets;
    if (std::any_of(tets.begin(), tets.end(), [&](int t) { return groupOf[t]; })) continue;
    for (const int t : tets) groupOf[t] = &found_[k];
  }
  std::vector<int> numbers(mesh_.tetCount(), -1);
  count = 0;
  for (std::size_t t = 0; t < numbers.size(); ++t) {
    if (!groupOf[t] || numbers[t] >= 0) continue;
    for (const int other : groupOf[t]->tets) numbers[other] = static_cast<int>(count);
    ++count;
  }
  return numbers;
}

}  // namespace

std::size_t findQuadraticTets(Cage& cage) {
  std::size_t count = 0;
  cage.quadraticTet = RefinedTets(cage.mesh).choose(count);
  if (count == 0) cage.quadraticTet.clear();
  return count;
}

}  // namespace tetskin
