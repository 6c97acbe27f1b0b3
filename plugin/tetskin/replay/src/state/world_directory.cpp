// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/core/src/base/hash.h>
#include <tetskin/replay/src/state/bullet_members.h>
#include <tetskin/replay/src/state/world_directory.h>
#include <tetskin/replay/src/state/world_state.h>

#include <algorithm>
#include <map>
#include <string>

namespace tetskin::bullet_detail {

using World = btDeformableMultiBodyDynamicsWorld;

using MovingBodiesMember = Hidden<btDiscreteDynamicsWorld, btAlignedObjectArray<btRigidBody*>>;
template struct Opened<MovingBodiesMember, &btDiscreteDynamicsWorld::m_nonStaticRigidBodies>;
using JointsMember = Hidden<btDiscreteDynamicsWorld, btAlignedObjectArray<btTypedConstraint*>>;
template struct Opened<JointsMember, &btDiscreteDynamicsWorld::m_constraints>;
using MultiBodiesMember = Hidden<btMultiBodyDynamicsWorld, btAlignedObjectArray<btMultiBody*>>;
template struct Opened<MultiBodiesMember, &btMultiBodyDynamicsWorld::m_multiBodies>;
using BodyJointsMember = Hidden<btMultiBodyDynamicsWorld, btAlignedObjectArray<btMultiBodyConstraint*>>;
template struct Opened<BodyJointsMember, &btMultiBodyDynamicsWorld::m_multiBodyConstraints>;

namespace {

void add(Hash& hash, const btVector3& v) {
  for (int k = 0; k < 3; ++k) hash.add(static_cast<double>(v[k]));
}

void addShape(Hash& hash, const btCollisionShape& shape) {
  hash.add(static_cast<std::uint64_t>(shape.getShapeType()));
  if (shape.isSoftBody()) return;
  hash.add(static_cast<double>(shape.getMargin()));
  add(hash, shape.getLocalScaling());
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  add(hash, low);
  add(hash, high);
  if (shape.isCompound()) {
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    hash.add(static_cast<std::uint64_t>(compound.getNumChildShapes()));
    for (int k = 0; k < compound.getNumChildShapes(); ++k) {
      const btTransform& place = compound.getChildTransform(k);
      for (int row = 0; row < 3; ++row) add(hash, place.getBasis()[row]);
      add(hash, place.getOrigin());
      addShape(hash, *compound.getChildShape(k));
    }
  } else if (shape.getShapeType() == STATIC_PLANE_PROXYTYPE) {
    const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
    add(hash, plane.getPlaneNormal());
    hash.add(static_cast<double>(plane.getPlaneConstant()));
  } else if (shape.getShapeType() == CONVEX_HULL_SHAPE_PROXYTYPE) {
    const auto& hull = static_cast<const btConvexHullShape&>(shape);
    for (int k = 0; k < hull.getNumPoints(); ++k) add(hash, hull.getUnscaledPoints()[k]);
  }
}

/// The nodes of the tets, as distances in memory. The tets' computations are independent.
void addTets(Hash& hash, const btSoftBody& body) {
  hash.add(static_cast<std::uint64_t>(body.m_nodes.size()));
  hash.add(static_cast<std::uint64_t>(body.m_tetras.size()));
  if (body.m_nodes.size() == 0) return;
  std::uint64_t sum = 0;
  for (int t = 0; t < body.m_tetras.size(); ++t) {
    Hash tet;
    tet.add(static_cast<std::uint64_t>(t));
    for (const btSoftBody::Node* node : body.m_tetras[t].m_n)
      tet.add(static_cast<std::uint64_t>(node - &body.m_nodes[0]));
    sum += tet.value();
  }
  hash.add(sum);
}

std::uint64_t fingerprintOf(btCollisionObject& object) {
  Hash hash;
  hash.add(static_cast<std::uint64_t>(object.getInternalType()));
  addShape(hash, *object.getCollisionShape());
  if (const btSoftBody* soft = btSoftBody::upcast(&object)) addTets(hash, *soft);
  return hash.value();
}

std::int64_t fingerprintOf(const btMultiBody& body) {
  Hash hash;
  hash.add(static_cast<std::uint64_t>(body.getNumLinks()));
  hash.add(static_cast<std::uint64_t>(body.hasFixedBase()));
  for (int k = 0; k < body.getNumLinks(); ++k) {
    const btMultibodyLink& link = body.getLink(k);
    for (const int n : {link.m_parent, static_cast<int>(link.m_jointType), link.m_dofCount}) {
      hash.add(static_cast<std::uint64_t>(n));
    }
  }
  return static_cast<std::int64_t>(hash.value());
}

/// -1: none, or not in this world.
std::int64_t indexOf(World& world, const btCollisionObject* object) {
  if (!object) return -1;
  const int index = object->getWorldArrayIndex();
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  return index >= 0 && index < objects.size() && objects[index] == object ? index : -1;
}
std::int64_t indexOf(World& world, const btMultiBody* body) {
  for (int k = 0; k < world.getNumMultibodies(); ++k) {
    if (world.getMultiBody(k) == body) return k;
  }
  return -1;
}

const char* kindOf(int type) {
  switch (type) {
    case btCollisionObject::CO_RIGID_BODY:
      return "a rigid body";
    case btCollisionObject::CO_SOFT_BODY:
      return "a soft body";
    case btCollisionObject::CO_FEATHERSTONE_LINK:
      return "the collider of a link";
    default:
      return "a collision object";
  }
}

/// Matches each saved item with the first equal item of the current list that is not taken yet.
/// Returns the index of the first saved item that is missing, or -1.
template <class Keys>
int findKeys(const Keys& saved, const Keys& now, std::vector<int>& at) {
  std::vector<char> taken(now.size(), 0);
  at.clear();
  for (std::size_t k = 0; k < saved.size(); ++k) {
    // They are mostly in the same order.
    const auto fits = [&](std::size_t n) { return n < now.size() && !taken[n] && now[n] == saved[k]; };
    std::size_t n = k;
    if (!fits(n)) {
      for (n = 0; n < now.size() && !fits(n);) ++n;
    }
    if (n == now.size()) return static_cast<int>(k);
    taken[n] = 1;
    at.push_back(static_cast<int>(n));
  }
  return -1;
}

Status mismatch(const std::string& what) {
  return {StatusCode::SnapshotMismatch, "the snapshot is of another world: " + what};
}

Status compareKeys(const char* kind, int missing, std::size_t saved, std::size_t now) {
  const std::string counts = " (it has " + std::to_string(saved) + ", the world " + std::to_string(now) + ")";
  if (missing >= 0)
    return mismatch("its " + (kind + (" " + std::to_string(missing))) + " is missing or different" + counts);
  if (saved < now) return mismatch("the world has more of the kind " + (kind + counts));
  return {};
}

template <class Item>
void reorder(btAlignedObjectArray<Item*>& list, const std::vector<int>& at) {
  std::vector<Item*> ordered;
  ordered.reserve(at.size());
  for (const int k : at) ordered.push_back(list[k]);
  for (std::size_t k = 0; k < at.size(); ++k) list[static_cast<int>(k)] = ordered[k];
}

}  // namespace

WorldDirectory::WorldDirectory(World& world) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int k = 0; k < objects.size(); ++k) {
    btCollisionObject& object = *objects[k];
    objects_.push_back({object.getBroadphaseHandle()->m_uniqueId, object.getInternalType(), object.getUserIndex(),
                        fingerprintOf(object)});
  }
  const auto& moving = world.*memberOf(MovingBodiesMember());
  for (int k = 0; k < moving.size(); ++k) moving_.push_back(moving[k]->getWorldArrayIndex());
  const btSoftBodyArray& softs = world.getSoftBodyArray();
  for (int k = 0; k < softs.size(); ++k) softs_.push_back(softs[k]->getWorldArrayIndex());
  for (int k = 0; k < world.getNumMultibodies(); ++k) {
    btMultiBody& body = *world.getMultiBody(k);
    const btCollisionObject* collider = body.getBaseCollider();
    for (int link = 0; !collider && link < body.getNumLinks(); ++link) collider = body.getLink(link).m_collider;
    multibodies_.push_back({fingerprintOf(body), indexOf(world, collider), 0, 0, 0});
  }
  for (int k = 0; k < world.getNumConstraints(); ++k) {
    btTypedConstraint& joint = *world.getConstraint(k);
    joints_.push_back(
        {classOfJoint(joint), indexOf(world, &joint.getRigidBodyA()), indexOf(world, &joint.getRigidBodyB()), 0, 0});
  }
  for (int k = 0; k < world.getNumMultiBodyConstraints(); ++k) {
    btMultiBodyConstraint& joint = *world.getMultiBodyConstraint(k);
    bodyJoints_.push_back({joint.getConstraintType(), indexOf(world, joint.getMultiBodyA()),
                           indexOf(world, joint.getMultiBodyB()), joint.getLinkA(), joint.getLinkB()});
  }
}

