// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/split/tet_copies.h>
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/mesh/tet_geometry.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>
#include <tuple>

namespace tetskin::cage_detail {
namespace {

/// How deep under a triangle its material is looked for, in altitudes of a cell.
constexpr std::array<double, 4> kProbeDepths = {0.3, 0.6, 1.0, 1.5};
/// Of a lattice tet, in lattice coordinates.
constexpr double kAltitude = 1.4142135623730951;
/// Share of a way under which what it crosses is where it begins.
constexpr double kJustThere = 1e-6;
/// Barycentric distance within which an edge touches a tet: triangles do within about as much.
constexpr double kTouches = 1e-4;
/// An eighth of a tet's longest edge, in half cubes: components nearer than that are joined.
constexpr double kNearComponents = 0.25;
/// Ways between two pieces of material that are tried.
constexpr std::size_t kSights = 24;
/// Copies looked at around a tet, which has some seventy neighbours.
constexpr std::size_t kMostAround = 200;

/// A triangle that a way crosses: where, and to which side.
struct Crossing {
  double share = std::numeric_limits<double>::quiet_NaN();  ///< of the way; not a number where it passes by
  bool leaves = false;
};

/// A cell by the number of its tet.
struct CellPlaceOf {
  int tet = -1;
  int cell = 0;
};

/// What is in one tet, and hangs together there. Elements are numbered over all tets: first what is in each of the
/// triangles that touch it, in the order of `TetMaterial::triangles`, then pieces of material.
class CopyFinder {
 public:
  CopyFinder(const Surface& surface, const WindingTree& winding, const SurfaceSamples& samples,
             const std::vector<int>& tetOf, const TetMaterial& material, const LatticeFrame& frame,
             const LatticeMesh& lattice, const LatticeLinks& links)
      : surface_(surface),
        samples_(samples),
        tetOf_(tetOf),
        material_(material),
        frame_(frame),
        lattice_(lattice),
        links_(links),
        winding_(winding),
        layered_(lattice.mesh.tetCount(), 0),
        sets_(material.triangles.values.size() + kCellsPerTet * lattice.mesh.tetCount()) {
    DisjointSets components(surface.points.size());
    for (const auto& t : surface.triangles) components.unite(t[0], t[1]), components.unite(t[0], t[2]);
    for (const auto& t : surface.triangles) componentOf_.push_back(components.find(t[0]));
  }

  TetCopies run() {
    joinTriangles();
    findPieces();
    for (std::size_t t = 0; t < lattice_.mesh.tetCount(); ++t) joinWithin(static_cast<int>(t));
    number();
    linkTriangles();
    linkMaterial();
    uniteLightCopies();
    placePoints();
    return result();
  }

 private:
  std::size_t firstOf(std::size_t tet) const { return material_.triangles.starts[tet]; }
  std::size_t lastOf(std::size_t tet) const { return material_.triangles.starts[tet + 1]; }
  int triangleOf(std::size_t element) const { return static_cast<int>(material_.triangles.values[element]); }
  std::size_t pieceElement(std::size_t piece) const { return material_.triangles.values.size() + piece; }
  const Eigen::Vector3d& at(int point) const { return surface_.points[point]; }

  /// By tet: its material in pieces that hang together by faces of cells.
  void findPieces() {
    pieces_.starts.push_back(0);
    for (std::size_t t = 0; t < material_.cells.size(); ++t) {
      const CellGraph open = layered_[t] ? openFaces(static_cast<int>(t)) : cellTables().adjacent[links_.tets[t].local];
      for (CellMask rest = material_.cells[t]; rest != 0;) {
        const CellMask piece = componentOf(rest, open);
        pieces_.values.push_back(piece);
        rest &= ~piece;
      }
      pieces_.starts.push_back(static_cast<std::uint32_t>(pieces_.values.size()));
    }
    cells_.assign(pieceElement(pieces_.values.size()), 0);
    for (std::size_t k = 0; k < pieces_.values.size(); ++k) cells_[pieceElement(k)] = pieces_.values[k];
  }

