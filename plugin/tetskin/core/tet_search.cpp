// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Matthias Müller, "100 x Simulation Speedup with Mesh Embedding", Ten Minute Physics 12, 2022
//
// The tutorial searches once, with a border of an absolute length. Here a search with tight boxes settles the vertices
// inside, and searches with growing boxes the rest: a vertex is settled once its best tet is nearer than the border
// already searched, because every tet that could be better has then been tested. The result is that of testing all
// pairs.
#include <tetskin/core/spatial_hash.h>
#include <tetskin/core/tet_search.h>

#include <algorithm>
#include <limits>

namespace tetskin {
namespace {

/// Query boxes are this fraction of the tet's size larger than the exact ones. A weight of a tet just above kFlatTet
/// can be off by 1e-7, and a vertex that far outside would still test as inside.
constexpr double kBoxSlack = 1e-6;
/// Cell size over the median side of the tets' boxes: smaller cells test fewer candidates but look up more rows, which
/// pays the more points there are to a tet.
constexpr double kFinestCells = 0.35;
constexpr double kCoarsestCells = 0.7;
/// First border around the tets' boxes for vertices outside, over the same median side; then doubled.
constexpr double kFirstBorder = 0.25;
/// First barycentric border; then doubled.
constexpr double kFirstBarycentricBorder = 0.25;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Box3 grown(const Box3& box, double border) {
  const Eigen::Vector3d b = Eigen::Vector3d::Constant(border);
  return {box.min() - b, box.max() + b};
}

double medianSide(const std::vector<SearchTet>& tets) {
  std::vector<double> sides(tets.size());
  std::transform(tets.begin(), tets.end(), sides.begin(), [](const SearchTet& t) { return t.box.sizes().maxCoeff(); });
  const auto middle = sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2);
  std::nth_element(sides.begin(), middle, sides.end());
  return *middle;
}

double cellSizeFor(const std::vector<SearchTet>& tets, std::size_t pointCount) {
  Box3 cage;
  for (const SearchTet& t : tets) cage.extend(t.box);
  // In a graded cage the median may be tiny beside the largest tets. Cells finer than this would make a box across the
  // cage look up more rows than there are points.
  const double finest = cage.sizes().maxCoeff() / (2.0 * std::sqrt(static_cast<double>(pointCount)));
  const double pointsPerTet = static_cast<double>(pointCount) / static_cast<double>(tets.size());
  const double fraction = std::min(std::max(1.0 / std::sqrt(pointsPerTet), kFinestCells), kCoarsestCells);
  return std::max(fraction * medianSide(tets), finest);
}

/// Smallest weight of each entry of [first, first + count) in the tet. Kept apart from its use so that it vectorises.
void smallestWeights(const SpatialHash& hash, const BarycentricMap& map, std::uint32_t first, std::uint32_t count,
                     double* smallest) {
  const double* x = hash.x() + first;
  const double* y = hash.y() + first;
  const double* z = hash.z() + first;
  for (std::uint32_t k = 0; k < count; ++k) {
    double b0, b1, b2, b3;
    map.weightsAt(x[k], y[k], z[k], b0, b1, b2, b3);
    smallest[k] = std::min(std::min(b0, b1), std::min(b2, b3));
  }
}

/// Tests the candidates of every tet's own box. Fills the hits of the points inside.
void findInside(const std::vector<SearchTet>& tets, const std::vector<Eigen::Vector3d>& points, double cellSize,
                std::size_t tableSize, TetSearch& search) {
  const SpatialHash hash(points, cellSize, tableSize);
  constexpr int kNone = -1, kSeveral = -2;
  std::vector<int> deepIn(points.size(), kNone);  // the tet in which a point is deep
  constexpr std::uint32_t kChunk = 64;
  double smallest[kChunk];

  for (std::size_t t = 0; t < tets.size(); ++t) {
    const SearchTet& tet = tets[t];
    const int place = static_cast<int>(t);
    hash.query(grown(tet.box, kBoxSlack * tet.size), [&](std::uint32_t first, std::uint32_t last) {
      search.candidates += last - first;
      for (; first < last; first += kChunk) {
        const std::uint32_t count = std::min(kChunk, last - first);
        smallestWeights(hash, tet.map, first, count, smallest);
        for (std::uint32_t k = 0; k < count; ++k) {
          if (smallest[k] < 0.0) continue;
          const std::uint32_t point = hash.ids()[first + k];
          TetHit& hit = search.hits[point];
          if (hit.tet < 0) hit = {place, -smallest[k], 0.0};  // tets come in order: the first is the lowest
          if (smallest[k] <= kOverlapDepth || deepIn[point] == place) continue;
          deepIn[point] = deepIn[point] == kNone ? place : kSeveral;
        }
      }
    });
  }
  search.overlapping = static_cast<std::size_t>(std::count(deepIn.begin(), deepIn.end(), kSeveral));
}

/// The points still without a tet, and what is known of them so far.
struct OpenPoints {
  std::vector<std::uint32_t> ids;
  std::vector<Eigen::Vector3d> positions;
  std::vector<double> best;  ///< shortest (barycentric) distance found so far