void WorldDirectory::serialize(WorldStream& stream) {
  stream.each(objects_, [&](Object& o) { serializeAll(stream, o.id, o.type, o.userIndex, o.fingerprint); });
  stream.array(moving_);
  stream.array(softs_);
  for (auto* keys : {&multibodies_, &joints_, &bodyJoints_}) {
    stream.each(*keys, [&](Key& key) { stream.plain(key.data(), key.size()); });
  }
}

bool WorldDirectory::isSame(const WorldDirectory& now, std::size_t object) const {
  const Object& other = now.objects_[static_cast<std::size_t>(objectAt_[object])];
  return other.type == objects_[object].type && other.fingerprint == objects_[object].fingerprint;
}

/// True if all ids are there; the world may have others, too.
bool WorldDirectory::findById(const WorldDirectory& now) {
  std::map<int, int> indices;
  for (std::size_t k = 0; k < now.objects_.size(); ++k) indices[now.objects_[k].id] = static_cast<int>(k);
  objectAt_.clear();
  for (const Object& object : objects_) {
    const auto found = indices.find(object.id);
    if (found == indices.end()) return false;
    objectAt_.push_back(found->second);
    indices.erase(found);
  }
  return true;
}

Status WorldDirectory::differenceOfObjects(const WorldDirectory& now, bool byId) const {
  const auto name = [](std::size_t k, const Object& object) {
    std::string text = "object " + std::to_string(k) + " (" + kindOf(object.type);
    if (object.userIndex != -1) text += ", user index " + std::to_string(object.userIndex);
    return text + ")";
  };
  const auto missing = [](const std::vector<Object>& from, const std::vector<Object>& in) {
    std::size_t k = 0;
    const auto sameId = [&](const Object& o) { return o.id == from[k].id; };
    while (k < from.size() && std::any_of(in.begin(), in.end(), sameId)) ++k;
    return k;
  };
  if (objects_.size() < now.objects_.size()) {
    const std::size_t k = missing(now.objects_, objects_);
    return mismatch(name(k, now.objects_[k]) + " has been added to the world");
  }
  if (objects_.size() > now.objects_.size()) {
    const std::size_t k = missing(objects_, now.objects_);
    return mismatch("its " + name(k, objects_[k]) + " has been removed from the world");
  }
  for (std::size_t k = 0; k < objects_.size(); ++k) {
    if (byId && isSame(now, k)) continue;
    const std::size_t at = byId ? static_cast<std::size_t>(objectAt_[k]) : k;
    const Object& other = now.objects_[at];
    if (other.type == objects_[k].type && other.fingerprint == objects_[k].fingerprint) continue;
    return mismatch("its " + name(k, objects_[k]) + " has another shape, or other tets, than the world's " +
                    name(at, other));
  }
  return {};
}

