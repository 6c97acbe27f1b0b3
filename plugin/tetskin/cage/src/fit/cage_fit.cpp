// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Node by node: a boundary node steps down the gradient of the cage's volume, an inner one towards the mean of its
// neighbours. A step only changes the tets around the node, so it is safe if these stay well-shaped and together still
// contain all of their points.
//
// This work is based on:
//   Lori Freitag, Carl Ollivier-Gooch, "Tetrahedral Mesh Improvement Using Swapping and Smoothing", 1997 ("smart"
//   Laplacian smoothing: move to the neighbours' mean only if the worst tet gets better)
#include <tetskin/cage/src/fit/cage_fit.h>
#include <tetskin/cage/src/fit/cage_quality.h>
#include <tetskin/cage/src/lattice/surface_cover.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/tets_around_nodes.h>
#include <tetskin/core/src/base/progress.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tetskin::cage_detail {
namespace {

/// Radians per degree.
constexpr double kRadians = 3.14159265358979323846 / 180.0;
/// Limits while fitting, narrower than the promised ones: 10 and 165 degrees would save 1 % more of the volume.
constexpr double kFitMinDihedralDeg = 25.0;
constexpr double kFitMaxDihedralDeg = 140.0;
static_assert(kFitMinDihedralDeg > kMinDihedralDeg && kFitMaxDihedralDeg < kMaxDihedralDeg);
/// Smallest volume of a tet as a fraction of the lattice's: small tets with good angles still need small time steps.
constexpr double kMinTet = 0.15;
/// Distance of the points from the cage's boundary, as a barycentric weight. It keeps them inside when they or the cage
/// are rounded to single precision. The lattice starts with a margin of kTouch, because its tets are 1.4 high.
constexpr double kBoundaryMargin = 0.5 * kTouch;
/// Step of a boundary node, in half cubes: the first one, its growth after success, its reduction after failure, and
/// the length below which the node stops.
constexpr double kFirstStep = 0.5;
constexpr double kGrow = 1.3;
constexpr double kShrink = 0.5;
constexpr double kLastStep = 0.02;
/// Step of a stopped node after a neighbour has moved out of its way.
constexpr double kRetryStep = 0.05;
/// An inner node nearer than this to its neighbours' mean, in half cubes, does not move.
constexpr double kNearMean = 0.02;
/// After some twelve sweeps the volume hardly changes.
constexpr int kSweeps = 16;

/// Points by tet, as doubly linked lists, so that a point changes its tet in constant time.
class PointLists {
 public:
  PointLists(std::size_t tetCount, std::vector<int>& tetOf) : head_(tetCount, -1), links_(tetOf.size()), tetOf_(tetOf) {
    for (std::size_t p = tetOf.size(); p-- > 0;) {
      if (tetOf[p] >= 0) push(static_cast<int>(p), tetOf[p]);
    }
  }

  int first(int tet) const { return head_[tet]; }
  int next(int point) const { return links_[point].next; }
  int tetOf(int point) const { return tetOf_[point]; }
  void move(int point, int tet) {
    assert(tetOf_[point] >= 0 && tet >= 0 && static_cast<std::size_t>(tet) < head_.size());
    const Link link = links_[point];
    (link.previous >= 0 ? links_[link.previous].next : head_[tetOf_[point]]) = link.next;
    if (link.next >= 0) links_[link.next].previous = link.previous;
    push(point, tet);
  }

 private:
  struct Link {
    int next = -1, previous = -1;
  };

  void push(int point, int tet) {
    links_[point] = {head_[tet], -1};
    if (head_[tet] >= 0) links_[head_[tet]].previous = point;
    head_[tet] = point;
    tetOf_[point] = tet;
  }

  std::vector<int> head_;
  std::vector<Link> links_;
  std::vector<int>& tetOf_;
};

class CageFit {
 public:
  CageFit(CageTets& cage, double half, const std::vector<Eigen::Vector3d>& points)
      : mesh_(cage.mesh),
        openFaces_(cage.openFaces),
        latticeTets_(cage.latticeTets),
        copied_(cage.mesh.tetCount(), 0),
        points_(points),
        half_(half),
        stars_(tetsAroundNodes(mesh_)),
        lists_(mesh_.tetCount(), cage.tetOf),
        boundary_(mesh_.nodeCount(), 0),
        step_(mesh_.nodeCount(), kFirstStep),
        blocker_(mesh_.nodeCount(), -1),
        smallestVolume_(kMinTet * kLatticeTetVolume * half * half * half) {
    assert(openFaces_.size() == mesh_.tetCount() && latticeTets_.size() == mesh_.tetCount());
    for (std::size_t t = 0; t < mesh_.tetCount(); ++t) {
      for (int corner = 0; corner < 4; ++corner) {
        if ((openFaces_[t] >> corner & 1) == 0) continue;
        for (int k = 1; k < 4; ++k) boundary_[mesh_.tets[t][(corner + k) % 4]] = 1;
      }
    }
    markCopied();
  }

