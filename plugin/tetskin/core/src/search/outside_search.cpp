// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Searches with growing boxes: a point is settled once its best tet is nearer than the searched border, because every
// tet that could be better has then been tested. The result is the same as that of testing all pairs.
#include <tetskin/core/src/search/outside_search.h>
#include <tetskin/core/src/search/spatial_hash.h>
#include <tetskin/core/src/search/tet_filter.h>
#include <algorithm>
#include <cassert>
#include <limits>

namespace tetskin {
namespace {

/// First border around the tets' boxes, relative to the median of their sides, and its growth factor: most points
/// outside are near, and each round has to visit all tets.
constexpr double kFirstBorder = 0.2;
constexpr double kGrowth = 4.0;
/// A barycentric distance d that keeps all weights within kMaxWeight: no weight is below -d, so none is above 1 + 3 d.
constexpr double kSafeDistance = 0.999 * (kMaxWeight - 1.0) / 3.0;
/// First barycentric border; it is doubled in each round.
constexpr double kFirstBarycentricBorder = 0.25;
/// Points are searched this many at a time, or an eighth of all if that is more: an unsettled point takes many times
/// the memory of its result.
constexpr std::size_t kMinBatch = 65536;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The points still without a tet, with their best results so far.
struct OpenPoints {
  std::vector<std::uint32_t> ids;
  std::vector<Eigen::Vector3d> positions;
  std::vector<double> best;  ///< shortest (barycentric) distance found so far

  std::size_t size() const { return ids.size(); }
  void add(std::uint32_t id, const Eigen::Vector3d& position, double bestSoFar) {
    ids.push_back(id);
    positions.push_back(position);
    best.push_back(bestSoFar);
  }
};

/// The points whose best exceeds the limit.
OpenPoints above(const OpenPoints& open, double limit) {
  OpenPoints rest;
  for (std::size_t k = 0; k < open.size(); ++k) {
    if (open.best[k] > limit) rest.add(open.ids[k], open.positions[k], open.best[k]);
  }
  return rest;
}

/// No open point can have its tet farther away than this; infinite while a point has not met any tet.
double farthestBest(const OpenPoints& open) {
  return open.best.empty() ? 0.0 : *std::max_element(open.best.begin(), open.best.end());
}

/// A point whose tet was found outside of it counts as inside if the distance is within rounding.
void settle(const SearchCage& cage, std::uint32_t point, double distance, TetSearch& search) {
  assert(search.tetOf[point] < 0 && search.tetOf[point] != TetSearch::kNone);
  if (distance <= kInsideTolerance * maxCoordinate(cage.box())) {
    search.tetOf[point] = ~search.tetOf[point];
  } else if (distance > search.farthestDistance || (distance == search.farthestDistance && point < search.farthest)) {
    search.farthestDistance = distance;
    search.farthest = point;
  }
}

/// A tet, and an open point that may be within its limit of the tet.
struct NearPair {
  int tet;
  double tetSize;
  std::uint32_t open;
  std::uint32_t entry;
  Eigen::Vector4d weights;
  double distance;
};

/// One round of a search by distance: all tets whose boxes, grown by a border, contain the point.
class DistanceRound {
 public:
  /// limitOf  of an open point: a distance; tets beyond the border may be missed
  template <class LimitOf>
  DistanceRound(const SearchCage& cage, const OpenPoints& open, double border, double cellSize, std::size_t tableSize,
                LimitOf&& limitOf)
      : cage_(cage),
        open_(open),
        border_(border),
        hash_(viewOf(open.positions), grown(cage.box(), border + cage.largestSlack()),
              std::max(cellSize, 0.5 * cage.medianSide() + border), {}, tableSize),
        limits_(hash_.size() + SpatialHash::kPadding) {
    for (std::uint32_t e = 0; e < hash_.size(); ++e) limits_[e] = inFrame(limitOf(hash_.ids()[e]));
  }

