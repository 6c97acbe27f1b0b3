// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/split/tet_clip.h>
#include <tetskin/cage/src/split/tet_pieces.h>
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/progress.h>

#include <algorithm>
#include <cassert>

namespace tetskin::cage_detail {
namespace {

/// Depths below a triangle at which its material is looked for, in altitudes of a cell.
constexpr std::array<double, 4> kProbeDepths = {0.3, 0.6, 1.0, 1.5};
/// Altitude of a lattice tet, in lattice coordinates.
constexpr double kAltitude = 1.4142135623730951;
/// Distance outside of a triangle at which its surroundings are determined, in altitudes of a cell.
constexpr double kJustOutside = 1e-3;
/// An eighth of a tet's longest edge, in half cubes: components nearer to each other than this are joined.
constexpr double kNearComponents = 0.25;
/// Largest number of segments to test between two pieces of material.
constexpr std::size_t kSights = 24;

/// Finds the pieces. Elements of surface come first, see SegmentQueries, then the connected cells of material.
class PieceFinder {
 public:
  PieceFinder(const Surface& surface, const WindingTree& winding, const std::vector<int>& tetOf,
              const TetMaterial& material, const LatticeFrame& frame, const LatticeMesh& lattice,
              const LatticeLinks& links, const SegmentQueries& directions)
      : surface_(surface),
        winding_(winding),
        tetOf_(tetOf),
        material_(material),
        frame_(frame),
        lattice_(lattice),
        links_(links),
        queries_(directions),
        cell_(kAltitude / kCellDivision * frame.half),
        sets_(material.triangles.values.size()),
        layered_(lattice.mesh.tetCount(), 0) {
    DisjointSets components(surface.points.size());
    for (const auto& t : surface.triangles) components.unite(t[0], t[1]), components.unite(t[0], t[2]);
    for (const auto& t : surface.triangles) componentOf_.push_back(components.find(t[0]));
  }

  TetPieces run() {
    joinSurface();
    findMaterial();
    for (std::size_t t = 0; t < tetCount(); ++t) {
      Progress::goOn(t);
      joinWithin(static_cast<int>(t));
    }
    return numbered();
  }

 private:
  std::size_t tetCount() const { return lattice_.mesh.tetCount(); }
  std::size_t surfaceElements() const { return material_.triangles.values.size(); }
  std::size_t first(std::size_t tet) const { return queries_.firstElement(tet); }
  std::size_t last(std::size_t tet) const { return queries_.lastElement(tet); }
  const std::array<int, 3>& triangle(std::size_t element) const {
    return surface_.triangles[queries_.triangleOf(element)];
  }
  int component(std::size_t element) const { return componentOf_[queries_.triangleOf(element)]; }
  BarycentricMap mapOf(std::size_t tet) const {
    return BarycentricMap(cornersOf(lattice_.mesh, lattice_.mesh.tets[tet]));
  }

  bool united(std::size_t a, std::size_t b) {
    return sets_.find(static_cast<int>(a)) == sets_.find(static_cast<int>(b));
  }
  void unite(std::size_t a, std::size_t b) {
    const int one = sets_.find(static_cast<int>(a)), other = sets_.find(static_cast<int>(b));
    const CellMask cells = cells_[one] | cells_[other];
    sets_.unite(one, other);
    cells_[sets_.find(one)] = cells;
  }
  CellMask cellsWith(std::size_t element) { return cells_[sets_.find(static_cast<int>(element))]; }

  void joinSurface() {
    for (std::size_t t = 0; t < tetCount(); ++t) {
      Progress::goOn(t);
      if (first(t) == last(t)) continue;
      joinTriangles(static_cast<int>(t), mapOf(t));
      for (std::size_t e = first(t); e < last(t); ++e) layered_[t] |= united(first(t), e) ? 0 : 1;
    }
  }

  /// Unites triangles whose common edge, or corner, is in the tet.
  void joinTriangles(int tet, const BarycentricMap& map) {
    shared_.clear();
    for (std::size_t e = first(tet); e < last(tet); ++e) {
      for (int k = 0; k < 3; ++k) {
        const int from = triangle(e)[k], to = triangle(e)[(k + 1) % 3], a = std::min(from, to), b = std::max(from, to);
        if (tetOf_[from] == tet) shared_.push_back({{from, from}, e});
        if (passesThrough(map(surface_.points[a]), map(surface_.points[b]))) shared_.push_back({{a, b}, e});
      }
    }
    std::sort(shared_.begin(), shared_.end());
    for (std::size_t k = 1; k < shared_.size(); ++k) {
      if (shared_[k].first != shared_[k - 1].first) continue;
      sets_.unite(static_cast<int>(shared_[k].second), static_cast<int>(shared_[k - 1].second));
    }
  }