bool WorldDirectory::listsFit() const {
  const auto fits = [this](const std::vector<int>& list, int type) {
    std::vector<char> listed(objects_.size(), 0);
    for (const int index : list) {
      if (index < 0 || static_cast<std::size_t>(index) >= objects_.size()) return false;
      if (objects_[static_cast<std::size_t>(index)].type != type || listed[static_cast<std::size_t>(index)]++)
        return false;
    }
    return true;
  };
  const auto soft = [](const Object& object) { return object.type == btCollisionObject::CO_SOFT_BODY; };
  return fits(moving_, btCollisionObject::CO_RIGID_BODY) && fits(softs_, btCollisionObject::CO_SOFT_BODY) &&
         static_cast<std::size_t>(std::count_if(objects_.begin(), objects_.end(), soft)) == softs_.size();
}

Status WorldDirectory::find(WorldDirectory now) {
  bool all = findById(now) && objects_.size() == now.objects_.size(), same = all;
  for (std::size_t k = 0; all && k < objects_.size(); ++k) {
    all = objects_[k].type == now.objects_[static_cast<std::size_t>(objectAt_[k])].type;
    same = same && all && isSame(now, k);
  }
  if (!same) {
    // The world may have been built in the same order, but after other objects had come and gone.
    const Status byOrder = differenceOfObjects(now, false);
    if (!byOrder.ok()) return all ? differenceOfObjects(now, true) : byOrder;
    objectAt_.resize(objects_.size());
    for (std::size_t k = 0; k < objects_.size(); ++k) objectAt_[k] = static_cast<int>(k);
  }
  if (!listsFit())
    return {StatusCode::Malformed, "the snapshot is damaged: its lists of bodies are not of its objects"};

  // The numbers that the snapshot uses.
  std::vector<std::int64_t> saved(objects_.size());
  for (std::size_t k = 0; k < objects_.size(); ++k) saved[static_cast<std::size_t>(objectAt_[k])] = static_cast<int>(k);
  const auto renumber = [](std::int64_t& index, const std::vector<std::int64_t>& by) {
    if (index >= 0) index = by[static_cast<std::size_t>(index)];
  };
  for (Key& key : now.multibodies_) renumber(key[1], saved);
  for (Key& key : now.joints_) renumber(key[1], saved), renumber(key[2], saved);
  Status status = compareKeys("multibody", findKeys(multibodies_, now.multibodies_, multibodyAt_), multibodies_.size(),
                              now.multibodies_.size());
  if (!status.ok()) return status;
  std::vector<std::int64_t> bodies(multibodies_.size());
  for (std::size_t k = 0; k < bodies.size(); ++k)
    bodies[static_cast<std::size_t>(multibodyAt_[k])] = static_cast<int>(k);
  for (Key& key : now.bodyJoints_) renumber(key[1], bodies), renumber(key[2], bodies);
  status = compareKeys("joint", findKeys(joints_, now.joints_, jointAt_), joints_.size(), now.joints_.size());
  if (!status.ok()) return status;
  return compareKeys("joint of multibodies", findKeys(bodyJoints_, now.bodyJoints_, bodyJointAt_), bodyJoints_.size(),
                     now.bodyJoints_.size());
}

void WorldDirectory::order(World& world) const {
  btCollisionObjectArray& objects = world.getCollisionObjectArray();
  reorder(objects, objectAt_);
  for (int k = 0; k < objects.size(); ++k) objects[k]->setWorldArrayIndex(k);
  // A body that has since become static or dynamic is in this list exactly if it was when saved.
  auto& moving = world.*memberOf(MovingBodiesMember());
  moving.resize(0);
  for (const int k : moving_) moving.push_back(btRigidBody::upcast(objects[k]));
  btSoftBodyArray& softs = world.getSoftBodyArray();
  softs.resize(0);
  for (const int k : softs_) softs.push_back(btSoftBody::upcast(objects[k]));
  reorder(world.*memberOf(MultiBodiesMember()), multibodyAt_);
  reorder(world.*memberOf(JointsMember()), jointAt_);
  reorder(world.*memberOf(BodyJointsMember()), bodyJointAt_);
}

}  // namespace tetskin::bullet_detail
