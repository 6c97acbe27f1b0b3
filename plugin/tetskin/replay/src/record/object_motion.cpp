// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <LinearMath/btDefaultMotionState.h>
#include <tetskin/bullet/src/base/own_objects.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/core/src/base/hash.h>
#include <tetskin/replay/src/record/object_motion.h>
#include <tetskin/solver/src/base/opened_member.h>

#include <algorithm>

namespace tetskin::bullet_detail {

/// Direct access, because `setMotionState` would ask the new one.
using MotionStateMember = Hidden<btRigidBody, btMotionState*>;
template struct Opened<MotionStateMember, &btRigidBody::m_optionalMotionState>;

namespace {

/// 0 and -0 differ: their bits do.
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

btRigidBody* kinematicAt(btDeformableMultiBodyDynamicsWorld& world, int index) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  btRigidBody* rigid = index >= 0 && index < objects.size() ? btRigidBody::upcast(objects[index]) : nullptr;
  return rigid && rigid->isKinematicObject() ? rigid : nullptr;
}

struct Target {
  int index = 0;  ///< in the world
  btTransform place = btTransform::getIdentity();
};

void serializeTargets(WorldStream& stream, std::vector<Target>& targets) {
  stream.each(targets, [&](Target& target) { stream(target.index), stream(target.place); });
}

btDefaultMotionState* asPlace(btMotionState* state) {
  static const btMotionState* const sample = new btDefaultMotionState;
  return state && isOfSameClass(*state, *sample) ? static_cast<btDefaultMotionState*>(state) : nullptr;
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
  std::vector<Target> targets;
  for (int k = 0; k < world.getNumCollisionObjects(); ++k) {
    const btRigidBody* body = kinematicAt(world, k);
    if (body && body->getMotionState()) targets.push_back({k, body->getWorldTransform()});
  }
  if (targets.empty()) return {};
  WorldStream counted(world);
  serializeTargets(counted, targets);
  Bytes bytes(counted.count());
  WorldStream written(world, bytes.data(), bytes.size());
  serializeTargets(written, targets);
  return bytes;
}

/// Tells Bullet, once, where the body is, and then gives the body its own motion state back.
class LedToTargets::StandIn : public btMotionState {
 public:
  explicit StandIn(btRigidBody& body) : body_(body), own_(body.getMotionState()), place_(body.getWorldTransform()) {
    body_.*memberOf(MotionStateMember()) = this;
  }
  void getWorldTransform(btTransform& to) const override {
    to = place_;
    giveBack();
  }
  void setWorldTransform(const btTransform&) override {}
  void giveBack() const {
    body_.*memberOf(MotionStateMember()) = own_;
    isDone_ = true;
  }
  /// For a step of zero length, in which Bullet does not ask the motion state.
  void giveBackIn(const btCollisionObjectArray& objects) const {
    if (isDone_ || objects.findLinearSearch(&body_) == objects.size()) return;
    if (body_.getMotionState() == this) giveBack();
  }

 private:
  btRigidBody& body_;
  btMotionState* const own_;
  const btTransform place_;
  mutable bool isDone_ = false;
};

LedToTargets::LedToTargets(btDeformableMultiBodyDynamicsWorld& world, const Bytes& bytes) : world_(world) {
  std::vector<Target> targets;
  WorldStream stream(world, bytes.data(), bytes.size());
  if (!bytes.empty()) serializeTargets(stream, targets);
  fits_ = !stream.failed() && stream.count() == bytes.size() &&
          std::all_of(targets.begin(), targets.end(), [&](const Target& t) { return kinematicAt(world, t.index); });
  if (!fits_) return;
  for (const Target& target : targets) {
    btRigidBody& body = *kinematicAt(world, target.index);
    body.getWorldTransform() = target.place;  // as Bullet does it: `setWorldTransform` would count as a change
    btDefaultMotionState* place = asPlace(body.getMotionState());
    if (place) place->setWorldTransform(target.place);
  }
  for (int k = 0; k < world.getNumCollisionObjects(); ++k) {
    btRigidBody* body = kinematicAt(world, k);
    const bool isAsked = body && body->getMotionState() && body->getActivationState() != ISLAND_SLEEPING;
    if (isAsked) standIns_.push_back(std::make_unique<StandIn>(*body));
  }
}

LedToTargets::~LedToTargets() {
  for (const auto& standIn : standIns_) standIn->giveBackIn(world_.getCollisionObjectArray());
}

}  // namespace tetskin::bullet_detail
