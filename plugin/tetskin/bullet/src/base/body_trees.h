// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::bullet: the bounding-volume trees of a body's faces and nodes (btSoftBody::m_fdbvt, m_fdbvnt,
// m_ndbvt), which rays and collisions by faces search.
//
// Bullet's own builder, btSoftBody::initializeFaceTree, compares all pairs of faces, and joins neighbours until one
// tree is left: for a surface of two components that share no edge it never ends. Bullet calls it from a ray test of a
// body without a tree, and from the first step after anything that sets m_bUpdateRtCst, such as setMass.
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
/// positions. Existing trees are deleted; the new ones belong to the body. Cost O(n log n) for n faces and nodes.
TETSKIN_BULLET_API void buildTrees(btSoftBody& body);

/// Does what Bullet would do in the next step if m_bUpdateRtCst is set, but with our trees. The tree of faces is only
/// updated if it was not omitted, and only rebuilt if nodes or faces have been added or moved in memory. Cost O(links +
/// faces + nodes) without a rebuild; nothing if the flag is not set.
TETSKIN_BULLET_API void updateConstants(btSoftBody& body);

/// Tells whether the nodes of a body may have moved; it exists as long as the body.
struct NodeMoves {
  std::uint64_t count = 1;
  /// The solver whose steps count; null if none does. If the body has another one, its world moves nodes uncounted.
  const btSoftBodySolver* counter = nullptr;
};

/// What a solver keeps with a body: it goes along from world to world, and is destroyed with the body.
class BodyCompanion {
 public:
  virtual ~BodyCompanion() = default;
  /// Distance that is added to that of the shape while a step searches for contacts; else 0.
  virtual btScalar speculation() const = 0;
  /// The box in the broadphase also contains the nodes' positions at the end of the step, enlarged by this: Bullet's
  /// own box only contains the positions at the beginning. Below 0: Bullet's own box.
  virtual btScalar reach() const = 0;
  /// The body has another state: drops what was found in a step.
  virtual void dropStep() = 0;
  /// The body is as it was created.
  virtual void returnToStart() = 0;
};

/// A soft body that keeps its trees valid.
///
/// The trees follow when the body is moved or scaled by hand. In Bullet only that of the nodes does: until the next
/// step, and for a sleeping body permanently, a ray searches for the faces at their old positions.
///
/// The tree of faces is also rebuilt at once where a step in a classic world deletes it, as it does if m_bUpdateRtCst
/// is set. Bullet leaves the faces pointing into the deleted tree, and writes there when nodes are appended.
class TETSKIN_BULLET_API BodyWithTrees : public btSoftBody {
 public:
  BodyWithTrees(btSoftBodyWorldInfo& worldInfo, const std::vector<btVector3>& nodes);

  /// Builds the trees for the first time; before, the body behaves as in Bullet.
  /// faces  false: instead of the tree of faces, there is a single leaf that no ray hits and no node touches, whatever
  ///        moves the body. A ray then misses, refits cost nothing, and Bullet's builder, which only tests whether
  ///        there is a tree, is not called
  void makeTrees(bool faces);
  bool hasNoFaceTree() const { return kind_ == Kind::Skipped; }
  /// Rebuilds the tree of faces, or the leaf that replaces it.
  void renewFaceTree();

  /// Expires when the body is destroyed.
  std::weak_ptr<const NodeMoves> lifetime() const { return moves_; }
  /// Call it whenever nodes may have been moved; `transform`, `scale` and `visitState` do.
  void countMove() { ++moves_->count; }
  /// From now on, the steps of this solver alone move the nodes, and call `countMove`; null: others may.
  void setMovesCountedBy(const btSoftBodySolver* solver) {
    if (moves_->counter == solver) return;
    moves_->counter = solver;
    countMove();  // whatever has happened in between
  }
  /// Null until a solver keeps something.
  BodyCompanion* companion() const { return companion_.get(); }
  void setCompanion(std::unique_ptr<BodyCompanion> companion) { companion_ = std::move(companion); }
  /// The nodes' positions with which the body was created.
  const std::vector<btVector3>& createdAt() const { return createdAt_; }
  /// By how much the world has been moved since.
  const btVector3& shifted() const { return shifted_; }
  void shift(const btVector3& by) { shifted_ += by; }
  /// Takes the body back to where it was created, at rest, with new trees; cost O(n log n).
  void returnToStart();
  /// The distance that is kept from objects: that of the shape, without what a step adds to it.
  btScalar margin() const;

  /// Writes or reads by how much it was shifted; what was found in the last step is dropped.
  void visitState(WorldStream& stream);

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

/// The object of a body that `createSoftBody` has created; null for others.
TETSKIN_BULLET_API BodyWithTrees* bodyWithTrees(btSoftBody& body);
TETSKIN_BULLET_API const BodyWithTrees* bodyWithTrees(const btSoftBody& body);

}  // namespace tetskin::bullet_detail