  /// By tet: divides its material into elements that are connected by faces of cells.
  void findMaterial() {
    materialStarts_.push_back(surfaceElements());
    cells_.assign(surfaceElements(), 0);
    for (std::size_t t = 0; t < tetCount(); ++t) {
      const CellGraph open = layered_[t] ? openFaces(static_cast<int>(t)) : cellTables().adjacent[links_.tets[t].local];
      for (CellMask rest = material_.cells[t]; rest != 0;) {
        cells_.push_back(componentOf(rest, open));
        rest &= ~cells_.back();
      }
      materialStarts_.push_back(cells_.size());
    }
    ofMaterial_.assign(cells_.begin() + static_cast<std::ptrdiff_t>(surfaceElements()), cells_.end());
    sets_.grow(cells_.size());
  }
  CellMask materialOf(std::size_t element) const {
    assert(element >= surfaceElements() && element - surfaceElements() < ofMaterial_.size());
    return ofMaterial_[element - surfaceElements()];
  }

  /// The faces of a tet's material cells that contain no surface: a gap may be narrower than a cell.
  CellGraph openFaces(int tet) const {
    CellGraph open{};
    for (int a = 0; a < kCellsPerTet; ++a) {
      if ((material_.cells[tet] >> a & 1) == 0) continue;
      const CellMask beside = cellTables().adjacent[links_.tets[tet].local][a] & material_.cells[tet];
      for (int b = a + 1; b < kCellsPerTet; ++b) {
        if ((beside >> b & 1) == 0 || queries_.isBlocked({tet, a}, {tet, b})) continue;
        open[a] |= cellBit(b);
        open[b] |= cellBit(a);
      }
    }
    return open;
  }

  void joinWithin(int tet) {
    if (first(tet) < last(tet)) {
      joinSurfaceAndMaterial(tet);
      if (hasSeveralComponents(tet)) joinComponents(tet);
    }
    joinMaterialInSight(tet);
  }

  /// A connected surface has the same material below all of it: the first triangle that finds it suffices.
  void joinSurfaceAndMaterial(int tet) {
    forEmpty(tet, [&](std::size_t e, const Eigen::Vector3d& from, const Eigen::Vector3d& outward) {
      const auto [found, depth] = materialAlong(tet, from, -outward);
      if (found > 0 && queries_.firstExit(tet, from, -depth * cell_ * outward) < 0) unite(e, found);
    });
    forEmpty(tet, [&](std::size_t e, const Eigen::Vector3d& from, const Eigen::Vector3d& outward) {
      const int other = queries_.firstExit(tet, from, -kProbeDepths.back() * cell_ * outward);
      if (other >= 0) unite(e, static_cast<std::size_t>(other));
    });
  }

  /// Calls visit(element, a point of it, unit normal) for the surface in a tet that is not yet united with material.
  template <class Visit>
  void forEmpty(int tet, Visit&& visit) {
    for (std::size_t e = first(tet); e < last(tet); ++e) {
      if (cellsWith(e) == 0) withNormal(tet, e, visit);
    }
  }
  /// Calls visit for one element, if it has a normal.
  template <class Visit>
  void withNormal(int tet, std::size_t element, Visit&& visit) const {
    const Eigen::Vector3d outward = areaVector(surface_, triangle(element)).normalized();
    if (outward.allFinite()) visit(element, centroidOf(tet, element), outward);
  }
  Eigen::Vector3d centroidOf(int tet, std::size_t element) const {
    const BarycentricMap map = mapOf(static_cast<std::size_t>(tet));
    const auto& [a, b, c] = triangle(element);
    const Eigen::Vector4d weights =
        centroidWithin({map(surface_.points[a]), map(surface_.points[b]), map(surface_.points[c])});
    const TetCorners corners = cornersOf(lattice_.mesh, lattice_.mesh.tets[tet]);
    return weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2] + weights[3] * corners[3];
  }

  /// The element of material in the tet that a ray reaches first, and its depth; or 0.
  std::pair<std::size_t, double> materialAlong(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    const LatticeTet& own = links_.tets[tet];
    for (const double depth : kProbeDepths) {
      const CellPosition position = locateCell(frame_.toLattice(from + depth * cell_ * to));
      if (position.tet.cube != own.cube || position.tet.local != own.local) break;
      for (std::size_t e = materialStarts_[tet]; e < materialStarts_[tet + 1]; ++e) {
        if ((materialOf(e) >> position.cell & 1) != 0) return {e, depth};
      }
    }
    return {0, 0.0};
  }

  bool hasSeveralComponents(int tet) const {
    for (std::size_t e = first(tet) + 1; e < last(tet); ++e) {
      if (component(e) != component(e - 1)) return true;
    }
    return false;
  }

