// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableBackwardEulerObjective.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/solver/src/rows/solver_bodies.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace tetskin::bullet_detail {
namespace {

const SolverSettings kBulletsBodies;

/// A body that has been moved to another world since has none.
void addWorld(const ForcedBody& elastic, std::vector<btDiscreteDynamicsWorld*>& worlds) {
  if (elastic.body->getWorldInfo() != elastic.worldInfo) return;
  if (std::find(worlds.begin(), worlds.end(), elastic.world) == worlds.end()) worlds.push_back(elastic.world);
}

}  // namespace

const btDeformableGravityForce* gravityForce(const btDeformableLagrangianForce* force) {
  static const btDeformableGravityForce bullets(btVector3(0, 0, 0));
  const bool isGravity =
      OwnObject::is(OwnObject::Kind::BodyGravity, force) || isOfSameClass<btDeformableLagrangianForce>(*force, bullets);
  return isGravity ? static_cast<const btDeformableGravityForce*>(force) : nullptr;
}

bool SolverBodies::collect(const btAlignedObjectArray<btSoftBody*>& all, bool everyone,
                           btAlignedObjectArray<btSoftBody*>& awake) {
  const auto awakeBefore = awake_, asleepBefore = asleep_;
  const auto countsBefore = nodeCounts_;
  awake_.clear();
  asleep_.clear();
  for (int i = 0; i < all.size(); ++i) (everyone || all[i]->isActive() ? awake_ : asleep_).push_back(all[i]);
  countNodes();
  seen_.copyFromArray(all);
  awake.resizeNoInitialize(0);
  for (btSoftBody* body : awake_) awake.push_back(body);
  const bool changed = awake_ != awakeBefore || asleep_ != asleepBefore || nodeCounts_ != countsBefore;
  return std::exchange(dropped_, false) || changed;
}

void SolverBodies::countNodes() {
  nodeCounts_.clear();
  nodeCount_ = 0;
  for (const auto* bodies : {&awake_, &asleep_}) {
    for (const btSoftBody* body : *bodies) {
      nodeCounts_.push_back(body->m_nodes.size());
      nodeCount_ += body->m_nodes.size();
    }
    if (bodies == &awake_) awakeCount_ = nodeCount_;
  }
}

std::vector<const btSoftBody*> SolverBodies::dropAllBut(const btAlignedObjectArray<btSoftBody*>& world,
                                                        btAlignedObjectArray<btSoftBody*>& awake) {
  std::vector<const btSoftBody*> gone;
  for (int k = 0; k < seen_.size(); ++k) {
    const bool stays = k < world.size() && world[k] == seen_[k];
    if (!stays && world.findLinearSearch(seen_[k]) == world.size()) gone.push_back(seen_[k]);
  }
  seen_.copyFromArray(world);
  if (gone.empty()) return gone;
  const auto isGone = [&](const btSoftBody* body) { return std::find(gone.begin(), gone.end(), body) != gone.end(); };
  for (auto* bodies : {&awake_, &asleep_}) {
    bodies->erase(std::remove_if(bodies->begin(), bodies->end(), isGone), bodies->end());
  }
  dropped_ = true;
  dropSolved(isGone);
  for (const btSoftBody* body : gone) memories_.erase(body);
  awake.resizeNoInitialize(0);
  for (btSoftBody* body : awake_) awake.push_back(body);
  return gone;
}

/// Systems stay as they are, without the bodies that are gone.
template <class IsGone>
void SolverBodies::dropSolved(const IsGone& isGone) {
  std::vector<std::size_t> indexNow(bodies_.size(), bodies_.size());  // by index before
  std::size_t left = 0;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (!isGone(bodies_[k].body)) indexNow[k] = left++;
  }
  const auto isLeft = [&](std::size_t k) { return indexNow[k] < indexNow.size(); };
  for (SolvedSystem& system : systems_) {
    auto& of = system.bodies;
    of.erase(std::remove_if(of.begin(), of.end(), [&](std::size_t k) { return !isLeft(k); }), of.end());
    for (std::size_t& k : of) k = indexNow[k];
  }
  systems_.erase(std::remove_if(systems_.begin(), systems_.end(), [](const auto& of) { return of.bodies.empty(); }),
                 systems_.end());
  bodies_.erase(std::remove_if(bodies_.begin(), bodies_.end(), [&](const auto& of) { return isGone(of.body); }),
                bodies_.end());
  indices_.clear();
  int first = 0;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    indices_[bodies_[k].body] = k;
    bodies_[k].first = first;
    first += bodies_[k].body->m_nodes.size();
  }
}

