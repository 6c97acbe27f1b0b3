// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Matthias Müller, "100 x Simulation Speedup with Mesh Embedding", Ten Minute Physics 12, 2022
//
// The tutorial searches once, with a border of an absolute length. Here a search with tight boxes settles the vertices
// inside, and a search with growing boxes (outside_search.cpp) the rest.
#include <tetskin/core/src/search/outside_search.h>
#include <tetskin/core/src/search/spatial_hash.h>
#include <tetskin/core/src/search/tet_filter.h>
#include <tetskin/core/src/search/tet_search.h>

#include <algorithm>
#include <cassert>

namespace tetskin {
namespace {

/// Cell size over the median side of the tets' boxes: smaller cells test fewer candidates but look up more rows, which
/// pays off more with more points per tet.
constexpr double kFinestCells = 0.4;
constexpr double kCoarsestCells = 0.7;

double cellSizeFor(const SearchCage& cage, std::size_t pointCount) {
  assert(pointCount > 0 && cage.size() > 0);
  // In a graded cage the median may be tiny compared with the largest tets. With finer cells than this, a box across
  // the cage would look up more rows than there are points.
  const double finest = cage.box().sizes().maxCoeff() / (2.0 * std::sqrt(static_cast<double>(pointCount)));
  const double pointsPerTet = static_cast<double>(pointCount) / static_cast<double>(cage.size());
  const double fraction = std::min(std::max(1.0 / std::sqrt(pointsPerTet), kFinestCells), kCoarsestCells);
  return std::max(fraction * cage.medianSide(), finest);
}

/// The first pass: every tet tests the points in its own box.
class InsideSearch {
 public:
  InsideSearch(PointReader points, const SpatialHash& hash, TetSearch& search)
      : points_(points), hash_(hash), search_(search), deep_(points.size(), 0) {}

  void test(const SearchTet& tet) {
    search_.candidates += hash_.findRanges(grown(tet.box, tet.slack()), ranges_);
    if (ranges_.empty()) return;  // many tets of a cage lie deep under the surface
    const BarycentricMap map(tet.corners);
    const std::size_t count = TetFilter::ofWeights(map, hash_.frame()).select(hash_, ranges_, nullptr, passed_);
    for (std::size_t k = 0; k < count; ++k) decide(tet.index, map, hash_.ids()[passed_[k]]);
  }

  std::size_t overlapping() const { return static_cast<std::size_t>(std::count(deep_.begin(), deep_.end(), kSeveral)); }

 private:
  /// A point counts as ambiguous from its second tet on; further tets are not counted.
  static constexpr std::uint8_t kSeveral = 2;

  void decide(int tet, const BarycentricMap& map, std::uint32_t point) {
    const Eigen::Vector3d p = points_[point];
    double b0, b1, b2, b3;
    map.weightsAt(p.x(), p.y(), p.z(), b0, b1, b2, b3);
    const double smallest = std::min(std::min(b0, b1), std::min(b2, b3));
    if (smallest < 0.0) return;
    std::int32_t& best = search_.tetOf[point];
    if (best == TetSearch::kNone) best = tet;  // tets come in order: the first is the lowest
    if (smallest > kOverlapDepth && deep_[point] < kSeveral) ++deep_[point];
  }

  PointReader points_;
  const SpatialHash& hash_;
  TetSearch& search_;
  std::vector<std::uint8_t> deep_;          ///< by point: number of tets in which it is deep, up to kSeveral
  std::vector<SpatialHash::Range> ranges_;  ///< scratch memory, as is the next
  std::vector<std::uint32_t> passed_;
};

void findInside(const SearchCage& cage, PointReader points, const std::vector<std::uint32_t>& first, double cellSize,
                std::size_t tableSize, TetSearch& search) {
  const Box3 reach = grown(cage.box(), cage.largestSlack());
  const SpatialHash hash(points, reach, cellSize, first, tableSize);
  InsideSearch inside(points, hash, search);
  for (std::size_t i = 0; i < cage.size(); ++i) inside.test(cage[i]);
  search.overlapping = inside.overlapping();
}

}  // namespace

TetSearch findTets(const SearchCage& cage, PointReader points, const std::vector<std::uint32_t>& first,
                   OutsideRule rule, std::size_t tableSize) {
  assert(first.size() == points.size());
  TetSearch search;
  search.tetOf.assign(points.size(), TetSearch::kNone);
  if (points.empty()) return search;
  const double cellSize = cellSizeFor(cage, points.size());
  findInside(cage, points, first, cellSize, tableSize, search);
  findOutside(cage, points, first, rule, cellSize, tableSize, search);
  for (std::size_t p = 0; p < points.size(); ++p) search.tetOf[p] = search.tetOf[first[p]];
  return search;
}

}  // namespace tetskin
