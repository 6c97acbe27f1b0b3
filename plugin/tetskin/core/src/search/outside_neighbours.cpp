// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/tets_around_nodes.h>
#include <tetskin/core/src/search/outside_neighbours.h>
#include <tetskin/core/src/search/tolerances.h>

#include <algorithm>
#include <cassert>
#include <queue>
#include <tuple>

namespace tetskin {
namespace {

std::int32_t indexOf(std::int32_t tet) {
  return tet >= 0 ? tet : ~tet;
}

/// Edges from vertices outside, by the first vertex at a position.
struct OutsideEdges {
  std::vector<std::uint32_t> vertices;  ///< vertices outside, ascending, one per position
  Lists<> ends;  ///< by index in `vertices`: the other ends of its edges, each from either triangle
  std::vector<std::uint32_t> indexOf;  ///< by vertex: its index in `vertices`; kInside if it is not outside

  /// Not an index of a vertex outside.
  static constexpr std::uint32_t kInside = 0xFFFFFFFFu;

  OutsideEdges(const std::vector<std::uint32_t>& first, const std::vector<std::array<int, 3>>& triangles,
               const std::vector<std::int32_t>& tetOf)
      : indexOf(tetOf.size(), kInside) {
    for (std::uint32_t v = 0; v < tetOf.size(); ++v) {
      if (tetOf[v] >= 0 || first[v] != v) continue;
      indexOf[v] = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back(v);
    }
    ends = packLists(vertices.size(), [&](auto&& add) {
      for (const auto& t : triangles) {
        for (int k = 0; k < 3; ++k) {
          if (tetOf[static_cast<std::size_t>(t[k])] >= 0) continue;
          const std::uint32_t a = first[static_cast<std::size_t>(t[k])];
          for (int step = 1; step <= 2; ++step) {
            const std::uint32_t b = first[static_cast<std::size_t>(t[(k + step) % 3])];
            if (b != a) add(indexOf[a], b);
          }
        }
      }
    });
  }
};

/// A tet near a vertex, with the vertex's weights in it.
struct Seen {
  std::int32_t tet;
  double size;
  double distance;
  double weight;  ///< largest absolute weight
};

/// One vertex, and the tets around it that are connected to its neighbours'.
class LocalSearch {
 public:
  explicit LocalSearch(const TetMesh& cage) : cage_(cage), visited_(cage.tetCount(), 0) {}

  /// The tet for a vertex to which the nearest rule gives `nearest`, with neighbours in the tets `others`, at most
  /// `reach` away.
  std::int32_t tetFor(const Eigen::Vector3d& v, std::int32_t nearest, const std::vector<std::int32_t>& others,
                      double reach) {
    assert(nearest >= 0 && static_cast<std::size_t>(nearest) < cage_.tetCount() && reach >= 0.0);
    const Seen theirs = look(v, cornersOf(cage_, cage_.tets[nearest]), nearest);
    if (connects(v, nearest, others, std::max(reach, theirs.distance + theirs.size)) || seen_.empty()) return nearest;
    const Seen own = *std::min_element(seen_.begin(), seen_.end(), [](const Seen& a, const Seen& b) {
      return std::tie(a.distance, a.tet) < std::tie(b.distance, b.tet);
    });
    if (own.distance > theirs.distance + own.size) return nearest;
    if (own.weight <= kMaxWeight) return own.tet;
    const Seen rescuer = minWeightWithin(own.distance + reassignmentReach());
    return rescuer.weight <= kMaxWeight * std::max(1.0, theirs.weight) ? rescuer.tet : nearest;
  }

 private:
  static Seen look(const Eigen::Vector3d& v, const TetCorners& corners, std::int32_t tet) {
    const Eigen::Vector4d weights = BarycentricMap(corners)(v);
    return {tet, tetSize(corners), distanceToTet(v, corners, weights), largestWeight(weights)};
  }

  /// Visits the tets that are connected to `others` within a radius. Returns true if `nearest` is among them; if not,
  /// all of them are in `seen_`.
  bool connects(const Eigen::Vector3d& v, std::int32_t nearest, const std::vector<std::int32_t>& others,
                double radius) {
    ++round_;
    seen_.clear();
    open_.clear();
    for (const std::int32_t t : others) push(t);
    while (!open_.empty()) {
      const std::int32_t t = open_.back();
      open_.pop_back();
      if (t == nearest) return true;
      const TetCorners corners = cornersOf(cage_, cage_.tets[t]);
      if (isFlat(corners)) continue;
      seen_.push_back(look(v, corners, t));
      if (seen_.back().distance > radius) continue;
      pushAround(cage_.tets[t]);
    }
    return false;
  }

  Seen minWeightWithin(double distance) const {
    Seen least{-1, 0.0, 0.0, std::numeric_limits<double>::infinity()};
    for (const Seen& s : seen_) {
      if (s.distance <= distance && std::tie(s.weight, s.tet) < std::tie(least.weight, least.tet)) least = s;
    }
    return least;
  }

  /// Computed at the first call, like the tets around nodes.
  double reassignmentReach() {
    if (meanEdge_ == 0.0) meanEdge_ = meanEdge(cage_);
    return meanEdge_;
  }