  void add(std::uint32_t id, const Eigen::Vector3d& position, double bestSoFar) {
    ids.push_back(id);
    positions.push_back(position);
    best.push_back(bestSoFar);
  }
};

OpenPoints withoutTet(const std::vector<Eigen::Vector3d>& points, const TetSearch& search) {
  OpenPoints open;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (search.hits[i].tet < 0) open.add(i, points[i], kInfinity);
  }
  return open;
}

/// Keeps the points whose best exceeds the limit.
OpenPoints above(const OpenPoints& open, double limit) {
  OpenPoints rest;
  for (std::size_t k = 0; k < open.ids.size(); ++k) {
    if (open.best[k] > limit) rest.add(open.ids[k], open.positions[k], open.best[k]);
  }
  return rest;
}

double farthestBest(const OpenPoints& open) {
  return open.best.empty() ? 0.0 : *std::max_element(open.best.begin(), open.best.end());
}

/// A tet that was within the tie's width of the best when it was tested.
struct NearTet {
  std::uint32_t open;
  TetHit hit;
};

/// Tests one tet against the open points in its box grown by the border.
void testNearest(const SearchTet& tet, int place, double border, const SpatialHash& hash, OpenPoints& open,
                 std::vector<NearTet>& near, std::size_t& candidates) {
  const Eigen::Vector4d altitudes = tet.map.gradientLengths().cwiseInverse();
  const double tie = kNearestTie * tet.size;
  hash.query(grown(tet.box, border + kBoxSlack * tet.size), [&](std::uint32_t first, std::uint32_t last) {
    candidates += last - first;
    for (; first < last; ++first) {
      const std::uint32_t k = hash.ids()[first];
      const Eigen::Vector3d& v = open.positions[k];
      const Eigen::Vector4d weights = tet.map(v);
      // The distance to a face's plane, from beyond it, bounds the distance to the tet from below.
      const double bound = -weights.cwiseProduct(altitudes).minCoeff();
      if (bound > open.best[k] + tie) continue;
      const double distance = distanceToTet(v, tet.corners, weights);
      if (distance > open.best[k] + tie) continue;
      near.push_back({k, {place, barycentricDistance(weights), distance}});
      open.best[k] = std::min(open.best[k], distance);
    }
  });
}

/// Of the tets tied for nearest, the smallest barycentric distance wins, then the lowest index.
void settleNearest(const std::vector<SearchTet>& tets, const OpenPoints& open, double searched,
                   const std::vector<NearTet>& near, TetSearch& search) {
  for (const NearTet& n : near) {
    if (open.best[n.open] > searched) continue;
    if (n.hit.distance > open.best[n.open] + kNearestTie * tets[n.hit.tet].size) continue;
    TetHit& hit = search.hits[open.ids[n.open]];
    const bool better = hit.tet < 0 || n.hit.barycentric < hit.barycentric ||
                        (n.hit.barycentric == hit.barycentric && n.hit.tet < hit.tet);
    if (better) hit = n.hit;
  }
}

void findNearest(const std::vector<SearchTet>& tets, OpenPoints open, double cellSize, std::size_t tableSize,
                 TetSearch& search) {
  double widestTie = 0.0;
  Box3 cage;
  for (const SearchTet& t : tets) {
    widestTie = std::max(widestTie, kNearestTie * t.size);
    cage.extend(t.box);
  }
  const double side = medianSide(tets);
  double border = kFirstBorder * side;
  while (!open.ids.empty()) {
    const SpatialHash hash(open.positions, std::max(cellSize, 0.5 * side + border), tableSize);
    const Box3 box = boundingBox(open.positions);
    std::vector<NearTet> near;
    for (std::size_t t = 0; t < tets.size(); ++t) {
      if (!grown(tets[t].box, border + kBoxSlack * tets[t].size).intersects(box)) continue;
      testNearest(tets[t], static_cast<int>(t), border, hash, open, near, search.candidates);
    }
    const double searched = border - widestTie;
    settleNearest(tets, open, searched, near, search);
    open = above(open, searched);
    // If all that is left is far away, go there at once; if it is known to be near, no farther than that.
    double nearestLeft = kInfinity;
    for (const Eigen::Vector3d& v : open.positions) nearestLeft = std::min(nearestLeft, cage.exteriorDistance(v));
    border = std::min(std::max(2.0 * border, nearestLeft), farthestBest(open) + 2.0 * widestTie);
  }
}

