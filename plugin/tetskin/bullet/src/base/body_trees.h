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
#include <tetskin/bullet/src/base/point_contacts.h>
#include <tetskin/export.h>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace tetskin::bullet_detail {

class BodyContacts;
class KinematicPaths;
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
  /// Finds contacts of points other than the nodes with rigid objects; expired if nothing does.
  const std::weak_ptr<BodyContacts>& surfaceContacts() const { return surfaceContacts_; }
  void setSurfaceContacts(std::weak_ptr<BodyContacts> contacts) { surfaceContacts_ = std::move(contacts); }
  /// Finds the contacts of the nodes; or null.
  const std::shared_ptr<BodyContacts>& nodeContacts() const { return nodeContacts_; }
  /// size  of the body, when they were made
  void setNodeContacts(std::shared_ptr<BodyContacts> contacts, btScalar size) {
    nodeContacts_ = std::move(contacts);
    contactSize_ = size;
  }
  btScalar contactSize() const { return contactSize_; }
  /// The nodes' positions with which the body was created.
  const std::vector<btVector3>& createdAt() const { return createdAt_; }
  /// By how much the world has been moved since.
  const btVector3& shifted() const { return shifted_; }
  void shift(const btVector3& by) { shifted_ += by; }
  /// Takes the body back to where it was created, at rest, with new trees; cost O(n log n).
  void returnToStart();
  /// The solver that reads the contacts of the nodes; null if Bullet searches for them. Whether the body is still in
  /// its world, another solver's name in the body tells.
  const btSoftBodySolver* nodesSolver() const { return nodesSolver_; }
  void setNodesSolver(const btSoftBodySolver* solver) { nodesSolver_ = solver; }

  /// Where kinematic bodies come from, of the world whose steps search for contacts; expired if nothing tells.
  const std::weak_ptr<const KinematicPaths>& kinematicPaths() const { return kinematicPaths_; }
  void setKinematicPaths(std::weak_ptr<const KinematicPaths> paths) { kinematicPaths_ = std::move(paths); }

  /// The points that must stay outside of objects in this step: a search adds them, the solver reads them, and clears
  /// them when a step begins.
  PointContacts& pointContacts() { return pointContacts_; }
  const PointContacts& pointContacts() const { return pointContacts_; }

  /// While this is set, searches wait until all pairs of the step are known: those of several bodies then run side by
  /// side.
  void setSearchWaits(bool waits) { searchWaits_ = waits; }
  bool searchWaits() const { return searchWaits_; }

  /// From now on, the box in the broadphase also contains the nodes' positions at the end of the step, enlarged by
  /// this: Bullet's own box only contains the positions at the beginning. Below 0: Bullet's own box.
  void setReach(btScalar beyondNodes) { reach_ = beyondNodes; }
  btScalar reach() const { return reach_; }
  /// The distance that is kept from objects: that of the shape, without what a step adds to it.
  btScalar margin() const;

  /// The distance at which a body's points count as touching while a step searches for contacts, in addition to the
  /// distance that is kept between the objects. Forces that will support both objects are not known yet: a body that
  /// rests on a resting object is predicted to fall with it, or away from it. 0: none, as outside of steps.
  void setSpeculation(btScalar distance) {
    speculation_ = distance;
    ++predictions_;
  }
  /// Grows from step to step: while it stays the same, and the speculation is above 0, nodes and their paths do, too.
  unsigned predictions() const { return predictions_; }
  btScalar speculation() const { return speculation_; }

  /// Writes or reads what the last step has left; what was found in it is dropped.
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
  btScalar reach_ = -1, speculation_ = 0;
  unsigned predictions_ = 0;
  bool searchWaits_ = false;
  std::shared_ptr<NodeMoves> moves_ = std::make_shared<NodeMoves>();
  PointContacts pointContacts_;
  std::weak_ptr<BodyContacts> surfaceContacts_;
  std::weak_ptr<const KinematicPaths> kinematicPaths_;
  std::shared_ptr<BodyContacts> nodeContacts_;
  btScalar contactSize_ = 0;
  std::vector<btVector3> createdAt_;
  btVector3 shifted_{0, 0, 0};
  const btSoftBodySolver* nodesSolver_ = nullptr;
};

/// The object of a body that `createSoftBody` has created; null for others.
TETSKIN_BULLET_API BodyWithTrees* bodyWithTrees(btSoftBody& body);
TETSKIN_BULLET_API const BodyWithTrees* bodyWithTrees(const btSoftBody& body);

}  // namespace tetskin::bullet_detail
