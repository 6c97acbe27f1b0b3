// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Contact of soft bodies with rigid ones at the visual surface.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/soft_body_skin.h>

#include <memory>
#include <vector>

namespace tetskin {

/// How a surface touches.
struct SurfaceContactOptions {
  /// Distance that is kept between the surface and rigid bodies, world units; below 0: 0.2 % of the body's size, the
  /// largest side of its box.
  double margin = -1.0;
  /// Rest units: triangles with longer edges get samples of this spacing, which touch as vertices do. 0: none. Vertices
  /// must not be farther apart than what the body touches is thick. At most 10,000,000 of them.
  double sampleSpacing = 0.0;
};

/// A point of the surface in touch with a rigid body, or so near that it might come there in the substep.
struct SurfaceContactPoint {
  btVector3 point;                            ///< of the surface, world space, when contacts were last looked for
  btVector3 normal;                           ///< away from the rigid body, of unit length
  btScalar distance = 0;                      ///< when the substep began, less the margin; below 0: too near
  const btCollisionObject* object = nullptr;  ///< the rigid body, or the link of a multibody
  /// Force times seconds of the last substep, on the soft body; its opposite is on the object. 0 where nothing
  /// pushes, and while the body sleeps.
  btVector3 impulse;
};

/// A soft body meets rigid ones by its visual surface, instead of by the nodes of its cage, which lie outside of it.
/// Points of the surface are what is held: the `DeformableSolver` solves for what pushes and rubs them together with
/// the rigid bodies, so that force and counterforce act at one point.
///
/// In a deformable world with a `DeformableSolver`. Nothing else need be done: static, kinematic and dynamic bodies and
/// the links of multibodies are met in whatever order they were added, as groups, masks, the world's overlap filter
/// callback, setIgnoreCollisionCheck, CF_NO_CONTACT_RESPONSE of either and the body's `m_cfg.collisions` (any of
/// RVSmask) allow: they are asked for in each step. What they forbid when boxes begin to overlap is unknown to Bullet
/// until the world's refreshBroadphaseProxy. A world's contactTest finds
/// nothing of the body, and leaves its contacts as they are. Planes, boxes, spheres, capsules and cylinders are met
/// exactly; convex hulls by their faces, as they are drawn, that is without their margin; other convex shapes by
/// Bullet's GJK; meshes and other concave shapes by their triangles, on the side from which these look
/// counter-clockwise, mirrored with the shape where its scaling is negative; height fields on the side of their up
/// axis, whatever their winding; compounds by their children. Friction is Bullet's. Surfaces are met as linear skins
/// draw them: a quadratic one is drawn up to some thousandths of the body's size away, more in few tets and under
/// loads.
///
/// Lifetime  Contact ends with this object: the body then meets rigid ones by its nodes again, as it does in a world
///           with another dispatcher. This object, the body, the world, rigid bodies and their shapes may go in any
///           order, each as Bullet allows it, also at the end of the program, where globals hold them.
/// Cost      in a substep, for an obstacle whose box meets the body's: O(nodes); where it is near, O(vertices near it);
///           children of a compound are found by its tree. Of the points of a tet that touch a shape four are
///           solved for, and as many more as are 2 % of the body's size apart, up to 64
class TETSKIN_CONTACT_API SurfaceContact {
 public:
  /// From the next substep on. Sets the margin of the body's shape, until this object goes.
  ///
  /// world    made with a `DeformableSolver`, and the body in it
  /// body     by `makeSoftBody` or of a `DeformableBody`, in which no other SurfaceContact is
  /// binding  of the mesh in the body's cage, as a skin's; read here only
  /// mesh     that of the binding
  /// Errors   InvalidOption: options out of range, a world with another solver, or a dispatcher that is no
  ///          btCollisionDispatcher, a body that is not in the world, or has a contact already, or was not made as
  ///          said; Empty: no vertices; SizeMismatch: binding, mesh and body do not belong together
  static Result<std::unique_ptr<SurfaceContact>> add(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body,
                                                     const SoftBodyBinding& binding, const TriangleMesh& mesh,
                                                     const SurfaceContactOptions& options = {});
  ~SurfaceContact();
  SurfaceContact(const SurfaceContact&) = delete;
  SurfaceContact& operator=(const SurfaceContact&) = delete;

  /// Those of the last substep in which the body was awake, each once, by obstacle; without obstacles that have left
  /// the world since. This object's own, valid until the next call; allocates only where there are more than ever.
  const std::vector<SurfaceContactPoint>& contacts() const;

  /// Vertices and samples that may touch.
  std::size_t sampleCount() const;

 private:
  struct Parts;
  explicit SurfaceContact(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace tetskin