  /// The faces of a tet's material cells that no surface lies in: a gap may be narrower than a cell.
  CellGraph openFaces(int tet) const {
    CellGraph open{};
    for (int a = 0; a < kCellsPerTet; ++a) {
      if ((material_.cells[tet] >> a & 1) == 0) continue;
      const CellMask beside = cellTables().adjacent[links_.tets[tet].local][a] & material_.cells[tet];
      for (int b = a + 1; b < kCellsPerTet; ++b) {
        if ((beside >> b & 1) == 0 || isBlocked({tet, a}, {tet, b})) continue;
        open[a] |= cellBit(b);
        open[b] |= cellBit(a);
      }
    }
    return open;
  }
  Eigen::Vector3d middleOf(const CellPlaceOf& place) const {
    const LatticeTet& tet = links_.tets[place.tet];
    return frame_.toRest(cubeOrigin(tet.cube) + cellTables().centroids[tet.local][place.cell]);
  }

  void unite(std::size_t a, std::size_t b) {
    const int one = sets_.find(static_cast<int>(a)), other = sets_.find(static_cast<int>(b));
    const CellMask cells = cells_[one] | cells_[other];
    sets_.unite(one, other);
    cells_[sets_.find(one)] = cells;
  }
  bool united(std::size_t a, std::size_t b) {
    return sets_.find(static_cast<int>(a)) == sets_.find(static_cast<int>(b));
  }
  CellMask cellsWith(std::size_t element) { return cells_[sets_.find(static_cast<int>(element))]; }

  void joinWithin(int tet) {
    if (firstOf(tet) < lastOf(tet)) {
      const BarycentricMap map(cornersOf(lattice_.mesh, lattice_.mesh.tets[tet]));
      joinSurfaceAndMaterial(tet, map);
      if (hasSeveralComponents(tet)) joinComponents(tet, map);
    }
    joinPiecesInSight(tet);
  }

  void joinTriangles() {
    for (std::size_t t = 0; t < lattice_.mesh.tetCount(); ++t) {
      if (firstOf(t) == lastOf(t)) continue;
      joinTriangles(static_cast<int>(t), BarycentricMap(cornersOf(lattice_.mesh, lattice_.mesh.tets[t])));
      for (std::size_t e = firstOf(t); e < lastOf(t); ++e) {
        if (!united(firstOf(t), e)) layered_[t] = 1;
      }
    }
  }

  /// Those whose common edge, or corner, is in the tet.
  void joinTriangles(int tet, const BarycentricMap& map) {
    shared_.clear();
    for (std::size_t e = firstOf(tet); e < lastOf(tet); ++e) {
      const std::array<int, 3>& t = surface_.triangles[triangleOf(e)];
      for (int k = 0; k < 3; ++k) {
        const int a = std::min(t[k], t[(k + 1) % 3]), b = std::max(t[k], t[(k + 1) % 3]);
        if (tetOf_[t[k]] == tet) shared_.push_back({{t[k], t[k]}, e});
        if (touches(map(at(a)), map(at(b)))) shared_.push_back({{a, b}, e});
      }
    }
    std::sort(shared_.begin(), shared_.end());
    for (std::size_t k = 1; k < shared_.size(); ++k) {
      if (shared_[k].first != shared_[k - 1].first) continue;
      sets_.unite(static_cast<int>(shared_[k].second), static_cast<int>(shared_[k - 1].second));
    }
  }

  /// True if the straight way between two points, by their weights, passes through the tet.
  static bool touches(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
    double first = 0.0, last = 1.0;
    for (int c = 0; c < 4; ++c) {
      const double from = a[c] + kTouches, to = b[c] + kTouches;
      if (from < 0.0 && to < 0.0) return false;
      if (from < 0.0) first = std::max(first, from / (from - to));
      if (to < 0.0) last = std::min(last, from / (from - to));
    }
    return first <= last;
  }