/// Tests one tet against the open points in the box of the tet scaled by 1 + 4 delta about its centroid, which holds
/// all points of barycentric distance up to delta: b_i >= -delta means b_i - 1/4 >= -(1 + 4 delta) / 4.
void testBarycentric(const SearchTet& tet, int place, double delta, const SpatialHash& hash, OpenPoints& open,
                     TetSearch& search) {
  const Eigen::Vector3d centroid = (tet.corners[0] + tet.corners[1] + tet.corners[2] + tet.corners[3]) / 4.0;
  const double scale = 1.0 + 4.0 * delta;
  const Box3 scaled(centroid + scale * (tet.box.min() - centroid), centroid + scale * (tet.box.max() - centroid));
  hash.query(grown(scaled, kBoxSlack * scale * tet.size), [&](std::uint32_t first, std::uint32_t last) {
    search.candidates += last - first;
    for (; first < last; ++first) {
      const std::uint32_t k = hash.ids()[first];
      const double d = barycentricDistance(tet.map(open.positions[k]));
      TetHit& hit = search.hits[open.ids[k]];
      if (hit.tet >= 0 && (d > hit.barycentric || (d == hit.barycentric && place >= hit.tet))) continue;
      hit = {place, d, 0.0};
      open.best[k] = d;
    }
  });
}

void findBarycentric(const std::vector<SearchTet>& tets, OpenPoints open, double cellSize, std::size_t tableSize,
                     TetSearch& search) {
  const std::vector<Eigen::Vector3d> outside = open.positions;
  const std::vector<std::uint32_t> ids = open.ids;
  for (double delta = kFirstBarycentricBorder; !open.ids.empty(); delta = std::min(2.0 * delta, farthestBest(open))) {
    const SpatialHash hash(open.positions, cellSize * (1.0 + 4.0 * delta), tableSize);
    for (std::size_t t = 0; t < tets.size(); ++t)
      testBarycentric(tets[t], static_cast<int>(t), delta, hash, open, search);
    open = above(open, delta);
  }
  for (std::size_t k = 0; k < ids.size(); ++k) {
    TetHit& hit = search.hits[ids[k]];
    hit.distance = distanceToTet(outside[k], tets[hit.tet].corners, tets[hit.tet].map(outside[k]));
  }
}

}  // namespace

SearchTet::SearchTet(int tetIndex, const TetCorners& p) : index(tetIndex), size(tetSize(p)), corners(p), map(p) {
  for (const Eigen::Vector3d& corner : p) box.extend(corner);
}

std::vector<SearchTet> searchTets(const TetMesh& cage) {
  std::vector<SearchTet> tets;
  tets.reserve(cage.tetCount());
  for (std::size_t t = 0; t < cage.tetCount(); ++t) {
    const TetCorners corners = cornersOf(cage, cage.tets[t]);
    if (!isFlat(corners)) tets.emplace_back(static_cast<int>(t), corners);
  }
  return tets;
}

TetSearch findTets(const std::vector<SearchTet>& tets, const std::vector<Eigen::Vector3d>& points, OutsideRule rule,
                   std::size_t tableSize) {
  assert(!tets.empty());
  assert(firstNonFinite(viewOf(points)) == points.size());
  TetSearch search;
  search.hits.resize(points.size());
  if (points.empty()) return search;
  const double cellSize = cellSizeFor(tets, points.size());
  findInside(tets, points, cellSize, tableSize, search);
  OpenPoints open = withoutTet(points, search);
  if (rule == OutsideRule::Nearest) {
    findNearest(tets, std::move(open), cellSize, tableSize, search);
  } else {
    findBarycentric(tets, std::move(open), cellSize, tableSize, search);
  }
  return search;
}

}  // namespace tetskin
