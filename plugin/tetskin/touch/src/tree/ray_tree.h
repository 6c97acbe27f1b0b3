// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceTree: a tree of triangles, made once at rest and fitted to where their corners are.
#pragma once

#include <tetskin/core/triangle_mesh.h>
#include <tetskin/touch/surface_tree.h>

#include <array>
#include <vector>

namespace tetskin::touch_detail {

/// A part of a line: from `start` on, up to `most` times `along`.
struct Ray {
  Eigen::Vector3d start, along;
  double most = 1.0;
};

struct RayHit {
  int triangle = -1;                 ///< of the mesh; -1: none
  double at = 0.0;                   ///< in units of the ray's `along`
  double second = 0.0, third = 0.0;  ///< weights of these corners
};

class RayTree {
 public:
  using Triangle = std::array<int, 3>;
  using Points = PointView<const btScalar>;

  RayTree() = default;
  /// mesh    with triangles, all of existing vertices
  /// places  by vertex: where `fit` will have it among its points
  RayTree(const TriangleMesh& mesh, const std::vector<std::uint32_t>& places);

  /// The boxes for these points, which must be there for `cast`. Cost O(triangles), no allocation
  void fit(Points points);
  /// The nearest triangle that the filter lets pass, if it is given; of two at one place, the one of lower number.
  RayHit cast(const Ray& ray, const TriangleFilter& filter) const;

  std::size_t triangleCount() const { return triangles_.size(); }

 private:
  struct Node {
    btScalar low[3], high[3];
    int first = 0, last = 0;  ///< triangles
    int right = 0;            ///< second child, 0 in a leaf; the first child is the next node
  };
  struct Search;

  void build(const std::vector<Eigen::Vector3d>& middles, int first, int last);
  void castAtLeaf(const Node& leaf, Search& search) const;

  std::vector<Node> nodes_;
  std::vector<int> order_;           ///< which triangles of the mesh
  std::vector<Triangle> triangles_;  ///< in that order; places of their corners
  Points points_;
};

/// Where a ray meets a triangle, from either side; nothing if it does not, or the triangle has no area.
bool meets(const Ray& ray, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, RayHit& hit);

}  // namespace tetskin::touch_detail
