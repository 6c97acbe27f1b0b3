// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/src/forces/body_forces.h>
#include <tetskin/bullet/src/forces/forced_bodies.h>
#include <tetskin/core/src/base/lame.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tetskin {
namespace {

using elastic_detail::RestTets;
using kernels::kGroup;

Status invalid(const char* message) {
  return {StatusCode::InvalidOption, message};
}

int nodeNumber(const btSoftBody& body, const btSoftBody::Node* node) {
  const btSoftBody::Node* first = &body.m_nodes[0];
  return node >= first && node < first + body.m_nodes.size() ? static_cast<int>(node - first) : -1;
}

RestTets restTetsOf(const btSoftBody& body) {
  RestTets rest;
  for (int t = 0; t < body.m_tetras.size(); ++t) {
    const btSoftBody::Tetra& tetra = body.m_tetras[t];
    Tet tet{};
    for (std::size_t k = 0; k < 4; ++k) tet[k] = nodeNumber(body, tetra.m_n[k]);
    std::array<double, 9> gradients{};
    for (std::size_t k = 0; k < gradients.size(); ++k) {
      const btVector3& row = tetra.m_Dm_inverse[static_cast<int>(k / 3)];
      gradients[k] = static_cast<double>(row[static_cast<int>(k % 3)]);
    }
    rest.tets.push_back(tet);
    rest.gradients.push_back(gradients);
    rest.volumes.push_back(static_cast<double>(tetra.m_element_measure));
  }
  return rest;
}

btDeformableBodySolver* solverOf(const btSoftBody& body) {
  return static_cast<btDeformableBodySolver*>(const_cast<btSoftBody&>(body).getSoftBodySolver());
}

/// Of some of the tets: another one if the body has been scaled, or given another rest shape.
btScalar restMeasureOf(const btSoftBody& body) {
  btScalar sum = 0;
  const int last = body.m_tetras.size() - 1;
  for (const int t : {0, last / 3, 2 * last / 3, last}) {
    const btSoftBody::Tetra& tetra = body.m_tetras[t];
    sum += tetra.m_element_measure;
    for (int i = 0; i < 3; ++i) sum += tetra.m_Dm_inverse[i].length2();
  }
  return sum;
}

/// Whether a force needs what Bullet keeps for each tet and updates in every step.
bool needsDeformation(btDeformableLagrangianForce& force) {
  if (dynamic_cast<ElasticForce*>(&force) || dynamic_cast<btDeformableGravityForce*>(&force)) return false;
  const btDeformableLagrangianForceType type = force.getForceType();
  return type != BT_GRAVITY_FORCE && type != BT_MASSSPRING_FORCE && type != BT_MOUSE_PICKING_FORCE;
}

}  // namespace

void readNodes(const btSoftBody& body, bool predicted, Dynamics& dynamics) {
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[n];
    const auto at = static_cast<std::size_t>(n);
    const btVector3& x = predicted ? node.m_q : node.m_x;
    btScalar* point = dynamics.point(at);
    btScalar* velocity = dynamics.velocity(at);
    for (int k = 0; k < 3; ++k) {
      point[k] = x[k];
      velocity[k] = node.m_v[k];
    }
    dynamics.setMass(at, node.m_im > 0 ? 1 / node.m_im : btScalar(0));
  }
}

