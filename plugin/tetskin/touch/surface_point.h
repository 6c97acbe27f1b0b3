// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Points of the visual surface: their positions, pushing them, and finding them by ray casts.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/mesh.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>

namespace tetskin {

/// A surface point with right-handed unit axes, world space: for objects attached to the surface.
struct SurfaceFrame {
  btVector3 position{0, 0, 0};   ///< of the point
  btVector3 normal{0, 1, 0};     ///< outward normal of the surface
  btVector3 tangent{1, 0, 0};    ///< along a material line of the surface: rotates only with the surface
  btVector3 bitangent{0, 0, 1};  ///< tangent x bitangent = normal

  /// As a transform with x along the tangent and y along the normal, for instance to place a hat that was modelled
  /// upright.
  btTransform transform() const;
};

/// A point on a triangle of a body's visual surface, stored as the nodes and weights of the triangle's corners. A value
/// of some 250 bytes: it can be copied, and may outlive the body.
///
/// Created by a `SurfaceTree`. Points of a body from `createSoftBody`, including that of a `DeformableBody`, detect its
/// deletion, and all functions report it. This is not possible for a body that the application has created itself: call
/// `release` before deleting it.
///
/// Reading works in every world. So do impulses, except for reduced bodies, whose nodes have no velocities of their
/// own.
class TETSKIN_TOUCH_API SurfacePoint {
 public:
  /// A point of no body: its status is Released.
  SurfacePoint() = default;

  /// Ok, BodyDeleted, Released, TopologyChanged or NonFinite. Cost: 12 nodes are read.
  StatusCode status() const;
  /// Detaches the point from the body: its status is Released from now on.
  void release();

  /// Position of the point on the linear surface after the last step, world space: the point where impulses and forces
  /// act. Empty unless the status is Ok.
  std::optional<btVector3> position() const;
  /// Position of the point as a skin of the same body draws it after `update(alpha)`, world space (the skin's origin is
  /// not subtracted), whether or not the skin is updated or visible. Empty if the skin is of another body, or unless
  /// the status is Ok.
  /// Cost  12 nodes are read; for a quadratic skin, those around them as well
  std::optional<btVector3> position(const SoftBodySkin& skin, btScalar alpha = 1) const;
  /// Velocity of `position()`, world length per second: its displacement in the last of Bullet's steps, divided by the
  /// step's time. It is also the velocity between two recorded steps, because points are interpolated linearly. Empty
  /// unless the status is Ok.
  std::optional<btVector3> velocity() const;
  /// The point on the linear surface and its axes after the last step, world space. Empty unless the status is Ok.
  std::optional<SurfaceFrame> frame() const;
  /// The point and its axes as a skin of the same body draws them after `update(alpha)`, world space. Empty if the skin
  /// is of another body, or unless the status is Ok.
  std::optional<SurfaceFrame> frame(const SoftBodySkin& skin, btScalar alpha = 1) const;

  /// Effective mass against an impulse at the point, from the surrounding nodes alone; 0 if the status is not Ok,
  /// infinite if all of them are pinned.
  btScalar effectiveMass() const;

  /// Applies an impulse: changes the velocities of the surrounding nodes so that the body's linear and angular momentum
  /// grow by exactly the impulse and its moment, except for the part that pinned nodes absorb. Wakes the body.
  /// impulse  world space, mass times velocity
  /// Errors   InvalidOption for reduced bodies; those of `status`; NonFinite
  StatusCode applyImpulse(const btVector3& impulse);
  /// Applies a force during Bullet's next `steps` steps, as part of their solve. Wakes the body.
  /// force   world space, mass times length / s^2; forces add up
  /// steps   number of Bullet's steps, that is substeps, 1 or more
  /// Errors  NotInWorld; InvalidOption in a world without a `DeformableSolver`, or for steps below 1; those of
  ///         `status`; NonFinite
  StatusCode applyForce(const btVector3& force, int steps = 1);

  /// The body, not owned; null if it was deleted, or the point released.
  btSoftBody* body() const;

 private:
  friend struct Access<SurfacePoint>;
  /// The triangle that the point lies on.
  struct Data {
    std::array<EmbeddedPoint<btScalar>, 3> corners;
    std::array<btScalar, 3> weights{1, 0, 0};  ///< of the corners, sum 1
    btVector3 restNormal{0, 0, 1};             ///< in the triangle's own axes: tangent, bitangent, normal
  };
  SurfacePoint(btSoftBody& body, const Data& data);

  btSoftBody* body_ = nullptr;
  bool watched_ = false;            ///< the body reports its deletion
  std::weak_ptr<const void> life_;  ///< lifetime of a watched body
  int nodeCount_ = 0, tetCount_ = 0;
  Data data_;
};

/// The first intersection of a ray with a surface. Converts to true for a hit.
struct SurfaceHit {
  StatusCode status = StatusCode::NoHit;  ///< Ok for a hit; otherwise why there is none
  const btSoftBody* body = nullptr;       ///< the skin's body
  int triangle = -1;                      ///< index of the triangle in the mesh
  btScalar weights[3] = {0, 0, 0};        ///< barycentric weights of its corners, sum 1
  btVector3 point{0, 0, 0};               ///< world space, on the drawn triangle
  btVector3 normal{0, 1, 0};              ///< of the drawn triangle, unit length, whichever side was hit
  btScalar distance = 0;                  ///< from the start of the ray, world length