  /// A connected surface has the same material under all of it: one triangle that finds it will do.
  void joinSurfaceAndMaterial(int tet, const BarycentricMap& map) {
    for (std::size_t e = firstOf(tet); e < lastOf(tet); ++e) {
      if (cellsWith(e) == 0) findMaterialUnder(tet, e, map);
    }
    for (std::size_t e = firstOf(tet); e < lastOf(tet); ++e) {
      if (cellsWith(e) == 0) findOtherSide(tet, e, map);
    }
  }

  void findMaterialUnder(int tet, std::size_t element, const BarycentricMap& map) {
    const Eigen::Vector3d inward = -areaVector(surface_, surface_.triangles[triangleOf(element)]).normalized();
    if (!inward.allFinite()) return;
    const Eigen::Vector3d from = middleWithin(tet, triangleOf(element), map);
    const double cell = kAltitude / kCellDivision * frame_.half;
    for (const double depth : kProbeDepths) {
      const Eigen::Vector3d way = depth * cell * inward;
      const CellPlace place = locateCell(frame_.toLattice(from + way));
      const LatticeTet& own = links_.tets[tet];
      if (place.tet.cube != own.cube || place.tet.local != own.local) return;
      if ((material_.cells[tet] >> place.cell & 1) == 0) continue;
      if (firstExit(tet, from, way) >= 0) return;
      for (std::size_t k = pieces_.starts[tet]; k < pieces_.starts[tet + 1]; ++k) {
        if ((pieces_.values[k] >> place.cell & 1) != 0) unite(element, pieceElement(k));
      }
      return;
    }
  }

  void findOtherSide(int tet, std::size_t element, const BarycentricMap& map) {
    const Eigen::Vector3d inward = -areaVector(surface_, surface_.triangles[triangleOf(element)]).normalized();
    if (!inward.allFinite()) return;
    const Eigen::Vector3d from = middleWithin(tet, triangleOf(element), map);
    const int other = firstExit(tet, from, inward * (kProbeDepths.back() * kAltitude / kCellDivision * frame_.half));
    if (other >= 0) unite(element, static_cast<std::size_t>(other));
  }

  bool hasSeveralComponents(int tet) const {
    for (std::size_t e = firstOf(tet) + 1; e < lastOf(tet); ++e) {
      if (componentOf_[triangleOf(e)] != componentOf_[triangleOf(e - 1)]) return true;
    }
    return false;
  }

  /// Components that lie in each other, or nearer to each other than an eighth of a tet: what is put on a body, or into
  /// it, stays there.
  void joinComponents(int tet, const BarycentricMap& map) {
    for (std::size_t e = firstOf(tet); e < lastOf(tet); ++e) {
      const Eigen::Vector3d outward = areaVector(surface_, surface_.triangles[triangleOf(e)]).normalized();
      if (!outward.allFinite()) continue;
      const Eigen::Vector3d from = middleWithin(tet, triangleOf(e), map);
      const int other = firstEntry(tet, from, outward * (kNearComponents * frame_.half));
      if (other >= 0 && componentOf_[triangleOf(other)] != componentOf_[triangleOf(e)]) {
        unite(e, static_cast<std::size_t>(other));
      }
      if (cellsWith(e) == 0) joinAround(tet, e, from, outward);
    }
  }

  /// With the material on the outside of a triangle, if it lies within another component.
  void joinAround(int tet, std::size_t element, const Eigen::Vector3d& from, const Eigen::Vector3d& outward) {
    const double cell = kAltitude / kCellDivision * frame_.half;
    if (std::abs(winding_.windingNumber(from + 1e-3 * cell * outward)) < 0.5) return;
    for (const double depth : kProbeDepths) {
      const CellPlace place = locateCell(frame_.toLattice(from + depth * cell * outward));
      const LatticeTet& own = links_.tets[tet];
      if (place.tet.cube != own.cube || place.tet.local != own.local) return;
      for (std::size_t k = pieces_.starts[tet]; k < pieces_.starts[tet + 1]; ++k) {
        if ((pieces_.values[k] >> place.cell & 1) != 0) return unite(element, pieceElement(k));
      }
    }
  }