Status checkTets(const btSoftBody& body, const std::vector<double>& stiffnessScale) {
  if (body.m_tetras.size() == 0) {
    return {StatusCode::Degenerate,
            "the body has no tets to be elastic; Bullet's mass-spring force serves cloth and ropes"};
  }
  for (int t = 0; t < body.m_tetras.size(); ++t) {
    const btSoftBody::Tetra& tetra = body.m_tetras[t];
    for (const btSoftBody::Node* node : tetra.m_n) {
      if (nodeNumber(body, node) >= 0) continue;
      return {StatusCode::Degenerate, "tet " + std::to_string(t) +
                                          " names no node of the body: Bullet leaves tets dangling when nodes are "
                                          "appended after them; append the nodes first"};
    }
    btScalar size = 0;
    for (int i = 0; i < 3; ++i) size += tetra.m_Dm_inverse[i].length2();
    if (!(tetra.m_element_measure > 0) || !(size > 0) || !std::isfinite(size)) {
      return {StatusCode::Degenerate, "tet " + std::to_string(t) +
                                          " of the body has no volume at rest, or no rest shape; call the body's "
                                          "initializeDmInverse() after its tets have been appended"};
    }
  }
  if (stiffnessScale.empty()) return {};
  if (stiffnessScale.size() != static_cast<std::size_t>(body.m_tetras.size())) {
    return {StatusCode::SizeMismatch,
            "a stiffness scale has a value for each tet: " + std::to_string(stiffnessScale.size()) +
                " values are given for " + std::to_string(body.m_tetras.size()) + " tets"};
  }
  for (std::size_t t = 0; t < stiffnessScale.size(); ++t) {
    if (stiffnessScale[t] > 0.0 && std::isfinite(static_cast<btScalar>(stiffnessScale[t]))) continue;
    return {StatusCode::InvalidOption,
            "the stiffness scale of tet " + std::to_string(t) + " must be above 0, and finite"};
  }
  return {};
}

Status checkMaterial(const ElasticMaterial& material) {
  if (!(material.youngsModulus > 0.0 && std::isfinite(material.youngsModulus))) {
    return invalid("a Young's modulus must be above 0, and finite");
  }
  if (!(material.poissonRatio >= 0.0 && material.poissonRatio < 0.5)) {
    return invalid("a Poisson's ratio must be at least 0 and below 0.5");
  }
  if (!(material.damping >= 0.0 && std::isfinite(material.damping))) {
    return invalid("damping must not be negative, and must be finite");
  }
  const Lame lame(material.youngsModulus, material.poissonRatio);
  const auto held = [](double value) { return std::isfinite(static_cast<btScalar>(value)); };
  if (held(lame.mu) && held(lame.lambda) && held(material.damping) && held(lame.lambda * material.damping)) return {};
  return invalid("a material so stiff, or so strongly damped, is beyond the range of Bullet's numbers");
}

/// A symmetric Gauss-Seidel sweep of each body of the elastic forces in a world, and masses for the others. Bullet's
/// conjugate gradient does not project what this makes.
class ElasticForce::Parts::Preconditioner : public ::Preconditioner {
 public:
  void begin(btDeformableBackwardEulerObjective& objective) {
    objective_ = &objective;
    bodies_.clear();
    inverseMasses_.resizeNoInitialize(objective.m_nodes.size());
    for (int i = 0; i < objective.m_nodes.size(); ++i) inverseMasses_[i] = objective.m_nodes[i]->m_im;
  }
  void add(const ElasticBody& body) { bodies_.push_back(&body); }

  void reinitialize(bool) override {}
  void operator()(const TVStack& x, TVStack& b) override {
    for (int i = 0; i < inverseMasses_.size(); ++i) b[i] = inverseMasses_[i] * x[i];
    for (const ElasticBody* of : bodies_) {
      auto& matrix = of->dynamics->matrix();
      const int first = of->body->m_nodes[0].index;
      for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
        const btVector3& v = x[first + static_cast<int>(n)];
        btScalar* to = matrix.residual() + matrix.wideOf(n);
        for (int k = 0; k < 3; ++k) to[k * kGroup] = v[k];
      }
      matrix.lower(nullptr);
      matrix.backward(0, nullptr);
      for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
        const btScalar* z = matrix.stepPoints() + 4 * matrix.slotOf(n);
        b[first + static_cast<int>(n)].setValue(z[0], z[1], z[2]);
      }
    }
    objective_->m_projection.project(b);
  }

 private:
  btDeformableBackwardEulerObjective* objective_ = nullptr;
  btAlignedObjectArray<btScalar> inverseMasses_;
  std::vector<const ElasticBody*> bodies_;
};

