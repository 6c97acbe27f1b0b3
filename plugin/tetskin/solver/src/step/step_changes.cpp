// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What the application adds and removes when Bullet calls it. Between steps, whatever has been removed is forgotten. In
// the middle of a step, it is taken out of the step, which continues with the rest; whatever has been added takes part
// from the next step on.
#include <BulletSoftBody/btDeformableContactProjection.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/search/body_contacts.h>
#include <tetskin/solver/src/step/step.h>

#include <algorithm>

namespace tetskin {
namespace {

template <class Contact>
void dropContactsWith(const StepObjects::Gone& gone, btAlignedObjectArray<Contact>& contacts) {
  int left = 0;
  for (int k = 0; k < contacts.size(); ++k) {
    if (gone.count(contacts[k].m_cti.m_colObj) > 0) continue;
    if (left != k) contacts[left] = contacts[k];
    ++left;
  }
  while (contacts.size() > left) contacts.pop_back();
}

bool isIn(const ForceList& forces, const btDeformableLagrangianForce* force) {
  for (int i = 0; i < forces.size(); ++i) {
    if (forces[i] == force) return true;
  }
  return false;
}

}  // namespace

void DeformableSolver::Impl::know(btDeformableMultiBodyDynamicsWorld& world) {
  known = &world;
  knownInfo = &world.getWorldInfo();
}

btDeformableMultiBodyDynamicsWorld* DeformableSolver::Impl::worldOf(
    const btAlignedObjectArray<btSoftBody*>& softs) const {
  for (int b = 0; b < softs.size(); ++b) {
    if (softs[b]->getWorldInfo() == knownInfo) return known;
  }
  return nullptr;
}

void DeformableSolver::Impl::dropRemoved(const btAlignedObjectArray<btSoftBody*>& world) {
  if (!inStep()) bodies.clear();  // the next step lists them anew
  const std::vector<const btSoftBody*> gone = bodies.dropAllBut(world, solver.m_softBodies);
  if (gone.empty()) return;
  for (const btSoftBody* body : gone) {
    driven.forget(*body);
    sleepers.forget(*body);
    stillness.forget(*body);
    impacts.forget(*body);
    if (auto* own = bodyWithTrees(*const_cast<btSoftBody*>(body))) own->setMovesCountedBy(nullptr);
  }
  if (!inStep()) {
    // The next step numbers the nodes.
    solver.m_objective->m_nodes.resizeNoInitialize(0);
    return;
  }
  numberAnew();
  for (VectorStack* v : {&solver.m_dv, &solver.m_ddv, &solver.m_residual}) {
    for (int n = 0; n < v->size(); ++n) (*v)[n].setZero();
  }
  solver.m_objective->m_projection.reinitialize(true);
}

void DeformableSolver::Impl::numberAnew() {
  bodies.number(*solver.m_objective);
  solver.m_numNodes = bodies.nodeCount();
  for (VectorStack* v : {&solver.m_dv, &solver.m_ddv, &solver.m_residual, &solver.m_backupVelocity}) {
    v->resize(bodies.nodeCount(), btVector3(0, 0, 0));
  }
}

void DeformableSolver::Impl::forgetRemovedObjects(const btDeformableMultiBodyDynamicsWorld* world) {
  if (objects.world() != world) impacts = {};  // what leaves another world is not known
  if (!world || objects.world() != world || !objects.haveChanged()) return;
  const StepObjects::Gone gone = objects.gone();
  bodies.forget(gone);
  for (const btCollisionObject* object : gone) impacts.forget(*object);
  rigids.paths().forget(gone);
  sleepers.forget(gone);
}

void DeformableSolver::Impl::noteObjects() {
  objects.note(worldOf(all));
}

/// Contacts at the surface are dropped together with the pair.
void DeformableSolver::Impl::dropRemovedObjects() {
  if (!objects.haveChanged()) return;
  const StepObjects::Gone gone = objects.gone();
  for (const btCollisionObject* object : gone) impacts.forget(*object);
  for (int b = 0; b < solver.m_softBodies.size(); ++b) {
    dropContactsWith(gone, solver.m_softBodies[b]->m_nodeRigidContacts);
    dropContactsWith(gone, solver.m_softBodies[b]->m_faceRigidContacts);
    // The end of a pair usually reports this, too, but not if an application's own algorithm handled the pair.
    const BodyChannel* channel = channelOf(*solver.m_softBodies[b]);
    if (!channel || !channel->nodeContacts()) continue;
    for (const btCollisionObject* object : gone) channel->nodeContacts()->forget(*object);
  }
  findIslands(*objects.world());
}

/// Forces of the application may be deleted once they have left the list.
void DeformableSolver::Impl::dropRemovedForces() {
  for (SolvedSystem& system : bodies.systems()) {
    auto& acting = system.forces;
    acting.erase(
        std::remove_if(acting.begin(), acting.end(), [&](const auto* force) { return !isIn(forces(), force); }),
        acting.end());
  }
}

/// False for a force on a body that was added since the step began: Bullet's forces use its nodes' numbers, which are
/// not assigned yet.
bool DeformableSolver::Impl::takesPart(const btDeformableLagrangianForce& force) const {
  const auto& nodes = solver.m_objective->m_nodes;
  for (int b = 0; b < force.m_softBodies.size(); ++b) {
    const auto& own = force.m_softBodies[b]->m_nodes;
    if (own.size() == 0) continue;
    const int number = own[0].index;
    if (number < 0 || number >= nodes.size() || nodes[number] != &own[0]) return false;
  }
  return true;
}

}  // namespace tetskin