void SolverBodies::number(btDeformableBackwardEulerObjective& objective) {
  countNodes();
  objective.m_nodes.resizeNoInitialize(0);
  int face = 0;
  for (const auto* bodies : {&awake_, &asleep_}) {
    for (btSoftBody* body : *bodies) {
      for (int n = 0; n < body->m_nodes.size(); ++n) {
        body->m_nodes[n].index = objective.m_nodes.size();
        objective.m_nodes.push_back(&body->m_nodes[n]);
      }
      for (int f = 0; f < body->m_faces.size(); ++f) body->m_faces[f].m_index = face++;
    }
  }
}

void SolverBodies::clear() {
  bodies_.clear();
  worlds_.clear();
  indices_.clear();
  systems_.clear();
}

void SolverBodies::forget(const btSoftBody& body) {
  clear();
  memories_.erase(&body);
  for (auto& [other, kept] : memories_) {
    auto& anchors = kept.frictionAnchors;
    anchors.erase(std::remove_if(anchors.begin(), anchors.end(), [&](const auto& a) { return a.object == &body; }),
                  anchors.end());
  }
}

void SolverBodies::forgetTrees() {
  for (auto& [body, kept] : memories_) kept.paddedTrees.forget();
}

void SolverBodies::assign(const ForceList& forces) {
  listAwake();
  takeElastic(forces);
  takeGravity(forces);
  attachMemories();
  makeSystems(forces);
}

void SolverBodies::listAwake() {
  bodies_.assign(awake_.size(), {});
  indices_.clear();
  int first = 0;
  for (std::size_t k = 0; k < awake_.size(); ++k) {
    bodies_[k].body = awake_[k];
    bodies_[k].first = first;
    bodies_[k].settings = &kBulletsBodies;
    first += awake_[k]->m_nodes.size();
    indices_[awake_[k]] = k;
  }
}

std::size_t SolverBodies::indexOf(const btSoftBody* body) const {
  const auto found = indices_.find(body);
  return found == indices_.end() ? bodies_.size() : found->second;
}

SolvedBody* SolverBodies::find(const btSoftBody* body) {
  const std::size_t index = indexOf(body);
  return index < bodies_.size() ? &bodies_[index] : nullptr;
}

std::vector<btDiscreteDynamicsWorld*> SolverBodies::worldsOf(const ForceList& forces) {
  std::vector<btDiscreteDynamicsWorld*> worlds;
  for (int i = 0; i < forces.size(); ++i) {
    auto* elastic = dynamic_cast<ElasticForce*>(inactiveForce(forces[i]));
    if (elastic && elastic->m_softBodies.size() > 0) addWorld(elastic->body(), worlds);
  }
  return worlds;
}

void SolverBodies::takeElastic(const ForceList& forces) {
  worlds_.clear();
  for (int i = 0; i < forces.size(); ++i) {
    auto* elastic = dynamic_cast<ElasticForce*>(inactiveForce(forces[i]));
    if (!elastic || elastic->m_softBodies.size() == 0) continue;
    addWorld(elastic->body(), worlds_);
    const std::size_t k = indexOf(elastic->body().body);
    if (k == bodies_.size()) continue;
    bodies_[k].elastic = &elastic->body();
    bodies_[k].settings = &elastic->settings();
  }
}

void SolverBodies::takeGravity(const ForceList& forces) {
  for (int i = 0; i < forces.size(); ++i) {
    const btDeformableGravityForce* gravity = gravityForce(forces[i]);
    for (int b = 0; gravity && b < gravity->m_softBodies.size(); ++b) {
      const btSoftBody* body = gravity->m_softBodies[b];
      SolvedBody* solved = find(body);
      if (solved && solved->elastic) solved->gravity += body->m_gravityFactor * gravity->m_gravity;
    }
  }
}

void SolverBodies::attachMemories() {
  for (SolvedBody& body : bodies_) {
    BodyMemory& kept = memories_[body.body];
    const auto nodes = static_cast<std::size_t>(body.body->m_nodes.size());
    body.memory = &kept;
    body.before = kept.rows;
    body.byBullet = !body.elastic || needsBulletsTrees(*body.body);
    if (body.elastic) {
      body.dynamics = body.elastic->dynamics.get();
      continue;
    }
    if (!kept.masses || kept.masses->nodeCount() != nodes) {
      kept.masses = std::make_unique<Dynamics>(elastic_detail::RestTets{}, nodes);
    }
    body.dynamics = kept.masses.get();
    assert(body.dynamics->nodeCount() == nodes);
  }
}