  /// Middle of the corners of what of a triangle is in a tet.
  Eigen::Vector3d middleWithin(int tet, int triangle, const BarycentricMap& map) {
    polygon_.clear();
    for (const int p : surface_.triangles[triangle]) polygon_.push_back(map(at(p)));
    for (int c = 0; c < 4; ++c) {
      clipped_.clear();
      for (std::size_t k = 0; k < polygon_.size(); ++k) {
        const Eigen::Vector4d &a = polygon_[k], &b = polygon_[(k + 1) % polygon_.size()];
        if (a[c] >= 0.0) clipped_.push_back(a);
        if ((a[c] >= 0.0) != (b[c] >= 0.0)) clipped_.emplace_back(a + (a[c] / (a[c] - b[c])) * (b - a));
      }
      // Touched only: what comes nearest has to do.
      if (clipped_.empty()) break;
      polygon_.swap(clipped_);
    }
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (const Eigen::Vector4d& weights : polygon_) sum += weights;
    sum /= static_cast<double>(polygon_.size());
    const TetCorners corners = cornersOf(lattice_.mesh, lattice_.mesh.tets[tet]);
    return sum[0] * corners[0] + sum[1] * corners[1] + sum[2] * corners[2] + sum[3] * corners[3];
  }

  Crossing crossingOf(int triangle, const Eigen::Vector3d& from, const Eigen::Vector3d& way) const {
    const auto& [ia, ib, ic] = surface_.triangles[triangle];
    const Eigen::Vector3d a = at(ia) - from, b = at(ib) - from, c = at(ic) - from;
    const Eigen::Vector3d bc = b.cross(c);
    const double x = way.dot(bc), y = way.dot(c.cross(a)), z = way.dot(a.cross(b));
    const bool leaves = x > 0.0 && y > 0.0 && z > 0.0, enters = x < 0.0 && y < 0.0 && z < 0.0;
    if (!leaves && !enters) return {};
    return {a.dot(bc) / (x + y + z), leaves};
  }

  /// The element, in the tet, of the triangle through which a way first leaves the body; -1 if there is none.
  int firstExit(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& way) const {
    int first = -1;
    double nearest = 1.0;
    for (std::size_t e = firstOf(tet); e < lastOf(tet); ++e) {
      const Crossing crossing = crossingOf(triangleOf(e), from, way);
      if (!crossing.leaves || !(crossing.share > kJustThere && crossing.share < nearest)) continue;
      nearest = crossing.share;
      first = static_cast<int>(e);
    }
    return first;
  }

  /// The same of the triangle through which it first comes into the body again, or into another one.
  int firstEntry(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& way) const {
    int first = -1;
    double nearest = 1.0;
    for (std::size_t e = firstOf(tet); e < lastOf(tet); ++e) {
      const Crossing crossing = crossingOf(triangleOf(e), from, way);
      if (crossing.leaves || !(crossing.share > kJustThere && crossing.share < nearest)) continue;
      nearest = crossing.share;
      first = static_cast<int>(e);
    }
    return first;
  }

  /// True if the straight way between the middles of two cells leaves the body. Where parts of it overlap, not every
  /// triangle on the way is its end.
  bool isBlocked(const CellPlaceOf& from, const CellPlaceOf& to) const {
    const Eigen::Vector3d start = middleOf(from), way = middleOf(to) - start;
    crossings_.clear();
    for (const int tet : {from.tet, to.tet}) {
      for (std::size_t e = firstOf(tet); e < lastOf(tet); ++e) {
        const Crossing crossing = crossingOf(triangleOf(e), start, way);
        if (crossing.share > 0.0 && crossing.share < 1.0) {
          crossings_.push_back({crossing.share, triangleOf(e), crossing.leaves ? -1 : 1});
        }
      }
      if (from.tet == to.tet) break;
    }
    if (crossings_.empty()) return false;
    std::sort(crossings_.begin(), crossings_.end());
    crossings_.erase(std::unique(crossings_.begin(), crossings_.end()), crossings_.end());
    int winding = material_.windings[from.tet][from.cell];
    return std::any_of(crossings_.begin(), crossings_.end(),
                       [&](const auto& crossing) { return (winding += std::get<2>(crossing)) == 0; });
  }

