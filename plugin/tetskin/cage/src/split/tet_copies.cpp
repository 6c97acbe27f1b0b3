// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/split/tet_copies.h>
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/progress.h>

#include <algorithm>
#include <cassert>

namespace tetskin::cage_detail {
namespace {

/// Largest number of duplicates to visit around a tet, which has some seventy neighbours.
constexpr std::size_t kMaxAround = 200;

/// Keeps each pair once, with the lower number first.
void sortUnique(std::vector<std::array<int, 2>>& pairs) {
  for (auto& [a, b] : pairs) {
    if (a > b) std::swap(a, b);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

class CopyLinks {
 public:
  CopyLinks(TetPieces& pieces, const Surface& surface, const TetMaterial& material, const LatticeMesh& lattice,
            const LatticeLinks& links, const SegmentQueries& directions)
      : pieces_(pieces),
        surface_(surface),
        material_(material),
        lattice_(lattice),
        links_(links),
        queries_(directions) {}

  /// Finds the links. Pieces of a tet that turn out to be one are united.
  std::vector<std::array<int, 2>> run() {
    linkTriangles();
    linkMaterial();
    sortUnique(found_);
    mergeLightPieces();
    return std::move(found_);
  }

 private:
  const TetPiece& piece(int k) const { return pieces_.pieces[k]; }

  /// A triangle in two tets that share a face passes through that face.
  void linkTriangles() {
    const Lists<> elements = packLists(surface_.triangles.size(), [&](auto&& add) {
      for (std::size_t e = 0; e < material_.triangles.values.size(); ++e) {
        add(static_cast<std::size_t>(queries_.triangleOf(e)), static_cast<std::uint32_t>(e));
      }
    });
    const auto tetOf = [&](std::uint32_t e) { return piece(pieces_.pieceOf[e]).tet; };
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      Progress::goOn(t);
      const auto first = elements.values.begin() + elements.starts[t];
      const auto last = elements.values.begin() + elements.starts[t + 1];
      for (auto e = first; e != last; ++e) {
        for (const int beyond : links_.beyond[tetOf(*e)]) {
          if (beyond <= tetOf(*e)) continue;  // elements are sorted by tet
          const auto other =
              std::lower_bound(e, last, beyond, [&](std::uint32_t x, int tet) { return tetOf(x) < tet; });
          if (other == last || tetOf(*other) != beyond) continue;
          found_.push_back({pieces_.pieceOf[*e], pieces_.pieceOf[*other]});
        }
      }
    }
  }

  void linkMaterial() {
    for (int k = 0; k < static_cast<int>(pieces_.pieces.size()); ++k) {
      Progress::goOn(static_cast<std::size_t>(k));
      for (int corner = 0; corner < 4 && piece(k).cells != 0; ++corner) {
        const int beyond = links_.beyond[piece(k).tet][corner];
        if (beyond <= piece(k).tet) continue;
        const CellMask against = cellsAgainst(piece(k), corner);
        for (int other = pieces_.starts[beyond]; other < pieces_.starts[beyond + 1]; ++other) {
          if ((piece(other).cells & against) != 0) found_.push_back({k, other});
        }
      }
    }
  }

  /// The cells beyond a face that no surface separates from those of a piece.
  CellMask cellsAgainst(const TetPiece& own, int corner) const {
    assert(links_.beyond[own.tet][corner] >= 0);
    const int beyond = links_.beyond[own.tet][corner];
    const bool layered = pieces_.layered[own.tet] || pieces_.layered[beyond];
    CellMask against = 0;
    for (const CellTables::Crossing& crossing : cellTables().crossings[links_.tets[own.tet].local][corner]) {
      if ((own.cells >> crossing.own & 1) == 0 || (material_.cells[beyond] >> crossing.beyond & 1) == 0) continue;
      if (layered && queries_.isBlocked({own.tet, crossing.own}, {beyond, crossing.beyond})) continue;
      against |= cellBit(crossing.beyond);
    }
    return against;
  }

  /// Unites a piece without material with another piece of its tet if the two are connected in the tets around: both
  /// then belong to the rim of one part.
  void mergeLightPieces() {
    DisjointSets same(pieces_.pieces.size());
    const Lists<> neighbours = packLists(pieces_.pieces.size(), [&](auto&& add) {
      for (const auto& [a, b] : found_) {
        add(static_cast<std::size_t>(a), static_cast<std::uint32_t>(b));
        add(static_cast<std::size_t>(b), static_cast<std::uint32_t>(a));
      }
    });
    for (int k = 0; k < static_cast<int>(pieces_.pieces.size()); ++k) {
      const int tet = piece(k).tet;
      if (piece(k).cells == 0 && pieces_.starts[tet + 1] - pieces_.starts[tet] > 1) uniteAround(k, neighbours, same);
    }
    renumber(same);
  }

  /// Unites it with those pieces of its tet that a path of links within the surrounding tets leads to.
  void uniteAround(int light, const Lists<>& neighbours, DisjointSets& same) const {
    const int tet = piece(light).tet;
    std::vector<int> reached = {light};
    for (std::size_t k = 0; k < reached.size() && reached.size() < kMaxAround; ++k) {
      for (std::uint32_t n = neighbours.starts[reached[k]]; n < neighbours.starts[reached[k] + 1]; ++n) {
        const int other = static_cast<int>(neighbours.values[n]);
        if (!shareNode(lattice_.mesh.tets[tet], lattice_.mesh.tets[piece(other).tet])) continue;
        if (std::find(reached.begin(), reached.end(), other) == reached.end()) reached.push_back(other);
      }
    }
    for (const int other : reached) {
      if (piece(other).tet == tet) same.unite(light, other);
    }
  }

  void renumber(DisjointSets& same) {
    std::vector<TetPiece> kept;
    std::vector<int> number(pieces_.pieces.size(), -1);
    for (int k = 0; k < static_cast<int>(number.size()); ++k) {
      int& index = number[same.find(k)];
      if (index < 0) {
        index = static_cast<int>(kept.size());
        kept.push_back({piece(k).tet, 0});
      }
      number[k] = index;
      kept[index].cells |= piece(k).cells;
    }
    pieces_.pieces = std::move(kept);
    for (int& k : pieces_.pieceOf) k = number[k];
    for (auto& [a, b] : found_) a = number[a], b = number[b];
    sortUnique(found_);
  }

  TetPieces& pieces_;
  const Surface& surface_;
  const TetMaterial& material_;
  const LatticeMesh& lattice_;
  const LatticeLinks& links_;
  const SegmentQueries& queries_;
  std::vector<std::array<int, 2>> found_;  ///< links that have been found
};

/// The piece of a tet that contains a triangle, or -1.
int pieceWith(const TetPieces& pieces, const TetMaterial& material, int triangle, int tet) {
  if (tet < 0) return -1;
  const auto begin = material.triangles.values.begin();
  const auto last = begin + material.triangles.starts[tet + 1];
  const auto found =
      std::lower_bound(begin + material.triangles.starts[tet], last, static_cast<std::uint32_t>(triangle));
  if (found == last || *found != static_cast<std::uint32_t>(triangle)) return -1;
  return pieces.pieceOf[static_cast<std::size_t>(found - begin)];
}

}  // namespace

TetCopies copyTets(const Surface& surface, const WindingTree& winding, const SurfaceSamples& samples,
                   const std::vector<int>& tetOf, const TetMaterial& material, const LatticeFrame& frame,
                   const LatticeMesh& lattice, const LatticeLinks& links) {
  assert(tetOf.size() == samples.points.size() && material.cells.size() == lattice.mesh.tetCount());
  const SegmentQueries directions(surface, material, frame, links);
  TetPieces pieces = piecesIn(surface, winding, tetOf, material, frame, lattice, links, directions);
  TetCopies made;
  made.links = CopyLinks(pieces, surface, material, lattice, links, directions).run();
  made.copyOf.assign(tetOf.size(), -1);
  const auto assign = [&](std::size_t point, int triangle) {
    if (made.copyOf[point] < 0) made.copyOf[point] = pieceWith(pieces, material, triangle, tetOf[point]);
  };
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    for (const int p : surface.triangles[t]) assign(static_cast<std::size_t>(p), t);
  }
  for (std::size_t k = 0; k < samples.triangleOf.size(); ++k) assign(surface.points.size() + k, samples.triangleOf[k]);
  assert(surface.points.size() + samples.triangleOf.size() == tetOf.size());
  made.copies = std::move(pieces.pieces);
  return made;
}

}  // namespace tetskin::cage_detail