std::vector<std::size_t> SolverBodies::actedOnBy(const btDeformableLagrangianForce& force) const {
  std::vector<std::size_t> indices;
  if (gravityForce(&force) || isSilent(force)) return indices;  // gravity has no derivative: it couples nothing
  const auto add = [&](const btSoftBody* body) {
    if (const std::size_t k = indexOf(body); k < bodies_.size()) indices.push_back(k);
  };
  if (force.m_softBodies.size() > 0) {
    for (int b = 0; b < force.m_softBodies.size(); ++b) add(force.m_softBodies[b]);
  } else {
    // A force that names no bodies may act on any.
    for (const SolvedBody& body : bodies_) add(body.body);
  }
  return indices;
}

void SolverBodies::makeSystems(const ForceList& forces) {
  DisjointSets sets(bodies_.size());
  std::vector<std::pair<std::size_t, btDeformableLagrangianForce*>> acting;  // the set's body index, and a force on it
  for (int i = 0; i < forces.size(); ++i) {
    const std::vector<std::size_t> indices = actedOnBy(*forces[i]);
    for (const std::size_t k : indices) {
      sets.unite(static_cast<int>(indices.front()), static_cast<int>(k));
      bodies_[k].needsDeformation |= needsDeformation(*forces[i]);
    }
    if (!indices.empty()) acting.emplace_back(indices.front(), forces[i]);
  }
  systems_.clear();
  std::vector<std::size_t> systemOf(bodies_.size(), bodies_.size());  // by set
  const auto systemAt = [&](std::size_t k) -> SolvedSystem& {
    std::size_t& system = systemOf[static_cast<std::size_t>(sets.find(static_cast<int>(k)))];
    if (system == bodies_.size()) {
      system = systems_.size();
      systems_.emplace_back();
    }
    return systems_[system];
  };
  for (std::size_t k = 0; k < bodies_.size(); ++k) systemAt(k).bodies.push_back(k);
  for (const auto& [k, force] : acting) systemAt(k).forces.push_back(force);
}

SolvedSystem& SolverBodies::join(const std::vector<std::size_t>& indices) {
  assert(!indices.empty());
  const auto holds = [&](const SolvedSystem& system) {
    return std::any_of(system.bodies.begin(), system.bodies.end(), [&](std::size_t body) {
      return std::find(indices.begin(), indices.end(), body) != indices.end();
    });
  };
  const auto first = std::find_if(systems_.begin(), systems_.end(), holds);
  assert(first != systems_.end());
  const auto others = std::stable_partition(std::next(first), systems_.end(),
                                            [&](const SolvedSystem& system) { return !holds(system); });
  for (auto other = others; other != systems_.end(); ++other) {
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(first->bodies, other->bodies);
    append(first->forces, other->forces);
    append(first->rigids, other->rigids);
    append(first->rows, other->rows);
  }
  systems_.erase(others, systems_.end());
  // A force may act on both bodies.
  std::vector<btDeformableLagrangianForce*> forces;
  for (btDeformableLagrangianForce* force : first->forces) {
    if (std::find(forces.begin(), forces.end(), force) == forces.end()) forces.push_back(force);
  }
  first->forces = std::move(forces);
  return *first;
}

SolvedBody& SolverBodies::bodyOf(int node) {
  assert(!bodies_.empty() && node >= 0);
  const auto after = std::upper_bound(bodies_.begin(), bodies_.end(), node,
                                      [](int n, const SolvedBody& body) { return n < body.first; });
  return *std::prev(after);
}

void SolverBodies::forget(const std::unordered_set<const btCollisionObject*>& gone) {
  for (auto& [body, kept] : memories_) {
    auto& anchors = kept.frictionAnchors;
    anchors.erase(std::remove_if(anchors.begin(), anchors.end(),
                                 [&](const FrictionAnchor& anchor) { return gone.count(anchor.object) > 0; }),
                  anchors.end());
  }
}

/// Everything else is made anew by the next step, whose list of bodies counts as another one.
void SolverBodies::serialize(WorldStream& stream) {
  if (stream.restoring()) {
    clear();
    dropped_ = true;
    seen_.copyFromArray(stream.world().getSoftBodyArray());  // what leaves before the next step is known to go
  }
  stream.byObject(memories_, [&](const btSoftBody&, BodyMemory& kept) {
    stream(kept.rows.any, kept.rows.contacts);
    stream.each(kept.frictionAnchors, [&](FrictionAnchor& anchor) {
      stream(anchor.point, anchor.sample);
      stream.object(anchor.object);
      stream(anchor.normal, anchor.position, anchor.normalForce, anchor.stuck);
    });
  });
}

}  // namespace tetskin::bullet_detail
