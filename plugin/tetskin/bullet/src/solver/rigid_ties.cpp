// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletSoftBody/btDeformableContactProjection.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/coupling_force.h>
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/rigid_ties.h>
#include <tetskin/bullet/src/solver/sliding.h>

#include <Eigen/LU>
#include <algorithm>
#include <set>

namespace tetskin {
namespace {

/// W where a contact binds, over the node's diagonal block. Contacts give way by a hundredth; what a solve leaves of
/// their forces, which is more with more, is 0.2 % of an impact.
constexpr btScalar kBinding = 100;

using NodeContact = btDeformableNodeRigidContactConstraint;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

RigidVector wrench(const btVector3& force, const btVector3& arm) {
  const btVector3 torque = arm.cross(force);
  RigidVector result;
  for (int k = 0; k < 3; ++k) {
    result[k] = static_cast<double>(force[k]);
    result[3 + k] = static_cast<double>(torque[k]);
  }
  return result;
}

btVector3 velocityAt(const RigidVector& v, const btVector3& arm) {
  const auto part = [&](int at) {
    return btVector3(static_cast<btScalar>(v[at]), static_cast<btScalar>(v[at + 1]), static_cast<btScalar>(v[at + 2]));
  };
  return part(0) + part(3).cross(arm);
}

/// As btRigidBody::applyImpulse has it; symmetric where factors lock single axes.
Matrix6 inverseMass(const btRigidBody& rigid) {
  Matrix6 inverse = Matrix6::Zero();
  const btVector3 &linear = rigid.getLinearFactor(), &angular = rigid.getAngularFactor();
  for (int i = 0; i < 3; ++i) {
    inverse(i, i) = static_cast<double>(rigid.getInvMass() * linear[i]);
    for (int j = 0; j < 3; ++j) {
      inverse(3 + i, 3 + j) = static_cast<double>(angular[i] * rigid.getInvInertiaTensorWorld()[i][j] * angular[j]);
    }
  }
  return inverse;
}

/// Sum of J^T W J.
Matrix6 weightOf(const std::vector<RigidTie>& ties) {
  Matrix6 sum = Matrix6::Zero();
  for (const RigidTie& tie : ties) {
    for (int k = 0; k < 6; ++k) {
      sum.col(k) += wrench(tie.weight * velocityAt(RigidVector::Unit(k), tie.arm), tie.arm);
    }
  }
  return sum;
}

/// Onto the directions in which a node's contacts have fixed its velocity.
btMatrix3x3 bindingPart(const btAlignedObjectArray<btVector3>& directions) {
  if (directions.size() >= 3) return btMatrix3x3::getIdentity();
  if (directions.size() == 1) return btMatrix3x3::getIdentity() - resistanceAcross(directions[0], 1);
  btVector3 free = directions[0].cross(directions[1]);
  if (free.length2() < SIMD_EPSILON) return btMatrix3x3::getIdentity() - resistanceAcross(directions[0], 1);
  return resistanceAcross(free.normalized(), 1);
}

template <class Visit>
void forNodeContacts(const btDeformableContactProjection& projection, const SolverBodies& bodies, Visit&& visit) {
  for (std::size_t b = 0; b < bodies.bodies().size(); ++b) {
    const auto& contacts = projection.m_nodeRigidConstraints[static_cast<int>(b)];
    for (int k = 0; k < contacts.size(); ++k) visit(b, contacts[k]);
  }
}

const btCollisionObject* objectOf(const btDeformableRigidContactConstraint& contact) {
  return contact.m_contact->m_cti.m_colObj;
}

/// Null where it is not known: of a body that is not elastic, or has been moved since.
btDiscreteDynamicsWorld* worldOf(const SolvedBody& of) {
  if (!of.elastic) return nullptr;
  return of.body->getWorldInfo() == of.elastic->worldInfo ? of.elastic->world : nullptr;
}

/// Whether the contact has a part in where its node goes.
bool acts(const NodeContact& contact) {
  return contact.m_binding || !contact.getDv(contact.m_node).isZero();
}

btVector3 solutionAt(const SolvedBody& of, std::size_t node) {
  const auto& matrix = of.dynamics->matrix();
  return fromWide(matrix.solution() + matrix.wideOf(node));
}

/// With the weight of what binds alone.
RigidTie makeTie(std::size_t b, const SolvedBody& of, const NodeContact& contact,
                 const btAlignedObjectArray<btVector3>& directions) {
  RigidTie tie;
  tie.body = b;
  tie.node = of.placeOf(contact.m_node->index);
  tie.normal = contact.m_contact->m_cti.m_normal;
  tie.arm = contact.m_contact->m_c1;
  tie.relative = fromPoint(of.dynamics->velocity(tie.node)) - contact.getVa();
  btScalar d[6];
  of.dynamics->matrix().diagonal(tie.node, d);
  tie.weight = bindingPart(directions) * (kBinding * std::max({d[0], d[3], d[5]}));
  tie.wanted = tie.weight * (tie.relative + solutionAt(of, tie.node));
  return tie;
}

/// What ties do to their rigid body at the solutions as they are: how its velocity differs from what it was.
RigidVector velocityChange(const TiedRigid& of, const SolverBodies& bodies) {
  RigidVector sum = of.known;
  for (const RigidTie& tie : of.ties) {
    sum += wrench(tie.weight * solutionAt(bodies.bodies()[tie.body], tie.node), tie.arm);
  }
  return of.compliance * sum;
}

}  // namespace

void RigidTies::collect(const btDeformableContactProjection& projection, const ForceList& forces,
                        SolverBodies& bodies) {
  rigids_.clear();
  places_.clear();
  numbers_.clear();
  listRigids(projection, bodies);
  if (places_.empty()) return;
  dropOthers(projection, bodies);
  dropMoved(forces);
  dropOfWorlds(bodies);
  listNodes(projection, bodies);
  makeTies(projection, bodies);
  addWeights(bodies);
}

void RigidTies::listRigids(const btDeformableContactProjection& projection, const SolverBodies& bodies) {
  forNodeContacts(projection, bodies, [&](std::size_t b, const NodeContact& contact) {
    const btRigidBody* rigid = btRigidBody::upcast(objectOf(contact));
    const SolvedBody& of = bodies.bodies()[b];
    if (!of.elastic || !rigid || rigid->isStaticOrKinematicObject() || !acts(contact)) return;
    if (!worldOf(of) || !(rigid->getInvMass() > 0)) return;
    if (!places_.emplace(rigid, rigids_.size()).second) return;
    rigids_.emplace_back();
    rigids_.back().rigid = const_cast<btRigidBody*>(rigid);
  });
}

/// Their places lead nowhere from here on.
void RigidTies::dropOthers(const btDeformableContactProjection& projection, const SolverBodies& bodies) {
  const auto drop = [&](const btCollisionObject* object) { places_.erase(object); };
  for (std::size_t b = 0; b < bodies.bodies().size(); ++b) {
    const auto at = static_cast<int>(b);
    const auto& faces = projection.m_faceRigidConstraints[at];
    for (int k = 0; k < faces.size(); ++k) drop(objectOf(faces[k]));
    const auto& anchors = projection.m_nodeAnchorConstraints[at];
    for (int k = 0; k < anchors.size(); ++k) drop(anchors[k].m_anchor->m_cti.m_colObj);
    if (bodies.bodies()[b].elastic) continue;
    const auto& nodes = projection.m_nodeRigidConstraints[at];
    for (int k = 0; k < nodes.size(); ++k) drop(objectOf(nodes[k]));
  }
}

void RigidTies::dropMoved(const ForceList& forces) {
  for (int f = 0; f < forces.size(); ++f) {
    const auto* coupling = dynamic_cast<const CouplingForce*>(forces[f]);
    for (auto at = places_.begin(); coupling && at != places_.end();) {
      at = coupling->moves(*at->first) ? places_.erase(at) : std::next(at);
    }
  }
}

void RigidTies::dropOfWorlds(const SolverBodies& bodies) {
  std::set<btDiscreteDynamicsWorld*> worlds;
  for (const SolvedBody& of : bodies.bodies()) worlds.insert(worldOf(of));
  worlds.erase(nullptr);
  for (btDiscreteDynamicsWorld* world : worlds) {
    for (int c = 0; c < world->getNumConstraints(); ++c) {
      const btTypedConstraint& joint = *world->getConstraint(c);
      if (!joint.isEnabled()) continue;
      places_.erase(&joint.getRigidBodyA());
      places_.erase(&joint.getRigidBodyB());
    }
    btDispatcher& dispatcher = *world->getDispatcher();
    for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
      const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
      if (manifold.getNumContacts() == 0) continue;
      places_.erase(manifold.getBody0());
      places_.erase(manifold.getBody1());
    }
  }
}

