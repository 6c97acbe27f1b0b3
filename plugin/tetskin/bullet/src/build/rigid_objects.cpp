// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <LinearMath/btDefaultMotionState.h>
#include <tetskin/bullet/src/build/rigid_objects.h>
#include <tetskin/bullet/src/build/rigid_shapes.h>
#include <tetskin/bullet/src/state/bullet_members.h>
#include <tetskin/bullet/src/state/world_state.h>

namespace tetskin::bullet_detail {
namespace {

/// -1 stands for Bullet's own fixed body, to which a joint holds one body in space.
constexpr int kFixedBody = -1;

int placeOf(btDeformableMultiBodyDynamicsWorld& world, const btRigidBody& body) {
  const int index = body.getWorldArrayIndex();
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  return index >= 0 && index < objects.size() && objects[index] == &body ? index : kFixedBody;
}

btRigidBody* bodyAt(BuildStream& stream, int index) {
  if (index == kFixedBody) return &btTypedConstraint::getFixedBody();
  const btCollisionObjectArray& objects = stream.world().getCollisionObjectArray();
  btRigidBody* body = index >= 0 && index < objects.size() ? btRigidBody::upcast(objects[index]) : nullptr;
  stream.require(body, "a joint of something else than a rigid body");
  return body;
}

std::unique_ptr<btTypedConstraint> buildJoint(BuildStream& stream, const btTypedConstraint* joint) {
  int kind = joint ? classOfJoint(*joint) : 0, first = 0, second = 0;
  if (joint) {
    first = placeOf(stream.world(), joint->getRigidBodyA());
    second = placeOf(stream.world(), joint->getRigidBodyB());
  }
  visitAll(stream, kind, first, second);
  if (joint || stream.failed()) return nullptr;
  btRigidBody *a = bodyAt(stream, first), *b = bodyAt(stream, second);
  if (!a || !b) return nullptr;
  std::unique_ptr<btTypedConstraint> made = makeJoint(kind, *a, *b);
  stream.require(made != nullptr, "a joint of a later version");
  if (made) stream.world().addConstraint(made.get(), false);
  return made;
}

}  // namespace

void ObjectFilters::readFrom(const btCollisionObject& object) {
  group = object.getBroadphaseHandle()->m_collisionFilterGroup;
  mask = object.getBroadphaseHandle()->m_collisionFilterMask;
  userIndex = object.getUserIndex();
}

void ObjectFilters::visit(BuildStream& stream) {
  visitAll(stream, group, mask, userIndex);
}

BuiltObject buildObject(BuildStream& stream, btCollisionObject* object) {
  btRigidBody* rigid = object ? btRigidBody::upcast(object) : nullptr;
  bool isRigid = rigid, moves = rigid && rigid->getMotionState();
  if (object && !rigid && object->getInternalType() != btCollisionObject::CO_COLLISION_OBJECT) {
    stream.refuse(object->getInternalType() == btCollisionObject::CO_FEATHERSTONE_LINK
                      ? "a multibody"
                      : "a collision object that is no rigid body");
  }
  ObjectFilters filters;
  if (object) filters.readFrom(*object);
  filters.visit(stream);
  visitAll(stream, isRigid, moves);
  BuiltObject built;
  built.shape = buildShape(stream, object ? object->getCollisionShape() : nullptr);
  if (object || !built.shape || stream.failed()) return built;
  if (isRigid) {
    if (moves) built.motion = std::make_unique<btDefaultMotionState>();
    auto made = std::make_unique<btRigidBody>(btScalar(0), built.motion.get(), built.shape.get());
    stream.world().addRigidBody(made.get(), filters.group, filters.mask);
    built.object = std::move(made);
  } else {
    built.object = std::make_unique<btCollisionObject>();
    built.object->setCollisionShape(built.shape.get());
    stream.world().addCollisionObject(built.object.get(), filters.group, filters.mask);
  }
  built.object->setUserIndex(filters.userIndex);
  return built;
}

std::vector<std::unique_ptr<btTypedConstraint>> buildJoints(BuildStream& stream) {
  btDeformableMultiBodyDynamicsWorld& world = stream.world();
  if (stream.saving() && world.getNumMultiBodyConstraints() > 0) stream.refuse("a joint of multibodies");
  std::vector<std::unique_ptr<btTypedConstraint>> joints;
  const std::size_t count = stream.length(static_cast<std::size_t>(world.getNumConstraints()));
  for (std::size_t k = 0; k < count && !stream.failed(); ++k) {
    std::unique_ptr<btTypedConstraint> made =
        buildJoint(stream, stream.saving() ? world.getConstraint(static_cast<int>(k)) : nullptr);
    if (made) joints.push_back(std::move(made));
  }
  return joints;
}

}  // namespace tetskin::bullet_detail
