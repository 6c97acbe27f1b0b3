// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <tetskin/bullet/src/base/build_stream.h>

#include <memory>
#include <vector>

namespace tetskin::bullet_detail {

/// A rigid body, or an object that is only collided with, and what it is made of.
struct BuiltObject {
  std::shared_ptr<btCollisionShape> shape;
  std::unique_ptr<btMotionState> motion;
  std::unique_ptr<btCollisionObject> object;
};

/// What an object has beside its state: filters, and the application's number.
struct ObjectFilters {
  int group = 1, mask = -1, userIndex = -1;

  void readFrom(const btCollisionObject& object);
  void visit(BuildStream& stream);
};

/// Describes an object, or builds it and adds it to the world. Its motion, masses and settings are those of the
/// snapshot that follows. Refuses links of multibodies and ghosts.
/// object  to be described; not used when building
BuiltObject buildObject(BuildStream& stream, btCollisionObject* object);

/// The same of the world's joints between rigid bodies, once all objects are there. Refuses joints of multibodies.
std::vector<std::unique_ptr<btTypedConstraint>> buildJoints(BuildStream& stream);

}  // namespace tetskin::bullet_detail
