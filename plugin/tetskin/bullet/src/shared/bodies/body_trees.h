// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::bullet: the bounding-volume trees of a body's faces and nodes (btSoftBody::m_fdbvt, m_fdbvnt,
// m_ndbvt), which rays and collisions by faces search.
//
// Bullet's own builder, btSoftBody::initializeFaceTree, compares all pairs of faces, and joins neighbours until one
// tree is left: for a surface of two parts that share no edge it never ends. Bullet calls it from a ray test of a body
// without a tree, and from the first step after anything that sets m_bUpdateRtCst, such as setMass.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/bullet/src/shared/bodies/point_contacts.h>
#include <tetskin/export.h>

#include <memory>
#include <utility>
#include <vector>

namespace tetskin {

/// Builds all three trees by median splits, for any number of parts, with boxes that fit the nodes where they are.
/// Whatever trees there were are deleted; the new ones are the body's. Cost O(n log n) for n faces and nodes.
TETSKIN_BULLET_API void buildTrees(btSoftBody& body);

/// What Bullet would do in the next step where m_bUpdateRtCst is set, but with our trees; of faces only where they were
/// not left out, and anew only if nodes or faces have been added or moved in memory. Cost O(links + faces + nodes)
/// without that; nothing where the flag is not set.
void updateConstants(btSoftBody& body);

/// A soft body that keeps its trees.
///
/// They follow when it is moved or scaled by hand. In Bullet only that of the nodes does: until the next step, and for
/// a sleeping body for good, a ray looks for the faces where they were.
///
/// And they are there again at once where a step in a classic world deletes that of the faces, as it does where
/// m_bUpdateRtCst is set. Bullet leaves the faces pointing into the deleted tree, and writes there when nodes are
/// appended.
class BodyWithTrees : public btSoftBody {
 public:
  BodyWithTrees(btSoftBodyWorldInfo& worldInfo, const std::vector<btVector3>& nodes);

  /// Builds the trees for the first time; before, the body is Bullet's own.
  /// faces  or instead of those of faces a single leaf that no ray hits and no node touches, whatever moves the body: a
  ///        ray misses, refits cost nothing, and Bullet's builder, which only looks whether there is a tree, is not
  ///        called
  void makeTrees(bool faces);
  bool faceTreeIsLeftOut() const { return kind_ == Kind::LeftOut; }
  /// Builds that of the faces, or what stands for it, anew.
  void renewFaceTree();

  /// Expires with the body.
  std::weak_ptr<const void> lifetime() const { return lifetime_; }
  /// What has to live as long as the body: one thing, of whoever puts it there.
  std::shared_ptr<void>& companion() { return companion_; }
  /// tetskin::contact's, who finds where the body's surface meets rigid bodies; gone where nobody does.
  const std::weak_ptr<void>& surfaceContacts() const { return surfaceContacts_; }
  void setSurfaceContacts(std::weak_ptr<void> contacts) { surfaceContacts_ = std::move(contacts); }

  /// What the body is to stay outside of in this step: whoever searches puts it there, the solver takes it up, and
  /// clears it when a step begins.
  PointContacts& pointContacts() { return pointContacts_; }
  const PointContacts& pointContacts() const { return pointContacts_; }

  /// From now on the box that the broadphase is given also holds the nodes where the step takes them, and this much
  /// around them: Bullet's own only holds them where the step begins. Below 0: Bullet's own.
  void setReach(btScalar beyondNodes) { reach_ = beyondNodes; }
  btScalar reach() const { return reach_; }

  /// How far from what it may meet a body's points count as touching, while a step looks for that, beside what is kept
  /// between them. Forces that will hold both are not known yet: what rests on something that rests is predicted to
  /// fall with it, or away from it. 0: none, as outside of steps.
  void setSpeculation(btScalar distance) { speculation_ = distance; }
  btScalar speculation() const { return speculation_; }

  /// Also called by transformTo, translate and rotate.
  void transform(const btTransform& transform) override;
  void scale(const btVector3& factors) override;

 private:
  enum class Kind { None, Faces, LeftOut };
  class Shape;
  void keepFaceTree();

  Kind kind_ = Kind::None;
  btScalar reach_ = -1, speculation_ = 0;
  std::shared_ptr<const void> lifetime_ = std::make_shared<char>();
  std::shared_ptr<void> companion_;
  PointContacts pointContacts_;
  std::weak_ptr<void> surfaceContacts_;
};

/// Of a body that `makeSoftBody` has made; null for others.
TETSKIN_BULLET_API BodyWithTrees* bodyWithTrees(btSoftBody& body);
TETSKIN_BULLET_API const BodyWithTrees* bodyWithTrees(const btSoftBody& body);

}  // namespace tetskin
