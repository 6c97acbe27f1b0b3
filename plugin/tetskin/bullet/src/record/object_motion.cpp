// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/bullet/src/record/object_motion.h>
#include <tetskin/core/src/base/hash.h>

namespace tetskin::bullet_detail {
namespace {

/// 0 and -0 are different: they are other bits.
void addBits(Hash& hash, const btVector3& v) {
  for (int k = 0; k < 3; ++k) {
    const auto x = static_cast<double>(v[k]);
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    hash.add(bits);
  }
}

void addBits(Hash& hash, const btTransform& t) {
  addBits(hash, t.getOrigin());
  for (int k = 0; k < 3; ++k) addBits(hash, t.getBasis()[k]);
}

std::uint32_t hashOfMotion(const btCollisionObject& object) {
  Hash hash;
  hash.add(static_cast<std::uint64_t>(object.getActivationState()));
  if (const btSoftBody* soft = btSoftBody::upcast(&object)) {
    for (int n = 0; n < soft->m_nodes.size(); ++n) {
      addBits(hash, soft->m_nodes[n].m_x);
      addBits(hash, soft->m_nodes[n].m_v);
    }
    return hash.mixed();
  }
  addBits(hash, object.getWorldTransform());
  if (const btRigidBody* rigid = btRigidBody::upcast(&object)) {
    addBits(hash, rigid->getLinearVelocity());
    addBits(hash, rigid->getAngularVelocity());
  }
  return hash.mixed();
}

/// Visits the motion states of kinematic bodies, in the order of the world.
template <class Visit>
void forKinematicTargets(btDeformableMultiBodyDynamicsWorld& world, Visit&& visit) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int k = 0; k < objects.size(); ++k) {
    btRigidBody* rigid = btRigidBody::upcast(objects[k]);
    if (rigid && rigid->isKinematicObject() && rigid->getMotionState()) visit(*rigid->getMotionState());
  }
}

}  // namespace

std::vector<std::uint32_t> hashesOfMotion(btDeformableMultiBodyDynamicsWorld& world) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  std::vector<std::uint32_t> hashes(static_cast<std::size_t>(objects.size()));
  for (int k = 0; k < objects.size(); ++k) hashes[static_cast<std::size_t>(k)] = hashOfMotion(*objects[k]);
  return hashes;
}

std::string nameOf(const btCollisionObject& object) {
  std::string kind = "a collision object";
  if (const btSoftBody* soft = btSoftBody::upcast(&object)) {
    kind = "a soft body of " + std::to_string(soft->m_nodes.size()) + " nodes";
  } else if (object.getInternalType() == btCollisionObject::CO_FEATHERSTONE_LINK) {
    kind = "a link of a multibody";
  } else if (btRigidBody::upcast(&object)) {
    kind = object.isStaticOrKinematicObject() ? "a fixed or kinematic rigid body" : "a rigid body";
  }
  return "object " + std::to_string(object.getWorldArrayIndex()) + " of the world, " + kind;
}

Bytes kinematicTargets(btDeformableMultiBodyDynamicsWorld& world) {
  Bytes targets;
  forKinematicTargets(world, [&](btMotionState& state) {
    btTransform target;
    state.getWorldTransform(target);
    unsigned char bytes[sizeof target];
    WorldStream stream(world, bytes, sizeof bytes);
    stream(target);
    targets.insert(targets.end(), bytes, bytes + stream.count());
  });
  return targets;
}

bool setKinematicTargets(btDeformableMultiBodyDynamicsWorld& world, const Bytes& targets) {
  WorldStream stream(world, targets.data(), targets.size());
  forKinematicTargets(world, [&](btMotionState& state) {
    btTransform target;
    stream(target);
    if (!stream.failed()) state.setWorldTransform(target);
  });
  return !stream.failed() && stream.count() == targets.size();
}

}  // namespace tetskin::bullet_detail
