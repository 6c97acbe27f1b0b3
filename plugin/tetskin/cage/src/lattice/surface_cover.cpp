// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Tomas Akenine-Möller, "Fast 3D Triangle-Box Overlap Testing", 2001 (separating axes of a triangle and a convex
//   body)
#include <tetskin/cage/src/lattice/surface_cover.h>
#include <tetskin/core/src/base/progress.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace tetskin::cage_detail {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

/// The directions of tets' edges: three axes and four diagonals of a cube. Each tet has edges along two of
/// the axes and along all diagonals.
const std::array<Eigen::Vector3d, 7>& edgeDirections() {
  static const std::array<Eigen::Vector3d, 7> directions = {
      Eigen::Vector3d(1, 0, 0),  Eigen::Vector3d(0, 1, 0),  Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 1, 1),
      Eigen::Vector3d(1, 1, -1), Eigen::Vector3d(1, -1, 1), Eigen::Vector3d(-1, 1, 1)};
  return directions;
}

struct Interval {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void extend(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// One triangle in lattice coordinates, ready to be tested against many tets.
class TriangleProbe {
 public:
  explicit TriangleProbe(const Corners& corners) : corners_(corners) {
    normal_ = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    for (const Eigen::Vector3d& p : corners) {
      const std::array<double, 6> d = planeCoordinates(p);
      for (int i = 0; i < 6; ++i) planes_[i].extend(d[i]);
    }
  }

  bool touches(const LatticeTet& tet) const {
    const Eigen::Vector3d base = cubeOrigin(tet.cube);
    if (outsidePlanes(tet, base)) return false;
    std::array<Eigen::Vector3d, 4> nodes;
    for (int i = 0; i < 4; ++i) {
      const auto& c = latticeTables().corners[tet.local][i];
      nodes[i] = {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
    }
    // Relative to the tet's cube, so that nothing is lost to cancellation far from the origin.
    const Corners triangle = {corners_[0] - base, corners_[1] - base, corners_[2] - base};
    if (separates(normal_, triangle, nodes)) return false;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d edge = triangle[(i + 1) % 3] - triangle[i];
      for (const Eigen::Vector3d& direction : edgeDirections()) {
        if (separates(direction.cross(edge), triangle, nodes)) return false;
      }
    }
    return true;
  }

 private:
  /// Tests the normals of the tet's faces; two more plane directions are included, which is harmless.
  bool outsidePlanes(const LatticeTet& tet, const Eigen::Vector3d& base) const {
    const std::array<double, 6> offset = planeCoordinates(base);
    const std::array<int, 6>& floors = latticeTables().floors[tet.local];
    for (int i = 0; i < 6; ++i) {
      const double low = offset[i] + floors[i];
      if (planes_[i].high < low - 2.0 * kTouch || planes_[i].low > low + 2.0 + 2.0 * kTouch) return true;
    }
    return false;
  }

  static bool separates(const Eigen::Vector3d& axis, const Corners& triangle,
                        const std::array<Eigen::Vector3d, 4>& nodes) {
    Interval a, b;
    for (const Eigen::Vector3d& p : triangle) a.extend(axis.dot(p));
    for (const Eigen::Vector3d& p : nodes) b.extend(axis.dot(p));
    const double slack = kTouch * axis.lpNorm<1>();
    return a.high < b.low - slack || a.low > b.high + slack;
  }

  Corners corners_;
  Eigen::Vector3d normal_;
  std::array<Interval, 6> planes_;
};

/// True if the point is farther than kTouch from every face of its tet.
bool isDeep(const Eigen::Vector3d& p) {
  for (const double d : planeCoordinates(p)) {
    const double fraction = 0.5 * d - std::floor(0.5 * d);
    if (fraction < kTouch || fraction > 1.0 - kTouch) return false;
  }
  return true;
}

class Cover {
 public:
  /// A tet that a triangle touches.
  struct Touch {
    LatticeTet tet;
    std::uint32_t triangle = 0;
  };

  /// touches  if given, receives all touches
  Cover(LatticeSet& set, std::size_t limit, std::vector<Touch>* touches = nullptr)
      : set_(set), limit_(limit), touches_(touches) {}

  bool full() const { return set_.tetCount() > limit_; }

  void setTriangle(std::uint32_t triangle) { triangle_ = triangle; }

  void addTriangle(const Corners& corners, const LatticeTet& start) {
    const TriangleProbe probe(corners);
    ++stamp_;
    stack_.clear();
    visit(start);
    while (!stack_.empty() && !full()) {
      const LatticeTet tet = stack_.back();
      stack_.pop_back();
      for (const LatticeStep& step : latticeTables().neighbours[tet.local]) {
        const LatticeTet next = tet.cube + step;
        if (!visited(next) && probe.touches(next)) visit(next);
      }
    }
  }

  void addTet(const LatticeTet& tet) {
    set_.add(tet);
    if (touches_) touches_->push_back({tet, triangle_});
  }

 private:
  bool visited(const LatticeTet& tet) const {
    const int i = set_.find(tet.cube);
    const std::size_t slot = kTetsPerCube * static_cast<std::size_t>(i) + static_cast<std::size_t>(tet.local);
    return i >= 0 && slot < stamps_.size() && stamps_[slot] == stamp_;
  }

  void visit(const LatticeTet& tet) {
    const auto i = static_cast<std::size_t>(set_.insert(tet.cube));
    set_.add(i, static_cast<std::uint16_t>(1u << tet.local));
    if (kTetsPerCube * set_.cubeCount() > stamps_.size()) stamps_.resize(2 * kTetsPerCube * set_.cubeCount(), 0);
    stamps_[kTetsPerCube * i + static_cast<std::size_t>(tet.local)] = stamp_;
    stack_.push_back(tet);
    if (touches_) touches_->push_back({tet, triangle_});
  }

  LatticeSet& set_;
  std::size_t limit_;
  std::vector<Touch>* touches_;
  std::uint32_t triangle_ = 0;
  std::vector<std::uint32_t> stamps_;  ///< last triangle that visited tet t of cube i, at 12 i + t
  std::uint32_t stamp_ = 0;
  std::vector<LatticeTet> stack_;
};

struct Located {
  Eigen::Vector3d position;  ///< lattice coordinates
  LatticeTet tet;
  bool deep = false;
};

bool sameTet(const Located& a, const Located& b) {
  return a.tet.local == b.tet.local && a.tet.cube == b.tet.cube;
}

}  // namespace

namespace {

bool coverAll(const Surface& surface, const LatticeFrame& frame, Cover& cover) {
  std::vector<Located> points(surface.points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    points[p].position = frame.toLattice(surface.points[p]);
    points[p].tet = locate(points[p].position);
    points[p].deep = isDeep(points[p].position);
  }
  for (std::uint32_t k = 0; k < surface.triangles.size(); ++k) {
    Progress::goOn(k);
    const auto& t = surface.triangles[k];
    cover.setTriangle(k);
    const Located &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    // Tets are convex: a triangle whose corners are all deep in one tet touches no other.
    if (a.deep && b.deep && c.deep && sameTet(a, b) && sameTet(a, c)) {
      cover.addTet(a.tet);
    } else {
      cover.addTriangle({a.position, b.position, c.position}, a.tet);
    }
    if (cover.full()) return false;
  }
  return true;
}

}  // namespace

bool coverSurface(const Surface& surface, const LatticeFrame& frame, std::size_t limit, LatticeSet& set) {
  assert(set.tetCount() == 0 && frame.half > 0.0);
  Cover cover(set, limit);
  return coverAll(surface, frame, cover);
}

Lists<> trianglesByTet(const Surface& surface, const LatticeFrame& frame, const LatticeSet& set,
                       const LatticeMesh& lattice) {
  assert(lattice.mesh.tetCount() == set.tetCount());
  std::vector<Cover::Touch> touches;
  LatticeSet touched;
  Cover cover(touched, std::numeric_limits<std::size_t>::max(), &touches);
  (void)coverAll(surface, frame, cover);
  return packLists(lattice.mesh.tetCount(), [&](auto&& add) {
    for (const Cover::Touch& touch : touches) {
      const int tet = lattice.indexOf(set, touch.tet);
      if (tet >= 0) add(static_cast<std::size_t>(tet), touch.triangle);
    }
  });
}

}  // namespace tetskin::cage_detail
