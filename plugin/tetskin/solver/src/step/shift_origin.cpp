// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Moves all positions in a world by the same offset: those of objects, and all remembered ones.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletDynamics/ConstraintSolver/btConeTwistConstraint.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofConstraint.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btPoint2PointConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSliderConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/solver/src/search/body_contacts.h>
#include <tetskin/solver/src/step/step.h>

#include <unordered_map>
#include <vector>

namespace tetskin {
namespace {

using World = btDeformableMultiBodyDynamicsWorld;

void shiftObject(btCollisionObject& object, const btVector3& by) {
  for (const bool interpolation : {false, true}) {
    btTransform at = interpolation ? object.getInterpolationWorldTransform() : object.getWorldTransform();
    at.getOrigin() += by;
    interpolation ? object.setInterpolationWorldTransform(at) : object.setWorldTransform(at);
  }
  btRigidBody* body = btRigidBody::upcast(&object);
  if (!body || !body->getMotionState()) return;
  btTransform shown;
  body->getMotionState()->getWorldTransform(shown);
  shown.getOrigin() += by;
  body->getMotionState()->setWorldTransform(shown);
}

/// `setBasePos` sets both the current and the interpolated position, unless the base is kinematic.
void shiftMultiBody(btMultiBody& body, const btVector3& by) {
  const btVector3 base = body.getBasePos() + by, interpolated = body.getInterpolateBasePos() + by;
  body.setBasePos(base);
  body.setInterpolateBasePos(interpolated);
  for (int k = 0; k < body.getNumLinks(); ++k) body.getLink(k).m_cachedWorldTransform.getOrigin() += by;
}

template <class Joint>
void shiftFrame(btTypedConstraint& joint, bool ofA, const btVector3& by) {
  auto& held = static_cast<Joint&>(joint);
  (ofA ? held.getFrameOffsetA() : held.getFrameOffsetB()).getOrigin() += by;
}

/// The other frame of a joint with a single body is in world space.
void shiftJoint(btTypedConstraint& joint, const btVector3& by) {
  const bool ofA = &joint.getRigidBodyA() == &btTypedConstraint::getFixedBody();
  if (!ofA && &joint.getRigidBodyB() != &btTypedConstraint::getFixedBody()) return;
  switch (joint.getConstraintType()) {
    case POINT2POINT_CONSTRAINT_TYPE: {
      auto& ball = static_cast<btPoint2PointConstraint&>(joint);
      return ofA ? ball.setPivotA(ball.getPivotInA() + by) : ball.setPivotB(ball.getPivotInB() + by);
    }
    case CONETWIST_CONSTRAINT_TYPE: {
      auto& cone = static_cast<btConeTwistConstraint&>(joint);
      btTransform a = cone.getAFrame(), b = cone.getBFrame();
      (ofA ? a : b).getOrigin() += by;
      return cone.setFrames(a, b);
    }
    case HINGE_CONSTRAINT_TYPE:
      return shiftFrame<btHingeConstraint>(joint, ofA, by);
    case SLIDER_CONSTRAINT_TYPE:
      return shiftFrame<btSliderConstraint>(joint, ofA, by);
    case D6_CONSTRAINT_TYPE:
    case D6_SPRING_CONSTRAINT_TYPE:
      return shiftFrame<btGeneric6DofConstraint>(joint, ofA, by);
    case D6_SPRING_2_CONSTRAINT_TYPE:
    case FIXED_CONSTRAINT_TYPE:
      return shiftFrame<btGeneric6DofSpring2Constraint>(joint, ofA, by);
    default:
      return;  // gears have no positions
  }
}

void shiftBoxes(btDbvtNode* node, const btVector3& by) {
  if (!node) return;
  node->volume.tMins() += by;
  node->volume.tMaxs() += by;
  for (int k = 0; k < 2 && node->isinternal(); ++k) shiftBoxes(node->childs[k], by);
}

/// If boxes were moved one after the other, they would meet boxes that have not been moved yet.
void shiftBroadphase(World& world, const btVector3& by) {
  btBroadphaseInterface& broadphase = *world.getBroadphase();
  const bool inPlace = isOfSameClass<btBroadphaseInterface>(broadphase, btDbvtBroadphase());
  if (inPlace) {
    for (btDbvt& tree : static_cast<btDbvtBroadphase&>(broadphase).m_sets) shiftBoxes(tree.m_root, by);
  }
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int k = 0; k < objects.size(); ++k) {
    btBroadphaseProxy* proxy = objects[k]->getBroadphaseHandle();
    if (!proxy) continue;
    const btVector3 low = proxy->m_aabbMin + by, high = proxy->m_aabbMax + by;
    if (!inPlace) {
      broadphase.setAabb(proxy, low, high, world.getDispatcher());
      continue;
    }
    proxy->m_aabbMin = low;
    proxy->m_aabbMax = high;
  }
}

void shiftManifolds(btDispatcher& dispatcher, const btVector3& by) {
  for (int k = 0; k < dispatcher.getNumManifolds(); ++k) {
    btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(k);
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      manifold.getContactPoint(p).m_positionWorldOnA += by;
      manifold.getContactPoint(p).m_positionWorldOnB += by;
    }
  }
}

