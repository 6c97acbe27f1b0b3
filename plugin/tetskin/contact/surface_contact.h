// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Contact of soft bodies with rigid ones at the visual surface.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/soft_body_skin.h>

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace tetskin {

/// Options of contact with rigid bodies.
struct SurfaceContactOptions {
  /// Distance kept between the surface and rigid bodies, world length, 0 or more; not given: 0.2 % of the body's size
  /// (largest side of its box).
  std::optional<double> margin;
  /// A `sampleSpacing`: only vertices collide, so objects smaller than the triangles may pass between them.
  static constexpr double kNoSamples = std::numeric_limits<double>::infinity();
  /// Spacing of samples, in rest units, above 0: triangles with longer edges get samples at most this far apart, which
  /// collide like vertices. At most 10,000,000 samples. Not given: triangles with edges longer than a quarter of the
  /// mean edge of the tets that carry their corners get samples at most an eighth of it apart, so that nothing half as
  /// large as such a tet passes through the surface.
  std::optional<double> sampleSpacing;
};

/// A surface point in contact with a rigid body, or so near that it may come into contact within the substep.
struct SurfaceContactPoint {
  btVector3 point;   ///< on the surface, world space, at the last collision detection
  btVector3 normal;  ///< unit length, world space, away from the rigid body
  btScalar distance =
      0;  ///< world length at the beginning of the substep, minus the margin; negative: closer than the margin
  const btCollisionObject* object = nullptr;  ///< the rigid body, or the link of a multibody
  /// Impulse on the soft body in that substep (force times seconds, world space); the object gets the opposite. 0 if
  /// there was no contact force.
  btVector3 impulse;
};

/// Contact of a soft body with rigid ones at its visual surface, instead of at the nodes of its cage, which lie outside
/// of it. The constrained points are points of the surface: the `DeformableSolver` solves normal and friction forces
/// simultaneously with the rigid bodies, so that action and reaction have the same point of application.
///
/// Needs only a deformable world with a `DeformableSolver`: the body collides with static, kinematic and dynamic bodies
/// and links of multibodies, in whatever order they were added, as groups, masks, the world's overlap filter callback,
/// setIgnoreCollisionCheck, CF_NO_CONTACT_RESPONSE of either and the body's `m_cfg.collisions` (any of RVSmask) allow,
/// evaluated in each step. If they forbid a pair at the time its boxes begin to overlap, Bullet does not see it until
/// the world's refreshBroadphaseProxy. A world's contactTest reports nothing for the body, and leaves its contacts
/// unchanged.
///
/// Planes, boxes, spheres, capsules and cylinders are exact. Convex hulls collide with their faces as drawn, without
/// their margin; other convex shapes by Bullet's GJK. Meshes and other concave shapes collide on the side from which
/// their triangles are counter-clockwise; a negative scaling mirrors that side. Height fields collide on the side of
/// their up axis, whatever their winding; compounds through their children. Friction is Bullet's. Contact uses the
/// surface of linear skinning: a quadratic skin is drawn up to some thousandths of the body's size away from it, more
/// with few tets and under loads.
///
/// Lifetime  Contact ends when this object is destroyed: the body then collides with rigid bodies at its nodes again,
///           as it does in a world with another dispatcher. This object, the body, the world, rigid bodies and their
///           shapes may be destroyed in any order that Bullet allows, also at the end of the program, by destructors of
///           globals.
/// Cost      per substep: O(nodes) for all obstacles whose boxes overlap the body's; for each obstacle nearby,
///           O(vertices near it), plus the samples where it is both near and curved (over something flat, a triangle's
///           corners are enough). Children of a compound are found by its tree. If more than four points of a tet, or
///           samples of a triangle, touch a shape, four are solved for, plus those that are 2 % of the body's size
///           apart, up to 64 and 6. Samples are not stored
class TETSKIN_CONTACT_API SurfaceContact {
 public:
  /// Switches contact on, from the next substep on. Sets the margin of the body's shape for the lifetime of this
  /// object.
  ///
  /// world    created with a `DeformableSolver` and a btCollisionDispatcher, and containing the body
  /// body     from `createSoftBody` or of a `DeformableBody`, without another SurfaceContact
  /// binding  of the mesh in the body's cage, such as a skin's; not kept
  /// mesh     the mesh of the binding; not kept
  /// Errors   InvalidOption: options out of range; a world with another solver; a body that is not in the world,
  ///          already has a SurfaceContact, or was not created as required above; Empty: no vertices; SizeMismatch:
  ///          binding, mesh and body do not belong together
  static Result<std::unique_ptr<SurfaceContact>> add(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body,
                                                     const SoftBodyBinding& binding, const TriangleMesh& mesh,
                                                     const SurfaceContactOptions& options = {});
  ~SurfaceContact();
  SurfaceContact(const SurfaceContact&) = delete;
  SurfaceContact& operator=(const SurfaceContact&) = delete;

  /// Contact points of the last substep in which the body was awake, each once, sorted by obstacle; without obstacles
  /// that have since left the world. Owned by this object, valid until the next call; allocates only if there are more
  /// points than ever before.
  const std::vector<SurfaceContactPoint>& contacts() const;

  /// Number of vertices and samples that can collide. Vertices that no triangle uses cannot, unless there are no
  /// triangles.
  std::size_t sampleCount() const;

 private:
  struct Impl;
  explicit SurfaceContact(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

}  // namespace tetskin
