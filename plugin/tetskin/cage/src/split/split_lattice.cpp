// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/split/split_lattice.h>
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/mesh/face_neighbours.h>
#include <tetskin/core/src/base/progress.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <numeric>

namespace tetskin::cage_detail {
namespace {

/// A duplicate that contains no point, and at most this many cells, is removed if at most one other is connected to it.
constexpr int kNextToNothing = 1;

class Splitter {
 public:
  Splitter(const TetCopies& copies, const SurfaceSamples& samples, const LatticeMesh& lattice,
           const LatticeLinks& links)
      : copies_(copies),
        samples_(samples),
        lattice_(lattice),
        links_(links),
        kept_(copies.copies.size(), 1),
        nodes_(4 * copies.copies.size()),
        components_(copies.copies.size()) {}

  CageTets run() {
    skipScraps();
    for (const auto& [a, b] : copies_.links) {
      if (kept_[a] && kept_[b]) joinNodes(a, b);
    }
    joinTornComponents();
    joinThinComponents();
    skipEmptyComponents();
    return result();
  }

 private:
  int tet(int copy) const { return copies_.copies[copy].tet; }
  const Tet& corners(int copy) const { return lattice_.mesh.tets[tet(copy)]; }

  void skipScraps() {
    std::vector<int> neighbours(kept_.size(), 0), points(kept_.size(), 0);
    for (const auto& [a, b] : copies_.links) ++neighbours[a], ++neighbours[b];
    for (const int copy : copies_.copyOf) {
      if (copy >= 0) ++points[copy];
    }
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      kept_[k] = points[k] > 0 || neighbours[k] > 1 || countCells(copies_.copies[k].cells) > kNextToNothing;
    }
  }

  /// Unites the common corners of two duplicates into the same nodes.
  void joinNodes(int a, int b) {
    assert(kept_[a] && kept_[b]);
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        if (corners(a)[i] == corners(b)[j]) nodes_.unite(4 * a + i, 4 * b + j);
      }
    }
    components_.unite(a, b);
  }

  /// If components of the surface have still been separated, joins them again, by tets with their duplicates or with
  /// those of a neighbour. The others join the component with the most points.
  void joinTornComponents() {
    DisjointSets components(samples_.points.size());
    for (const auto& [a, b] : samples_.steps) components.unite(a, b);
    std::map<std::array<int, 2>, int> pointsIn;  // component of the surface, component of the cage
    for (std::size_t p = 0; p < copies_.copyOf.size(); ++p) {
      if (copies_.copyOf[p] >= 0)
        ++pointsIn[{components.find(static_cast<int>(p)), components_.find(copies_.copyOf[p])}];
    }
    std::map<int, std::array<int, 2>> main;  // by component of the surface: most points, their component
    for (const auto& [where, count] : pointsIn) {
      std::array<int, 2>& largest = main.try_emplace(where[0], std::array<int, 2>{0, -1}).first->second;
      if (count > largest[0]) largest = {count, where[1]};
    }
    const Lists<> inTet = copiesInTets();
    for (std::size_t p = 0; p < copies_.copyOf.size(); ++p) {
      if (copies_.copyOf[p] < 0) continue;
      const int target = main.at(components.find(static_cast<int>(p)))[1];
      if (components_.find(copies_.copyOf[p]) != components_.find(target)) joinTo(target, copies_.copyOf[p], inTet);
    }
  }

  Lists<> copiesInTets() const {
    return packLists(lattice_.mesh.tetCount(), [&](auto&& add) {
      for (std::uint32_t k = 0; k < kept_.size(); ++k) {
        if (kept_[k]) add(static_cast<std::size_t>(tet(static_cast<int>(k))), k);
      }
    });
  }

  /// Joins a duplicate to a component that has a duplicate of the same tet or of a neighbouring one.
  void joinTo(int component, int copy, const Lists<>& inTet) {
    const std::array<int, 4>& beyond = links_.beyond[tet(copy)];
    for (const int index : {tet(copy), beyond[0], beyond[1], beyond[2], beyond[3]}) {
      if (index < 0) continue;
      for (std::uint32_t k = inTet.starts[index]; k < inTet.starts[index + 1]; ++k) {
        const int other = static_cast<int>(inTet.values[k]);
        if (components_.find(other) == components_.find(component)) return joinNodes(copy, other);
      }
    }
  }

  /// A component that is nowhere thick enough for material joins another with which it shares a tet, like something
  /// that grows out of a body.
  void joinThinComponents() {
    std::vector<char> thick(kept_.size(), 0);
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      if (kept_[k] && copies_.copies[k].cells != 0) thick[components_.find(static_cast<int>(k))] = 1;
    }
    const Lists<> inTet = copiesInTets();
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      const int copy = static_cast<int>(k);
      if (!kept_[k] || thick[components_.find(copy)]) continue;
      for (std::uint32_t n = inTet.starts[tet(copy)]; n < inTet.starts[tet(copy) + 1]; ++n) {
        const int other = static_cast<int>(inTet.values[n]);
        if (copies_.copies[other].cells == 0 || components_.find(other) == components_.find(copy)) continue;
        joinNodes(copy, other);
        thick[components_.find(copy)] = 1;
        break;
      }
    }
  }

  void skipEmptyComponents() {
    std::vector<char> holds(kept_.size(), 0);
    for (const int copy : copies_.copyOf) {
      if (copy >= 0) holds[components_.find(copy)] = 1;
    }
    for (std::size_t k = 0; k < kept_.size(); ++k) kept_[k] = kept_[k] && holds[components_.find(static_cast<int>(k))];
  }

  CageTets result() {
    CageTets cage;
    std::vector<int> nodeOf(4 * kept_.size(), -1), tetOf(kept_.size(), -1);
    std::map<Tet, int> made;  // duplicates with the same nodes are one tet
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      Progress::goOn(k);
      if (!kept_[k]) continue;
      const int copy = static_cast<int>(k);
      Tet nodes{};
      for (int i = 0; i < 4; ++i) nodes[i] = nodes_.find(4 * copy + i);
      const auto [entry, isNew] = made.try_emplace(nodes, static_cast<int>(cage.mesh.tets.size()));
      tetOf[k] = entry->second;
      if (!isNew) {
        cage.cells[entry->second] |= copies_.copies[k].cells;
        continue;
      }
      cage.mesh.tets.push_back(numbered(nodes, corners(copy), nodeOf, cage.mesh.nodes));
      cage.latticeTets.push_back(tet(copy));
      cage.cells.push_back(copies_.copies[k].cells);
    }
    for (const int copy : copies_.copyOf) cage.tetOf.push_back(copy < 0 ? -1 : tetOf[copy]);
    cage.split = cage.mesh.nodeCount() > nodesUsed(cage.latticeTets);
    assert(cage.cells.size() == cage.mesh.tetCount() && cage.tetOf.size() == samples_.points.size());
    return cage;
  }

  /// The number of lattice nodes that these lattice tets use.
  std::size_t nodesUsed(const std::vector<int>& tets) const {
    std::vector<char> used(lattice_.mesh.nodeCount(), 0);
    for (const int t : tets) {
      for (const int n : lattice_.mesh.tets[t]) used[n] = 1;
    }
    return static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
  }

  Tet numbered(const Tet& sets, const Tet& indices, std::vector<int>& nodeOf,
               std::vector<Eigen::Vector3d>& nodes) const {
    Tet numbers{};
    for (int i = 0; i < 4; ++i) {
      int& number = nodeOf[sets[i]];
      if (number < 0) {
        number = static_cast<int>(nodes.size());
        nodes.push_back(lattice_.mesh.nodes[indices[i]]);
      }
      numbers[i] = number;
    }
    return numbers;
  }

  const TetCopies& copies_;
  const SurfaceSamples& samples_;
  const LatticeMesh& lattice_;
  const LatticeLinks& links_;
  std::vector<char> kept_;   ///< by duplicate
  DisjointSets nodes_;       ///< 4 per duplicate
  DisjointSets components_;  ///< of duplicates
};

