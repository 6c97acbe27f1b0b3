// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/outside_neighbours.h>
#include <tetskin/core/tet_geometry.h>

#include <algorithm>
#include <queue>

namespace tetskin {
namespace {

std::int32_t indexOf(std::int32_t tet) {
  return tet >= 0 ? tet : ~tet;
}

bool shareNode(const Tet& a, const Tet& b) {
  return std::any_of(a.begin(), a.end(), [&](int n) { return std::find(b.begin(), b.end(), n) != b.end(); });
}

/// Edges from vertices outside, by the first vertex at a position: entries of the k-th outside vertex.
struct OutsideEdges {
  std::vector<std::uint32_t> vertices;  ///< outside, ascending, one a position
  std::vector<std::uint32_t> starts;
  std::vector<std::uint32_t> ends;
  std::vector<std::uint32_t> placeOf;  ///< by vertex; kInside if it is not outside

  static constexpr std::uint32_t kInside = 0xFFFFFFFFu;

  OutsideEdges(const std::vector<std::uint32_t>& first, const std::vector<std::array<int, 3>>& triangles,
               const std::vector<std::int32_t>& tetOf)
      : placeOf(tetOf.size(), kInside) {
    for (std::uint32_t v = 0; v < tetOf.size(); ++v) {
      if (tetOf[v] >= 0 || first[v] != v) continue;
      placeOf[v] = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back(v);
    }
    std::vector<std::array<std::uint32_t, 2>> pairs;  // of each edge twice, once from either triangle
    for (const auto& t : triangles) {
      for (int k = 0; k < 3; ++k) {
        if (tetOf[static_cast<std::size_t>(t[k])] >= 0) continue;
        const std::uint32_t a = first[static_cast<std::size_t>(t[k])];
        for (int step = 1; step <= 2; ++step) {
          const std::uint32_t b = first[static_cast<std::size_t>(t[(k + step) % 3])];
          if (b != a) pairs.push_back({placeOf[a], b});
        }
      }
    }
    starts.assign(vertices.size() + 1, 0);
    for (const auto& pair : pairs) ++starts[pair[0]];
    std::uint32_t sum = 0;
    for (std::uint32_t& start : starts) start = sum += start;  // now one past each vertex's last
    ends.resize(pairs.size());
    for (std::size_t k = pairs.size(); k-- > 0;) ends[--starts[pairs[k][0]]] = pairs[k][1];
  }
};

/// The tets around each node, made when first asked for: most meshes never need them.
class TetsAroundNodes {
 public:
  explicit TetsAroundNodes(const TetMesh& cage) : cage_(cage) {}

  template <class Visit>
  void around(const Tet& tet, Visit&& visit) {
    if (starts_.empty()) build();
    for (const int n : tet) {
      for (std::uint32_t k = starts_[n]; k < starts_[n + 1]; ++k) visit(tets_[k]);
    }
  }

 private:
  void build() {
    starts_.assign(cage_.nodeCount() + 1, 0);
    for (const Tet& tet : cage_.tets) {
      for (const int n : tet) ++starts_[n + 1];
    }
    for (std::size_t n = 0; n < cage_.nodeCount(); ++n) starts_[n + 1] += starts_[n];
    tets_.resize(4 * cage_.tetCount());
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t t = 0; t < cage_.tetCount(); ++t) {
      for (const int n : cage_.tets[t]) tets_[next[n]++] = t;
    }
  }

  const TetMesh& cage_;
  std::vector<std::uint32_t> starts_, tets_;
};

double distanceFrom(const Eigen::Vector3d& v, const TetCorners& corners) {
  return distanceToTet(v, corners, BarycentricMap(corners)(v));
}

/// One vertex and the tets around it that are connected to its neighbours'.
class LocalSearch {
 public:
  LocalSearch(const TetMesh& cage, TetsAroundNodes& adjacency)
      : cage_(cage), adjacency_(adjacency), visited_(cage.tetCount(), 0) {}

