// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <tetskin/solver/src/rows/joint_impulses.h>
#include <tetskin/solver/src/rows/rigid_rows.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <unordered_map>

namespace tetskin::bullet_detail {
namespace {

/// D over effective masses: higher than for soft bodies, as both bodies are rigid.
constexpr double kRigidStiffness = 200.0;
/// Most bodies per step to which rows are followed: bounds the cost. Heaps of 300 and 1,000 boxes on a mat cost the
/// same per box.
constexpr std::size_t kMaxUnknowns = 2000;
/// Fraction of the bound of friction: below it, Bullet's contact sticks.
constexpr btScalar kStuck = btScalar(0.99);

double massOf(const ContactRow& row, const RigidUnknowns& rigids) {
  const double sum =
      rigids.compliance(row.ends[0].rigid, row.normal) + rigids.compliance(row.ends[1].rigid, row.normal);
  return sum > 0.0 ? 1.0 / sum : 0.0;
}

/// Collects rows of contacts and joints that have none yet.
class RigidRowCollector {
 public:
  RigidRowCollector(btScalar seconds, RigidUnknowns& rigids, ContactRows& rows)
      : seconds_(seconds), rigids_(rigids), rows_(rows) {}

  void collect(btDiscreteDynamicsWorld& world) {
    btDispatcher& dispatcher = *world.getDispatcher();
    for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
      const btPersistentManifold* manifold = dispatcher.getManifoldByIndexInternal(m);
      const btCollisionObject &a = *manifold->getBody0(), &b = *manifold->getBody1();
      if (manifold->getNumContacts() > 0 && a.hasContactResponse() && b.hasContactResponse()) {
        addEdge(a, b, {manifold, nullptr});
      }
    }
    for (int c = 0; c < world.getNumConstraints(); ++c) {
      btTypedConstraint* joint = world.getConstraint(c);
      if (joint->isEnabled()) addEdge(joint->getRigidBodyA(), joint->getRigidBodyB(), {nullptr, joint});
    }
    // The list grows by the bodies that earlier ones touch, nearest first.
    std::size_t next = 0;
    while (next < rigids_.list().size()) followFrom(RigidUnknowns::keyOf(rigids_.list()[next++]));
  }

 private:
  /// A contact or a joint of two objects, as an edge of the graph of bodies.
  struct Edge {
    const btPersistentManifold* manifold;
    btTypedConstraint* joint;
    bool followed = false;
  };

  void addEdge(const btCollisionObject& a, const btCollisionObject& b, const Edge& edge) {
    for (const btCollisionObject* object : {&a, &b}) edgesOf_[RigidUnknowns::keyOf(*object)].push_back(edges_.size());
    edges_.push_back(edge);
  }

  void followFrom(const void* key) {
    const auto found = edgesOf_.find(key);
    if (found == edgesOf_.end()) return;
    for (const std::size_t e : found->second) {
      Edge& edge = edges_[e];
      if (edge.followed) continue;
      edge.followed = true;
      if (edge.joint) {
        addJoint(*edge.joint);
        continue;
      }
      for (int k = 0; k < edge.manifold->getNumContacts(); ++k) {
        addContact(*edge.manifold->getBody0(), *edge.manifold->getBody1(), edge.manifold->getContactPoint(k));
      }
    }
  }

  RigidPoint pointOf(const btCollisionObject& object, const btVector3& position) {
    const bool room = rigids_.list().size() < kMaxUnknowns || rigids_.find(object) >= 0;
    if (room && object.isActive() && !object.isKinematicObject()) return rigids_.at(object, position);
    RigidPoint point;
    point.arm = position - object.getWorldTransform().getOrigin();
    return point;
  }

  /// Bullet's contacts assume straight paths; only the path of a kinematic body is known from its transforms.
  btVector3 velocityAt(const RigidPoint& point, const btCollisionObject& object) {
    return rigids_.velocityAt(point, object, object.isKinematicObject() ? seconds_ : 0);
  }