  /// True for a hit.
  explicit operator bool() const { return status == StatusCode::Ok; }
};

/// Selects the triangles that a ray may hit, by their index; empty: all.
using TriangleFilter = std::function<bool(int triangle)>;

/// A radial impulse on all of the surface in a ball, directed away from its centre: an explosion. A vertex's share is
/// proportional to its area at rest, and falls to zero at the radius.
struct RadialImpulse {
  btVector3 centre{0, 0, 0};  ///< world space
  btScalar radius = 0;        ///< world length, above 0
  btScalar strength = 0;      ///< sum of the magnitudes at all vertices: an impulse, or a force
};

/// Result of a radial impulse: sums over all vertices.
struct ImpulseResult {
  StatusCode status = StatusCode::Ok;  ///< NoHit: no vertex of the surface is within the radius
  btVector3 linear{0, 0, 0};           ///< total impulse, or force, world space
  btVector3 angular{0, 0, 0};          ///< its moment about the world's origin
  std::size_t vertices = 0;            ///< number of vertices pushed
};

/// A tree of a mesh's triangles, for ray casts against any body that carries the mesh.
///
///     auto tree = tetskin::SurfaceTree::create(skin.binding(), mesh).value();
///     if (auto hit = tree.raycast(skin, from, to)) auto point = tree.pointAt(body, hit);
///
/// One tree serves all bodies of a binding, one after the other; it must not be used by several threads at a time. A
/// ray cast refits it if the body's nodes have moved since the previous cast. It uses the nodes, so it does not matter
/// whether skins are updated, hidden, written to other buffers, or in another order. Cast all rays for one body, then
/// for the next.
class TETSKIN_TOUCH_API SurfaceTree {
 public:
  /// Creates a tree of a mesh's triangles. The first ray cast fits it.
  /// binding  of this mesh; shared
  /// mesh     the necessary parts are copied
  /// Cost     O(n log n) for n triangles
  /// Errors   Empty without a binding or triangles; SizeMismatch for another mesh than the binding's; those of
  ///          `validate`
  static Result<SurfaceTree> create(std::shared_ptr<const SoftBodyBinding> binding, const TriangleMesh& mesh);
  ~SurfaceTree();
  SurfaceTree(SurfaceTree&&) noexcept;
  SurfaceTree& operator=(SurfaceTree&&) noexcept;

  /// The first triangle between two points, hit from either side.
  /// skin      bound with the tree's binding; its body must exist, even if the skin is no longer updated
  /// from, to  world space
  /// filter    triangles that may be hit; empty: all
  /// Cost      some microseconds; if the nodes have moved, also a skin's update and a refit: less than a millisecond
  ///           for 60,000 triangles
  /// Errors    in the hit: NoHit, Unbound, OtherBody, TopologyChanged, NonFinite
  SurfaceHit raycast(const SoftBodySkin& skin, const btVector3& from, const btVector3& to,
                     const TriangleFilter& filter = {}) const;

  /// The surface point at a ray's hit.
  /// Errors: InvalidOption for a result that is not a hit, is of another body, or has weights that do not add up to 1;
  /// SizeMismatch for a body of another cage; Empty if the tree was moved from.
  Result<SurfacePoint> pointAt(btSoftBody& body, const SurfaceHit& hit) const;
  /// The surface point at a vertex of the mesh; its axes are those of the largest triangle around it, its normal is the
  /// vertex's at rest. Cost O(1).
  /// Errors: IndexOutOfRange, also for a vertex without triangles; SizeMismatch for a body of another cage; Empty if
  /// the tree was moved from.
  Result<SurfacePoint> pointAtVertex(btSoftBody& body, int vertex) const;
  /// The point of the rest surface nearest to a position in rest space; if several are equally near, the one on the
  /// triangle of the lowest number. Cost about O(log n) for n triangles; O(n) in the first call.
  /// Errors: NonFinite; SizeMismatch for a body of another cage; Empty if the tree was moved from.
  Result<SurfacePoint> pointAtRest(btSoftBody& body, const Eigen::Vector3d& rest) const;

  /// Applies a radial impulse at once, to the current surface; wakes the body as `SurfacePoint::applyImpulse` does.
  /// Cost O(vertices).
  /// Errors: in the result: NoHit, OtherBody for a body of another cage, InvalidOption for a radius not above 0, and
  /// those of `SurfacePoint::applyImpulse`.
  ImpulseResult applyImpulse(btSoftBody& body, const RadialImpulse& impulse) const;
  /// Applies a radial force during the next steps, as `SurfacePoint::applyForce` does, to the current surface. Cost
  /// O(vertices).
  /// Errors: in the result: NoHit, OtherBody for a body of another cage, and those of `SurfacePoint::applyForce`;
  /// InvalidOption for a radius not above 0.
  ImpulseResult applyForce(btSoftBody& body, const RadialImpulse& force, int steps = 1) const;

 private:
  struct Impl;
  explicit SurfaceTree(std::unique_ptr<Impl> impl);
  Impl& impl() const;
  std::unique_ptr<Impl> impl_;  ///< null: moved from
};

}  // namespace tetskin