ElasticForce::Parts::Parts(const ElasticMaterial& ofMaterial)
    : material(ofMaterial), preconditioner(std::make_unique<Preconditioner>()) {}
ElasticForce::Parts::~Parts() = default;

void ElasticForce::Parts::applyMaterial(ElasticBody& to) const {
  const Lame lame(material.youngsModulus, material.poissonRatio);
  std::vector<elastic_detail::LameOfTet> tets(to.dynamics->tets()->count(), {lame.mu, lame.lambda});
  for (std::size_t t = 0; t < to.stiffnessScale.size(); ++t) {
    tets[t].mu *= to.stiffnessScale[t];
    tets[t].lambda *= to.stiffnessScale[t];
  }
  to.dynamics->setMaterial(tets);
  to.dynamics->setDamping(material.damping);
}

void ElasticForce::Parts::build(ElasticBody& of) const {
  if (of.stiffnessScale.size() != static_cast<std::size_t>(of.body->m_tetras.size())) of.stiffnessScale.clear();
  of.dynamics = std::make_unique<Dynamics>(restTetsOf(*of.body), static_cast<std::size_t>(of.body->m_nodes.size()));
  of.restMeasure = restMeasureOf(*of.body);
  applyMaterial(of);
}

ElasticBody* ElasticForce::Parts::find(const btSoftBody* body) {
  for (const auto& of : bodies) {
    if (of->body == body) return of.get();
  }
  return nullptr;
}

/// The first elastic force of a step installs its own, the others join it: the world resets what is installed.
void ElasticForce::Parts::precondition(btDeformableBodySolver& solver, ElasticBody& of) {
  if (!solver.m_useProjection || of.dynamics->alpha() == 0.0) return;
  btDeformableBackwardEulerObjective& objective = *solver.m_objective;
  auto* installed = dynamic_cast<Preconditioner*>(objective.m_preconditioner);
  if (!installed) {
    installed = preconditioner.get();
    installed->begin(objective);
    objective.m_preconditioner = installed;
  }
  installed->add(of);
}

namespace {

/// Bodies that the force acts on itself, in this step.
template <class Visit>
void forActive(ElasticForce::Parts& parts, Visit&& visit) {
  for (const auto& of : parts.bodies) {
    if (of->body->isActive() && !of->solved) visit(*of);
  }
}

/// The damping in use: where elastic forces are explicit, a step longer, which makes them as good as implicit.
double dampingTime(const ElasticForce::Parts& parts, const btSoftBody& body) {
  const btDeformableBackwardEulerObjective& objective = *solverOf(body)->m_objective;
  const double damping = parts.material.damping;
  return objective.m_implicit ? damping : damping + static_cast<double>(objective.m_dt);
}

/// out += factor K in
template <class In>
void addStiffness(ElasticBody& of, double factor, In&& in, btAlignedObjectArray<btVector3>& out) {
  Dynamics& dynamics = *of.dynamics;
  if (dynamics.alpha() == 0.0) return;  // woken in the middle of its first step
  const auto& matrix = dynamics.matrix();
  const auto scale = static_cast<btScalar>(factor / dynamics.alpha());
  btScalar* points = dynamics.scratchPoints();
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    const btVector3& v = in(static_cast<int>(n));
    for (int k = 0; k < 3; ++k) points[4 * matrix.slotOf(n) + static_cast<std::size_t>(k)] = v[k];
  }
  const btScalar* image = dynamics.times(points);
  const int first = of.body->m_nodes[0].index;
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    const btVector3& v = in(static_cast<int>(n));
    btVector3& to = out[first + static_cast<int>(n)];
    for (int k = 0; k < 3; ++k) {
      to[k] += scale * (image[matrix.wideOf(n) + static_cast<std::size_t>(k * kGroup)] - matrix.mass(n) * v[k]);
    }
  }
}

