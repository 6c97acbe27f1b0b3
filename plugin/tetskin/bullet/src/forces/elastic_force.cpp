// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What Bullet calls of an ElasticForce, in a step of its own solver:
//   reinitialize                           rest shapes that have changed; hides tets from what Bullet does next
//   addScaledForces, ...ExplicitForce      forces, and with them the matrix of this step
//   addScaledDampingForce                  the same matrix; the preconditioner, before Bullet's conjugate gradient
//   addScaled...ForceDifferential          its products
// Bodies that a DeformableSolver solves for are passed over.
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/src/forces/body_forces.h>
#include <tetskin/bullet/src/forces/elastic_force_parts.h>
#include <tetskin/bullet/src/forces/node_vectors.h>

#include <algorithm>

namespace tetskin {
namespace {

void addForces(ForcedBody& of, btScalar scale, bool predicted, btAlignedObjectArray<btVector3>& force) {
  readNodes(*of.body, predicted, *of.dynamics);
  of.dynamics->prepare(static_cast<double>(scale), nullptr);
  const int first = of.body->m_nodes[0].index;
  for (std::size_t n = 0; n < of.dynamics->nodeCount(); ++n) {
    force[first + static_cast<int>(n)] += scale * fromPoint(of.dynamics->force(n));
  }
}

}  // namespace

ElasticForce::ElasticForce(const ElasticMaterial& material) : parts_(std::make_unique<Parts>(material)) {}
ElasticForce::~ElasticForce() = default;

const ElasticMaterial& ElasticForce::material() const {
  return parts_->material;
}
const SolverLimits& ElasticForce::limits() const {
  return parts_->limits;
}
const std::vector<std::unique_ptr<ForcedBody>>& ElasticForce::bodies() const {
  return parts_->bodies;
}

Status ElasticForce::setMaterial(const ElasticMaterial& material) {
  if (Status status = checkMaterial(material); !status.ok()) return status;
  for (const auto& of : parts_->bodies) {
    if (Status status = checkStiffness(*of->body, material); !status.ok()) return status;
  }
  parts_->material = material;
  for (const auto& of : parts_->bodies) of->setMaterial(material);
  return {};
}

Status ElasticForce::setLimits(const SolverLimits& limits) {
  if (!(limits.tolerance >= 0.0 && limits.tolerance < 1.0)) {
    return {StatusCode::InvalidOption, "a solver's tolerance must be at least 0 and below 1"};
  }
  if (limits.iterations < 1) return {StatusCode::InvalidOption, "a solver needs at least one iteration"};
  parts_->limits = limits;
  return {};
}

Status ElasticForce::addTo(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body,
                           std::vector<double> stiffnessScale) {
  if (Status status = checkMaterial(parts_->material); !status.ok()) return status;
  if (Status status = checkTets(body, stiffnessScale); !status.ok()) return status;
  if (Status status = checkStiffness(body, parts_->material); !status.ok()) return status;
  const auto& inWorld = world.getSoftBodyArray();
  btDeformableBodySolver* solver = solverOf(body);
  if (!solver || inWorld.findLinearSearch(&body) == inWorld.size()) {
    return {StatusCode::InvalidOption, "add the body to the world before its forces"};
  }
  if (solver->isReducedSolver()) {
    return {StatusCode::InvalidOption,
            "a world made with a btReducedDeformableBodySolver holds reduced bodies alone; make it with a "
            "DeformableSolver, or a btDeformableBodySolver"};
  }
  ForceList& list = *solver->getLagrangianForceArray();
  if (list.findLinearSearch(this) == list.size()) list.push_back(this);
  setIndices(solver->getIndices());
  addSoftBody(&body);
  if (ForcedBody* of = parts_->find(&body)) of->know(world);
  return setStiffnessScale(body, std::move(stiffnessScale));
}

Status ElasticForce::setStiffnessScale(btSoftBody& body, std::vector<double> stiffnessScale) {
  ForcedBody* of = parts_->find(&body);
  if (!of) return {StatusCode::IndexOutOfRange, "the body is none of this force's"};
  if (Status status = checkTets(body, stiffnessScale); !status.ok()) return status;
  of->stiffnessScale = std::move(stiffnessScale);
  const bool same = of->dynamics->tets()->count() == static_cast<std::size_t>(body.m_tetras.size());
  same ? of->setMaterial(parts_->material) : of->build(parts_->material);
  return {};
}

btDeformableLagrangianForceType ElasticForce::getForceType() {
  // One that Bullet does not use, nor forces that belong to a DeformableBody.
  return static_cast<btDeformableLagrangianForceType>(0);
}

void ElasticForce::removeFrom(btSoftBody& body) {
  if (!parts_->find(&body)) return;
  removeSoftBody(&body);
  btDeformableBodySolver* solver = solverOf(body);
  if (solver && m_softBodies.size() == 0) removeFromList(*solver->getLagrangianForceArray(), this);
}

void ElasticForce::addSoftBody(btSoftBody* body) {
  if (parts_->find(body) || !checkTets(*body, {}).ok() || !checkMaterial(parts_->material).ok()) return;
  if (!checkStiffness(*body, parts_->material).ok()) return;
  btDeformableLagrangianForce::addSoftBody(body);
  auto of = std::make_unique<ForcedBody>();
  of->body = body;
  of->build(parts_->material);
  parts_->bodies.push_back(std::move(of));
  parts_->knownForces = -1;
}

void ElasticForce::removeSoftBody(btSoftBody* body) {
  parts_->showTets();
  btDeformableLagrangianForce::removeSoftBody(body);
  auto& bodies = parts_->bodies;
  bodies.erase(std::remove_if(bodies.begin(), bodies.end(), [&](const auto& of) { return of->body == body; }),
               bodies.end());
  parts_->bodyRemoved = true;
}

void ElasticForce::reinitialize(bool nodeUpdated) {
  parts_->showTets();
  for (btSoftBody* body : parts_->rebuildChanged()) removeSoftBody(body);
  const bool removal = parts_->bodyRemoved;
  parts_->bodyRemoved = false;
  const auto& bodies = parts_->bodies;
  if (removal || std::all_of(bodies.begin(), bodies.end(), [](const auto& of) { return of->solved; })) return;
  parts_->findAlone(nodeUpdated);
  parts_->forActive([](ForcedBody& of) { of.hideTets(); });
}

void ElasticForce::addScaledForces(btScalar scale, TVStack& force) {
  parts_->showTets();
  parts_->forActive([&](ForcedBody& of) {
    addForces(of, scale, true, force);
    parts_->addDamping(of, scale, force);
  });
}

void ElasticForce::addScaledExplicitForce(btScalar scale, TVStack& force) {
  parts_->showTets();
  parts_->forActive([&](ForcedBody& of) { addForces(of, scale, false, force); });
}

void ElasticForce::addScaledDampingForce(btScalar scale, TVStack& force) {
  parts_->forActive([&](ForcedBody& of) {
    parts_->addDamping(of, scale, force);
    parts_->precondition(of);
  });
}

void ElasticForce::addScaledDampingForceDifferential(btScalar scale, const TVStack& dv, TVStack& df) {
  parts_->forActive([&](ForcedBody& of) {
    parts_->addStiffness(of, -static_cast<double>(scale) * parts_->dampingTime(*of.body), dv, df);
  });
}

void ElasticForce::addScaledElasticForceDifferential(btScalar scale, const TVStack& dx, TVStack& df) {
  parts_->forActive([&](ForcedBody& of) { parts_->addStiffness(of, -static_cast<double>(scale), dx, df); });
}

void ElasticForce::buildDampingForceDifferentialDiagonal(btScalar scale, TVStack& diagonal) {
  parts_->forActive([&](ForcedBody& of) {
    if (of.dynamics->alpha() == 0.0) return;
    const double factor = -static_cast<double>(scale) * parts_->dampingTime(*of.body) / of.dynamics->alpha();
    const int first = of.body->m_nodes[0].index;
    for (std::size_t n = 0; n < of.dynamics->nodeCount(); ++n) {
      btScalar d[6];
      of.dynamics->matrix().diagonal(n, d);
      const btScalar mass = of.dynamics->matrix().mass(n);
      const btVector3 stiffness(d[0] - mass, d[3] - mass, d[5] - mass);
      diagonal[first + static_cast<int>(n)] += static_cast<btScalar>(factor) * stiffness;
    }
  });
}

double ElasticForce::totalElasticEnergy(btScalar) {
  double energy = 0.0;
  for (const auto& of : parts_->bodies) {
    // Of those that a DeformableSolver solves for, too: it asks for none.
    if (!of->body->isActive()) continue;
    readNodes(*of->body, true, *of->dynamics);
    energy += of->dynamics->energy(nullptr);
  }
  return energy;
}

}  // namespace tetskin
