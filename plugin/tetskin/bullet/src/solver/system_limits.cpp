// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How closely a system is solved for.
#include <tetskin/bullet/src/solver/system_solve.h>

#include <algorithm>

namespace tetskin {
namespace {

/// Where forces of Bullet's or of the application's act on elastic bodies, the residual at most: they act on few nodes,
/// so that their part of it is small, and what is left of that they give anew in each step, and energy with it.
constexpr double kWithForeignForces = 1e-6;
/// With rows: the tolerance over that of a body by itself; and of what hangs by joints without a largest force, at
/// most, as it goes on at the speed that it has, as far as its tolerance lets it.
constexpr double kCloserWithRows = 0.1, kWhereJoined = 1e-4;
/// Closer than that to a solution no arithmetic comes that has so few digits.
constexpr double kClosest = 8.0 * SIMD_EPSILON;
/// By how much the first pass lessens the residual, at most, and the others: rows are others after it.
constexpr double kFirstPass = 0.02, kLaterPass = 0.1;

}  // namespace

double SystemSolve::massOfAll() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < states_.size(); ++k) sum += bodyAt(k).dynamics->matrix().totalMass();
  return sum;
}

double SystemSolve::toleranceWithForces(double tolerance, bool anyElastic) const {
  const bool anyForeign = anyElastic && !system_.forces.empty();
  return anyForeign ? std::min(tolerance, kWithForeignForces) : tolerance;
}

/// The strictest of all.
elastic_detail::SolveLimits SystemSolve::limitsWithoutRows() const {
  elastic_detail::SolveLimits limits;
  limits.floor = kUnseen * static_cast<double>(step_.dt());
  limits.iterations = 0;
  bool changed = false, anyElastic = false, stiff = false;
  double squaredStart = 0.0;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const SolvedBody& of = bodyAt(k);
    limits.tolerance = std::min(limits.tolerance, of.limits->tolerance);
    limits.iterations = std::max(limits.iterations, of.limits->iterations);
    if (of.elastic && !of.waits) limits.enough += of.solve->enough();
    changed |= !of.fixed.empty() || of.touched;
    stiff |= of.dynamics->isStiff();
    squaredStart += of.dynamics->squaredSolution();
    anyElastic |= of.elastic != nullptr;
  }
  const double tolerance = toleranceWithForces(limits.tolerance, anyElastic);
  const double share = tolerance / std::max(limits.tolerance, 1e-300);  // 0 is a tolerance, too
  limits.tolerance = tolerance;
  limits.enough *= share * share;  // of squares
  // A share of how the velocities differ from rigid motion may be left, too. Of stiff bodies nothing else: the residual
  // that a contact begins with is as large as the body is stiff, and what may be left of it would move light nodes.
  if (changed || stiff) {
    limits.enough = std::max(limits.enough, limits.tolerance * limits.tolerance * squaredStart);
  }
  if (stiff) limits.tolerance = 0.0;
  return limits;
}

/// Over what contacts and others have changed: how much the solution is, or by how much velocities have changed in the
/// step, whichever is more.
elastic_detail::SolveLimits SystemSolve::limitsOfPass(int pass) const {
  elastic_detail::SolveLimits limits;
  limits.iterations = 0;
  limits.floor = 0.0;
  double byMatrix = 0.0, byMasses = 0.0, tolerance = 1.0;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const SolvedBody& of = bodyAt(k);
    tolerance = std::min(tolerance, of.limits->tolerance);
    limits.iterations = std::max(limits.iterations, of.limits->iterations);
    byMatrix += of.dynamics->squaredByMatrix();
    byMasses += of.dynamics->squaredChange();
  }
  for (const PartUnknown& part : parts_) {
    byMasses += few_.segment<6>(part.first).dot(partsBefore_.segment<6>(part.first));
  }
  const bool joined = std::any_of(system_.rows.begin(), system_.rows.end(), [](const ContactRow* row) {
    return row->joined && !(row->highest < BT_LARGE_FLOAT);
  });
  tolerance = toleranceWithForces(std::min(kCloserWithRows * tolerance, joined ? kWhereJoined : 1.0), true);
  tolerance = std::max(tolerance, kClosest);
  limits.enough = tolerance * tolerance * std::max(byMatrix, byMasses);
  limits.tolerance = pass == 0 ? kFirstPass : kLaterPass;
  return limits;
}

}  // namespace tetskin
