// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The contacts of a step: the search distance, their rows, and which bodies they join into one solve.
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/rows/rigid_rows.h>
#include <tetskin/solver/src/search/body_contacts.h>
#include <tetskin/solver/src/step/step.h>

#include <algorithm>
#include <cassert>
#include <unordered_map>

namespace tetskin {

/// Nodes may have been appended.
void DeformableSolver::Impl::prepareSearch(SolvedBody& body) const {
  auto* own = bodyWithTrees(*body.body);
  if (!own) return;
  BodyChannel& channel = BodyChannel::of(*own);
  channel.setSearchWaits(threads != nullptr);
  channel.setKinematicPaths(rigids.sharedPaths());
  channel.setNodesSolver(body.byBullet ? nullptr : static_cast<const btSoftBodySolver*>(&solver));
  if (body.byBullet) return;
  const auto& contacts = channel.nodeContacts();
  const auto count = static_cast<std::size_t>(body.body->m_nodes.size());
  if (!contacts || contacts->search().patches().nodes.size() != count) {
    const btScalar size = sizeOfNodes(*own);
    channel.setNodeContacts(makeNodeContacts(*own, size), size);
  }
  if (channel.surfaceContacts().expired()) channel.setReach(own->margin());
}

/// Runs the searches that have waited for threads.
void DeformableSolver::Impl::searchWaiting() {
  std::vector<std::shared_ptr<BodyContacts>> waiting;
  for (const SolvedBody& solved : bodies.bodies()) {
    BodyChannel* channel = channelOf(*solved.body);
    if (!channel) continue;
    channel->setSearchWaits(false);
    for (const auto& contacts : {channel->surfaceContacts().lock(), channel->nodeContacts()}) {
      if (contacts && contacts->isWaiting()) waiting.push_back(contacts);
    }
  }
  runTasks(threads, waiting.size(), [&](std::size_t k) { waiting[k]->searchWaiting(); });
}

/// The distance is twice the path of a body that gravity accelerates for a step: of two bodies in contact, the
/// prediction may let one fall although neither will. A fraction of the body's own path is added: stopping some points
/// of a body turns others towards the obstacle.
void DeformableSolver::Impl::speculate(const SolvedBody& body, btScalar fastest) const {
  // Boxes and balls that land, rest or stop in `tetskin_measure` also pass with 0: it is for bodies that tip over what
  // stops them. More would cost searches of points that do not arrive.
  constexpr btScalar kPathFraction = btScalar(0.2);
  assert(stage == Stage::Predict && !(fastest < 0));
  auto* own = bodyWithTrees(*body.body);
  if (!own) return;
  BodyChannel& channel = BodyChannel::of(*own);
  const btScalar falls = 2 * body.gravity.length() * dt() * dt();
  const btScalar distance = falls + kPathFraction * fastest * dt();
  // The body's box includes this distance.
  const btScalar more = distance - channel.speculation();
  channel.setSpeculation(distance);
  body.body->m_bounds[0] -= btVector3(more, more, more);
  body.body->m_bounds[1] += btVector3(more, more, more);
}

/// A fraction of what gravity adds in a step, so that a world in centimetres is solved like one in metres; no less than
/// the rounding, below which solving for a resting body would be in vain.
double DeformableSolver::Impl::unseenSpeed(const SolvedBody& body) const {
  constexpr double kUnseen = 1e-3;
  const auto seconds = static_cast<double>(dt());
  assert(seconds > 0.0 && body.dynamics);
  return std::max(kUnseen * static_cast<double>(body.gravity.length()) * seconds, body.dynamics->roundingSpeed());
}

std::vector<RowSource*> DeformableSolver::Impl::rowSources() {
  std::vector<RowSource*> sources;
  for (int i = 0; i < forces().size(); ++i) {
    if (auto* source = dynamic_cast<RowSource*>(inactiveForce(forces()[i]))) sources.push_back(source);
  }
  if (!loads.empty()) sources.push_back(&loads);
  return sources;
}

void DeformableSolver::Impl::collectRows() {
  assert(stage == Stage::Assemble);
  rigids.clear();
  rows.collect(bodies, rigids, dt());
  for (RowSource* source : rowSources()) {
    clock.end(&StepTimes::rows);
    PointContacts* contacts = source->contacts(dt(), threads);
    clock.end(&StepTimes::softSearch);
    if (contacts) rows.add(*contacts, bodies, dt());
    if (auto* joints = source->joints(dt())) rows.add(*joints, bodies, rigids, dt());
  }
  rows.setStiffness(bodies, rigids, dt());
  collectRigidRowsOfWorlds();
  jointImpulses.end();
  joinByRows();
  runTasks(threads, bodies.bodies().size(), [&](std::size_t k) {
    SolvedBody& body = bodies.bodies()[k];
    if (body.before.any && body.acted.rowCount > 0) reuseLastVelocity(body);
  });
}

/// A resting body stays at rest: the solution starts from the velocities of the last step.
void DeformableSolver::Impl::reuseLastVelocity(SolvedBody& body) {
  assert(body.dynamics->nodeCount() == static_cast<std::size_t>(body.body->m_nodes.size()));
  Dynamics& dynamics = *body.dynamics;
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    const btSoftBody::Node& node = body.body->m_nodes[static_cast<int>(n)];
    if (!(node.m_im > 0)) continue;
    toWide(node.m_vn - fromPoint(dynamics.velocity(n)), dynamics.matrix().solution() + dynamics.matrix().wideOf(n));
  }
  // A stiff body's deformation does not persist into the next step.
  if (dynamics.isStiff()) dynamics.projectToRigidMotion();
}

void DeformableSolver::Impl::collectRigidRowsOfWorlds() {
  if (rigids.list().empty()) return;
  for (btDiscreteDynamicsWorld* world : bodies.worlds()) collectRigidRows(*world, dt(), rigids, rows);
}

/// Unites the systems of soft bodies that rows connect directly, or through rigid bodies.
void DeformableSolver::Impl::joinByRows() {
  const std::size_t bodyCount = bodies.bodies().size();
  DisjointSets sets(bodyCount + rigids.list().size());
  // Below 0: the object's motion is prescribed.
  const auto memberOf = [&](const RowEnd& end) {
    assert(!end.isSoft() || end.body < bodyCount);
    if (end.isSoft()) return static_cast<int>(end.body);
    return end.rigid.unknown < 0 ? -1 : static_cast<int>(bodyCount) + end.rigid.unknown;
  };
  for (const ContactRow& row : rows.rows()) {
    const int first = memberOf(row.ends[0]), second = memberOf(row.ends[1]);
    if (first >= 0 && second >= 0) sets.unite(first, second);
  }
  std::unordered_map<int, std::vector<std::size_t>> groups;  // indices of bodies, by set
  for (std::size_t b = 0; b < bodyCount; ++b) groups[sets.find(static_cast<int>(b))].push_back(b);
  for (std::size_t b = 0; b < bodyCount; ++b) {
    const auto& group = groups[sets.find(static_cast<int>(b))];
    if (group.front() == b && group.size() > 1) bodies.join(group);
  }
  std::vector<SolvedSystem*> systemOf(bodyCount, nullptr);
  for (SolvedSystem& system : bodies.systems()) {
    for (const std::size_t b : system.bodies) systemOf[b] = &system;
  }
  assert(std::find(systemOf.begin(), systemOf.end(), nullptr) == systemOf.end());
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
