// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/surface/surface.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tetskin::cage_detail {

/// A tree of boxes over some triangles of a surface, for the few of them that a straight way may cross.
class TriangleTree {
 public:
  /// triangles  numbers of `count` of them, at least one
  /// slack      how far a way may pass by a triangle and still be told of it: more than rounding makes of what crosses
  /// Cost O(n log n)
  TriangleTree(const Surface& surface, const std::uint32_t* triangles, std::size_t count, double slack);

  /// Calls visit(k, most) for all triangles, by their place in the list, that `from + share * way` crosses at a share
  /// between 0 and `most`, and some nearby, in no order that means anything. `most` is 1 at first, and `visit` may
  /// lower it. Cost about O(log n) and what is visited.
  template <class Visit>
  void along(const Eigen::Vector3d& from, const Eigen::Vector3d& way, Visit&& visit) const {
    Ray ray{from, way.cwiseInverse()};
    walk(0, ray, visit);
  }

 private:
  struct Node {
    Box3 box;                 ///< with the slack
    int first = 0, last = 0;  ///< in `order_`
    int right = 0;            ///< second child, 0 in a leaf; the first child is the next node
  };
  struct Ray {
    Eigen::Vector3d from, inverse;
    double most = 1.0;
  };

  void build(const std::vector<Box3>& boxes, double slack, int first, int last);

  static bool meets(const Ray& ray, const Box3& box) {
    double in = 0.0, out = ray.most;
    for (int k = 0; k < 3; ++k) {
      const double a = (box.min()[k] - ray.from[k]) * ray.inverse[k], b = (box.max()[k] - ray.from[k]) * ray.inverse[k];
      // In this order a ray within a face's plane, of which these are not numbers, is in.
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    }
    return in <= out;
  }

  template <class Visit>
  void walk(int index, Ray& ray, Visit& visit) const {
    const Node& node = nodes_[index];
    if (!meets(ray, node.box)) return;
    if (node.right == 0) {
      for (int k = node.first; k < node.last; ++k) visit(static_cast<std::size_t>(order_[k]), ray.most);
      return;
    }
    walk(index + 1, ray, visit);
    walk(node.right, ray, visit);
  }

  std::vector<Node> nodes_;
  std::vector<int> order_;  ///< places in the list, in the order of the leaves
};

}  // namespace tetskin::cage_detail
