// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/forces/body_forces.h>
#include <tetskin/bullet/src/forces/elastic_force_parts.h>
#include <tetskin/bullet/src/forces/node_vectors.h>

namespace tetskin {
namespace {

/// No other elastic force either: it would find no tets, and take the body for a changed one.
bool isAlone(const btSoftBody& body, const ForceList& list) {
  int elastic = 0;
  for (int i = 0; i < list.size(); ++i) {
    const auto& bodies = list[i]->m_softBodies;
    const bool acts = bodies.size() == 0 || bodies.findLinearSearch(const_cast<btSoftBody*>(&body)) < bodies.size();
    if (acts && needsDeformation(*list[i])) return false;
    if (acts && dynamic_cast<ElasticForce*>(list[i])) ++elastic;
  }
  return elastic <= 1;
}

/// out += factor K in
template <class In>
void addProduct(ForcedBody& of, double factor, In&& in, btAlignedObjectArray<btVector3>& out) {
  Dynamics& dynamics = *of.dynamics;
  if (dynamics.alpha() == 0.0) return;  // woken in the middle of its first step
  const auto& matrix = dynamics.matrix();
  const auto scale = static_cast<btScalar>(factor / dynamics.alpha());
  btScalar* points = dynamics.scratchPoints();
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    toPoint(in(static_cast<int>(n)), points + 4 * matrix.slotOf(n));
  }
  const btScalar* image = dynamics.times(points);
  const int first = of.body->m_nodes[0].index;
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    const btVector3 masses = matrix.mass(n) * in(static_cast<int>(n));
    out[first + static_cast<int>(n)] += scale * (fromWide(image + matrix.wideOf(n)) - masses);
  }
}

}  // namespace

ForcedBody* ElasticForce::Parts::find(const btSoftBody* body) const {
  for (const auto& of : bodies) {
    if (of->body == body) return of.get();
  }
  return nullptr;
}

void ElasticForce::Parts::showTets() {
  for (const auto& of : bodies) of->showTets();
}

std::vector<btSoftBody*> ElasticForce::Parts::rebuildChanged() {
  std::vector<btSoftBody*> lost;
  for (const auto& of : bodies) {
    if (of->hasItsRestShapes()) continue;
    if (checkTets(*of->body, {}).ok()) {
      of->build(material);
    } else if (!of->hasItsCounts()) {
      lost.push_back(of->body);
    }
  }
  return lost;
}

void ElasticForce::Parts::findAlone(bool nodeUpdated) {
  const ForceList& list = *solverOf(*bodies.front()->body)->getLagrangianForceArray();
  int known = list.size();
  for (int i = 0; i < list.size(); ++i) known += list[i]->m_softBodies.size();
  if (!nodeUpdated && knownForces == known) return;
  for (const auto& of : bodies) of->alone = isAlone(*of->body, list);
  knownForces = known;
}

/// The damping in use: where elastic forces are explicit, a step longer, which makes them as good as implicit.
double ElasticForce::Parts::dampingTime(const btSoftBody& body) const {
  const btDeformableBackwardEulerObjective& objective = *solverOf(body)->m_objective;
  return objective.m_implicit ? material.damping : material.damping + static_cast<double>(objective.m_dt);
}

void ElasticForce::Parts::addStiffness(ForcedBody& of, double factor, const TVStack& in, TVStack& out) const {
  addProduct(
      of, factor, [&in, first = of.body->m_nodes[0].index](int n) -> const btVector3& { return in[first + n]; }, out);
}

void ElasticForce::Parts::addDamping(ForcedBody& of, btScalar scale, TVStack& force) const {
  const auto velocity = [&](int n) -> const btVector3& { return of.body->m_nodes[n].m_v; };
  addProduct(of, -static_cast<double>(scale) * dampingTime(*of.body), velocity, force);
}

void ElasticForce::Parts::precondition(const ForcedBody& of) {
  const btDeformableBodySolver& solver = *solverOf(*of.body);
  if (solver.m_useProjection && of.dynamics->alpha() != 0.0) preconditioner.add(*solver.m_objective, of);
}

}  // namespace tetskin