  /// The tet for a vertex that the nearest rule gives to `nearest`, with neighbours in the tets `others`, at most
  /// `reach` away.
  std::int32_t tetFor(const Eigen::Vector3d& v, std::int32_t nearest, const std::vector<std::int32_t>& others,
                      double reach) {
    ++round_;
    std::vector<std::int32_t> open;
    for (const std::int32_t t : others) push(t, open);
    const TetCorners nearestCorners = cornersOf(cage_, cage_.tets[nearest]);
    const double shortest = distanceFrom(v, nearestCorners);
    const double radius = std::max(reach, shortest + tetSize(nearestCorners));
    std::int32_t best = -1;
    double bestDistance = std::numeric_limits<double>::infinity();
    while (!open.empty()) {
      const std::int32_t t = open.back();
      open.pop_back();
      if (t == nearest) return nearest;
      const TetCorners corners = cornersOf(cage_, cage_.tets[t]);
      if (isFlat(corners)) continue;
      const double distance = distanceFrom(v, corners);
      if (distance < bestDistance || (distance == bestDistance && t < best)) {
        bestDistance = distance;
        best = t;
      }
      if (distance > radius) continue;
      adjacency_.around(cage_.tets[t], [&](std::uint32_t next) { push(static_cast<std::int32_t>(next), open); });
    }
    if (best < 0) return nearest;
    return bestDistance <= shortest + tetSize(cornersOf(cage_, cage_.tets[best])) ? best : nearest;
  }

 private:
  void push(std::int32_t tet, std::vector<std::int32_t>& open) {
    if (visited_[tet] == round_) return;
    visited_[tet] = round_;
    open.push_back(tet);
  }

  const TetMesh& cage_;
  TetsAroundNodes& adjacency_;
  std::vector<std::uint32_t> visited_;
  std::uint32_t round_ = 0;
};

}  // namespace

std::size_t keepWithNeighbours(const TetMesh& cage, PointReader vertices, const std::vector<std::uint32_t>& first,
                               const std::vector<std::array<int, 3>>& triangles, std::vector<std::int32_t>& tetOf) {
  assert(first.size() == vertices.size() && tetOf.size() == vertices.size());
  if (std::all_of(tetOf.begin(), tetOf.end(), [](std::int32_t tet) { return tet >= 0; })) return 0;
  const OutsideEdges edges(first, triangles, tetOf);
  TetsAroundNodes adjacency(cage);
  LocalSearch search(cage, adjacency);

  enum class State : char { Untouched, Queued, Settled };
  std::vector<State> state(edges.vertices.size(), State::Untouched);
  std::queue<std::uint32_t> queue;  // places, ring by ring from the inside
  const auto settled = [&](std::uint32_t v) {
    const std::uint32_t place = edges.placeOf[v];
    return place == OutsideEdges::kInside || state[place] == State::Settled;
  };
  for (std::uint32_t place = 0; place < state.size(); ++place) {
    const auto begin = edges.ends.begin() + edges.starts[place], end = edges.ends.begin() + edges.starts[place + 1];
    if (!std::any_of(begin, end, settled)) continue;
    state[place] = State::Queued;
    queue.push(place);
  }

  std::size_t changed = 0;
  std::vector<std::int32_t> others;
  for (; !queue.empty(); queue.pop()) {
    const std::uint32_t place = queue.front(), v = edges.vertices[place];
    const std::int32_t nearest = ~tetOf[v];
    const Eigen::Vector3d point = vertices[v];
    others.clear();
    double reach = 0.0;
    bool local = false;
    for (std::uint32_t k = edges.starts[place]; k < edges.starts[place + 1]; ++k) {
      const std::uint32_t other = edges.ends[k];
      if (settled(other)) {
        others.push_back(indexOf(tetOf[other]));
        reach = std::max(reach, (vertices[other] - point).norm());
        local = local || shareNode(cage.tets[others.back()], cage.tets[nearest]);
      } else if (state[edges.placeOf[other]] == State::Untouched) {
        state[edges.placeOf[other]] = State::Queued;
        queue.push(edges.placeOf[other]);
      }
    }
    state[place] = State::Settled;
    if (local) continue;
    const std::int32_t tet = search.tetFor(point, nearest, others, reach);
    changed += tet != nearest;
    tetOf[v] = ~tet;
  }
  for (std::size_t v = 0; v < first.size(); ++v) {
    if (tetOf[v] < 0) tetOf[v] = tetOf[first[v]];
  }
  return changed;
}

}  // namespace tetskin