  void run() {
    bool moved = true;
    for (int sweep = 0; sweep < kSweeps && moved; ++sweep) {
      moved = false;
      for (std::size_t n = 0; n < mesh_.nodeCount(); ++n) {
        Progress::goOn(n);
        if (boundary_[n] && pull(static_cast<int>(n))) moved = true;
      }
      for (std::size_t n = 0; n < mesh_.nodeCount(); ++n) {
        Progress::goOn(n);
        if (!boundary_[n] && smooth(static_cast<int>(n))) moved = true;
      }
    }
  }

 private:
  void markCopied() {
    std::vector<int> tets(static_cast<std::size_t>(*std::max_element(latticeTets_.begin(), latticeTets_.end())) + 1, 0);
    for (const int home : latticeTets_) ++tets[home];
    for (std::size_t t = 0; t < copied_.size(); ++t) copied_[t] = tets[latticeTets_[t]] > 1;
  }

  int starSize(int n) const { return static_cast<int>(stars_.starts[n + 1] - stars_.starts[n]); }
  int starTet(int n, int k) const {
    return static_cast<int>(stars_.values[stars_.starts[n] + static_cast<std::uint32_t>(k)]);
  }

  /// Six times the derivative of the cage's volume by the node's position. Zero for an inner node.
  Eigen::Vector3d volumeGradient(int n) const {
    // By corner: the others, counter-clockwise as seen from it.
    constexpr int kOpposite[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int k = 0; k < starSize(n); ++k) {
      const Tet& tet = mesh_.tets[starTet(n, k)];
      const auto corner = std::find(tet.begin(), tet.end(), n) - tet.begin();
      const Eigen::Vector3d& a = mesh_.nodes[tet[kOpposite[corner][0]]];
      const Eigen::Vector3d& b = mesh_.nodes[tet[kOpposite[corner][1]]];
      const Eigen::Vector3d& c = mesh_.nodes[tet[kOpposite[corner][2]]];
      sum += (b - a).cross(c - a);
    }
    return sum;
  }

  /// One step of a boundary node. True if it moved, or may move with a smaller step.
  bool pull(int n) {
    if (step_[n] < kLastStep) return false;
    const Eigen::Vector3d gradient = volumeGradient(n);
    const double length = gradient.norm();
    if (!(length > 0.0)) return false;
    const bool moved = tryMove(n, mesh_.nodes[n] - gradient * (step_[n] * half_ / length));
    step_[n] *= moved ? kGrow : kShrink;
    return true;
  }

  bool smooth(int n) {
    assert(starSize(n) > 0);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int k = 0; k < starSize(n); ++k) {
      for (const int other : mesh_.tets[starTet(n, k)]) sum += mesh_.nodes[other] - mesh_.nodes[n];
    }
    const Eigen::Vector3d offset = sum / (3.0 * starSize(n));
    if (offset.norm() < kNearMean * half_) return false;
    const Eigen::Vector3d old = mesh_.nodes[n];
    const Eigen::Vector3d halfway = old + 0.5 * offset;
    const double before = worstShape(n);
    mesh_.nodes[n] = halfway;
    const double after = worstShape(n);
    mesh_.nodes[n] = old;
    if (after <= before || !tryMove(n, halfway)) return false;
    for (int k = 0; k < starSize(n); ++k) {
      for (const int other : mesh_.tets[starTet(n, k)]) step_[other] = std::max(step_[other], kRetryStep);
    }
    return true;
  }

  /// Distance of the node's dihedral angles from 0 and 180 degrees, in terms of cosines.
  double worstShape(int n) const {
    double worst = 1.0;
    for (int k = 0; k < starSize(n); ++k) {
      for (const double c : dihedralCosines(cornersOf(mesh_, mesh_.tets[starTet(n, k)]))) {
        worst = std::min(worst, 1.0 - std::abs(c));
      }
    }
    return worst;
  }

