// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Rays against the visual surface as it is now, and points of it.
#pragma once

#include <tetskin/core/triangle_mesh.h>
#include <tetskin/touch/surface_point.h>

#include <functional>

namespace tetskin {

/// Where a ray meets a surface first. True if it does.
struct SurfaceHit {
  TouchStatus status = TouchStatus::Miss;  ///< Ok for a hit; else why there is none
  const btSoftBody* body = nullptr;        ///< the skin's
  int triangle = -1;                       ///< of the mesh
  btScalar weights[3] = {0, 0, 0};         ///< of its corners, adding up to 1
  btVector3 point{0, 0, 0};                ///< world space, on the drawn triangle
  btVector3 normal{0, 1, 0};               ///< of the drawn triangle, of unit length, whichever side was hit
  btScalar distance = 0;                   ///< from where the ray begins, world units

  /// A hit.
  explicit operator bool() const { return status == TouchStatus::Ok; }
};

/// Which triangles a ray may meet, by their number; empty: all.
using TriangleFilter = std::function<bool(int triangle)>;

/// Pushes all of the surface in a ball, away from its middle: an explosion. What a vertex gets is in proportion to its
/// area at rest and falls to nothing at the radius.
struct SurfaceBlast {
  btVector3 centre{0, 0, 0};  ///< world space
  btScalar radius = 0;        ///< above 0
  btScalar strength = 0;      ///< of all pushes together: an impulse, or a force
};

/// What it came to: the sum of all pushes, and of their moments about the world's origin.
struct SurfacePush {
  TouchStatus status = TouchStatus::Ok;  ///< Miss: nothing of the surface is that near
  btVector3 linear{0, 0, 0};             ///< impulse, or force
  btVector3 angular{0, 0, 0};            ///< its moment about the world's origin
  std::size_t vertices = 0;              ///< that were pushed
};

/// A tree of a mesh's triangles, for rays against any body that carries it.
///
///     tetskin::SurfaceTree tree(skin.binding(), mesh);
///     if (auto hit = tree.raycast(skin, from, to)) auto point = tree.pointAt(body, hit);
///
/// One tree serves all bodies of a binding, one after the other: not several threads at a time. It is fitted when a ray
/// is cast and the body's nodes are not where they were in the cast before: by the nodes, so whether skins are updated,
/// hidden, written elsewhere, or in another order, is all one. Cast all rays for one body, then for the next.
class TETSKIN_TOUCH_API SurfaceTree {
 public:
  /// Not fitted yet: the first ray does that.
  /// binding  not null, of this mesh
  /// mesh     copied as far as it is needed; its triangles name existing vertices: see `check`
  /// Cost     O(n log n) for n triangles
  SurfaceTree(std::shared_ptr<const SoftBodyBinding> binding, const TriangleMesh& mesh);
  ~SurfaceTree();
  SurfaceTree(SurfaceTree&&) noexcept;
  SurfaceTree& operator=(SurfaceTree&&) noexcept;

  /// Ok; or why the tree is empty, and every ray misses: no binding, a mesh without triangles, indices out of range,
  /// another mesh than the binding's, or a tree that was moved from.
  const Status& check() const;

  /// The nearest triangle between two points, from either side.
  /// skin      bound, by the tree's binding; its body must be there, unlike that of an update it may have lost the skin
  /// from, to  world space
  /// Cost      some microseconds; and if the nodes have moved, a skin's update and a fit, less than a millisecond for
  ///           60,000 triangles
  /// Errors    in the hit: Miss, Unbound, OtherBody, TopologyChanged, NonFinite
  SurfaceHit raycast(const SoftBodySkin& skin, const btVector3& from, const btVector3& to,
                     const TriangleFilter& filter = {}) const;

  /// The point that a ray has hit. Errors: InvalidOption for what is no hit, or one of another body, or has weights
  /// that do not add up to 1; SizeMismatch for a body of another cage.
  Result<SurfacePoint> pointAt(btSoftBody& body, const SurfaceHit& hit) const;
  /// A vertex of the mesh; its axes are those of the largest triangle around it, its normal that at rest. Cost
  /// O(triangles). Errors: IndexOutOfRange, also for a vertex without triangles; SizeMismatch
  Result<SurfacePoint> pointOfVertex(btSoftBody& body, int vertex) const;
  /// The point of the rest surface nearest to one in rest space. Cost O(triangles). Errors: NonFinite, SizeMismatch
  Result<SurfacePoint> pointAtRest(btSoftBody& body, const Eigen::Vector3d& rest) const;

  /// Pushes at once, as `SurfacePoint::applyImpulse`, of which it has the errors. Cost O(vertices)
  SurfacePush applyImpulse(btSoftBody& body, const SurfaceBlast& blast) const;
  /// Pushes through the next steps, as `SurfacePoint::applyForce`, by where the surface is now; for a body made by
  /// `makeSoftBody`, others are InvalidOption.
  SurfacePush applyForce(btSoftBody& body, const SurfaceBlast& blast, int steps = 1) const;

 private:
  struct Parts;
  Parts& parts() const;
  std::unique_ptr<Parts> parts_;
};

}  // namespace tetskin