  /// Calls decide(pair) for tets in ascending order.
  template <class Decide>
  void run(std::size_t& candidates, Decide&& decide) {
    for (std::size_t i = 0; i < cage_.size(); ++i) {
      const SearchTet tet = cage_[i];
      candidates += hash_.findRanges(grown(tet.box, border_ + tet.slack()), ranges_);
      if (ranges_.empty()) continue;
      const BarycentricMap map(tet.corners);
      const double size = tetSize(tet.corners);
      const TetFilter filter = TetFilter::ofDistance(map, hash_.frame());
      const std::size_t count = filter.select(hash_, ranges_, limits_.data(), passed_);
      for (std::size_t n = 0; n < count; ++n) {
        const std::uint32_t k = hash_.ids()[passed_[n]];
        const Eigen::Vector4d weights = map(open_.positions[k]);
        decide({tet.index, size, k, passed_[n], weights, distanceToTet(open_.positions[k], tet.corners, weights)});
      }
    }
  }
  void lowerLimit(std::uint32_t entry, double limit) { limits_[entry] = std::min(limits_[entry], inFrame(limit)); }

 private:
  /// A distance in the frame's unit, rounded up.
  float inFrame(double distance) const { return static_cast<float>(distance * hash_.frame().scale * (1.0 + 0x1p-20)); }