  bool shapeIsGood(int tet) const {
    static const double minimum = std::cos(kFitMaxDihedralDeg * kRadians);
    static const double maximum = std::cos(kFitMinDihedralDeg * kRadians);
    const TetCorners p = cornersOf(mesh_, mesh_.tets[tet]);
    if (!(signedVolume(p) > smallestVolume_)) return false;
    const std::array<double, 6> cosines = dihedralCosines(p);
    return std::all_of(cosines.begin(), cosines.end(), [](double c) { return c > minimum && c < maximum; });
  }

  /// Moves the node if the tets around it stay well-shaped and still contain their points; otherwise nothing changes.
  bool tryMove(int n, const Eigen::Vector3d& position) {
    const Eigen::Vector3d old = mesh_.nodes[n];
    mesh_.nodes[n] = position;
    bool good = true;
    for (int k = 0; k < starSize(n) && good; ++k) good = shapeIsGood(starTet(n, k));
    if (!good || !holdsPoints(n)) {
      mesh_.nodes[n] = old;
      return false;
    }
    for (const auto& [point, tet] : moved_) lists_.move(point, tet);
    return true;
  }

  /// True if the tets around the node still contain all their points. Those that change tets are then in `moved_`.
  bool holdsPoints(int n) {
    maps_.clear();
    for (int k = 0; k < starSize(n); ++k) maps_.emplace_back(cornersOf(mesh_, mesh_.tets[starTet(n, k)]));
    moved_.clear();
    // The point that stopped the node last time is the most likely to stop it again, if it is still nearby.
    if (blocker_[n] >= 0) {
      const Tet& home = mesh_.tets[lists_.tetOf(blocker_[n])];
      if (std::find(home.begin(), home.end(), n) != home.end() && holder(n, 0, blocker_[n]) < 0) return false;
    }
    for (int k = 0; k < starSize(n); ++k) {
      for (int p = lists_.first(starTet(n, k)); p >= 0; p = lists_.next(p)) {
        const int j = holder(n, k, p);
        if (j < 0) {
          blocker_[n] = p;
          return false;
        }
        if (j != k) moved_.push_back({p, starTet(n, j)});
      }
    }
    return true;
  }

  /// The tet around the node that contains the point; tries number k first; -1 if there is none.
  int holder(int n, int k, int point) const {
    assert(maps_.size() == static_cast<std::size_t>(starSize(n)));
    if (holds(starTet(n, k), k, point)) return k;
    for (int j = 0; j < starSize(n); ++j) {
      if (j != k && mayTake(starTet(n, j), starTet(n, k)) && holds(starTet(n, j), j, point)) return j;
    }
    return -1;
  }

  /// Among several duplicates, only one that shares a face with the point's tet certainly belongs to its component.
  bool mayTake(int tet, int from) const {
    if (!copied_[tet] && !copied_[from]) return true;
    const Tet& own = mesh_.tets[from];
    const auto shared = std::count_if(mesh_.tets[tet].begin(), mesh_.tets[tet].end(),
                                      [&](int n) { return std::find(own.begin(), own.end(), n) != own.end(); });
    return latticeTets_[tet] != latticeTets_[from] && shared == 3;
  }

  bool holds(int tet, int k, int point) const {
    const Eigen::Vector4d weights = maps_[k](points_[point]);
    for (int corner = 0; corner < 4; ++corner) {
      const double minimum = (openFaces_[tet] >> corner & 1) != 0 ? kBoundaryMargin : 0.0;
      if (!(weights[corner] >= minimum)) return false;
    }
    return true;
  }

  TetMesh& mesh_;
  const std::vector<std::uint8_t>& openFaces_;
  const std::vector<int>& latticeTets_;
  std::vector<char> copied_;  ///< by tet: it has duplicates
  const std::vector<Eigen::Vector3d>& points_;
  double half_;
  Lists<> stars_;  ///< by node: the tets around it
  PointLists lists_;
  std::vector<char> boundary_;  ///< by node
  std::vector<double> step_;    ///< by node, in half cubes
  std::vector<int> blocker_;    ///< by node: the point that its last failed move would have lost, or -1
  double smallestVolume_;
  std::vector<BarycentricMap> maps_;       ///< of the tets around the node being moved
  std::vector<std::array<int, 2>> moved_;  ///< pairs of point and new tet
};

}  // namespace

void fitCage(CageTets& cage, double half, const std::vector<Eigen::Vector3d>& points) {
  assert(points.size() == cage.tetOf.size() && half > 0.0);
  CageFit(cage, half, points).run();
}

}  // namespace tetskin::cage_detail