/// Duplicates of one tet do not close each other's faces.
std::vector<std::uint8_t> openFacesOf(const CageTets& cage) {
  const Lists<> beyond = faceNeighbours(cage.mesh);
  std::vector<std::uint8_t> open(cage.mesh.tetCount(), 0);
  for (std::size_t t = 0; t < open.size(); ++t) {
    Progress::goOn(t);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      bool closed = false;
      for (std::uint32_t k = beyond.starts[4 * t + corner]; k < beyond.starts[4 * t + corner + 1]; ++k) {
        closed |= cage.latticeTets[beyond.values[k]] != cage.latticeTets[t];
      }
      if (!closed) open[t] = static_cast<std::uint8_t>(open[t] | 1u << corner);
    }
  }
  return open;
}

}  // namespace

std::size_t CageTets::copies() const {
  std::vector<int> sorted = latticeTets;
  std::sort(sorted.begin(), sorted.end());
  return static_cast<std::size_t>(sorted.end() - std::unique(sorted.begin(), sorted.end()));
}

CageTets wholeLattice(const LatticeMesh& lattice, const TetMaterial& material, const std::vector<int>& tetOf) {
  assert(lattice.openFaces.size() == lattice.mesh.tetCount() && material.cells.size() == lattice.mesh.tetCount());
  CageTets cage;
  cage.mesh = lattice.mesh;
  cage.openFaces = lattice.openFaces;
  cage.latticeTets.resize(lattice.mesh.tetCount());
  std::iota(cage.latticeTets.begin(), cage.latticeTets.end(), 0);
  cage.cells = material.cells;
  cage.tetOf = tetOf;
  return cage;
}

CageTets splitLattice(const TetCopies& copies, const SurfaceSamples& samples, const LatticeMesh& lattice,
                      const LatticeLinks& links) {
  assert(copies.copyOf.size() == samples.points.size());
  CageTets cage = Splitter(copies, samples, lattice, links).run();
  cage.openFaces = openFacesOf(cage);
  return cage;
}

}  // namespace tetskin::cage_detail
