// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceTree: rays against the surface of one body at a time, by a tree that is fitted to it.
#pragma once

#include <tetskin/core/src/shared/bvh/bvh.h>
#include <tetskin/touch/src/tree/ray_triangle.h>
#include <tetskin/touch/surface_tree.h>

#include <memory>
#include <vector>

namespace tetskin::touch_detail {

class SurfaceRayCaster {
 public:
  SurfaceRayCaster() = default;
  /// Of each other; both good.
  SurfaceRayCaster(std::shared_ptr<const SoftBodyBinding> binding, const TriangleMesh& mesh);

  /// Computes what the skin draws, and the tree, unless the last one had the same nodes. Ok, or Unbound, OtherBody,
  /// TopologyChanged, NonFinite: then there is nothing to cast against.
  TouchStatus fit(const SoftBodySkin& skin);
  /// After `fit` has returned Ok: the nearest triangle that the filter lets pass, if it is given; of two at one place,
  /// the one of lower number. The hit has no body yet.
  SurfaceHit cast(const btVector3& from, const btVector3& to, const TriangleFilter& filter) const;

 private:
  TriangleCorners cornersAt(int index) const;
  RayHit nearestHit(Ray ray, const TriangleFilter& filter) const;
  void fitBoxes();
  bool isFitted(const btSoftBody& body) const;
  void keepNodes(const btSoftBody& body);

  std::shared_ptr<const SoftBodyBinding> binding_;
  Bvh bvh_;                                    ///< of the triangles
  std::vector<BvhBox<btScalar>> boxes_;        ///< by node, of the last fit
  std::vector<std::array<int, 3>> triangles_;  ///< in the order of the leaves, by their vertices' places in the skin
  MeshSkin<btScalar> skin_;
  std::vector<btScalar> nodes_;  ///< 3 a node, of the last fit; empty: none
};

}  // namespace tetskin::touch_detail