/// Those which a tied rigid body alone has a part in.
void RigidTies::listNodes(const btDeformableContactProjection& projection, const SolverBodies& bodies) {
  std::set<int> others;
  forNodeContacts(projection, bodies, [&](std::size_t b, const NodeContact& contact) {
    if (!acts(contact)) return;
    const int number = contact.m_node->index;
    const SolvedBody& of = bodies.bodies()[b];
    const auto place = places_.find(objectOf(contact));
    const bool known = place != places_.end() && of.dynamics->matrix().mass(of.placeOf(number)) > 0;
    if (!known || numbers_.emplace(number, Place{place->second, 0}).first->second.rigid != place->second) {
      others.insert(number);
    }
  });
  for (auto at = numbers_.begin(); at != numbers_.end();) {
    const bool binds = projection.m_projectionsDict.find(btHashInt(at->first)) != nullptr;
    at = binds && others.count(at->first) == 0 ? std::next(at) : numbers_.erase(at);
  }
}

void RigidTies::makeTies(const btDeformableContactProjection& projection, SolverBodies& bodies) {
  forNodeContacts(projection, bodies, [&](std::size_t b, const NodeContact& contact) {
    const auto found = numbers_.find(contact.m_node->index);
    if (found == numbers_.end() || !acts(contact)) return;
    TiedRigid& of = rigids_[found->second.rigid];
    SolvedBody& body = bodies.bodies()[b];
    if (found->second.tie == 0) {
      of.ties.push_back(makeTie(b, body, contact, *projection.m_projectionsDict.find(btHashInt(found->first))));
      found->second.tie = of.ties.size();
    }
    const btVector3 dv = contact.getDv(contact.m_node);
    if (!isNoNumber(dv)) of.known += wrench(contact.getContact()->m_c5.inverse() * dv, contact.m_contact->m_c1);
    of.ties[found->second.tie - 1].weight +=
        resistanceAcross(contact.m_contact->m_cti.m_normal, slidingOf(body, contact).resistance);
    body.touched = true;
  });
}