void addForces(ElasticBody& of, btScalar scale, bool predicted, btAlignedObjectArray<btVector3>& force) {
  readNodes(*of.body, predicted, *of.dynamics);
  of.dynamics->prepare(static_cast<double>(scale), nullptr);
  const int first = of.body->m_nodes[0].index;
  for (std::size_t n = 0; n < of.dynamics->nodeCount(); ++n) {
    const btScalar* f = of.dynamics->force(n);
    force[first + static_cast<int>(n)] += scale * btVector3(f[0], f[1], f[2]);
  }
}

void addDamping(const ElasticForce::Parts& parts, ElasticBody& of, btScalar scale,
                btAlignedObjectArray<btVector3>& force) {
  addStiffness(
      of, -static_cast<double>(scale) * dampingTime(parts, *of.body),
      [&](int n) -> const btVector3& { return of.body->m_nodes[n].m_v; }, force);
}

/// Bullet updates deformation gradients of its own between `reinitialize` and the first force of a step, which takes as
/// long as all that we do, and only its own forces read them. It finds no tets then.
void hideTets(ElasticBody& of) {
  if (of.hiddenTets >= 0 || !of.alone || of.solved || of.body->m_tetras.size() == 0) return;
  of.hiddenTets = of.body->m_tetras.size();
  of.body->m_tetras.resizeNoInitialize(0);
}
void showTets(ElasticForce::Parts& parts) {
  for (const auto& of : parts.bodies) {
    if (of->hiddenTets >= 0) of->body->m_tetras.resizeNoInitialize(of->hiddenTets);
    of->hiddenTets = -1;
  }
}

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

}  // namespace

ElasticForce::ElasticForce(const ElasticMaterial& material) : parts_(std::make_unique<Parts>(material)) {}
ElasticForce::~ElasticForce() = default;

const ElasticMaterial& ElasticForce::material() const {
  return parts_->material;
}
const SolverLimits& ElasticForce::limits() const {
  return parts_->limits;
}

Status ElasticForce::setMaterial(const ElasticMaterial& material) {
  if (Status status = checkMaterial(material); !status.ok()) return status;
  parts_->material = material;
  for (const auto& of : parts_->bodies) parts_->applyMaterial(*of);
  return {};
}

Status ElasticForce::setLimits(const SolverLimits& limits) {
  if (!(limits.tolerance >= 0.0 && limits.tolerance < 1.0)) {
    return invalid("a solver's tolerance must be at least 0 and below 1");
  }
  if (limits.iterations < 1) return invalid("a solver needs at least one iteration");
  parts_->limits = limits;
  return {};
}

Status ElasticForce::addTo(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body,
                           std::vector<double> stiffnessScale) {
  if (Status status = checkMaterial(parts_->material); !status.ok()) return status;
  if (Status status = checkTets(body, stiffnessScale); !status.ok()) return status;
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
  return setStiffnessScale(body, std::move(stiffnessScale));
}

Status ElasticForce::setStiffnessScale(btSoftBody& body, std::vector<double> stiffnessScale) {
  ElasticBody* of = parts_->find(&body);
  if (!of) return {StatusCode::IndexOutOfRange, "the body is none of this force's"};
  if (Status status = checkTets(body, stiffnessScale); !status.ok()) return status;
  of->stiffnessScale = std::move(stiffnessScale);
  const bool same = of->dynamics->tets()->count() == static_cast<std::size_t>(body.m_tetras.size());
  same ? parts_->applyMaterial(*of) : parts_->build(*of);
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
  btDeformableLagrangianForce::addSoftBody(body);
  auto of = std::make_unique<ElasticBody>();
  of->body = body;
  parts_->build(*of);
  parts_->bodies.push_back(std::move(of));
  parts_->knownForces = -1;
}

