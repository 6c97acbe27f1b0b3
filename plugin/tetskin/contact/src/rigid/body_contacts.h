// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: one body and all that it meets.
#pragma once

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <tetskin/bullet/src/shared/bodies/body_trees.h>
#include <tetskin/contact/src/rigid/convex_probe.h>
#include <tetskin/contact/src/rigid/hull_probe.h>
#include <tetskin/contact/src/rigid/mesh_probe.h>
#include <tetskin/contact/src/rigid/touch_search.h>

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

namespace tetskin {

/// What is known of one shape of one object.
struct KnownShape {
  const btCollisionShape* shape = nullptr;
  btVector3 low = {0, 0, 0}, high = {0, 0, 0};  ///< its box: another one is of another shape
  std::shared_ptr<const HullFaces> hull;        ///< of a convex hull: kept for the probe
  unsigned lastStep = 0;                        ///< in which it was near
  bool isRemembered = false;                    ///< in `memory`
  ShapeMemory memory;
};

struct KnownObject {
  std::unordered_map<std::uint64_t, KnownShape> shapes;  ///< by number
  unsigned step = 0;                                     ///< counts those in which it was met
};

class BodyContacts {
 public:
  /// dispatcher  whose pairs are met; only compared
  /// body        one that `makeSoftBody` has made
  /// thickness   how deep in a mesh a point still belongs to it
  BodyContacts(const btDispatcher& dispatcher, BodyWithTrees& body, TouchSearch search, btScalar thickness);

  const btDispatcher* dispatcher() const { return dispatcher_; }
  /// If not, nothing else may be called but `forget` and the accessors.
  bool bodyLives() const { return !lifetime_.expired(); }

  /// Adds the contacts with an object, shape by shape, to the body's.
  void collide(const btCollisionObjectWrapper& rigid);

  /// An object that is met no more, or not for now.
  void forget(const btCollisionObject& object);

  BodyWithTrees& body() const { return body_; }
  const TouchSearch& search() const { return search_; }

 private:
  void readNodes();
  void collideShape(const btCollisionShape& shape, std::uint64_t number, const ShapePath& path,
                    const btCollisionObject& object);
  std::vector<int> childrenNear(const btCompoundShape& compound, const ShapePath& path) const;
  void addContact(const PointTouch& touch, const btCollisionObject& object);
  bool isNear(const btCollisionShape& shape, const ShapePath& path) const;
  KnownShape& knownShape(const btCollisionShape& shape, std::uint64_t number, const btCollisionObject& object);
  ShapeMemory& memoryOf(KnownShape& known);
  ShapeProbe* probeOf(const btCollisionShape& shape, KnownShape& known);
  void forgetUnused(KnownObject& object);

  const btDispatcher* dispatcher_;
  BodyWithTrees& body_;
  std::weak_ptr<const void> lifetime_;  ///< the body's: another one may have its address afterwards
  TouchSearch search_;
  btScalar thickness_;
  std::vector<NodePath> nodes_;
  bool nodesRead_ = false;  ///< in this call
  ExactProbe exact_;
  HullProbe hull_;
  ConvexProbe convex_;
  MeshProbe mesh_;
  std::unordered_map<const btCollisionObject*, KnownObject> known_;
  std::size_t remembered_ = 0, maxRemembered_;  ///< shapes
  ShapeMemory overflow_;                        ///< of a shape too many: nothing is remembered of it
};

}  // namespace tetskin