  const SearchCage& cage_;
  const OpenPoints& open_;
  double border_;
  SpatialHash hash_;
  std::vector<float> limits_;               ///< by entry
  std::vector<SpatialHash::Range> ranges_;  ///< scratch memory, as is the next
  std::vector<std::uint32_t> passed_;
};

/// A tet that may be the nearest one of an open point.
struct NearTet {
  std::uint32_t open;
  int tet;
  double tie;  ///< distances up to this much longer count as equal
  double barycentric;
  double distance;
};

std::vector<NearTet> nearTets(const SearchCage& cage, OpenPoints& open, double border, double cellSize,
                              std::size_t tableSize, std::size_t& candidates) {
  const double widestTie = kNearestTie * cage.largestSize();
  DistanceRound round(cage, open, border, cellSize, tableSize,
                      [&](std::uint32_t k) { return std::min(open.best[k], border) + widestTie; });
  std::vector<NearTet> near;
  round.run(candidates, [&](const NearPair& pair) {
    double& best = open.best[pair.open];
    const double tie = kNearestTie * pair.tetSize;
    if (pair.distance > best + tie) return;
    near.push_back({pair.open, pair.tet, tie, barycentricDistance(pair.weights), pair.distance});
    if (pair.distance >= best) return;
    best = pair.distance;
    round.lowerLimit(pair.entry, best + widestTie);
  });
  return near;
}

/// Of the tets tied for nearest, the smallest barycentric distance wins, then the lowest index (tets come in order).
/// Returns the points that would be extrapolated too far.
OpenPoints settleNearest(const SearchCage& cage, const OpenPoints& open, double searched,
                         const std::vector<NearTet>& near, TetSearch& search) {
  assert(open.best.size() == open.ids.size() && open.positions.size() == open.ids.size());
  std::vector<double> barycentric(open.size(), kInfinity);
  for (const NearTet& n : near) {
    if (open.best[n.open] > searched) continue;
    if (n.distance > open.best[n.open] + n.tie) continue;
    if (n.barycentric >= barycentric[n.open]) continue;
    barycentric[n.open] = n.barycentric;
    search.tetOf[open.ids[n.open]] = ~n.tet;
  }
  OpenPoints extrapolated;
  for (std::size_t k = 0; k < open.size(); ++k) {
    if (open.best[k] > searched) continue;
    settle(cage, open.ids[k], open.best[k], search);
    const std::int32_t tet = search.tetOf[open.ids[k]];
    if (tet >= 0 || barycentric[k] <= kSafeDistance) continue;
    if (largestWeight(BarycentricMap(cage.corners(~tet))(open.positions[k])) <= kMaxWeight) continue;
    extrapolated.add(open.ids[k], open.positions[k], open.best[k]);
  }
  return extrapolated;
}

/// Among the tets near them, chooses those that extrapolate least, for points whose nearest tets would extrapolate too
/// far.
void reassignByWeight(const SearchCage& cage, const OpenPoints& points, double cellSize, std::size_t tableSize,
                      TetSearch& search) {
  if (points.size() == 0) return;
  const double reach = meanEdge(cage.mesh());
  DistanceRound round(cage, points, farthestBest(points) + reach, cellSize, tableSize,
                      [&](std::uint32_t k) { return points.best[k] + reach; });
  std::vector<double> smallest(points.size(), kInfinity);
  std::vector<std::int32_t> tets(points.size(), TetSearch::kNone);
  round.run(search.candidates, [&](const NearPair& pair) {
    const double weight = largestWeight(pair.weights);
    if (pair.distance > points.best[pair.open] + reach || weight >= smallest[pair.open]) return;
    smallest[pair.open] = weight;
    tets[pair.open] = ~pair.tet;
  });
  for (std::size_t k = 0; k < points.size(); ++k) {
    std::int32_t& tet = search.tetOf[points.ids[k]];
    if (tet == tets[k]) continue;
    assert(tets[k] != TetSearch::kNone);
    tet = tets[k];
    search.reassigned.resize(search.tetOf.size());
    search.reassigned[points.ids[k]] = true;
  }
}

void findNearest(const SearchCage& cage, OpenPoints open, double cellSize, std::size_t tableSize, TetSearch& search) {
  const double widestTie = kNearestTie * cage.largestSize();
  double border = kFirstBorder * cage.medianSide();
  while (open.size() > 0) {
    const double searched = border - widestTie;
    const OpenPoints extrapolated = settleNearest(
        cage, open, searched, nearTets(cage, open, border, cellSize, tableSize, search.candidates), search);
    open = above(open, searched);
    reassignByWeight(cage, extrapolated, cellSize, tableSize, search);
    // If all remaining points are far away, the border grows to them at once; if they are known to be near, it grows no
    // further.
    double nearestLeft = kInfinity;
    for (const Eigen::Vector3d& v : open.positions) nearestLeft = std::min(nearestLeft, cage.box().exteriorDistance(v));
    border = std::min(std::max(kGrowth * border, nearestLeft), farthestBest(open) + 2.0 * widestTie);
  }
}

/// Tests one tet against the open points in the box of the tet scaled by 1 + 4 delta about its centroid, which contains
/// all points of barycentric distance up to delta: b_i >= -delta means b_i - 1/4 >= -(1 + 4 delta) / 4.
void testBarycentric(const SearchTet& tet, double delta, const SpatialHash& hash, OpenPoints& open, TetSearch& search) {
  const BarycentricMap map(tet.corners);
  const Eigen::Vector3d centroid = (tet.corners[0] + tet.corners[1] + tet.corners[2] + tet.corners[3]) / 4.0;
  const double scale = 1.0 + 4.0 * delta;
  const Box3 scaled(centroid + scale * (tet.box.min() - centroid), centroid + scale * (tet.box.max() - centroid));
  hash.query(grown(scaled, scale * tet.slack()), [&](std::uint32_t first, std::uint32_t last) {
    search.candidates += last - first;
    for (; first < last; ++first) {
      const std::uint32_t k = hash.ids()[first];
      const double d = barycentricDistance(map(open.positions[k]));
      std::int32_t& best = search.tetOf[open.ids[k]];
      if (d > open.best[k] || (d == open.best[k] && tet.index >= ~best)) continue;
      best = ~tet.index;
      open.best[k] = d;
    }
  });
}

void findBarycentric(const SearchCage& cage, OpenPoints open, double cellSize, std::size_t tableSize,
                     TetSearch& search) {
  for (double delta = kFirstBarycentricBorder; open.size() > 0; delta = std::min(2.0 * delta, farthestBest(open))) {
    const SpatialHash hash(viewOf(std::as_const(open.positions)), boundingBox(open.positions),
                           cellSize * (1.0 + 4.0 * delta), {}, tableSize);
    for (std::size_t i = 0; i < cage.size(); ++i) testBarycentric(cage[i], delta, hash, open, search);
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (open.best[k] > delta) continue;
      const TetCorners corners = cage.corners(~search.tetOf[open.ids[k]]);
      const Eigen::Vector3d& v = open.positions[k];
      settle(cage, open.ids[k], distanceToTet(v, corners, BarycentricMap(corners)(v)), search);
    }
    open = above(open, delta);
  }
}

}  // namespace

void findOutside(const SearchCage& cage, PointReader points, const std::vector<std::uint32_t>& first, OutsideRule rule,
                 double cellSize, std::size_t tableSize, TetSearch& search) {
  assert(first.size() == points.size() && search.tetOf.size() == points.size() && cellSize > 0.0);
  const std::size_t batch = std::max(kMinBatch, points.size() / 8);
  OpenPoints open;
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    if (first[p] == p && search.tetOf[p] == TetSearch::kNone) open.add(p, points[p], kInfinity);
    if (open.size() < batch && p + 1 < points.size()) continue;
    if (rule == OutsideRule::Nearest) {
      findNearest(cage, std::move(open), cellSize, tableSize, search);
    } else {
      findBarycentric(cage, std::move(open), cellSize, tableSize, search);
    }
    open = {};
  }
}

}  // namespace tetskin
