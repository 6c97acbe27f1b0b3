// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: the contacts of one body with everything that it touches.
#pragma once

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/base/shape_key.h>
#include <tetskin/solver/src/search/convex_probe.h>
#include <tetskin/solver/src/search/hull_probe.h>
#include <tetskin/solver/src/search/mesh_probe.h>
#include <tetskin/solver/src/search/point_collider.h>

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

namespace tetskin::bullet_detail {

/// Stored about one shape of one object.
struct KnownShape {
  ShapeKey key;                           ///< without a shape: stands for the next shape with this box
  std::shared_ptr<const HullFaces> hull;  ///< the faces of a convex hull, kept for the probe
  unsigned lastStep = 0;                  ///< last step in which it was near
  bool isRemembered = false;              ///< has an entry in `memory`
  ShapeMemory memory;
};

struct KnownObject {
  std::unordered_map<std::uint64_t, KnownShape> shapes;  ///< by number of the shape
  unsigned step = 0;                                     ///< number of the last step with this object nearby
};

class BodyContacts {
 public:
  /// dispatcher  whose pairs are handled, used only for comparison; null: any
  /// body        created by `createSoftBody`
  /// thickness   depth up to which a point behind a mesh's surface still belongs to it
  BodyContacts(const btDispatcher* dispatcher, BodyWithTrees& body, PointCollider search, btScalar thickness);
  BodyContacts(const BodyContacts&) = delete;
  BodyContacts& operator=(const BodyContacts&) = delete;

  const btDispatcher* dispatcher() const { return dispatcher_; }
  /// Sets the dispatcher of another world, which the body is about to enter.
  void setDispatcher(const btDispatcher* dispatcher) { dispatcher_ = dispatcher; }
  /// If this is false, only `forget` and the accessors may be called.
  bool bodyLives() const { return !lifetime_.expired(); }

  /// Adds the contacts with an object to the body's, shape by shape: at once or, if the body's search waits, in
  /// `searchWaiting`.
  void collide(const btCollisionObjectWrapper& rigid);
  bool isWaiting() const { return !waiting_.empty(); }
  void searchWaiting();

  /// Forgets an object that is no longer near, or not at present.
  void forget(const btCollisionObject& object);

  void forgetAll();
  /// Call it after the body and all objects have been moved by as much.
  void shift(const btVector3& by);

  /// Writes or reads which points have touched, and from where they are followed. Clearances are found again, with the
  /// same result.
  void serialize(WorldStream& stream);

  BodyWithTrees& body() const { return body_; }
  const PointCollider& search() const { return search_; }

 private:
  /// An object near the body, with its shape and path at that moment.
  struct Met {
    const btCollisionObject* object;
    const btCollisionShape* shape;
    ShapePath path;
  };
  void search(const Met& met);
  bool passesOver(const CarriedPoint& point) const;
  void readNodes();
  void collideShape(const btCollisionShape& shape, std::uint64_t number, const ShapePath& path,
                    const btCollisionObject& object);
  std::vector<int> childrenNear(const btCompoundShape& compound, const ShapePath& path) const;
  WorldBox boxAround(const btCollisionShape& shape, const ShapePath& path) const;
  bool isNear(const WorldBox& box) const;
  KnownShape& knownShape(const btCollisionShape& shape, std::uint64_t number, const btCollisionObject& object);
  ShapeMemory& memoryOf(KnownShape& known);
  ShapeProbe* probeOf(const btCollisionShape& shape, KnownShape& known);
  void forgetUnused(KnownObject& object);
  void serializeShape(WorldStream& stream, KnownShape& shape);
  void serializeFollowed(WorldStream& stream, ShapeMemory& memory);

  const btDispatcher* dispatcher_;
  BodyWithTrees& body_;
  BodyChannel& channel_;
  std::weak_ptr<const void> lifetime_;  ///< of the body: after its end, another one may have its address
  PointCollider search_;
  btScalar thickness_;
  btScalar margin_ = 0;  ///< of the last search
  std::vector<NodePath> nodes_;
  unsigned nodesRead_ = 0;    ///< BodyChannel::predictions when they were read; 0: not read yet
  std::vector<Met> waiting_;  ///< still to be searched
  ExactProbe exact_;
  HullProbe hull_;
  ConvexProbe convex_;
  MeshProbe mesh_;
  std::unordered_map<const btCollisionObject*, KnownObject> known_;
  std::size_t remembered_ = 0, maxRemembered_;  ///< numbers of shapes
  ShapeMemory overflow_;                        ///< for shapes beyond the limit: nothing about them is kept
};

/// Creates the search for contacts of the body's nodes. It orders points by their positions when the body was created,
/// so that a body that is created again has the same order.
/// size  of the body
std::shared_ptr<BodyContacts> makeNodeContacts(BodyWithTrees& body, btScalar size);
/// The longest side of the box around its nodes.
btScalar sizeOfNodes(const BodyWithTrees& body);

/// The search that finds the body's contacts in a world with this dispatcher; null if Bullet does.
/// nodes  true: contacts of nodes
std::shared_ptr<BodyContacts> contactsOf(const btSoftBody& body, const btDispatcher& dispatcher, bool nodes);

}  // namespace tetskin::bullet_detail
