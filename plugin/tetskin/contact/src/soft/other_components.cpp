// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/other_components.h>

#include <algorithm>
#include <cassert>
#include <queue>

namespace tetskin::contact_detail {
namespace {

std::vector<std::vector<int>> neighboursOf(const ShapeData& data) {
  std::vector<std::vector<int>> neighbours(data.nodes.size());
  for (const Tet& tet : data.tets) {
    for (const int a : tet) {
      for (const int b : tet) {
        if (a != b) neighbours[static_cast<std::size_t>(a)].push_back(b);
      }
    }
  }
  for (std::vector<int>& indices : neighbours) {
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  }
  return neighbours;
}

/// Finds the nodes within some distance of a tet, measured along edges.
class NearNodes {
 public:
  explicit NearNodes(const ShapeData& data)
      : data_(data), neighbours_(neighboursOf(data)), direction_(data.nodes.size(), BT_LARGE_FLOAT) {}

  void find(const Tet& from, btScalar farthest) {
    assert(open_.empty() && farthest >= 0);
    for (const int n : reached_) direction_[static_cast<std::size_t>(n)] = BT_LARGE_FLOAT;
    reached_.clear();
    for (const int n : from) reach(n, 0);
    while (!open_.empty()) {
      const auto [direction, node] = open_.top();
      open_.pop();
      if (direction > direction_[static_cast<std::size_t>(node)]) continue;
      const btVector3& at = data_.nodes[static_cast<std::size_t>(node)];
      for (const int n : neighbours_[static_cast<std::size_t>(node)]) {
        const btScalar farther = direction + (data_.nodes[static_cast<std::size_t>(n)] - at).length();
        if (farther <= farthest) reach(n, farther);
      }
    }
  }
  bool hold(int node) const { return direction_[static_cast<std::size_t>(node)] < BT_LARGE_FLOAT; }

 private:
  void reach(int node, btScalar direction) {
    btScalar& known = direction_[static_cast<std::size_t>(node)];
    if (direction >= known) return;
    if (known == BT_LARGE_FLOAT) reached_.push_back(node);
    known = direction;
    open_.emplace(direction, node);
  }

  using Open = std::pair<btScalar, int>;
  const ShapeData& data_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<btScalar> direction_;  ///< shortest path by node
  std::vector<int> reached_;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
};

}  // namespace

std::vector<std::vector<int>> tetsOfOtherComponents(const ShapeData& data) {
  assert(data.centroids.size() == data.tets.size() && data.edge > 0);
  std::vector<int> alongX(data.tets.size());
  for (std::size_t t = 0; t < alongX.size(); ++t) alongX[t] = static_cast<int>(t);
  const auto centroidOf = [&](int tet) -> const btVector3& { return data.centroids[static_cast<std::size_t>(tet)]; };
  std::sort(alongX.begin(), alongX.end(), [&](int a, int b) { return centroidOf(a).x() < centroidOf(b).x(); });
  const btScalar apart = kEdgesApart * data.edge;
  NearNodes near(data);
  std::vector<std::vector<int>> others(data.runs.size());
  for (std::size_t r = 0; r < data.runs.size(); ++r) {
    const btVector3& centroid = centroidOf(data.runs[r].tet);
    near.find(data.tets[static_cast<std::size_t>(data.runs[r].tet)], kEdgesAlong * data.edge);
    auto at = std::lower_bound(alongX.begin(), alongX.end(), centroid.x() - apart,
                               [&](int tet, btScalar x) { return centroidOf(tet).x() < x; });
    for (; at != alongX.end() && centroidOf(*at).x() <= centroid.x() + apart; ++at) {
      if ((centroidOf(*at) - centroid).length2() >= apart * apart) continue;
      const Tet& nodes = data.tets[static_cast<std::size_t>(*at)];
      const bool reached = std::any_of(nodes.begin(), nodes.end(), [&](int n) { return near.hold(n); });
      if (!reached) others[r].push_back(*at);
    }
    std::sort(others[r].begin(), others[r].end());
  }
  return others;
}

}  // namespace tetskin::contact_detail
