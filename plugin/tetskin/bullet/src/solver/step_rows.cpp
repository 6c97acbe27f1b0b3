// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What bodies touch in a step: how far around them contacts are looked for, the rows that come of it, and which bodies
// are solved for together by them.
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/shared/bodies/body_trees.h>
#include <tetskin/bullet/src/solver/rigid_rows.h>
#include <tetskin/bullet/src/solver/step.h>
#include <tetskin/core/src/shared/base/disjoint_sets.h>

#include <algorithm>
#include <unordered_map>

namespace tetskin {
namespace {

/// Null where it is not known: of a body that is not elastic, or has been moved since.
btDiscreteDynamicsWorld* worldOf(const SolvedBody& of) {
  if (!of.elastic) return nullptr;
  return of.body->getWorldInfo() == of.elastic->worldInfo ? of.elastic->world : nullptr;
}

}  // namespace

/// Twice as far as gravity takes anything in a step: one of two that are in touch may be predicted to fall, and neither
/// does. And a share of the body's own way: what is stopped by some points turns others in.
void DeformableSolver::Parts::speculate(const SolvedBody& of) const {
  constexpr btScalar kShareOfWay = btScalar(0.2);
  auto* own = bodyWithTrees(*of.body);
  const btDiscreteDynamicsWorld* world = worldOf(of);
  if (!own || !world) return;
  btScalar fastest = 0;
  for (int n = 0; n < of.body->m_nodes.size(); ++n) fastest = std::max(fastest, of.body->m_nodes[n].m_v.length2());
  const btScalar falls = 2 * world->getGravity().length() * dt() * dt();
  own->setSpeculation(falls + kShareOfWay * btSqrt(fastest) * dt());
  // The box that the broadphase is given has it; the trees, which are fitted to the margin, have not.
  of.body->updateBounds();
}

std::vector<RowSource*> DeformableSolver::Parts::rowSources() {
  std::vector<RowSource*> sources;
  for (int i = 0; i < forces().size(); ++i) {
    if (auto* source = dynamic_cast<RowSource*>(forces()[i])) sources.push_back(source);
  }
  return sources;
}

void DeformableSolver::Parts::collectRows() {
  rigids.clear();
  rows.collect(bodies, rigids, rowSources(), dt());
  collectRigidRowsOfWorlds();
  joinByRows();
  for (SolvedBody& of : bodies.bodies()) {
    if (of.wasTouched && of.rowCount > 0) goOn(of);
  }
}

/// What rests goes on to rest: the solution begins with the velocities of the step before.
void DeformableSolver::Parts::goOn(SolvedBody& of) {
  Dynamics& dynamics = *of.dynamics;
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    const btSoftBody::Node& node = of.body->m_nodes[static_cast<int>(n)];
    if (!(node.m_im > 0)) continue;
    toWide(node.m_vn - fromPoint(dynamics.velocity(n)), dynamics.matrix().solution() + dynamics.matrix().wideOf(n));
  }
  // What stiff bodies deform by does not last.
  if (dynamics.isStiff()) dynamics.keepRigidPart();
}

void DeformableSolver::Parts::collectRigidRowsOfWorlds() {
  if (rigids.list().empty()) return;
  std::vector<btDiscreteDynamicsWorld*> worlds;
  for (const SolvedBody& of : bodies.bodies()) {
    btDiscreteDynamicsWorld* world = worldOf(of);
    if (!world || std::find(worlds.begin(), worlds.end(), world) != worlds.end()) continue;
    worlds.push_back(world);
    collectRigidRows(*world, dt(), rigids, rows.rows());
  }
}

/// Soft bodies are solved for together where rows lead from one to the other, or by way of rigid bodies.
void DeformableSolver::Parts::joinByRows() {
  const std::size_t bodyCount = bodies.bodies().size();
  DisjointSets sets(bodyCount + rigids.list().size());
  // Below 0: what moves as it is prescribed.
  const auto memberOf = [&](const RowEnd& end) {
    if (end.isSoft()) return static_cast<int>(end.body);
    return end.rigid.unknown < 0 ? -1 : static_cast<int>(bodyCount) + end.rigid.unknown;
  };
  for (const ContactRow& row : rows.rows()) {
    const int first = memberOf(row.ends[0]), second = memberOf(row.ends[1]);
    if (first >= 0 && second >= 0) sets.unite(first, second);
  }
  std::unordered_map<int, std::vector<std::size_t>> groups;  // bodies, by set
  for (std::size_t b = 0; b < bodyCount; ++b) groups[sets.find(static_cast<int>(b))].push_back(b);
  for (std::size_t b = 0; b < bodyCount; ++b) {
    const auto& group = groups[sets.find(static_cast<int>(b))];
    if (group.front() == b && group.size() > 1) bodies.join(group);
  }
  std::vector<SolvedSystem*> systemOf(bodyCount, nullptr);
  for (SolvedSystem& system : bodies.systems()) {
    for (const std::size_t b : system.bodies) systemOf[b] = &system;
  }
  const auto systemOfSet = [&](int member) -> SolvedSystem* {
    const auto group = groups.find(sets.find(member));
    return group == groups.end() ? nullptr : systemOf[group->second.front()];
  };
  for (ContactRow& row : rows.rows()) {
    const int member = std::max(memberOf(row.ends[0]), memberOf(row.ends[1]));
    if (SolvedSystem* system = member < 0 ? nullptr : systemOfSet(member)) system->rows.push_back(&row);
  }
  for (std::size_t r = 0; r < rigids.list().size(); ++r) {
    if (SolvedSystem* system = systemOfSet(static_cast<int>(bodyCount + r))) system->rigids.push_back(r);
  }
}

}  // namespace tetskin