  /// Where there is little of a body, its cells may touch at edges only.
  void joinPiecesInSight(int tet) {
    for (std::size_t a = pieces_.starts[tet]; a < pieces_.starts[tet + 1]; ++a) {
      for (std::size_t b = a + 1; b < pieces_.starts[tet + 1]; ++b) {
        if (united(pieceElement(a), pieceElement(b)) || !inSight(tet, pieces_.values[a], pieces_.values[b])) continue;
        unite(pieceElement(a), pieceElement(b));
      }
    }
  }

  /// By the ways between their nearest cells.
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
      const auto& [a, b] = pair.second;
      return !isBlocked({tet, a}, {tet, b});
    });
  }

  /// Numbers the copies by tet.
  void number() {
    numberOf_.assign(cells_.size(), -1);
    for (std::size_t t = 0; t < lattice_.mesh.tetCount(); ++t) {
      for (std::size_t e = firstOf(t); e < lastOf(t); ++e) numberSet(t, e);
      for (std::size_t k = pieces_.starts[t]; k < pieces_.starts[t + 1]; ++k) numberSet(t, pieceElement(k));
      copiesIn_.push_back(copies_.size());
    }
  }
  void numberSet(std::size_t tet, std::size_t element) {
    int& number = numberOf_[sets_.find(static_cast<int>(element))];
    if (number < 0) {
      number = static_cast<int>(copies_.size());
      copies_.push_back({static_cast<int>(tet), cellsWith(element)});
    }
    numberOf_[element] = number;
  }

  void link(int a, int b) { found_.push_back({std::min(a, b), std::max(a, b)}); }

  /// A triangle in two tets that share a face passes through the face.
  void linkTriangles() {
    const Lists<> elements = packLists(surface_.triangles.size(), [&](auto&& add) {
      for (std::size_t e = 0; e < material_.triangles.values.size(); ++e) {
        add(static_cast<std::size_t>(triangleOf(e)), static_cast<std::uint32_t>(e));
      }
    });
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const auto first = elements.values.begin() + elements.starts[t],
                 last = elements.values.begin() + elements.starts[t + 1];
      if (last - first < 2) continue;
      const auto tetOfElement = [&](std::uint32_t e) { return copies_[numberOf_[e]].tet; };
      for (auto e = first; e != last; ++e) {
        for (const int beyond : links_.beyond[tetOfElement(*e)]) {
          if (beyond <= tetOfElement(*e)) continue;  // elements are in the order of tets
          const auto other =
              std::lower_bound(e, last, beyond, [&](std::uint32_t x, int tet) { return tetOfElement(x) < tet; });
          if (other != last && tetOfElement(*other) == beyond) link(numberOf_[*e], numberOf_[*other]);
        }
      }
    }
  }

  void linkMaterial() {
    for (std::size_t k = 0; k < copies_.size(); ++k) {
      const TetCopies::Copy& copy = copies_[k];
      for (int corner = 0; corner < 4 && copy.cells != 0; ++corner) {
        const int beyond = links_.beyond[copy.tet][corner];
        if (beyond <= copy.tet) continue;
        const CellMask against = cellsAgainst(copy, corner);
        for (int other = firstCopyIn(beyond); other < lastCopyIn(beyond); ++other) {
          if ((copies_[other].cells & against) != 0) link(static_cast<int>(k), other);
        }
      }
    }
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  }

  /// Cells beyond a face that no surface keeps from those of a copy.
  CellMask cellsAgainst(const TetCopies::Copy& copy, int corner) const {
    const LatticeTet& place = links_.tets[copy.tet];
    const int beyond = links_.beyond[copy.tet][corner];
    CellMask against = 0;
    for (const CellTables::Crossing& crossing : cellTables().crossings[place.local][corner]) {
      if ((copy.cells >> crossing.own & 1) == 0 || (material_.cells[beyond] >> crossing.beyond & 1) == 0) continue;
      if ((layered_[copy.tet] || layered_[beyond]) && isBlocked({copy.tet, crossing.own}, {beyond, crossing.beyond})) {
        continue;
      }
      against |= cellBit(crossing.beyond);
    }
    return against;
  }

  int firstCopyIn(int tet) const { return tet == 0 ? 0 : static_cast<int>(copiesIn_[tet - 1]); }
  int lastCopyIn(int tet) const { return static_cast<int>(copiesIn_[tet]); }

  /// A copy without material goes with another of its tet that hangs together with it around the tet: both are the brim
  /// of one part.
  void uniteLightCopies() {
    DisjointSets same(copies_.size());
    const Lists<> neighbours = packLists(copies_.size(), [&](auto&& add) {
      for (const auto& [a, b] : found_) {
        add(static_cast<std::size_t>(a), static_cast<std::uint32_t>(b));
        add(static_cast<std::size_t>(b), static_cast<std::uint32_t>(a));
      }
    });
    for (int t = 0; t < static_cast<int>(copiesIn_.size()); ++t) {
      if (lastCopyIn(t) - firstCopyIn(t) < 2) continue;
      for (int k = firstCopyIn(t); k < lastCopyIn(t); ++k) {
        if (copies_[k].cells == 0) uniteAround(k, neighbours, same);
      }
    }
    renumber(same);
  }

  /// With those of its tet to which a way of links leads that does not leave the tets around it.
  void uniteAround(int copy, const Lists<>& neighbours, DisjointSets& same) const {
    const int tet = copies_[copy].tet;
    std::vector<int> reached = {copy};
    for (std::size_t k = 0; k < reached.size() && reached.size() < kMostAround; ++k) {
      for (std::uint32_t n = neighbours.starts[reached[k]]; n < neighbours.starts[reached[k] + 1]; ++n) {
        const int other = static_cast<int>(neighbours.values[n]);
        if (!shareNode(tet, copies_[other].tet)) continue;
        if (std::find(reached.begin(), reached.end(), other) == reached.end()) reached.push_back(other);
      }
    }
    for (const int other : reached) {
      if (copies_[other].tet == tet) same.unite(copy, other);
    }
  }

  bool shareNode(int a, int b) const {
    const Tet &one = lattice_.mesh.tets[a], &other = lattice_.mesh.tets[b];
    return std::any_of(one.begin(), one.end(),
                       [&](int n) { return std::find(other.begin(), other.end(), n) != other.end(); });
  }

  void renumber(DisjointSets& same) {
    std::vector<TetCopies::Copy> kept;
    std::vector<int> number(copies_.size(), -1);
    for (int k = 0; k < static_cast<int>(copies_.size()); ++k) {
      int& of = number[same.find(k)];
      if (of < 0) {
        of = static_cast<int>(kept.size());
        kept.push_back({copies_[k].tet, 0});
      }
      number[k] = of;
      kept[of].cells |= copies_[k].cells;
    }
    copies_ = std::move(kept);
    for (int& n : numberOf_) n = n < 0 ? n : number[n];
    for (auto& [a, b] : found_) a = number[a], b = number[b];
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  }

  void placePoints() {
    copyOf_.assign(tetOf_.size(), -1);
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      for (const int p : surface_.triangles[t]) {
        if (copyOf_[p] < 0) copyOf_[p] = copyWith(static_cast<int>(t), tetOf_[p]);
      }
    }
    for (std::size_t k = 0; k < samples_.triangleOf.size(); ++k) {
      const std::size_t p = surface_.points.size() + k;
      copyOf_[p] = copyWith(samples_.triangleOf[k], tetOf_[p]);
    }
    placeLoosePoints();
  }

  /// The copy of a tet that has a triangle in it, or -1.
  int copyWith(int triangle, int tet) const {
    if (tet < 0) return -1;
    const auto first = material_.triangles.values.begin() + static_cast<std::ptrdiff_t>(firstOf(tet));
    const auto last = material_.triangles.values.begin() + static_cast<std::ptrdiff_t>(lastOf(tet));
    const auto found = std::lower_bound(first, last, static_cast<std::uint32_t>(triangle));
    if (found == last || *found != static_cast<std::uint32_t>(triangle)) return -1;
    return numberOf_[static_cast<std::size_t>(found - material_.triangles.values.begin())];
  }

  /// They belong to nothing: to the first copy of their tet, or one of its own.
  void placeLoosePoints() {
    std::vector<std::array<int, 2>> made;  // tet, copy
    for (const int p : surface_.loosePoints) {
      const int tet = tetOf_[p];
      if (tet < 0) continue;
      copyOf_[p] = firstWhere(tet);
      const auto found = std::find_if(made.begin(), made.end(), [&](const auto& m) { return m[0] == tet; });
      if (copyOf_[p] < 0 && found != made.end()) copyOf_[p] = (*found)[1];
      if (copyOf_[p] >= 0) continue;
      copyOf_[p] = static_cast<int>(copies_.size());
      made.push_back({tet, copyOf_[p]});
      copies_.push_back({tet, 0});
    }
  }
  int firstWhere(int tet) const {
    const auto found = std::lower_bound(copies_.begin(), copies_.end(), tet,
                                        [](const TetCopies::Copy& copy, int t) { return copy.tet < t; });
    return found != copies_.end() && found->tet == tet ? static_cast<int>(found - copies_.begin()) : -1;
  }

  TetCopies result() { return {std::move(copies_), std::move(copyOf_), std::move(found_)}; }

  const Surface& surface_;
  const SurfaceSamples& samples_;
  const std::vector<int>& tetOf_;
  const TetMaterial& material_;
  const LatticeFrame& frame_;
  const LatticeMesh& lattice_;
  const LatticeLinks& links_;
  const WindingTree& winding_;
  std::vector<int> componentOf_;  ///< by triangle
  std::vector<char> layered_;     ///< by tet: the surface passes through it more than once
  Lists<CellMask> pieces_;        ///< by tet: of material
  DisjointSets sets_;             ///< of elements
  std::vector<CellMask> cells_;   ///< of a set, at its representative
  std::vector<int> numberOf_;     ///< by element: its copy
  std::vector<TetCopies::Copy> copies_;
  std::vector<std::size_t> copiesIn_;      ///< by tet: how many copies there are up to its last
  std::vector<int> copyOf_;                ///< by point
  std::vector<std::array<int, 2>> found_;  ///< links
  std::vector<std::pair<std::array<int, 2>, std::size_t>> shared_;  ///< scratch memory, as are the next two
  std::vector<Eigen::Vector4d> polygon_, clipped_;
  mutable std::vector<std::tuple<double, int, int>>
      crossings_;  ///< share of the way, triangle, change of winding number
};

}  // namespace

TetCopies copyTets(const Surface& surface, const WindingTree& winding, const SurfaceSamples& samples,
                   const std::vector<int>& tetOf, const TetMaterial& material, const LatticeFrame& frame,
                   const LatticeMesh& lattice, const LatticeLinks& links) {
  assert(tetOf.size() == samples.points.size() && material.cells.size() == lattice.mesh.tetCount());
  return CopyFinder(surface, winding, samples, tetOf, material, frame, lattice, links).run();
}

}  // namespace tetskin::cage_detail
