// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The solve of one system: of bodies that forces couple together, or of one by itself.
#include <tetskin/bullet/coupling_force.h>
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/step.h>

#include <algorithm>

namespace tetskin {
namespace {

/// Of the errors that a solve may leave: what a dynamic rigid body gets is known as well as they are small.
constexpr double kCloserWithRigids = 0.1;
/// Where forces of Bullet's or of the application's act on elastic bodies, the residual at most: they act on few nodes,
/// so that their part of it is small, and what is left of that they give anew in each step, and energy with it.
constexpr double kWithForeignForces = 1e-6;

}  // namespace

void DeformableSolver::Parts::solveSystem(const SolvedSystem& system, ParallelFor* inner) {
  SolvedBody& first = bodies.bodies()[system.bodies.front()];
  bool again = !system.forces.empty();
  for (const std::size_t b : system.bodies) again |= bodies.bodies()[b].constrained || bodies.bodies()[b].touched;
  if (again) {
    solveAgain(system, inner);
    for (const std::size_t b : system.bodies) bodies.bodies()[b].solvedAgain = true;
  } else if (first.elastic) {
    first.solve->iterate(first.limits->iterations, inner);
    first.iterations = first.solve->iterations();
  }
  const bool free = system.forces.empty() && system.rigids.empty() && !first.constrained && !first.touched;
  if (free && first.elastic) first.dynamics->removeMomentum();
}

void DeformableSolver::Parts::solveAgain(const SolvedSystem& system, ParallelFor* inner) {
  using Solve = elastic_detail::ConjugateGradient<btScalar>;
  const elastic_detail::SolveLimits limits = limitsOf(system);
  startAgain(system, inner);
  Solve::Matrices matrices;
  for (const std::size_t b : system.bodies) matrices.push_back(&bodies.bodies()[b].dynamics->matrix());
  Solve::Extra extra;
  if (!system.forces.empty() || !system.rigids.empty()) {
    extra = [&](std::vector<const btScalar*>& added) { addProducts(system, added); };
  }
  SolvedBody& first = bodies.bodies()[system.bodies.front()];
  first.solve->start(std::move(matrices), limits, std::move(extra), inner);
  first.solve->iterate(limits.iterations, inner);
  first.iterations += first.solve->iterations();
}

void DeformableSolver::Parts::addProducts(const SolvedSystem& system, std::vector<const btScalar*>& added) {
  for (const std::size_t b : system.bodies) {
    const SolvedBody& of = bodies.bodies()[b];
    const auto& matrix = of.dynamics->matrix();
    if (system.forces.empty()) {
      extras[b].assign(matrix.wideSize(), btScalar(0));
      continue;
    }
    for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
      step[of.first + static_cast<int>(n)] = fromPoint(matrix.stepPoints() + 4 * matrix.slotOf(n));
    }
  }
  if (!system.forces.empty()) multiplyOthers(system);
  ties.addProducts(system.rigids, bodies, extras);
  for (std::size_t k = 0; k < system.bodies.size(); ++k) added[k] = extras[system.bodies[k]].data();
}

/// The strictest of all.
elastic_detail::SolveLimits DeformableSolver::Parts::limitsOf(const SolvedSystem& system) const {
  elastic_detail::SolveLimits limits;
  limits.floor = kUnseen * static_cast<double>(dt());
  limits.iterations = 0;
  bool inContact = false, anyElastic = false, stiff = false;
  double squaredStart = 0.0;
  for (const std::size_t b : system.bodies) {
    const SolvedBody& of = bodies.bodies()[b];
    limits.tolerance = std::min(limits.tolerance, of.limits->tolerance);
    limits.iterations = std::max(limits.iterations, of.limits->iterations);
    if (of.elastic) limits.enough += of.solve->enough();
    inContact |= of.constrained || of.touched;
    stiff |= of.dynamics->isStiff();
    squaredStart += of.dynamics->squaredSolution();
    anyElastic |= of.elastic != nullptr;
  }
  const double closer = system.rigids.empty() ? 1.0 : kCloserWithRigids;
  double tolerance = closer * limits.tolerance;
  for (const btDeformableLagrangianForce* force : system.forces) {
    const auto* coupling = dynamic_cast<const CouplingForce*>(force);
    const double foreign = anyElastic ? kWithForeignForces : 1.0;
    tolerance = std::min(tolerance, coupling ? coupling->tolerance() : foreign);
  }
  const double share = tolerance / std::max(limits.tolerance, 1e-300);  // 0 is a tolerance, too
  limits.tolerance = tolerance;
  limits.floor *= closer;
  limits.enough *= share * share;  // of squares
  // A share of how the velocities differ from rigid motion may be left, too. Of stiff bodies nothing else: the residual
  // that a contact begins with is as large as the body is stiff, and what may be left of it would move light nodes.
  if (inContact || stiff) {
    limits.enough = std::max(limits.enough, limits.tolerance * limits.tolerance * squaredStart);
  }
  if (stiff) limits.tolerance = 0.0;
  return limits;
}

/// The residuals of what contacts have done, and of what other forces do.
void DeformableSolver::Parts::startAgain(const SolvedSystem& system, ParallelFor* inner) {
  const bool withForces = !system.forces.empty();
  if (withForces) {
    for (const std::size_t b : system.bodies) {
      const SolvedBody& of = bodies.bodies()[b];
      const int end = of.first + static_cast<int>(of.dynamics->nodeCount());
      for (int number = of.first; number < end; ++number) step[number] = solver.m_dv[number];
    }
    multiplyOthers(system);
  }
  ties.addForces(system.rigids, bodies, solver.m_residual);
  for (const std::size_t b : system.bodies) {
    SolvedBody& of = bodies.bodies()[b];
    of.dynamics->startAgain(inner);
    auto& matrix = of.dynamics->matrix();
    for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
      const std::size_t wide = matrix.wideOf(n);
      btVector3 residual = fromWide(matrix.residual() + wide);
      residual += solver.m_residual[of.first + static_cast<int>(n)];
      if (withForces) residual -= fromWide(&extras[b][wide]);
      toWide(residual, matrix.residual() + wide);
    }
  }
}

void DeformableSolver::Parts::multiplyOthers(const SolvedSystem& system) {
  for (const std::size_t b : system.bodies) {
    const SolvedBody& of = bodies.bodies()[b];
    for (int n = 0; n < of.body->m_nodes.size(); ++n) image[of.first + n].setZero();
  }
  for (btDeformableLagrangianForce* force : system.forces) {
    force->addScaledDampingForceDifferential(-dt(), step, image);
    if (force->getForceType() == BT_MOUSE_PICKING_FORCE) {
      force->addScaledElasticForceDifferential(-dt() * dt(), step, image);
    }
  }
  for (const std::size_t b : system.bodies) {
    const SolvedBody& of = bodies.bodies()[b];
    const auto& matrix = of.dynamics->matrix();
    extras[b].resize(matrix.wideSize(), btScalar(0));
    for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
      toWide(image[of.first + static_cast<int>(n)], &extras[b][matrix.wideOf(n)]);
    }
  }
}

}  // namespace tetskin
