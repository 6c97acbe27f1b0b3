// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/core/src/base/hash.h>
#include <cstdint>

namespace tetskin::bullet_detail {

/// Hash of positions and velocities of all nodes, and of transforms and velocities of all rigid bodies, to the last
/// bit, in the order of the world's objects.
inline std::uint64_t stateHash(const btDeformableMultiBodyDynamicsWorld& world) {
  std::uint64_t hash = kStateHashBasis;
  const auto add = [&](const btVector3& v) { hash = fnv1a(&v[0], 3 * sizeof v[0], hash); };
  for (int i = 0; i < world.getNumCollisionObjects(); ++i) {
    const btCollisionObject* object = world.getCollisionObjectArray()[i];
    if (const btSoftBody* soft = btSoftBody::upcast(object)) {
      for (int n = 0; n < soft->m_nodes.size(); ++n) {
        add(soft->m_nodes[n].m_x);
        add(soft->m_nodes[n].m_v);
      }
      continue;
    }
    for (int row = 0; row < 3; ++row) add(object->getWorldTransform().getBasis()[row]);
    add(object->getWorldTransform().getOrigin());
    if (const btRigidBody* rigid = btRigidBody::upcast(object)) {
      add(rigid->getLinearVelocity());
      add(rigid->getAngularVelocity());
    }
  }
  return hash;
}

}  // namespace tetskin::bullet_detail