  void pushAround(const Tet& tet) {
    if (tetsAround_.starts.empty()) tetsAround_ = tetsAroundNodes(cage_);
    for (const int n : tet) {
      for (std::uint32_t k = tetsAround_.starts[n]; k < tetsAround_.starts[n + 1]; ++k) {
        push(static_cast<std::int32_t>(tetsAround_.values[k]));
      }
    }
  }

  void push(std::int32_t tet) {
    assert(tet >= 0 && static_cast<std::size_t>(tet) < visited_.size());
    if (visited_[tet] == round_) return;
    visited_[tet] = round_;
    open_.push_back(tet);
  }

  const TetMesh& cage_;
  Lists<> tetsAround_;  ///< by node; computed when first needed: most meshes never need it
  double meanEdge_ = 0.0;
  std::vector<std::uint32_t> visited_;
  std::uint32_t round_ = 0;
  std::vector<std::int32_t> open_;
  std::vector<Seen> seen_;
};

/// Visits the vertices outside, ring by ring.
class Walk {
 public:
  Walk(const TetMesh& cage, PointReader vertices, const std::vector<std::uint32_t>& first,
       const std::vector<std::array<int, 3>>& triangles, std::vector<std::int32_t>& tetOf)
      : cage_(cage),
        vertices_(vertices),
        tetOf_(tetOf),
        edges_(first, triangles, tetOf),
        search_(cage),
        state_(edges_.vertices.size(), State::Untouched) {}

  /// Proceeds outwards from the settled vertices to all that are connected. Returns how many vertices changed their
  /// tet.
  std::size_t run() {
    for (std::uint32_t index = 0; index < state_.size(); ++index) {
      if (state_[index] != State::Untouched) continue;
      const auto begin = edges_.ends.values.begin() + edges_.ends.starts[index],
                 end = edges_.ends.values.begin() + edges_.ends.starts[index + 1];
      if (std::any_of(begin, end, [&](std::uint32_t v) { return settled(v); })) push(index);
    }
    std::size_t changed = 0;
    for (; !queue_.empty(); queue_.pop()) changed += settle(queue_.front());
    return changed;
  }

  /// Settles the vertices that no run has reached with their present tets, except for some of them.
  void settleAllBut(const std::vector<bool>& excepted) {
    assert(excepted.size() == tetOf_.size());
    for (std::size_t index = 0; index < state_.size(); ++index) {
      if (state_[index] == State::Untouched && !excepted[edges_.vertices[index]]) state_[index] = State::Settled;
    }
  }

 private:
  enum class State : char { Untouched, Queued, Settled };

  bool settled(std::uint32_t v) const {
    const std::uint32_t index = edges_.indexOf[v];
    return index == OutsideEdges::kInside || state_[index] == State::Settled;
  }
  void push(std::uint32_t index) {
    state_[index] = State::Queued;
    queue_.push(index);
  }

  /// Returns true if the vertex changes its tet.
  bool settle(std::uint32_t index) {
    const std::uint32_t v = edges_.vertices[index];
    assert(tetOf_[v] < 0 && state_[index] != State::Settled);
    const std::int32_t nearest = ~tetOf_[v];
    const Eigen::Vector3d point = vertices_[v];
    others_.clear();
    double reach = 0.0;
    bool local = false;
    for (std::uint32_t k = edges_.ends.starts[index]; k < edges_.ends.starts[index + 1]; ++k) {
      const std::uint32_t other = edges_.ends.values[k];
      if (settled(other)) {
        others_.push_back(indexOf(tetOf_[other]));
        reach = std::max(reach, (vertices_[other] - point).norm());
        local = local || shareNode(cage_.tets[others_.back()], cage_.tets[nearest]);
      } else if (state_[edges_.indexOf[other]] == State::Untouched) {
        push(edges_.indexOf[other]);
      }
    }
    state_[index] = State::Settled;
    if (local) return false;
    const std::int32_t tet = search_.tetFor(point, nearest, others_, reach);
    tetOf_[v] = ~tet;
    return tet != nearest;
  }

  const TetMesh& cage_;
  PointReader vertices_;
  std::vector<std::int32_t>& tetOf_;
  OutsideEdges edges_;
  LocalSearch search_;
  std::vector<State> state_;          ///< by index in `vertices`
  std::queue<std::uint32_t> queue_;   ///< indices in `vertices`
  std::vector<std::int32_t> others_;  ///< scratch memory
};

}  // namespace

std::size_t reassignByConnectivity(const TetMesh& cage, PointReader vertices, const std::vector<std::uint32_t>& first,
                                   const std::vector<std::array<int, 3>>& triangles,
                                   const std::vector<bool>& reassigned, std::vector<std::int32_t>& tetOf) {
  assert(first.size() == vertices.size() && tetOf.size() == vertices.size());
  assert(reassigned.empty() || reassigned.size() == vertices.size());
  if (std::all_of(tetOf.begin(), tetOf.end(), [](std::int32_t tet) { return tet >= 0; })) return 0;
  Walk walk(cage, vertices, first, triangles, tetOf);
  std::size_t changed = walk.run();
  if (!reassigned.empty()) {
    walk.settleAllBut(reassigned);
    changed += walk.run();
  }
  for (std::size_t v = 0; v < first.size(); ++v) {
    if (tetOf[v] < 0) tetOf[v] = tetOf[first[v]];
  }
  return changed;
}

}  // namespace tetskin
