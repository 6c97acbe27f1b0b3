// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: what a joint ties a point of a surface to.
#pragma once

#include <LinearMath/btTransform.h>

#include <memory>

class btCollisionObject;
class btMultiBodyLinkCollider;
class btRigidBody;

namespace tetskin::touch_detail {

/// Where the joint holds it is its *anchor*.
class Partner {
 public:
  virtual ~Partner() = default;
  /// Null for a point in space.
  virtual btCollisionObject* object() const { return nullptr; }
  virtual btTransform anchor() const = 0;
  virtual void moveAnchor(const btVector3& local) = 0;

  /// Now, at any time.
  virtual btScalar speed() const { return 0; }
};

std::unique_ptr<Partner> pointInSpace(const btVector3& at);
/// anchor  in the body's own space; it turns with the body
std::unique_ptr<Partner> rigidPartner(btRigidBody& body, const btTransform& anchor);
std::unique_ptr<Partner> linkPartner(btMultiBodyLinkCollider& link, const btTransform& anchor);

}  // namespace tetskin::touch_detail
