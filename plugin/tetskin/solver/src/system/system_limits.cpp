// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
#include <tetskin/solver/src/system/system_limits.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// Bound of the relative residual where forces of Bullet or of the application act on elastic bodies: they act on few
/// nodes, so that they contribute little to it, and an error in them recurs in each step and adds energy.
constexpr double kWithForeignForces = 1e-6;
/// With rows: the tolerance relative to that of a body without rows; and its bound for a body that hangs by joints
/// without a largest force, since such a body keeps an error in its velocity as far as the tolerance allows.
constexpr double kCloserWithRows = 0.1, kWhereJoined = 1e-4;
/// A residual smaller than this cannot be reached in this precision.
constexpr double kClosest = 8.0 * SIMD_EPSILON;
/// Bound of the relative residual in Bullet's solve: its square is the last digit.
const double kBullets = std::sqrt(static_cast<double>(SIMD_EPSILON));
/// By how much the first pass reduces the residual, at most, and the passes after it: the rows change after each pass.
constexpr double kFirstPass = 0.1, kLaterPass = 0.1;

/// The squared norm of impulses that change all velocities alike, over that by the masses: how far a stiffness spreads
/// an impulse before it becomes velocity.
double shareOfImpulses(const SolvedBody& body) {
  const double mass = body.dynamics->matrix().totalMass();
  return mass > 0.0 ? body.dynamics->squaredImpulses(1.0) / mass : 1.0;
}

double toleranceWithForces(const SystemBodies& bodies, double tolerance) {
  return bodies.hasForces() ? std::min(tolerance, kWithForeignForces) : tolerance;
}

/// Where only Bullet's forces act, the solve is for their damping, and what it leaves is missing in every step: it goes
/// as far as Bullet's does. Bullet's limit is relative to the damping impulses before contacts have changed velocities,
/// or to 1 where these are larger.
elastic_detail::SolveLimits limitsOfBulletsForces(const SystemBodies& bodies) {
  double squared = 0.0;
  for (const SystemBody& one : bodies.list()) {
    const btSoftBody& body = *one.solved.body;
    for (int n = 0; n < body.m_nodes.size(); ++n) {
      const btVector3& impulse = bodies.input().others.impulse(one.solved.first + n);
      squared += static_cast<double>(body.m_nodes[n].m_im * impulse.length2());
    }
  }
  elastic_detail::SolveLimits limits;
  limits.tolerance = kBullets;
  limits.enough = kBullets * kBullets * std::min(squared, 1.0);
  return limits;
}

}  // namespace

elastic_detail::SolveLimits limitsWithoutRows(const SystemBodies& bodies) {
  elastic_detail::SolveLimits limits;
  limits.iterations = 0;
  limits.tolerance = 1.0;
  bool changed = false, anyElastic = false, stiff = false;
  double squaredStart = 0.0, unseen = 0.0;
  for (const SystemBody& one : bodies.list()) {
    const SolvedBody& body = one.solved;
    unseen += body.dynamics->squaredImpulses(body.solve.unseenSpeed);
    limits.tolerance = std::min(limits.tolerance, body.settings->tolerance);
    limits.iterations = std::max(limits.iterations, body.settings->iterations);
    if (body.elastic && !body.solve.deferred) limits.enough += body.memory->gradient.enough();
    changed |= !body.acted.fixed.empty() || body.acted.changed;
    stiff |= body.dynamics->isStiff();
    squaredStart += body.dynamics->squaredSolution() * shareOfImpulses(body);
    anyElastic |= body.elastic != nullptr;
  }
  if (!anyElastic) return limitsOfBulletsForces(bodies);
  const double tolerance = toleranceWithForces(bodies, limits.tolerance);
  const double fraction = tolerance / std::max(limits.tolerance, 1e-300);  // a tolerance may be 0
  limits.tolerance = tolerance;
  limits.enough *= fraction * fraction;  // the limits are squares
  assert(!(limits.tolerance < 0.0) && limits.tolerance <= 1.0);
  // The residual may also be a fraction of the impulses that give the velocities their difference to a rigid motion.
  // Stiff bodies use this criterion only: the initial residual of a contact is proportional to the body's stiffness,
  // and a fraction of it would move light nodes.
  if (changed || stiff) {
    limits.enough = std::max(limits.enough, limits.tolerance * limits.tolerance * squaredStart);
  }
  if (stiff) limits.tolerance = 0.0;
  limits.enough = std::max(limits.enough, unseen);
  return limits;
}

elastic_detail::SolveLimits limitsOfPass(const SystemBodies& bodies, const ReducedUnknowns& reduced, int pass) {
  assert(bodies.hasRows() && pass >= 0);
  elastic_detail::SolveLimits limits;
  limits.iterations = 0;
  double byMatrix = 0.0, byMasses = 0.0, share = 1.0, tolerance = 1.0;
  for (const SystemBody& body : bodies.list()) {
    tolerance = std::min(tolerance, body.solved.settings->tolerance);
    limits.iterations = std::max(limits.iterations, body.solved.settings->iterations);
    byMatrix += body.start.byMatrix;
    byMasses += body.start.byMasses;
    share = std::min(share, shareOfImpulses(body.solved));
  }
  for (const ComponentUnknown& component : reduced.components()) byMasses += reduced.squaredByMasses(component);
  const auto& rows = bodies.system().rows;
  const bool joined = std::any_of(
      rows.begin(), rows.end(), [](const ContactRow* row) { return row->joined && !(row->highest < BT_LARGE_FLOAT); });
  // In a stiff body, an error of velocities that is small by its masses is as large as all the forces that act on it.
  const double ofForces = std::max(tolerance * tolerance * share, kClosest * kClosest);
  tolerance = toleranceWithForces(bodies, std::min(kCloserWithRows * tolerance, joined ? kWhereJoined : 1.0));
  tolerance = std::max(tolerance, kClosest);
  const double squared = tolerance * tolerance;
  limits.enough = std::max(squared * byMatrix, std::min(squared, ofForces) * byMasses);
  limits.tolerance = pass == 0 ? kFirstPass : kLaterPass;
  return limits;
}

}  // namespace tetskin::bullet_detail
