// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::bullet: the bounding-volume trees of a body's faces and nodes (btSoftBody::m_fdbvt, m_fdbvnt,
// m_ndbvt), which ray casts and collisions at faces use.
//
// Bullet's own builder, btSoftBody::initializeFaceTree, compares all pairs of faces, and joins neighbours until one
// tree is left: for a surface of two components without a common edge it never ends. Bullet calls it from a ray cast
// against a body without a tree, and from the first step after anything that sets m_bUpdateRtCst, such as setMass.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/bullet/src/base/own_objects.h>
#include <tetskin/export.h>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace tetskin::bullet_detail {

class WorldStream;

/// Builds all three trees by median splits, for any number of components, with boxes that fit the nodes' current
/// positions. Existing trees are deleted; the body owns the new ones. Cost O(n log n) for n faces and nodes.
TETSKIN_BULLET_API void buildTrees(btSoftBody& body);

/// Does what Bullet would do in the next step if m_bUpdateRtCst is set, but with our trees. The tree of faces is only
/// updated if it was not omitted, and only rebuilt if nodes or faces have been added or moved in memory. Cost O(links +
/// faces + nodes) without a rebuild; nothing if the flag is not set.
TETSKIN_BULLET_API void updateConstants(btSoftBody& body);

/// Tells whether the nodes of a body may have moved; lives as long as the body.
struct NodeMoves {
  std::uint64_t count = 1;
  /// The solver whose steps are counted; null if none. If the body has another solver, its world moves nodes uncounted.
  const btSoftBodySolver* counter = nullptr;
};

/// Data that a solver attaches to a body: moves with it from world to world, and is destroyed with it.
class BodyCompanion {
 public:
  virtual ~BodyCompanion() = default;
  /// Extra distance, beyond the shape's, while a step searches for contacts; otherwise 0.
  virtual btScalar speculation() const = 0;
  /// If 0 or more, the box in the broadphase also contains the nodes' positions at the end of the step, enlarged by
  /// this; Bullet's own box only contains the positions at the beginning. Below 0: Bullet's own box.
  virtual btScalar reach() const = 0;
  /// The body has another state: drops the results of the last step.
  virtual void dropStep() = 0;
  /// The body is again as it was created.
  virtual void returnToStart() = 0;
};

/// A soft body that keeps its trees valid.
///
/// The trees follow when the body is moved or scaled by hand. In Bullet only the tree of nodes does: until the next
/// step, and for a sleeping body permanently, a ray cast looks for the faces at their old positions.
///
/// The tree of faces is also rebuilt at once when a step in a classic world deletes it, which happens if m_bUpdateRtCst
/// is set. Bullet leaves the faces pointing into the deleted tree, and writes there when nodes are appended.
class TETSKIN_BULLET_API BodyWithTrees : public btSoftBody {
 public:
  BodyWithTrees(btSoftBodyWorldInfo& worldInfo, const std::vector<btVector3>& nodes);

  /// Builds the trees for the first time; until then the body behaves as in Bullet.
  /// faces  false: instead of the tree of faces, there is a single leaf that no ray hits and no node touches, however
  ///        the body moves. Ray casts then miss, refits cost nothing, and Bullet's builder is not called, because it
  ///        only tests whether there is a tree
  void makeTrees(bool faces);
  bool hasNoFaceTree() const { return kind_ == Kind::Skipped; }
  /// Rebuilds the tree of faces, or the leaf that replaces it.
  void renewFaceTree();

  /// Expires when the body is destroyed.
  std::weak_ptr<const NodeMoves> lifetime() const { return moves_; }
  /// Call it whenever nodes may have been moved; `transform`, `scale` and `serialize` do.
  void countMove() { ++moves_->count; }
  /// From now on, only the steps of this solver move the nodes, and they call `countMove`; null: others may.
  void setMovesCountedBy(const btSoftBodySolver* solver) {
    if (moves_->counter == solver) return;
    moves_->counter = solver;
    countMove();  // whatever has happened in between
  }
  /// Null until a solver attaches one.
  BodyCompanion* companion() const { return companion_.get(); }
  void setCompanion(std::unique_ptr<BodyCompanion> companion) { companion_ = std::move(companion); }
  /// The nodes' positions with which the body was created.
  const std::vector<btVector3>& createdAt() const { return createdAt_; }
  /// By how much the world has been shifted since then.
  const btVector3& shifted() const { return shifted_; }
  void shift(const btVector3& by) { shifted_ += by; }
  /// Returns the body to where it was created, at rest, with new trees; cost O(n log n).
  void returnToStart();
  /// The distance kept from objects: the shape's, without what a step adds to it.
  btScalar margin() const;

  /// Writes or reads how far it was shifted; drops the results of the last step.
  void serializeShift(WorldStream& stream);

  /// Also called by transformTo, translate and rotate.
  void transform(const btTransform& transform) override;
  void scale(const btVector3& factors) override;

 private:
  enum class Kind { None, Faces, Skipped };
  class Shape;
  void keepFaceTree();

  OwnObject registered_{OwnObject::Kind::BodyWithTrees, static_cast<const btSoftBody*>(this)};
  Kind kind_ = Kind::None;
  std::shared_ptr<NodeMoves> moves_ = std::make_shared<NodeMoves>();
  std::unique_ptr<BodyCompanion> companion_;
  std::vector<btVector3> createdAt_;
  btVector3 shifted_{0, 0, 0};
};

/// The body as a BodyWithTrees if `createSoftBody` has created it; otherwise null.
TETSKIN_BULLET_API BodyWithTrees* bodyWithTrees(btSoftBody& body);
TETSKIN_BULLET_API const BodyWithTrees* bodyWithTrees(const btSoftBody& body);

}  // namespace tetskin::bullet_detail