void shiftSoft(btSoftBody& body, const btVector3& by) {
  BodyWithTrees* own = bodyWithTrees(body);
  if (!own) return;
  own->shift(by);
  own->countMove();
  const BodyChannel& channel = BodyChannel::of(*own);
  for (const auto& contacts : {channel.surfaceContacts().lock(), channel.nodeContacts()}) {
    if (contacts) contacts->shift(by);
  }
}

/// False if a usable position, or a body's stored initial position, would become unusable.
bool canShift(const World& world, const btVector3& by) {
  const auto remains = [&](const btVector3& place) { return !isUsable(place) || isUsable(place + by); };
  bool all = isUsable(by);
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int k = 0; k < objects.size(); ++k) {
    all = all && remains(objects[k]->getWorldTransform().getOrigin());
    const btSoftBody* body = btSoftBody::upcast(objects[k]);
    for (int n = 0; all && body && n < body->m_nodes.size(); ++n) all = remains(body->m_nodes[n].m_x);
    const BodyWithTrees* own = body ? bodyWithTrees(*body) : nullptr;
    all = all && (!own || remains(own->shifted()));
  }
  for (int k = 0; k < world.getNumMultibodies(); ++k) all = all && remains(world.getMultiBody(k)->getBasePos());
  return all;
}

}  // namespace

void DeformableSolver::Impl::shift(World& world, const btVector3& by) {
  const std::vector<const btSoftBody*> changed = sleepers.changed();
  const Placement placement(by);
  std::unordered_map<const btSoftBody*, Dynamics*> dynamics;
  for (int i = 0; i < forces().size(); ++i) {
    auto* elastic = dynamic_cast<ElasticForce*>(inactiveForce(forces()[i]));
    if (elastic && elastic->m_softBodies.size() > 0) dynamics[elastic->body().body] = elastic->body().dynamics.get();
  }
  const btAlignedObjectArray<btSoftBody*>& softBodies = world.getSoftBodyArray();
  shiftBroadphase(world, by);
  for (int b = 0; b < softBodies.size(); ++b) {
    btSoftBody& body = *softBodies[b];
    const auto found = dynamics.find(&body);
    Dynamics* own = found == dynamics.end() ? nullptr : found->second;
    driven.carry(body, placement, [&] { carryNodes(body, own, placement); });
    shiftSoft(body, by);
  }
  const btCollisionObjectArray& inWorld = world.getCollisionObjectArray();
  for (int k = 0; k < inWorld.size(); ++k) {
    if (!btSoftBody::upcast(inWorld[k])) shiftObject(*inWorld[k], by);
  }
  for (int k = 0; k < world.getNumMultibodies(); ++k) shiftMultiBody(*world.getMultiBody(k), by);
  for (int k = 0; k < world.getNumConstraints(); ++k) shiftJoint(*world.getConstraint(k), by);
  shiftManifolds(*world.getDispatcher(), by);
  bodies.forgetTrees();
  rigids.paths().shift(by);
  sleepers.shift(by, changed);
  stillness.shift(by);
  impacts.shift(by);
  if (const auto record = recorded.lock()) record->shift(by);
  for (int i = 0; i < forces().size(); ++i) {
    if (InactiveForce* own = inactiveForce(forces()[i])) own->shift(by);
  }
}

void Access<DeformableSolver>::shift(DeformableSolver& solver, World& world, const btVector3& by) {
  solver.impl_->shift(world, by);
}

Status shiftOrigin(World& world, const btVector3& origin) {
  DeformableSolver* solver = deformableSolverOf(world);
  if (!solver) return refusal("shiftOrigin", {kUseDeformableSolver});
  if (isWithinStep(*solver)) {
    return {StatusCode::InvalidOption, "shiftOrigin: within a step; call it between two steps"};
  }
  if (!toEigen(origin).allFinite()) return {StatusCode::NonFinite, "shiftOrigin: the origin is not finite"};
  if (!canShift(world, -origin)) {
    const char* const fault =
        "shiftOrigin: coordinates would pass Limits::kMaxCoordinate; choose a point near the bodies";
    return {StatusCode::InvalidOption, fault};
  }
  Access<DeformableSolver>::shift(*solver, world, -origin);
  return {};
}

}  // namespace tetskin
