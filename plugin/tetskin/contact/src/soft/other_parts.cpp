// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/other_parts.h>

#include <algorithm>
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
  for (std::vector<int>& of : neighbours) {
    std::sort(of.begin(), of.end());
    of.erase(std::unique(of.begin(), of.end()), of.end());
  }
  return neighbours;
}

/// Which nodes are so near to a tet along edges.
class NearNodes {
 public:
  explicit NearNodes(const ShapeData& data)
      : data_(data), neighbours_(neighboursOf(data)), way_(data.nodes.size(), BT_LARGE_FLOAT) {}

  void find(const Tet& from, btScalar farthest) {
    for (const int n : reached_) way_[static_cast<std::size_t>(n)] = BT_LARGE_FLOAT;
    reached_.clear();
    for (const int n : from) reach(n, 0);
    while (!open_.empty()) {
      const auto [way, node] = open_.top();
      open_.pop();
      if (way > way_[static_cast<std::size_t>(node)]) continue;
      const btVector3& at = data_.nodes[static_cast<std::size_t>(node)];
      for (const int n : neighbours_[static_cast<std::size_t>(node)]) {
        const btScalar farther = way + (data_.nodes[static_cast<std::size_t>(n)] - at).length();
        if (farther <= farthest) reach(n, farther);
      }
    }
  }
  bool hold(int node) const { return way_[static_cast<std::size_t>(node)] < BT_LARGE_FLOAT; }

 private:
  void reach(int node, btScalar way) {
    btScalar& known = way_[static_cast<std::size_t>(node)];
    if (way >= known) return;
    if (known == BT_LARGE_FLOAT) reached_.push_back(node);
    known = way;
    open_.emplace(way, node);
  }

  using Open = std::pair<btScalar, int>;
  const ShapeData& data_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<btScalar> way_;  ///< by node
  std::vector<int> reached_;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
};

}  // namespace

std::vector<std::vector<int>> tetsOfOtherParts(const ShapeData& data) {
  std::vector<int> alongX(data.tets.size());
  for (std::size_t t = 0; t < alongX.size(); ++t) alongX[t] = static_cast<int>(t);
  const auto middleOf = [&](int tet) -> const btVector3& { return data.middles[static_cast<std::size_t>(tet)]; };
  std::sort(alongX.begin(), alongX.end(), [&](int a, int b) { return middleOf(a).x() < middleOf(b).x(); });
  const btScalar apart = kEdgesApart * data.edge;
  NearNodes near(data);
  std::vector<std::vector<int>> others(data.runs.size());
  for (std::size_t r = 0; r < data.runs.size(); ++r) {
    const btVector3& middle = middleOf(data.runs[r].tet);
    near.find(data.tets[static_cast<std::size_t>(data.runs[r].tet)], kEdgesAlong * data.edge);
    auto at = std::lower_bound(alongX.begin(), alongX.end(), middle.x() - apart,
                               [&](int tet, btScalar x) { return middleOf(tet).x() < x; });
    for (; at != alongX.end() && middleOf(*at).x() <= middle.x() + apart; ++at) {
      if ((middleOf(*at) - middle).length2() >= apart * apart) continue;
      const Tet& nodes = data.tets[static_cast<std::size_t>(*at)];
      const bool reached = std::any_of(nodes.begin(), nodes.end(), [&](int n) { return near.hold(n); });
      if (!reached) others[r].push_back(*at);
    }
    std::sort(others[r].begin(), others[r].end());
  }
  return others;
}

}  // namespace tetskin::contact_detail
