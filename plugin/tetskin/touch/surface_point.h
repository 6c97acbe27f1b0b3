// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Points of the visual surface: where they are, and how they are pushed.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/core/embedded_point.h>

#include <array>
#include <memory>
#include <optional>

namespace tetskin {

/// What reading a point, or acting at it, came to.
enum class [[nodiscard]] TouchStatus{
    Ok,
    Miss,             ///< of rays: they meet nothing
    Unbound,          ///< of rays: the skin is not bound
    Gone,             ///< the body is deleted
    Released,         ///< by `release`, or never of any body
    OtherBody,        ///< the skin, or the tree, is of another body or binding
    TopologyChanged,  ///< the body has gained or lost nodes or tets since
    NonFinite,        ///< a node, or what was given, is infinite or not a number
    OutOfWorld,       ///< the body is in no world
    InvalidOption,    ///< nothing for this kind of world or body: see the function
};

/// Name of a status, for messages and logs. Never null.
TETSKIN_TOUCH_API const char* toString(TouchStatus status);

/// A point of a surface with its axes, of unit length and right-handed: for what rides on it. World space.
struct SurfaceFrame {
  btVector3 position{0, 0, 0};   ///< of the point
  btVector3 normal{0, 1, 0};     ///< out of the surface
  btVector3 tangent{1, 0, 0};    ///< along a line of the surface that moves with it: it turns with it, never by itself
  btVector3 bitangent{0, 0, 1};  ///< tangent x bitangent = normal

  /// The same with x along the tangent, y along the normal: where a hat goes that was modelled upright.
  btTransform transform() const;
};

namespace touch_detail {

struct PointData {
  std::array<EmbeddedPoint<btScalar>, 3> corners;
  std::array<btScalar, 3> shares{1, 0, 0};  ///< of the corners
  btVector3 restNormal{0, 0, 1};            ///< in the triangle's own axes: tangent, bitangent, normal
};

}  // namespace touch_detail

/// A point on a triangle of a body's visual surface, by its corners' nodes and weights. A value of some 250 bytes: copy
/// it, keep it as long as the body lives, or longer.
///
/// It is made by a `SurfaceTree`. Points of a body made by `makeSoftBody`, a `DeformableBody`'s among them, know when
/// it is gone, and all functions say so. Of a body that the application has made itself they do not: call `release`
/// before that is deleted.
///
/// Reading works in every world. So do impulses, but for reduced bodies, whose nodes have no velocities of their own.
class TETSKIN_TOUCH_API SurfacePoint {
 public:
  /// Of no body: Released.
  SurfacePoint() = default;
  /// For the library's own use.
  SurfacePoint(btSoftBody& body, const touch_detail::PointData& data);

  /// Ok, Gone, Released, TopologyChanged or NonFinite. Cost: a look at 12 nodes.
  TouchStatus status() const;
  /// Lets the body go; the point is of none from now on.
  void release();

  /// Where a linear surface has it after the last step, world space: the point that is acted at. Nothing unless the
  /// status is Ok.
  std::optional<btVector3> position() const;
  /// Where this skin, of the same body, draws it after `update(alpha)`, whether it is updated, visible or moved by an
  /// origin or not. Nothing if it is of another body.
  /// Cost  a look at 12 nodes; of a quadratic skin at those around them, too
  std::optional<btVector3> position(const SoftBodySkin& skin, btScalar alpha = 1) const;
  /// Of `position()`, world units a second: what it has moved by in the last of Bullet's steps, over its time. It is
  /// that of the two steps kept as well, as points move on a line between them.
  std::optional<btVector3> velocity() const;
  /// The point and its axes, likewise.
  std::optional<SurfaceFrame> frame() const;
  /// As this skin draws them.
  std::optional<SurfaceFrame> frame(const SoftBodySkin& skin, btScalar alpha = 1) const;

  /// Mass that a push feels at the first moment, by the nodes around it alone; 0 if the status is not Ok, infinite
  /// where all of them are pinned.
  btScalar mass() const;

  /// Changes the velocities of the nodes around the point so that the body's linear and angular momentum grow by
  /// exactly this, but for what pinned nodes take. Wakes the body.
  /// impulse  world space, mass times velocity
  /// Errors   InvalidOption for reduced bodies; those of `status`; NonFinite
  TouchStatus applyImpulse(const btVector3& impulse);
  /// The same as a force through the next of Bullet's steps, as part of what they solve for. Wakes the body. For a body
  /// that `makeSoftBody` has not made, the point must live until then.
  /// force   world space; forces add up
  /// steps   of Bullet's, that is substeps, 1 or more
  /// Errors  OutOfWorld; InvalidOption but in a world with a `DeformableSolver`; those of `status`; NonFinite
  TouchStatus applyForce(const btVector3& force, int steps = 1);

  /// Null if it is gone, or released.
  btSoftBody* body() const;
  /// For the library's own use.
  const touch_detail::PointData& data() const { return data_; }

 private:
  btSoftBody* body_ = nullptr;
  bool watched_ = false;            ///< the body tells when it goes
  std::weak_ptr<const void> life_;  ///< of a watched body
  std::shared_ptr<void> forces_;    ///< of a body that is not: what applies them
  int nodeCount_ = 0, tetCount_ = 0;
  touch_detail::PointData data_;
};

}  // namespace tetskin
