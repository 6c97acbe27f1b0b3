// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <cstdint>
#include <cstring>

namespace tetskin::bullet_detail {

/// FNV-1a.
class StateHash {
 public:
  void add(const btVector3& v) {
    for (int k = 0; k < 3; ++k) {
      const btScalar x = v[k];
      unsigned char bytes[sizeof x];
      std::memcpy(bytes, &x, sizeof x);
      for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 1099511628211u;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 1469598103934665603u;
};

/// Hash of positions and velocities of all nodes, and of transforms and velocities of all rigid bodies, to the last
/// bit, in the order of the world's objects.
inline std::uint64_t stateHash(const btDeformableMultiBodyDynamicsWorld& world) {
  StateHash hash;
  for (int i = 0; i < world.getNumCollisionObjects(); ++i) {
    const btCollisionObject* object = world.getCollisionObjectArray()[i];
    if (const btSoftBody* soft = btSoftBody::upcast(object)) {
      for (int n = 0; n < soft->m_nodes.size(); ++n) {
        hash.add(soft->m_nodes[n].m_x);
        hash.add(soft->m_nodes[n].m_v);
      }
      continue;
    }
    for (int row = 0; row < 3; ++row) hash.add(object->getWorldTransform().getBasis()[row]);
    hash.add(object->getWorldTransform().getOrigin());
    if (const btRigidBody* rigid = btRigidBody::upcast(object)) {
      hash.add(rigid->getLinearVelocity());
      hash.add(rigid->getAngularVelocity());
    }
  }
  return hash.value();
}

}  // namespace tetskin::bullet_detail
