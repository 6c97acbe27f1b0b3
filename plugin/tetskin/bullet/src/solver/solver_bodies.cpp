// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableBackwardEulerObjective.h>
#include <tetskin/bullet/src/solver/solver_bodies.h>
#include <tetskin/core/src/base/disjoint_sets.h>

#include <algorithm>
#include <typeinfo>

namespace tetskin {
namespace {

const SolverLimits kBulletsBodies;

/// Gravity has no differential, so that it couples nothing.
bool isGravity(const btDeformableLagrangianForce& force) {
  return typeid(force) == typeid(btDeformableGravityForce) || dynamic_cast<const BodyGravity*>(&force);
}

}  // namespace

void FittedTrees::keep(Dynamics& dynamics) {
  points.resize(3 * dynamics.nodeCount());
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) std::copy_n(dynamics.point(n), 3, &points[3 * n]);
  drift = 0;
  ready = true;
}

btScalar FittedTrees::furthest(Dynamics& dynamics) const {
  btScalar most = 0;
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    const btScalar* now = dynamics.point(n);
    const btScalar x = now[0] - points[3 * n], y = now[1] - points[3 * n + 1], z = now[2] - points[3 * n + 2];
    most = std::max(most, x * x + y * y + z * z);
  }
  return btSqrt(most);
}

bool SolverBodies::collect(const btAlignedObjectArray<btSoftBody*>& all, bool everyone,
                           btAlignedObjectArray<btSoftBody*>& awake) {
  const auto awakeBefore = awake_, asleepBefore = asleep_;
  const auto countsBefore = nodeCounts_;
  awake_.clear();
  asleep_.clear();
  nodeCounts_.clear();
  for (int i = 0; i < all.size(); ++i) (everyone || all[i]->isActive() ? awake_ : asleep_).push_back(all[i]);
  nodeCount_ = 0;
  for (const auto* bodies : {&awake_, &asleep_}) {
    for (const btSoftBody* body : *bodies) {
      nodeCounts_.push_back(body->m_nodes.size());
      nodeCount_ += body->m_nodes.size();
    }
    if (bodies == &awake_) awakeCount_ = nodeCount_;
  }
  awake.resizeNoInitialize(0);
  for (btSoftBody* body : awake_) awake.push_back(body);
  const bool changed = awake_ != awakeBefore || asleep_ != asleepBefore || nodeCounts_ != countsBefore;
  if (!changed) return false;
  for (auto kept = kept_.begin(); kept != kept_.end();) {
    const bool here = std::find(awake_.begin(), awake_.end(), kept->first) != awake_.end() ||
                      std::find(asleep_.begin(), asleep_.end(), kept->first) != asleep_.end();
    kept = here ? std::next(kept) : kept_.erase(kept);
  }
  return true;
}

void SolverBodies::number(btDeformableBackwardEulerObjective& objective) {
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

void SolverBodies::release(const ForceList& forces) {
  for (int i = 0; i < forces.size(); ++i) {
    auto* elastic = dynamic_cast<ElasticForce*>(forces[i]);
    if (!elastic) continue;
    for (const auto& of : elastic->bodies()) of->solved = false;
  }
  bodies_.clear();
  systems_.clear();
}

void SolverBodies::assign(const ForceList& forces) {
  std::unordered_map<const btSoftBody*, std::size_t> places;
  bodies_.resize(awake_.size());
  int first = 0;
  for (std::size_t k = 0; k < awake_.size(); ++k) {
    bodies_[k].body = awake_[k];
    bodies_[k].first = first;
    bodies_[k].elastic = nullptr;
    bodies_[k].limits = &kBulletsBodies;
    bodies_[k].needsDeformation = false;
    bodies_[k].constrained = false;
    bodies_[k].touched = false;
    first += awake_[k]->m_nodes.size();
    places[awake_[k]] = k;
  }
  const auto placeOf = [&](const btSoftBody* body) {
    const auto found = places.find(body);
    return found == places.end() ? bodies_.size() : found->second;
  };
  for (int i = 0; i < forces.size(); ++i) {
    auto* elastic = dynamic_cast<ElasticForce*>(forces[i]);
    if (!elastic) continue;
    for (const auto& of : elastic->bodies()) {
      const std::size_t k = placeOf(of->body);
      // A second elastic force of one body acts by itself.
      of->solved = k < bodies_.size() && !bodies_[k].elastic;
      if (!of->solved) continue;
      bodies_[k].elastic = of.get();
      bodies_[k].limits = &elastic->limits();
    }
  }
  makeDynamics();

  // Forces that say of no body that they act on it may act on any.
  DisjointSets sets(bodies_.size());
  std::vector<std::pair<std::size_t, btDeformableLagrangianForce*>> acting;
  for (int i = 0; i < forces.size(); ++i) {
    btDeformableLagrangianForce& force = *forces[i];
    if (isGravity(force) || isNoForce(force)) continue;
    std::vector<std::size_t> on;
    const auto addPlace = [&](const btSoftBody* body) {
      if (const std::size_t k = placeOf(body); k < bodies_.size()) on.push_back(k);
    };
    if (const auto* elastic = dynamic_cast<ElasticForce*>(&force)) {
      for (const auto& of : elastic->bodies()) {
        if (!of->solved) addPlace(of->body);
      }
    } else if (force.m_softBodies.size() > 0) {
      for (int b = 0; b < force.m_softBodies.size(); ++b) addPlace(force.m_softBodies[b]);
    } else {
      for (std::size_t k = 0; k < bodies_.size(); ++k) on.push_back(k);
    }
    if (on.empty()) continue;
    const bool deformation = needsDeformation(force);
    for (const std::size_t k : on) {
      sets.unite(static_cast<int>(on.front()), static_cast<int>(k));
      bodies_[k].needsDeformation |= deformation;
    }
    acting.emplace_back(on.front(), &force);
  }
  systems_.clear();
  std::vector<std::size_t> systemOf(bodies_.size(), bodies_.size());
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

void SolverBodies::makeDynamics() {
  for (SolvedBody& of : bodies_) {
    Kept& kept = kept_[of.body];
    const auto nodes = static_cast<std::size_t>(of.body->m_nodes.size());
    of.normalImpulses = &kept.normalImpulses;
    of.fittedTrees = &kept.fittedTrees;
    of.solve = &kept.solve;
    if (kept.fittedTrees.points.size() != 3 * nodes) kept.fittedTrees.ready = false;
    if (of.elastic) {
      kept.normalImpulses.resize(nodes, btScalar(0));
      of.dynamics = of.elastic->dynamics.get();
      continue;
    }
    if (!kept.masses || kept.masses->nodeCount() != nodes) {
      kept.masses = std::make_unique<Dynamics>(elastic_detail::RestTets{}, nodes);
    }
    of.dynamics = kept.masses.get();
  }
}

SolvedBody& SolverBodies::bodyOf(int node) {
  const auto after =
      std::upper_bound(bodies_.begin(), bodies_.end(), node, [](int n, const SolvedBody& of) { return n < of.first; });
  return *std::prev(after);
}

}  // namespace tetskin
