// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <tetskin/bullet/src/rows/rigid_rows.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <unordered_map>

namespace tetskin::bullet_detail {
namespace {

/// D over effective masses: higher than for soft bodies, as both bodies are rigid.
constexpr double kRigidStiffness = 200.0;
/// Most bodies of one step to which rows are followed: a bound of its cost. Heaps of 300 and 1,000 boxes on a mat cost
/// as much per box.
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
    // The list grows by the bodies that those before in it touch, nearest first.
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
    if (room && object.isActive()) return rigids_.at(object, position);
    RigidPoint point;
    point.arm = position - object.getWorldTransform().getOrigin();
    return point;
  }

  /// Bullet's contacts are between straight paths; only the path of a kinematic body is known from its transforms.
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
    row.stiffness = static_cast<btScalar>(kRigidStiffness) * row.effectiveMass;
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
  std::unordered_map<const void*, std::vector<std::size_t>> edgesOf_;  ///< by the bodies' keys: in `edges_`
};

/// The rows of a joint, in the form in which Bullet's solver asks for them.
struct JointRows {
  /// One row for each degree of freedom; and btScalars from one to the next.
  static constexpr std::size_t kMaxRows = 6, kStride = 16;
  std::array<btScalar, kMaxRows * kStride> linearA{}, angularA{}, linearB{}, angularB{}, rest{}, softness{}, lowest{},
      highest{};

  btTypedConstraint::btConstraintInfo2 info(btScalar seconds) {
    btTypedConstraint::btConstraintInfo2 info;
    info.fps = 1 / seconds;
    info.erp = btScalar(0.2);
    info.m_J1linearAxis = linearA.data();
    info.m_J1angularAxis = angularA.data();
    info.m_J2linearAxis = linearB.data();
    info.m_J2angularAxis = angularB.data();
    info.rowskip = static_cast<int>(kStride);
    info.m_constraintError = rest.data();
    info.cfm = softness.data();
    info.m_lowerLimit = lowest.data();
    info.m_upperLimit = highest.data();
    info.m_damping = 1;
    return info;
  }
};

btVector3 vectorAt(const std::array<btScalar, JointRows::kMaxRows * JointRows::kStride>& from, int row) {
  assert(row >= 0 && row < static_cast<int>(JointRows::kMaxRows));
  const auto at = static_cast<std::size_t>(row) * JointRows::kStride;
  return {from[at], from[at + 1], from[at + 2]};
}

/// Each row begins with the impulse that Bullet has left it, and adds what else is needed.
void RigidRowCollector::addJoint(btTypedConstraint& joint) {
  btTypedConstraint::btConstraintInfo1 counts{};
  joint.getInfo1(&counts);
  if (counts.m_numConstraintRows <= 0 || counts.m_numConstraintRows > static_cast<int>(JointRows::kMaxRows)) return;
  JointRows from;
  from.lowest.fill(-BT_LARGE_FLOAT);
  from.highest.fill(BT_LARGE_FLOAT);
  auto info = from.info(seconds_);
  joint.getInfo2(&info);
  const btRigidBody &a = joint.getRigidBodyA(), &b = joint.getRigidBodyB();
  for (int k = 0; k < counts.m_numConstraintRows; ++k) {
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
    row.ends[0].rigid = at(a, vectorAt(from.linearA, k), vectorAt(from.angularA, k));
    // The row of the other body has the opposite sign.
    row.ends[1].rigid = at(b, -vectorAt(from.linearB, k), -vectorAt(from.angularB, k));
    row.effectiveMass = static_cast<btScalar>(massOf(row, rigids_));
    if (!(row.effectiveMass > 0)) continue;
    const auto index = static_cast<std::size_t>(k) * JointRows::kStride;
    row.stiffness = static_cast<btScalar>(kRigidStiffness) * row.effectiveMass;
    if (from.softness[index] > 0) {
      row.stiffness = std::min(row.stiffness, row.effectiveMass / from.softness[index]);
    }
    row.lowest = from.lowest[index];
    row.highest = from.highest[index];
    rows_.add(row, origin);
  }
}

}  // namespace

void collectRigidRows(btDiscreteDynamicsWorld& world, btScalar seconds, RigidUnknowns& rigids, ContactRows& rows) {
  assert(seconds > 0);
  if (!rigids.list().empty()) RigidRowCollector(seconds, rigids, rows).collect(world);
}

}  // namespace tetskin::bullet_detail