void RigidTies::addWeights(SolverBodies& bodies) {
  for (TiedRigid& of : rigids_) {
    for (const RigidTie& tie : of.ties) {
      const btMatrix3x3& w = tie.weight;
      const btScalar block[6] = {w[0][0], w[0][1], w[0][2], w[1][1], w[1][2], w[2][2]};
      bodies.bodies()[tie.body].dynamics->matrix().resist(tie.node, block);
      of.known += wrench(w * tie.relative - tie.wanted, tie.arm);
    }
    const Matrix6 inverse = inverseMass(*of.rigid);
    of.compliance = (Matrix6::Identity() + inverse * weightOf(of.ties)).partialPivLu().solve(inverse);
  }
}

void RigidTies::addForces(const std::vector<std::size_t>& rigids, const SolverBodies& bodies,
                          VectorStack& residual) const {
  for (const std::size_t r : rigids) {
    const RigidVector change = velocityChange(rigids_[r], bodies);
    for (const RigidTie& tie : rigids_[r].ties) {
      const int number = bodies.bodies()[tie.body].first + static_cast<int>(tie.node);
      residual[number] += tie.weight * (velocityAt(change, tie.arm) - tie.relative) + tie.wanted;
    }
  }
}

void RigidTies::addProducts(const std::vector<std::size_t>& rigids, const SolverBodies& bodies,
                            std::vector<std::vector<btScalar>>& products) const {
  for (const std::size_t r : rigids) {
    const TiedRigid& of = rigids_[r];
    RigidVector sum = RigidVector::Zero();
    for (const RigidTie& tie : of.ties) {
      const auto& matrix = bodies.bodies()[tie.body].dynamics->matrix();
      sum += wrench(tie.weight * fromPoint(matrix.stepPoints() + 4 * matrix.slotOf(tie.node)), tie.arm);
    }
    const RigidVector change = of.compliance * sum;
    for (const RigidTie& tie : of.ties) {
      btScalar* to = &products[tie.body][bodies.bodies()[tie.body].dynamics->matrix().wideOf(tie.node)];
      toWide(fromWide(to) - tie.weight * velocityAt(change, tie.arm), to);
    }
  }
}

void RigidTies::finish(SolverBodies& bodies) const {
  for (const TiedRigid& of : rigids_) {
    if (of.ties.empty()) continue;
    const RigidVector change = velocityChange(of, bodies);
    for (const RigidTie& tie : of.ties) {
      const SolvedBody& body = bodies.bodies()[tie.body];
      const btVector3 moves = tie.relative + solutionAt(body, tie.node) - velocityAt(change, tie.arm);
      const btVector3 force = tie.wanted - tie.weight * moves;
      (*body.normalImpulses)[tie.node] = std::max(btScalar(0), force.dot(tie.normal));
    }
    of.rigid->setLinearVelocity(of.rigid->getLinearVelocity() + velocityAt(change, btVector3(0, 0, 0)));
    RigidVector turn = RigidVector::Zero();
    turn.head<3>() = change.tail<3>();
    of.rigid->setAngularVelocity(of.rigid->getAngularVelocity() + velocityAt(turn, btVector3(0, 0, 0)));
  }
}

}  // namespace tetskin
