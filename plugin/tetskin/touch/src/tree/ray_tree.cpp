// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Tomas Möller and Ben Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools 2,
//   1997, doi 10.1080/10867651.1997.10487468
#include <tetskin/touch/src/tree/ray_tree.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tetskin::touch_detail {
namespace {

using Eigen::Vector3d;

/// Few enough that few are tested in vain, many enough that fitting is cheap.
constexpr int kTrianglesInLeaf = 4;
/// Of nodes that wait: one a level, and trees are balanced.
constexpr int kDeepest = 64;
/// A ray that passes between two triangles by rounding meets both.
constexpr double kEdge = 1e-12;

Vector3d toVector(const btScalar* p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

}  // namespace

bool meets(const Ray& ray, const Vector3d& a, const Vector3d& b, const Vector3d& c, RayHit& hit) {
  const Vector3d first = b - a, second = c - a, across = ray.along.cross(second), from = ray.start - a;
  const double volume = first.dot(across);
  if (!(volume * volume > 0.0)) return false;
  const double u = from.dot(across) / volume;
  if (!(u >= -kEdge && u <= 1.0 + kEdge)) return false;
  const Vector3d turned = from.cross(first);
  const double v = ray.along.dot(turned) / volume;
  if (!(v >= -kEdge && u + v <= 1.0 + kEdge)) return false;
  const double at = second.dot(turned) / volume;
  if (!(at >= 0.0 && at <= ray.most)) return false;
  hit.at = at;
  hit.second = u;
  hit.third = v;
  return true;
}

RayTree::RayTree(const TriangleMesh& mesh, const std::vector<std::uint32_t>& places) : order_(mesh.triangleCount()) {
  assert(!mesh.triangles.empty() && places.size() == mesh.vertexCount());
  std::vector<Vector3d> middles;
  middles.reserve(mesh.triangleCount());
  for (const auto& [a, b, c] : mesh.triangles) {
    middles.push_back(mesh.positions[a] + mesh.positions[b] + mesh.positions[c]);
  }
  std::iota(order_.begin(), order_.end(), 0);
  build(middles, 0, static_cast<int>(order_.size()));
  triangles_.reserve(order_.size());
  for (const int t : order_) {
    const auto& corners = mesh.triangles[static_cast<std::size_t>(t)];
    Triangle& placed = triangles_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) placed[k] = static_cast<int>(places[static_cast<std::size_t>(corners[k])]);
  }
}

void RayTree::build(const std::vector<Vector3d>& middles, int first, int last) {
  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  nodes_[index].first = first;
  nodes_[index].last = last;
  if (last - first <= kTrianglesInLeaf) return;
  Box3 box;
  for (int i = first; i < last; ++i) box.extend(middles[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])]);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const int middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](int a, int b) {
    const double x = middles[static_cast<std::size_t>(a)][axis], y = middles[static_cast<std::size_t>(b)][axis];
    return x < y || (x == y && a < b);
  });
  build(middles, first, middle);
  nodes_[index].right = static_cast<int>(nodes_.size());
  build(middles, middle, last);
}

void RayTree::fit(Points points) {
  points_ = points;
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    if (node.right != 0) {
      const Node &left = nodes_[n + 1], &right = nodes_[static_cast<std::size_t>(node.right)];
      for (int k = 0; k < 3; ++k) {
        node.low[k] = std::min(left.low[k], right.low[k]);
        node.high[k] = std::max(left.high[k], right.high[k]);
      }
      continue;
    }
    std::copy_n(points[static_cast<std::size_t>(triangles_[static_cast<std::size_t>(node.first)][0])], 3, node.low);
    std::copy_n(node.low, 3, node.high);
    for (int t = node.first; t < node.last; ++t) {
      for (const int corner : triangles_[static_cast<std::size_t>(t)]) {
        const btScalar* p = points[static_cast<std::size_t>(corner)];
        for (int k = 0; k < 3; ++k) {
          node.low[k] = std::min(node.low[k], p[k]);
          node.high[k] = std::max(node.high[k], p[k]);
        }
      }
    }
  }
}

struct RayTree::Search {
  Ray ray;  ///< cut short by what has been met
  const TriangleFilter& filter;
  Vector3d inverse;
  RayHit best;

  /// Where the ray enters a box; infinite if it passes by.
  double enters(const Node& node) const {
    double in = 0.0, out = ray.most;
    for (int k = 0; k < 3; ++k) {
      const double a = (static_cast<double>(node.low[k]) - ray.start[k]) * inverse[k];
      const double b = (static_cast<double>(node.high[k]) - ray.start[k]) * inverse[k];
      // In this order a ray within a face's plane, of which these are not numbers, is in.
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    }
    constexpr double kRounding = 1.0 + 1e-14;
    return in <= out * kRounding ? in : HUGE_VAL;
  }
};

void RayTree::castAtLeaf(const Node& leaf, Search& search) const {
  for (int t = leaf.first; t < leaf.last; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const auto corner = [&](std::size_t k) { return toVector(points_[static_cast<std::size_t>(triangles_[i][k])]); };
    RayHit hit;
    if (!meets(search.ray, corner(0), corner(1), corner(2), hit)) continue;
    hit.triangle = order_[i];
    const RayHit& best = search.best;
    if (best.triangle >= 0 && hit.at == best.at && hit.triangle > best.triangle) continue;
    if (search.filter && !search.filter(hit.triangle)) continue;
    search.best = hit;
    search.ray.most = hit.at;
  }
}

RayHit RayTree::cast(const Ray& ray, const TriangleFilter& filter) const {
  assert(points_.size() > 0);
  Search search{ray, filter, ray.along.cwiseInverse(), {}};
  struct Waiting {
    int node;
    double enters;
  };
  Waiting stack[kDeepest];
  int count = 0;
  stack[count++] = {0, search.enters(nodes_[0])};
  while (count > 0) {
    const Waiting next = stack[--count];
    if (!(next.enters <= search.ray.most)) continue;
    const Node& node = nodes_[static_cast<std::size_t>(next.node)];
    if (node.right == 0) {
      castAtLeaf(node, search);
      continue;
    }
    const Waiting left{next.node + 1, search.enters(nodes_[static_cast<std::size_t>(next.node) + 1])};
    const Waiting right{node.right, search.enters(nodes_[static_cast<std::size_t>(node.right)])};
    assert(count + 2 <= kDeepest);
    // The nearer one first.
    stack[count++] = left.enters <= right.enters ? right : left;
    stack[count++] = left.enters <= right.enters ? left : right;
  }
  return search.best;
}

}  // namespace tetskin::touch_detail