  /// Unites components that lie inside each other, or near: something placed on a body, or in it, stays attached.
  void joinComponents(int tet) {
    for (std::size_t k = first(tet); k < last(tet); ++k) {
      withNormal(tet, k, [&](std::size_t e, const Eigen::Vector3d& from, const Eigen::Vector3d& outward) {
        const int other = queries_.firstEntry(tet, from, kNearComponents * frame_.half * outward);
        if (other >= 0 && component(static_cast<std::size_t>(other)) != component(e)) {
          unite(e, static_cast<std::size_t>(other));
        }
        if (cellsWith(e) == 0) joinSurroundings(tet, e, from, outward);
      });
    }
  }

  /// Unites an element with the material outside of its triangle, if that lies inside another component.
  void joinSurroundings(int tet, std::size_t element, const Eigen::Vector3d& from, const Eigen::Vector3d& outward) {
    const std::size_t found = materialAlong(tet, from, outward).first;
    if (found == 0) return;
    // Tested last, because it takes far longer than the other tests of a triangle.
    if (std::abs(winding_.windingNumber(from + kJustOutside * cell_ * outward)) >= kInside) unite(element, found);
  }

  /// Where a body has little material, its cells may touch at edges only.
  void joinMaterialInSight(int tet) {
    for (std::size_t a = materialStarts_[tet]; a < materialStarts_[tet + 1]; ++a) {
      for (std::size_t b = a + 1; b < materialStarts_[tet + 1]; ++b) {
        if (!united(a, b) && inSight(tet, materialOf(a), materialOf(b))) unite(a, b);
      }
    }
  }

  /// Tests the segments between their nearest cells.
  bool inSight(int tet, CellMask one, CellMask other) const {
    const auto& centroids = cellTables().centroids[links_.tets[tet].local];
    std::vector<std::pair<double, std::array<int, 2>>> pairs;
    for (int a = 0; a < kCellsPerTet; ++a) {
      if ((one >> a & 1) == 0) continue;
      for (int b = 0; b < kCellsPerTet; ++b) {
        if ((other >> b & 1) != 0) pairs.push_back({(centroids[a] - centroids[b]).squaredNorm(), {a, b}});
      }
    }
    const auto end = pairs.begin() + static_cast<std::ptrdiff_t>(std::min(pairs.size(), kSights));
    std::partial_sort(pairs.begin(), end, pairs.end());
    return std::any_of(pairs.begin(), end, [&](const auto& pair) {
      return !queries_.isBlocked({tet, pair.second[0]}, {tet, pair.second[1]});
    });
  }

  TetPieces numbered() {
    TetPieces made;
    std::vector<int> numberOf(cells_.size(), -1);
    const auto add = [&](std::size_t tet, std::size_t element) {
      int& number = numberOf[sets_.find(static_cast<int>(element))];
      if (number < 0) {
        number = static_cast<int>(made.pieces.size());
        made.pieces.push_back({static_cast<int>(tet), cellsWith(element)});
      }
      numberOf[element] = number;
    };
    for (std::size_t t = 0; t < tetCount(); ++t) {
      made.starts.push_back(static_cast<int>(made.pieces.size()));
      for (std::size_t e = first(t); e < last(t); ++e) add(t, e);
      for (std::size_t e = materialStarts_[t]; e < materialStarts_[t + 1]; ++e) add(t, e);
    }
    made.starts.push_back(static_cast<int>(made.pieces.size()));
    numberOf.resize(surfaceElements());
    made.pieceOf = std::move(numberOf);
    assert(made.starts.size() == tetCount() + 1 && made.pieceOf.size() == surfaceElements());
    made.layered = std::move(layered_);
    return made;
  }

  const Surface& surface_;
  const WindingTree& winding_;
  const std::vector<int>& tetOf_;
  const TetMaterial& material_;
  const LatticeFrame& frame_;
  const LatticeMesh& lattice_;
  const LatticeLinks& links_;
  const SegmentQueries& queries_;
  double cell_;                              ///< altitude of a cell
  std::vector<int> componentOf_;             ///< by triangle
  DisjointSets sets_;                        ///< of elements
  std::vector<char> layered_;                ///< by tet
  std::vector<std::size_t> materialStarts_;  ///< by tet, and the end: its first element of material
  std::vector<CellMask> ofMaterial_;         ///< by element of material
  std::vector<CellMask> cells_;              ///< by representative of a set: all its cells
  std::vector<std::pair<std::array<int, 2>, std::size_t>> shared_;  ///< scratch memory
};

}  // namespace

TetPieces piecesIn(const Surface& surface, const WindingTree& winding, const std::vector<int>& tetOf,
                   const TetMaterial& material, const LatticeFrame& frame, const LatticeMesh& lattice,
                   const LatticeLinks& links, const SegmentQueries& directions) {
  assert(tetOf.size() >= surface.points.size() && material.cells.size() == lattice.mesh.tetCount());
  return PieceFinder(surface, winding, tetOf, material, frame, lattice, links, directions).run();
}

}  // namespace tetskin::cage_detail
