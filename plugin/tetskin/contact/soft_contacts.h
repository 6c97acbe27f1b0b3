// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Contact of soft bodies with each other, and with themselves, at their visual surfaces.
#pragma once

#include <tetskin/bullet/soft_body.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

class btDeformableMultiBodyDynamicsWorld;

namespace tetskin {

/// Resolution of a contact shape.
struct ContactShapeOptions {
  /// Number of surface points that are tested against other bodies; met within a third. Coarse meshes get extra points
  /// on their triangles; of fine meshes some vertices are left out. Empty: the number of vertices, or 30 per node of
  /// the cage's surface if that is more; but at least 2,000 and at most 8,000.
  std::optional<std::size_t> sampleCount;
  /// Cells of the distance grid along the largest side of the cage's box, 4 to 1,024. Features thinner than two cells
  /// are not resolved well. The time to create the shape grows nearly with the cube of this: 256 takes some 30 times as
  /// long as 64. Empty: 64; if half of the surface belongs to parts thinner than one such cell, two cells in their
  /// thickness, but no more than a grid of 400,000 corners allows: a sheet of 1 : 1 : 0.01 gets 200.
  std::optional<int> gridResolution;
};

namespace contact_detail {
struct ShapeData;
}

/// The visual surface at rest, for contact between soft bodies: its signed distance on a grid, and sample points with
/// the tets that carry them. Created once per model, immutable, shared by all bodies of that model.
class TETSKIN_CONTACT_API ContactShape {
 public:
  /// Creates the shape of a model's surface.
  /// cage    the cage that the body was created from, or a translated or rotated copy; rest space. Cages with duplicate
  ///         elements need their `vertexTets`. Not kept
  /// mesh    in the cage's rest space, triangles counter-clockwise from outside; not kept. Small holes are closed;
  ///         surfaces of components inside other components are left out
  /// Cost    a second for 20,000 triangles and the default grid
  /// Errors  those of `validate`, `Cage::checkMesh` and `embed`; Degenerate: the surface encloses nothing that the grid
  ///         resolves;
  ///         InvalidOption: options out of range
  static Result<std::shared_ptr<const ContactShape>> create(const Cage& cage, const TriangleMesh& mesh,
                                                            const ContactShapeOptions& options = {});
  ~ContactShape();

  std::size_t nodeCount() const;    ///< number of nodes of the cage from which it was created
  std::size_t tetCount() const;     ///< number of tets of the cage from which it was created
  std::size_t sampleCount() const;  ///< number of points that are tested against other bodies

 private:
  friend struct Access<ContactShape>;
  explicit ContactShape(std::unique_ptr<const contact_detail::ShapeData> data);
  std::unique_ptr<const contact_detail::ShapeData> data_;
};

/// Options of contact between soft bodies.
struct SoftContactOptions {
  /// Coulomb friction coefficient, 0 or more; not given: the geometric mean of the bodies' m_cfg.kDF.
  std::optional<double> friction;
};

/// A contact point between two bodies, or within one, in the last step.
struct SoftContact {
  const btSoftBody* body = nullptr;   ///< the body that the surface point belongs to
  const btSoftBody* other = nullptr;  ///< the body that the point has entered, or nearly
  btVector3 point{0, 0, 0};           ///< world space, at the beginning of the step
  btVector3 normal{0, 1, 0};          ///< unit length, world space, out of `other`
  btScalar distance = 0;              ///< world length; negative: penetration depth
  btScalar impulse = 0;               ///< along the normal in that step, mass times velocity
};

/// Contact between soft bodies of a deformable world, at their visual surfaces. The world's solver gets the contact
/// points, and solves them with Coulomb friction, simultaneously with all other contacts of its bodies.
///
///     auto contacts = SoftContacts::add(world).value();
///     contacts->add(body.body(), shape);
///
/// Bodies may be removed from the world, and this object and the world destroyed, in any order; after the world's
/// solver has been destroyed, there are no contacts.
/// Two bodies collide if groups, masks, the world's overlap filter callback, setIgnoreCollisionCheck and
/// CF_NO_CONTACT_RESPONSE of either allow it, evaluated in each step, and the `m_cfg.collisions` of neither is 0;
/// self-contact does not depend on group and mask.
/// Bullet's own contact between soft bodies (VF_DD and the like) should be off for these bodies, as it is for those of
/// `DeformableBody`.
class TETSKIN_CONTACT_API SoftContacts {
 public:
  /// Creates contacts for a world, without bodies yet.
  /// world   created with a `DeformableSolver`; not owned
  /// Errors  InvalidOption for options out of range, and for worlds with another solver
  static Result<std::unique_ptr<SoftContacts>> add(btDeformableMultiBodyDynamicsWorld& world,
                                                   const SoftContactOptions& options = {});
  ~SoftContacts();
  SoftContacts(const SoftContacts&) = delete;
  SoftContacts& operator=(const SoftContacts&) = delete;

  /// Adds a body: from the next step on, it collides with all others that were added. Adding it again replaces its
  /// shape.
  /// body    of this world, created from the shape's cage: the same nodes and tets in the same order, at any positions
  /// shape   shared
  /// self    whether it collides with itself: regions collide that are more than two cage edges apart at rest, or
  ///         somewhat more along the body. Fingers that the cage keeps apart therefore collide; if they are nearer than
  ///         that, only from a depth of 1.5 cells of the shape's grid
  /// Errors  Empty without a shape; SizeMismatch: the body has another number of nodes or tets; InvalidOption: it is in
  ///         another world, or in other SoftContacts
  Status add(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool self = false);
  /// Removes a body from these contacts; it stays in the world.
  void remove(const btSoftBody& body);
  /// State of a body in these contacts. Ok: it collides with others; NotAdded; NotInWorld: it has been removed from the
  /// world; TopologyChanged: its nodes or tets are not those of its shape, and it collides with nothing; Enclosed: it
  /// lies wholly inside another body, and collides with all others, but not with that one.
  StatusCode status(const btSoftBody& body) const;

  /// Contact points with a force in the last step or, between two sleeping bodies, in the last step in which either was
  /// awake; without bodies that have since left the world or were removed.
  /// Owned by this object, valid until the next call; allocates only if there are more points than ever before.
  const std::vector<SoftContact>& contacts() const;

 private:
  struct Impl;
  explicit SoftContacts(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tetskin
