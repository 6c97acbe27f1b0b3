// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Soft bodies meet each other, and themselves, where their visual surfaces are.
#pragma once

#include <tetskin/bullet/soft_body.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/triangle_mesh.h>

#include <cstddef>
#include <memory>
#include <vector>

class btDeformableMultiBodyDynamicsWorld;

namespace tetskin {

/// How finely a surface is felt.
struct ContactShapeOptions {
  /// Points of the surface that are looked for in other bodies; met within a third. Coarse meshes get points on their
  /// triangles, of fine ones some vertices are left out.
  std::size_t samples = 8000;
  /// Cubes of the distance's grid along the longest side of the cage's box. Parts thinner than two of them are not
  /// felt well. Making the shape costs nearly as their cube: 256 take some 30 times as long as 64.
  int cells = 64;
};

namespace contact_detail {
struct ShapeData;
}

/// The visual surface at rest, as what soft bodies touch: its signed distance on a grid, and points of it with the tets
/// that carry them. Made once for a model, immutable, shared by all bodies of it.
class TETSKIN_CONTACT_API ContactShape {
 public:
  /// For the library's own use: see `makeContactShape`.
  explicit ContactShape(std::unique_ptr<const contact_detail::ShapeData> data);
  ~ContactShape();

  std::size_t nodeCount() const;    ///< of the cage that it was made in
  std::size_t tetCount() const;     ///< likewise
  std::size_t sampleCount() const;  ///< points that are looked for in other bodies
  /// For the library's own use.
  const contact_detail::ShapeData& data() const { return *data_; }

 private:
  std::unique_ptr<const contact_detail::ShapeData> data_;
};

/// Makes the shape of a model's surface.
/// cage    as the body was made of it, or moved or turned: rest space. Split cages need their `vertexTets`
/// mesh    in the cage's rest space, triangles counter-clockwise from outside. Holes are closed where they are small;
///         surfaces of parts that lie within other parts are left out
/// Cost    a second for 20,000 triangles and the default grid
/// Errors  those of `usable`, `Cage::check`, `Cage::checkMesh` and `embed`; Degenerate for a surface that encloses
///         nothing; InvalidOption
TETSKIN_CONTACT_API Result<std::shared_ptr<const ContactShape>> makeContactShape(
    const Cage& cage, const TriangleMesh& mesh, const ContactShapeOptions& options = {});

/// How soft bodies meet.
struct SoftContactOptions {
  /// Coulomb's; below 0: the geometric mean of the bodies' m_cfg.kDF.
  double friction = -1.0;
};

/// What a body of SoftContacts is to it.
enum class IncludedBody {
  Active,   ///< meets others
  Gone,     ///< was taken out of the world
  Changed,  ///< has other nodes or tets than its shape: it meets nothing
  Unknown,  ///< was never included
  Within,   ///< lies wholly within another one, and has no way out: it meets all others, but not that one
};

/// A point where two bodies touch, or one itself, as of the last step.
struct SoftContact {
  const btSoftBody* body = nullptr;   ///< whose surface point it is
  const btSoftBody* other = nullptr;  ///< in whose interior, or nearly
  btVector3 point{0, 0, 0};           ///< world space, when the step began
  btVector3 normal{0, 1, 0};          ///< of unit length, out of `other`
  btScalar distance = 0;              ///< below 0: how deep
  btScalar impulse = 0;               ///< along the normal, of the step's
};

/// Contact among soft bodies of a deformable world, by their visual surfaces: the world's solver is told of points that
/// touch, and solves for them with Coulomb friction, together with all else that its bodies touch.
///
///     auto contacts = SoftContacts::add(world).value();
///     contacts->include(body.body(), shape);
///
/// Bodies may be taken out of the world, and this may go, in any order, as long as it goes before the world does.
/// Two bodies meet as groups, masks, the world's overlap filter callback, setIgnoreCollisionCheck and
/// CF_NO_CONTACT_RESPONSE of either allow, in each step, and not where the `m_cfg.collisions` of one is 0; one meets
/// itself whatever its group and mask.
/// Bullet's own contact of soft bodies (VF_DD and the like) should be off for them, as it is for bodies of
/// `DeformableBody`.
class TETSKIN_CONTACT_API SoftContacts {
 public:
  /// world   made with a `DeformableSolver`
  /// Errors  InvalidOption for options out of range, and for worlds with another solver
  static Result<std::unique_ptr<SoftContacts>> add(btDeformableMultiBodyDynamicsWorld& world,
                                                   const SoftContactOptions& options = {});
  ~SoftContacts();
  SoftContacts(const SoftContacts&) = delete;
  SoftContacts& operator=(const SoftContacts&) = delete;

  /// The body meets all others that were included, from the next step on; included again, it gets this shape.
  /// body    of this world, made of the shape's cage: the same nodes and tets in the same order, wherever they are
  /// self    it meets itself too, where parts touch that are more than two cage edges apart at rest, or some more along
  ///         the body: fingers that the cage keeps apart meet, from 1.5 cells of the shape's grid deep if they are
  ///         nearer
  /// Errors  Empty without a shape; SizeMismatch; InvalidOption for a body of another world, or in other SoftContacts
  Status include(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool self = false);
  /// No longer; the body stays in the world.
  void exclude(const btSoftBody& body);
  /// What a body is to these contacts.
  IncludedBody statusOf(const btSoftBody& body) const;

  /// Those of the last step that push; without bodies that have left the world, or were excluded, since. This object's
  /// own, valid until the next call; allocates only where there are more than ever.
  const std::vector<SoftContact>& contacts() const;

 private:
  struct Parts;
  explicit SoftContacts(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace tetskin
