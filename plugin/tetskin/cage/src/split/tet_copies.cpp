// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/split/tet_copies.h>
#include <tetskin/core/src/mesh/tet_geometry.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <numeric>
#include <optional>

namespace tetskin::cage_detail {
namespace {

/// How deep under a point its material is looked for, in altitudes of a cell; a little first, so that what is thin is
/// found, then just at the point, and farther.
constexpr std::array<double, 5> kProbeDepths = {0.3, 0.6, 1.0, 0.0, 1.5};
/// Of a lattice tet, in lattice coordinates.
constexpr double kAltitude = 1.4142135623730951;
/// Tets that a way between two points may pass: they are a few cells apart.
constexpr int kMostTetsOnTheWay = 24;

/// Sets to which members are added.
class GrowingSets {
 public:
  int add() {
    parent_.push_back(static_cast<int>(parent_.size()));
    return parent_.back();
  }
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The lower one represents both.
  int unite(int a, int b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

class CopyFinder {
 public:
  CopyFinder(const Surface& surface, const SurfaceSamples& samples, const std::vector<int>& tetOf,
             const TetMaterial& material, const LatticeFrame& frame, const LatticeSet& set, const LatticeMesh& lattice,
             const LatticeLinks& links)
      : surface_(surface),
        samples_(samples),
        tetOf_(tetOf),
        material_(material),
        frame_(frame),
        set_(set),
        lattice_(lattice),
        links_(links),
        inTet_(lattice.mesh.tetCount()),
        copyOf_(tetOf.size(), -1) {}

  TetCopies run() {
    copyMaterial();
    placePoints();
    joinAlongSurface();
    joinThinParts();
    joinLightCopies();
    linkMaterial();
    return result();
  }

 private:
  int add(int tet, CellMask cells) {
    copies_.push_back({tet, cells});
    const int copy = sets_.add();
    inTet_[tet].push_back(copy);
    return copy;
  }
  int unite(int a, int b) {
    a = sets_.find(a);
    b = sets_.find(b);
    const CellMask cells = copies_[a].cells | copies_[b].cells;
    const int one = sets_.unite(a, b);
    copies_[one].cells = cells;
    return one;
  }
  TetCopies::Copy& at(int copy) { return copies_[sets_.find(copy)]; }

  /// A copy for every piece of material in a tet.
  void copyMaterial() {
    for (std::size_t t = 0; t < material_.cells.size(); ++t) {
      for (CellMask rest = material_.cells[t]; rest != 0;) {
        const CellMask piece = componentOf(rest, links_.tets[t].local);
        add(static_cast<int>(t), piece);
        rest &= ~piece;
      }
    }
    materialCopies_ = static_cast<int>(copies_.size());
  }

  void placePoints() {
    std::vector<Eigen::Vector3d> inwards(surface_.points.size(), Eigen::Vector3d::Zero());
    for (const auto& t : surface_.triangles) {
      const Eigen::Vector3d area = areaVector(surface_, t);
      for (const int p : t) inwards[p] -= area;
    }
    for (std::size_t p = 0; p < tetOf_.size(); ++p) {
      if (tetOf_[p] < 0) continue;
      const bool own = p < surface_.points.size();
      const Eigen::Vector3d inward =
          own ? inwards[p] : -areaVector(surface_, surface_.triangles[samples_.triangleOf[p - surface_.points.size()]]);
      place(static_cast<int>(p), inward.norm() > 0.0 ? Eigen::Vector3d(inward.normalized()) : Eigen::Vector3d::Zero());
    }
    placeLoosePoints();
  }

  /// Into the copy of its tet that goes with the material under it; into one of its own if there is none.
  void place(int point, const Eigen::Vector3d& inward) {
    const Eigen::Vector3d& p = samples_.points[point];
    const double cell = kAltitude / kCellDivision * frame_.half;
    const std::optional<Hit> opposite = firstExit(tetOf_[point], p, inward * (kProbeDepths.back() * cell));
    for (const double depth : kProbeDepths) {
      if (opposite && depth >= opposite->way * kProbeDepths.back()) continue;
      const Eigen::Vector3d probe = p + depth * cell * inward;
      const CellPlace found = locateCell(frame_.toLattice(probe));
      const int tet = lattice_.indexOf(set_, found.tet);
      if (tet < 0 || (material_.cells[tet] >> found.cell & 1) == 0) continue;
      if (tet != tetOf_[point] && firstExit(tet, p, probe - p)) continue;
      const int copy = goFrom(pieceWith(tet, found.cell), probe, p, tetOf_[point]);
      if (copy < 0) continue;
      copyOf_[point] = copy;
      return;
    }
    copyOf_[point] = add(tetOf_[point], 0);
    if (opposite) thin_.push_back({point, opposite->triangle});
  }

  /// They belong to nothing: all of a tet to one copy.
  void placeLoosePoints() {
    for (const int p : surface_.loosePoints) {
      if (tetOf_[p] >= 0) unite(copyOf_[p], inTet_[tetOf_[p]].front());
    }
  }

  int pieceWith(int tet, int cell) {
    for (const int copy : inTet_[tet]) {
      if ((copies_[copy].cells >> cell & 1) != 0) return copy;
    }
    assert(false);
    return -1;
  }

  struct Hit {
    double way = 0.0;  ///< share of it
    int triangle = -1;
  };
  /// Where the way from a point first leaves the body, through a triangle that touches the tet.
  std::optional<Hit> firstExit(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& way) const {
    std::optional<Hit> first;
    for (std::uint32_t k = material_.triangles.starts[tet]; k < material_.triangles.starts[tet + 1]; ++k) {
      const int triangle = static_cast<int>(material_.triangles.values[k]);
      const auto& [ia, ib, ic] = surface_.triangles[triangle];
      const Eigen::Vector3d a = surface_.points[ia] - from, b = surface_.points[ib] - from,
                            c = surface_.points[ic] - from;
      const Eigen::Vector3d bc = b.cross(c);
      const double x = way.dot(bc), y = way.dot(c.cross(a)), z = way.dot(a.cross(b)), slope = x + y + z;
      if (!(x > 0.0 && y > 0.0 && z > 0.0)) continue;
      const double share = a.dot(bc) / slope;
      if (share > kJustThere && share < (first ? first->way : 1.0)) first = Hit{share, triangle};
    }
    return first;
  }

  /// The copy of the last tet on the straight way, from tet to tet: each time the copy that hangs together with the one
  /// before, or one that is made to. -1 if the way leads out of the lattice.
  int goFrom(int copy, const Eigen::Vector3d& from, const Eigen::Vector3d& to, int last) {
    int tet = at(copy).tet;
    for (int k = 0; k < kMostTetsOnTheWay; ++k) {
      if (tet == last) return copy;
      int corner = links_.cornerTowards(tet, last);
      if (corner < 0) corner = exitFrom(tet, from, to);
      if (corner < 0 || links_.beyond[tet][corner] < 0) return -1;
      copy = across(copy, corner);
      tet = links_.beyond[tet][corner];
    }
    return -1;
  }

  /// The corner opposite to the face through which a way leaves a tet, or -1 if it ends there.
  int exitFrom(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    const BarycentricMap map(cornersOf(lattice_.mesh, lattice_.mesh.tets[tet]));
    const Eigen::Vector4d start = map(from), end = map(to);
    int exit = -1;
    double earliest = std::numeric_limits<double>::infinity();
    for (int corner = 0; corner < 4; ++corner) {
      if (end[corner] >= 0.0) continue;
      const double share = start[corner] / (start[corner] - end[corner]);
      if (start[corner] < end[corner] || share >= earliest) continue;
      earliest = share;
      exit = corner;
    }
    return exit;
  }

  /// The copy beyond a face that hangs together with this one.
  int across(int copy, int corner) {
    copy = sets_.find(copy);
    const int tet = copies_[copy].tet, beyond = links_.beyond[tet][corner];
    const CellMask against = cellsBeyond(copies_[copy].cells, links_.tets[tet].local, corner);
    int best = -1, most = 0;
    for (const int other : inTet_[beyond]) {
      const int shared = countCells(copies_[other].cells & against);
      if (shared <= most) continue;
      most = shared;
      best = other;
    }
    if (best >= 0) return best;
    const auto [hung, isNew] = hung_.try_emplace({copy, beyond}, -1);
    if (isNew) {
      const int made = add(beyond, 0);
      hung->second = made;
      link(copy, made);
    }
    return hung->second;
  }

  void link(int a, int b) { found_.push_back({a, b}); }

  void joinAlongSurface() {
    for (const auto& [a, b] : samples_.steps) {
      if (join(a, b)) continue;
      // What has cells hangs together by them.
      if (at(copyOf_[a]).cells != 0 && at(copyOf_[b]).cells != 0) continue;
      const int end = goFrom(copyOf_[a], samples_.points[a], samples_.points[b], tetOf_[b]);
      if (end >= 0) unite(end, copyOf_[b]);
    }
  }

  /// Two points that are one part. False if their tets do not share a face.
  bool join(int a, int b) {
    if (copyOf_[a] < 0 || copyOf_[b] < 0) return true;
    if (tetOf_[a] == tetOf_[b]) {
      unite(copyOf_[a], copyOf_[b]);
      return true;
    }
    if (links_.cornerTowards(tetOf_[a], tetOf_[b]) < 0) return false;
    link(copyOf_[a], copyOf_[b]);
    return true;
  }

  /// Points of what is thinner than a cell, with its other side.
  void joinThinParts() {
    for (const auto& [point, triangle] : thin_) {
      for (const int corner : surface_.triangles[triangle]) (void)join(point, corner);
    }
  }

  /// A copy without material goes with a piece that is in its tet, if both hang on one beyond a face: it is the brim of
  /// it, or too thin to matter.
  void joinLightCopies() {
    const std::size_t count = found_.size();
    for (std::size_t k = 0; k < count; ++k) {
      for (const auto& [light, held] : {found_[k], std::array<int, 2>{found_[k][1], found_[k][0]}}) {
        if (at(light).cells != 0 || at(held).cells == 0) continue;
        const int corner = links_.cornerTowards(at(held).tet, at(light).tet);
        const CellMask against = cellsBeyond(at(held).cells, links_.tets[at(held).tet].local, corner);
        for (const int other : inTet_[at(light).tet]) {
          if ((at(other).cells & against) == 0) continue;
          unite(light, other);
          break;
        }
      }
    }
  }

  void linkMaterial() {
    for (int copy = 0; copy < materialCopies_; ++copy) {
      const int tet = copies_[copy].tet;
      for (int corner = 0; corner < 4; ++corner) {
        const int beyond = links_.beyond[tet][corner];
        if (beyond <= tet) continue;
        const CellMask against = cellsBeyond(at(copy).cells, links_.tets[tet].local, corner);
        for (const int other : inTet_[beyond]) {
          if ((at(other).cells & against) != 0) link(copy, other);
        }
      }
    }
  }

  TetCopies result() {
    TetCopies made;
    std::vector<int> number(copies_.size(), -1);
    for (std::size_t t = 0; t < inTet_.size(); ++t) {
      for (const int copy : inTet_[t]) {
        if (sets_.find(copy) != copy) continue;
        number[copy] = static_cast<int>(made.copies.size());
        made.copies.push_back(copies_[copy]);
      }
    }
    for (const int copy : copyOf_) made.copyOf.push_back(copy < 0 ? -1 : number[sets_.find(copy)]);
    for (const auto& [a, b] : found_) {
      const int one = number[sets_.find(a)], other = number[sets_.find(b)];
      made.links.push_back({std::min(one, other), std::max(one, other)});
    }
    std::sort(made.links.begin(), made.links.end());
    made.links.erase(std::unique(made.links.begin(), made.links.end()), made.links.end());
    return made;
  }

  /// Share of a way under which an exit is the point's own place.
  static constexpr double kJustThere = 1e-6;

  const Surface& surface_;
  const SurfaceSamples& samples_;
  const std::vector<int>& tetOf_;
  const TetMaterial& material_;
  const LatticeFrame& frame_;
  const LatticeSet& set_;
  const LatticeMesh& lattice_;
  const LatticeLinks& links_;
  std::vector<TetCopies::Copy> copies_;  ///< cells are those of all that were united, at the set's representative
  GrowingSets sets_;                     ///< of copies
  std::vector<std::vector<int>> inTet_;
  int materialCopies_ = 0;
  std::vector<int> copyOf_;                 ///< by point
  std::vector<std::array<int, 2>> thin_;    ///< point, triangle on the other side
  std::vector<std::array<int, 2>> found_;   ///< links
  std::map<std::array<int, 2>, int> hung_;  ///< copy, tet beyond: the copy without material made there
};

}  // namespace

TetCopies copyTets(const Surface& surface, const SurfaceSamples& samples, const std::vector<int>& tetOf,
                   const TetMaterial& material, const LatticeFrame& frame, const LatticeSet& set,
                   const LatticeMesh& lattice, const LatticeLinks& links) {
  assert(tetOf.size() == samples.points.size() && material.cells.size() == lattice.mesh.tetCount());
  return CopyFinder(surface, samples, tetOf, material, frame, set, lattice, links).run();
}

}  // namespace tetskin::cage_detail