  /// The contact point belongs to body A.
  void addContact(const btCollisionObject& a, const btCollisionObject& b, const btManifoldPoint& from) {
    RowOrigin origin;
    origin.object = &b;
    origin.position = from.getPositionWorldOnB();
    ContactRow row;
    row.ends[0].rigid = pointOf(a, origin.position);
    row.ends[1].rigid = pointOf(b, origin.position);
    row.normal = from.m_normalWorldOnB;
    row.friction = from.m_combinedFriction;
    row.effectiveMass = static_cast<btScalar>(massOf(row, rigids_));
    row.stiffness = rows_.likeUsual(seconds_) * static_cast<btScalar>(kRigidStiffness) * row.effectiveMass;
    row.tangentStiffness = row.stiffness;
    row.relative = velocityAt(row.ends[0].rigid, a) - velocityAt(row.ends[1].rigid, b);
    const btVector3 along = from.m_appliedImpulseLateral1 * from.m_lateralFrictionDir1 +
                            from.m_appliedImpulseLateral2 * from.m_lateralFrictionDir2;
    const btScalar pushed = from.m_appliedImpulse;
    row.given = pushed * row.normal + along;
    row.normalBound = pushed;
    const btScalar target =
        pushed > 0 ? row.normal.dot(row.relative) : -std::max(from.getDistance(), btScalar(0)) / seconds_;
    row.gapVelocity = -target - pushed / row.stiffness;
    if (along.length() < kStuck * row.friction * pushed) {
      const btVector3 slipping = row.relative - row.normal.dot(row.relative) * row.normal;
      row.offsetVelocity = -slipping - along / row.tangentStiffness;
    }
    if (row.stiffness > 0) rows_.add(row, origin);
  }

  void addJoint(btTypedConstraint& joint);

  btScalar seconds_;
  RigidUnknowns& rigids_;
  ContactRows& rows_;
  std::vector<Edge> edges_;
  std::unordered_map<const void*, std::vector<std::size_t>> edgesOf_;  ///< indices in `edges_`, by the bodies' keys
};

/// The velocity that a row lacks because its impulse is at a bound: all that the bound has cost, as far as the impulse
/// may still change.
btScalar missingVelocity(const JointRows& rows, std::size_t row, btScalar impulse, btScalar velocity) {
  const btScalar missing = rows.number(rows.rest, row) - velocity;
  const btScalar lowest = rows.number(rows.lowest, row), highest = rows.number(rows.highest, row);
  const btScalar near = (1 - kStuck) * std::max(std::abs(impulse), std::min(std::abs(lowest), std::abs(highest)));
  if (impulse >= highest - near && missing > 0) return missing;
  if (impulse <= lowest + near && missing < 0) return missing;
  return 0;
}

/// Each row starts with the impulse of Bullet's solve, and adds what else is needed. That impulse only matters if it is
/// bounded: any other may grow and shrink freely.
void RigidRowCollector::addJoint(btTypedConstraint& joint) {
  const JointRows from(joint, seconds_);
  const btRigidBody &a = joint.getRigidBodyA(), &b = joint.getRigidBodyB();
  std::array<btScalar, JointRows::kMaxRows> impulses{};
  bool known = false;
  for (std::size_t k = 0; k < from.count; ++k) {
    RowOrigin origin;
    origin.object = &b;
    origin.position = a.getWorldTransform().getOrigin();
    ContactRow row;
    row.normal.setValue(1, 0, 0);
    const auto at = [&](const btRigidBody& body, const btVector3& linear, const btVector3& angular) {
      RigidPoint point = pointOf(body, body.getWorldTransform().getOrigin());
      if (point.unknown >= 0) point.jacobian = rigids_.addScalarJacobian(linear, angular);
      return point;
    };
    row.ends[0].rigid = at(a, from.vector(from.linearA, k), from.vector(from.angularA, k));
    // The row of the other body has the opposite sign.
    row.ends[1].rigid = at(b, -from.vector(from.linearB, k), -from.vector(from.angularB, k));
    row.effectiveMass = static_cast<btScalar>(massOf(row, rigids_));
    if (!(row.effectiveMass > 0)) continue;
    row.stiffness = rows_.likeUsual(seconds_) * static_cast<btScalar>(kRigidStiffness) * row.effectiveMass;
    const btScalar softness = from.number(from.softness, k);
    if (softness > 0) row.stiffness = std::min(row.stiffness, row.effectiveMass / softness);
    row.lowest = from.number(from.lowest, k);
    row.highest = from.number(from.highest, k);
    if (from.isBounded(k)) {
      if (!known) impulses = JointImpulses::of(joint, from, seconds_);
      known = true;
      const btScalar applied = std::min(std::max(impulses[k], row.lowest), row.highest);
      row.given = applied * row.normal;
      row.gapVelocity = -missingVelocity(from, k, applied, from.velocity(joint, k)) - applied / row.stiffness;
    }
    rows_.add(row, origin);
  }
}

}  // namespace

void collectRigidRows(btDiscreteDynamicsWorld& world, btScalar seconds, RigidUnknowns& rigids, ContactRows& rows) {
  assert(seconds > 0);
  if (!rigids.list().empty()) RigidRowCollector(seconds, rigids, rows).collect(world);
}

}  // namespace tetskin::bullet_detail
