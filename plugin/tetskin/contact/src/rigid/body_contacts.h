// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: one body and all that it meets.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <tetskin/bullet/src/shared/bodies/body_trees.h>
#include <tetskin/contact/src/rigid/convex_probe.h>
#include <tetskin/contact/src/rigid/hull_probe.h>
#include <tetskin/contact/src/rigid/mesh_probe.h>
#include <tetskin/contact/src/rigid/touch_search.h>

#include <vector>

namespace tetskin {

/// What is known of one shape of one object.
struct KnownShape {
  const btCollisionObject* object = nullptr;
  int number = 0;  ///< of the shapes of the object: a compound may have one twice
  const btCollisionShape* shape = nullptr;
  btVector3 low = {0, 0, 0}, high = {0, 0, 0};  ///< its box: another one is of another shape
  ShapeMemory memory;
};

class BodyContacts {
 public:
  /// thickness  how deep in a mesh a point still belongs to it
  BodyContacts(BodyWithTrees& body, TouchSearch search, btScalar thickness)
      : body_(body), search_(std::move(search)), thickness_(thickness) {}

  /// Adds the contacts with an object, shape by shape, to the body's.
  void collide(const btCollisionObjectWrapper& rigid);

  /// An object that is met no more, or not for now.
  void forget(const btCollisionObject& object);

  BodyWithTrees& body() const { return body_; }
  const TouchSearch& search() const { return search_; }

 private:
  bool responds(const btCollisionObject& object) const;
  void readNodes();
  void collideShape(const btCollisionShape& shape, const ShapePath& path, const btCollisionObject& object);
  void collideChildren(const btCollisionShape& compound, const ShapePath& path, const btCollisionObject& object);
  void addContact(const PointTouch& touch, const btCollisionObject& object);
  bool isNear(const btCollisionShape& shape, const ShapePath& path) const;
  ShapeMemory& memoryOf(const btCollisionShape& shape, const btCollisionObject& object);
  ShapeProbe* probeOf(const btCollisionShape& shape);

  BodyWithTrees& body_;
  TouchSearch search_;
  btScalar thickness_;
  std::vector<NodePath> nodes_;
  bool nodesRead_ = false;  ///< in this call
  ExactProbe exact_;
  HullProbe hull_;
  ConvexProbe convex_;
  MeshProbe mesh_;
  std::vector<KnownShape> known_;
  ShapeMemory overflow_;  ///< of a shape too many: nothing is remembered of it
  int shapeNumber_ = 0;   ///< in this call
};

}  // namespace tetskin
