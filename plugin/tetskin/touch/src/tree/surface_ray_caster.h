// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceTree: ray casts against the surface of one body at a time, with a tree that is fitted to it.
#pragma once

#include <tetskin/core/src/base/bvh/bvh.h>
#include <tetskin/touch/src/tree/ray_triangle.h>
#include <tetskin/touch/surface_point.h>

#include <memory>
#include <vector>

namespace tetskin::touch_detail {

class SurfaceRayCaster {
 public:
  SurfaceRayCaster() = default;
  /// The binding and the hierarchy belong together; the caller has checked both.
  SurfaceRayCaster(std::shared_ptr<const SoftBodyBinding> binding, const TriangleMesh& mesh);

  /// Computes the positions that the skin draws, and fits the tree, unless the last call had the same node positions.
  /// Returns Ok, or Unbound, OtherBody, TopologyChanged or NonFinite; then there is nothing to cast against.
  StatusCode fit(const SoftBodySkin& skin);
  /// Call it after `fit` has returned Ok. Returns the nearest triangle that the filter, if any, accepts; of two at the
  /// same distance, the one of lower number. The hit's body is not set.
  SurfaceHit cast(const btVector3& from, const btVector3& to, const TriangleFilter& filter) const;

  /// The hierarchy of the mesh's triangles, independent of the body.
  const Bvh& tree() const { return bvh_; }

 private:
  TriangleCorners cornersAt(int index) const;
  RayHit nearestHit(Ray ray, const TriangleFilter& filter) const;
  void fitBoxes();
  bool isFitted(const btSoftBody& body) const;
  void keepNodes(const btSoftBody& body);

  std::shared_ptr<const SoftBodyBinding> binding_;
  Bvh bvh_;                                    ///< of the triangles
  std::vector<BvhBox<btScalar>> boxes_;        ///< by node, of the last fit
  std::vector<std::array<int, 3>> triangles_;  ///< in the order of the leaves, by their vertices' indices in the skin
  MeshSkin<btScalar> skin_;
  std::vector<btScalar> nodes_;  ///< 3 scalars per node, of the last fit; empty: no fit yet
};

}  // namespace tetskin::touch_detail
