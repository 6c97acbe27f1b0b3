// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/lattice/inside_fill.h>
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/progress.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::cage_detail {
namespace {

/// Number of samples that vote on a region: enough to overrule one that is too near to a fold.
constexpr std::size_t kVotes = 5;

/// Largest number of cubes whose tets can be numbered in 31 bits.
constexpr std::size_t kMaxCubes = 150'000'000;

/// Steps to the neighbouring cubes along the axes.
constexpr std::array<std::array<std::int8_t, 3>, 6> kSteps = {
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

class InsideFill {
 public:
  InsideFill(const Surface& surface, const WindingTree& winding, const LatticeFrame& frame, std::size_t limit,
             LatticeSet& set)
      : surface_(surface), winding_(winding), frame_(frame), limit_(limit), set_(set) {}

  bool run() {
    if (!addRim()) return false;
    const std::size_t entries = set_.cubeCount();
    DisjointSets regions(kTetsPerCube * entries + 1);
    const auto outside = static_cast<int>(kTetsPerCube * entries);
    connectTets(regions);
    const std::vector<Gap> gaps = connectColumns(regions, outside);
    const std::vector<char> inside = classify(regions, outside);
    const int outsideRoot = regions.find(outside);
    for (std::size_t i = 0; i < entries; ++i) addRegionTets(i, regions, inside);
    if (!addGaps(gaps, regions, inside)) return false;
    // Without open edges nothing leaks in from outside; without orientation the winding number cannot decide.
    if (surface_.openEdges == 0 || !surface_.oriented) return true;
    return growThroughHoles(entries, regions, outsideRoot);
  }

 private:
  /// Cubes without an entry, strictly between two entries of a column.
  struct Gap {
    int left = 0, right = 0;
  };

  /// Adds entries for the cubes around touched ones, so that every neighbour of a touched cube has an entry, and a cube
  /// without an entry only borders on cubes without touched tets.
  bool addRim() {
    const std::size_t touched = set_.cubeCount();
    wasTouched_.assign(touched, 1);
    for (std::size_t i = 0; i < touched; ++i) {
      const Cube c = set_.cube(i);
      for (int n = 0; n < 27; ++n) set_.insert({c[0] + n % 3 - 1, c[1] + n / 3 % 3 - 1, c[2] + n / 9 - 1});
      if (set_.cubeCount() > kMaxCubes) return false;
    }
    wasTouched_.resize(set_.cubeCount(), 0);
    touchedMask_.resize(set_.cubeCount());
    for (std::size_t i = 0; i < touchedMask_.size(); ++i) touchedMask_[i] = set_.mask(i);
    return true;
  }

  /// Number of an untouched tet: the tets of a completely untouched cube share one.
  int nameOf(std::size_t entry, int local) const {
    assert(entry < wasTouched_.size() && local >= 0 && local < kTetsPerCube);
    return static_cast<int>(kTetsPerCube * entry) + (wasTouched_[entry] ? local : 0);
  }
  bool untouched(std::size_t entry, int local) const { return (touchedMask_[entry] >> local & 1) == 0; }

  void connectTets(DisjointSets& regions) const {
    for (std::size_t i = 0; i < touchedMask_.size(); ++i) {
      if (!wasTouched_[i]) {
        for (int s = 0; s < 6; s += 2) {
          const int j = set_.find(set_.cube(i) + kSteps[s]);
          if (j >= 0 && !wasTouched_[j]) regions.unite(nameOf(i, 0), nameOf(j, 0));
        }
        continue;
      }
      for (int local = 0; local < kTetsPerCube; ++local) {
        if (!untouched(i, local)) continue;
        for (const LatticeStep& step : latticeTables().neighbours[local]) {
          const int j = set_.find(set_.cube(i) + step.cube);
          if (untouched(j, step.local)) regions.unite(nameOf(i, local), nameOf(j, step.local));
        }
      }
    }
  }

  /// Connects the regions at both ends of every gap along x, and the ends of every column with the outside. This
  /// connects each region completely: each of its rims is connected in itself, and from a rim's last cube along x a gap
  /// leads to a rim farther out.
  std::vector<Gap> connectColumns(DisjointSets& regions, int outside) const {
    const std::vector<std::int32_t> order = columnOrder(set_);
    std::vector<Gap> gaps;
    for (std::size_t k = 0; k < order.size(); ++k) {
      const int i = order[k];
      const bool last = k + 1 == order.size();
      const Cube& c = set_.cube(i);
      const bool sameColumn = !last && set_.cube(order[k + 1])[1] == c[1] && set_.cube(order[k + 1])[2] == c[2];
      if (k == 0) regions.unite(nameOf(i, 0), outside);
      if (!sameColumn) {
        regions.unite(nameOf(i, 0), outside);
        if (!last) regions.unite(nameOf(order[k + 1], 0), outside);
      } else if (set_.cube(order[k + 1])[0] > c[0] + 1) {
        regions.unite(nameOf(i, 0), nameOf(order[k + 1], 0));
        gaps.push_back({i, order[k + 1]});
      }
    }
    return gaps;
  }

  bool insideAt(const Eigen::Vector3d& lattice) const {
    return std::abs(winding_.windingNumber(frame_.toRest(lattice))) >= kInside;
  }

  Eigen::Vector3d sampleOf(std::size_t entry, int local) const {
    return wasTouched_[entry] ? centroid({set_.cube(entry), local}) : centroidOf(set_.cube(entry));
  }
  /// Mean of the centroids of a cube's tets, which lie around its upper faces.
  static Eigen::Vector3d centroidOf(const Cube& cube) {
    return cubeOrigin(cube) + Eigen::Vector3d::Constant(1.0 + 1.0 / 3.0);
  }

  /// By number of a region's representative: 1 if it is inside.
  std::vector<char> classify(DisjointSets& regions, int outside) const {
    const int outsideRoot = regions.find(outside);
    std::vector<std::array<int, 2>> members;  // representative, member
    forUntouched([&](std::size_t i, int local) {
      const int root = regions.find(nameOf(i, local));
      if (root != outsideRoot) members.push_back({root, static_cast<int>(kTetsPerCube * i) + local});
    });
    std::sort(members.begin(), members.end());
    std::vector<char> inside(kTetsPerCube * touchedMask_.size() + 1, 0);
    for (std::size_t first = 0; first < members.size();) {
      std::size_t last = first;
      while (last < members.size() && members[last][0] == members[first][0]) ++last;
      inside[members[first][0]] = vote(members, first, last) ? 1 : 0;
      first = last;
    }
    return inside;
  }

  /// Calls f with every untouched tet; for a completely untouched cube, only with tet 0.
  template <class F>
  void forUntouched(F f) const {
    for (std::size_t i = 0; i < touchedMask_.size(); ++i) {
      Progress::goOn(i);
      const int count = wasTouched_[i] ? kTetsPerCube : 1;
      for (int local = 0; local < count; ++local) {
        if (untouched(i, local)) f(i, local);
      }
    }
  }

  bool vote(const std::vector<std::array<int, 2>>& members, std::size_t first, std::size_t last) const {
    assert(first < last && last <= members.size());
    if (!surface_.oriented) return true;
    const std::size_t count = std::min(kVotes, last - first);
    std::size_t yes = 0;
    for (std::size_t v = 0; v < count; ++v) {
      const int member = members[first + (2 * v + 1) * (last - first) / (2 * count)][1];
      yes += insideAt(sampleOf(static_cast<std::size_t>(member / kTetsPerCube), member % kTetsPerCube)) ? 1 : 0;
    }
    return 2 * yes > count;
  }

  void addRegionTets(std::size_t entry, DisjointSets& regions, const std::vector<char>& inside) {
    unsigned tets = 0;
    for (int local = 0; local < kTetsPerCube; ++local) {
      if (untouched(entry, local) && inside[regions.find(nameOf(entry, local))]) tets |= 1u << local;
    }
    set_.add(entry, static_cast<std::uint16_t>(tets));
  }

  bool addGaps(const std::vector<Gap>& gaps, DisjointSets& regions, const std::vector<char>& inside) {
    for (const Gap& gap : gaps) {
      if (!inside[regions.find(nameOf(gap.left, 0))]) continue;
      Cube c = set_.cube(gap.left);
      const std::int32_t end = set_.cube(gap.right)[0];
      for (++c[0]; c[0] < end; ++c[0]) {
        set_.add(set_.insert(c), kAllTets);
        if (set_.tetCount() > limit_) return false;
      }
    }
    return set_.tetCount() <= limit_;
  }

  bool growThroughHoles(std::size_t entries, DisjointSets& regions, int outsideRoot) {
    std::vector<Cube> fresh;  // whole cubes that are inside
    forUntouched([&](std::size_t i, int local) {
      if (regions.find(nameOf(i, local)) != outsideRoot || !insideAt(sampleOf(i, local))) return;
      set_.add(i, wasTouched_[i] ? static_cast<std::uint16_t>(1u << local) : kAllTets);
      if (!wasTouched_[i]) fresh.push_back(set_.cube(i));
    });
    while (!fresh.empty()) {
      const Cube cube = fresh.back();
      fresh.pop_back();
      for (const auto& step : kSteps) {
        const Cube next = cube + step;
        if (static_cast<std::size_t>(set_.insert(next)) < entries) continue;
        if (set_.contains({next, 0}) || !insideAt(centroidOf(next))) continue;
        set_.add(set_.insert(next), kAllTets);
        fresh.push_back(next);
        if (set_.tetCount() > limit_) return false;
      }
    }
    return set_.tetCount() <= limit_;
  }

  const Surface& surface_;
  const WindingTree& winding_;
  const LatticeFrame& frame_;
  std::size_t limit_;
  LatticeSet& set_;
  std::vector<char> wasTouched_;            ///< by entry: some of its tets are touched
  std::vector<std::uint16_t> touchedMask_;  ///< by entry
};

}  // namespace

bool fillInside(const Surface& surface, const WindingTree& winding, const LatticeFrame& frame, std::size_t limit,
                LatticeSet& set) {
  return InsideFill(surface, winding, frame, limit, set).run();
}

}  // namespace tetskin::cage_detail