void ElasticForce::removeSoftBody(btSoftBody* body) {
  showTets(*parts_);
  btDeformableLagrangianForce::removeSoftBody(body);
  auto& bodies = parts_->bodies;
  bodies.erase(std::remove_if(bodies.begin(), bodies.end(), [&](const auto& of) { return of->body == body; }),
               bodies.end());
  parts_->bodyRemoved = true;
}

void ElasticForce::reinitialize(bool nodeUpdated) {
  showTets(*parts_);
  std::vector<btSoftBody*> lost;  // whose tets name no nodes any more
  for (const auto& of : parts_->bodies) {
    const btSoftBody& body = *of->body;
    const bool same = of->dynamics->nodeCount() == static_cast<std::size_t>(body.m_nodes.size()) &&
                      of->dynamics->tets()->count() == static_cast<std::size_t>(body.m_tetras.size());
    if (same && restMeasureOf(body) == of->restMeasure) continue;
    if (checkTets(body, {}).ok()) {
      parts_->build(*of);
    } else if (!same) {
      lost.push_back(of->body);
    }
  }
  for (btSoftBody* body : lost) removeSoftBody(body);
  const bool removal = parts_->bodyRemoved;
  parts_->bodyRemoved = false;
  const bool solved =
      std::all_of(parts_->bodies.begin(), parts_->bodies.end(), [](const auto& of) { return of->solved; });
  if (removal || solved) return;
  const ForceList& list = *solverOf(*parts_->bodies.front()->body)->getLagrangianForceArray();
  int known = list.size();
  for (int i = 0; i < list.size(); ++i) known += list[i]->m_softBodies.size();
  if (nodeUpdated || parts_->knownForces != known) {
    for (const auto& of : parts_->bodies) of->alone = isAlone(*of->body, list);
    parts_->knownForces = known;
  }
  forActive(*parts_, hideTets);
}

void ElasticForce::addScaledForces(btScalar scale, TVStack& force) {
  showTets(*parts_);
  forActive(*parts_, [&](ElasticBody& of) {
    addForces(of, scale, true, force);
    addDamping(*parts_, of, scale, force);
  });
}

void ElasticForce::addScaledExplicitForce(btScalar scale, TVStack& force) {
  showTets(*parts_);
  forActive(*parts_, [&](ElasticBody& of) { addForces(of, scale, false, force); });
}

void ElasticForce::addScaledDampingForce(btScalar scale, TVStack& force) {
  forActive(*parts_, [&](ElasticBody& of) {
    addDamping(*parts_, of, scale, force);
    parts_->precondition(*solverOf(*of.body), of);
  });
}

void ElasticForce::addScaledDampingForceDifferential(btScalar scale, const TVStack& dv, TVStack& df) {
  forActive(*parts_, [&](ElasticBody& of) {
    const int first = of.body->m_nodes[0].index;
    addStiffness(
        of, -static_cast<double>(scale) * dampingTime(*parts_, *of.body),
        [&](int n) -> const btVector3& { return dv[first + n]; }, df);
  });
}

void ElasticForce::addScaledElasticForceDifferential(btScalar scale, const TVStack& dx, TVStack& df) {
  forActive(*parts_, [&](ElasticBody& of) {
    const int first = of.body->m_nodes[0].index;
    addStiffness(
        of, -static_cast<double>(scale), [&](int n) -> const btVector3& { return dx[first + n]; }, df);
  });
}

void ElasticForce::buildDampingForceDifferentialDiagonal(btScalar scale, TVStack& diagonal) {
  forActive(*parts_, [&](ElasticBody& of) {
    if (of.dynamics->alpha() == 0.0) return;
    const double factor = -static_cast<double>(scale) * dampingTime(*parts_, *of.body) / of.dynamics->alpha();
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
  forActive(*parts_, [&](ElasticBody& of) {
    readNodes(*of.body, true, *of.dynamics);
    energy += of.dynamics->energy(nullptr);
  });
  return energy;
}

}  // namespace tetskin
