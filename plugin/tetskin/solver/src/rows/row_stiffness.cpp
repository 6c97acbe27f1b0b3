// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/rows/row_stiffness.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// D over effective masses: a gap is violated by a twentieth of the distance that the nodes alone would move. With
/// 0.01, a box of `tetskin_measure` (stop/equal steps/k50) stops 3 % too early.
constexpr double kStiffness = 20.0;
/// By how much of the body's size an impact may violate a gap: D is raised if a twentieth of the path towards the
/// object in this step is more than that. Otherwise fast bodies sink in by 5 % of their path, and tunnel through thin
/// walls.
constexpr double kViolation = 1e-3;
/// Upper bound of the factor by which D is raised for this: beyond it, the rounding of float dominates.
constexpr double kMostStiffening = 100.0;
/// The path that gravity adds in a step, times this, is left out: a small body at rest falls by a visible part of its
/// size in each step, and would jump on contacts stiffened for that.
constexpr btScalar kFallsAtRest = 2;
/// T over D. Slopes and stops in `tetskin_measure` also pass with 0.0003 and with 100, because the offset of a sticking
/// point grows until it suffices. But 100 takes 19 iterations per step in stop/equal steps/k50, where this value takes
/// 4.
constexpr btScalar kTangentShare = btScalar(0.3);
/// D of joints and anchors over effective masses, if the object is free to move (Joint) or not (Mount). What hangs on a
/// soft body is pushed by the residual of a solve, and more so with a higher D. A beam 16 times as long as thick that
/// sags by a thousandth of its length hangs lower by 1.5 % of that on its anchors; with 1000, by 8 %; with 1e5, slender
/// ones in float do not converge.
constexpr double kJointStiffness = 1000.0, kMountStiffness = 1e4;
/// Share by which each step moves the usual length of steps: with a tenth, bodies at rest move visibly under steps of 4
/// to 30 ms in random order; with a thousandth, following a change takes a minute.
constexpr double kFollowed = 0.01;
/// Largest factor by which an unusual step length makes contacts stiffer or softer: more would take many iterations.
constexpr double kMostOtherwise = 25.0;
/// Smaller weights are ignored when rows share a node.
constexpr btScalar kSmallWeight = btScalar(0.02);

std::array<double, 3> numbersOf(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

/// Inverse effective mass of an end's point in a direction: that of its nodes alone, plus that of the rigid motion of
/// their component.
/// stiffer  factor of the stiffness of the nodes' neighbourhood
double compliance(const SolvedBody& body, const CarriedPoint& point, const btVector3& position,
                  const btVector3& direction, double stiffer) {
  assert(point.count > 0);
  double sum = 0.0;
  for (std::uint32_t k = 0; k < point.count; ++k) {
    btScalar inverse[6];
    body.dynamics->matrix().freeInverse(static_cast<std::size_t>(point.nodes[k]), inverse);
    auto own = static_cast<double>(direction.dot(symmetricMatrix(inverse) * direction));
    if (stiffer != 1.0 && own > 0.0) {
      const auto mass = static_cast<double>(body.dynamics->matrix().mass(static_cast<std::size_t>(point.nodes[k])));
      own = 1.0 / (mass + stiffer * std::max(1.0 / own - mass, 0.0));
    }
    sum += static_cast<double>(point.weights[k] * point.weights[k]) * own;
  }
  const auto node = static_cast<std::size_t>(point.nodes[0]);
  return sum +
         body.dynamics->rigidCompliance(body.dynamics->componentOf(node), numbersOf(position), numbersOf(direction));
}

/// By end: how much stiffer a soft body's matrix is in a step of this length; 1 for a rigid body.
std::array<double, 2> alphaRatios(const SolverBodies& bodies, const ContactRow& row, double seconds) {
  const auto ratio = [&](const RowEnd& end) {
    return end.isSoft() ? bodies.bodies()[end.body].dynamics->alphaRatio(seconds) : 1.0;
  };
  return {ratio(row.ends[0]), ratio(row.ends[1])};
}

/// stiffer  by end: see `compliance`
double effectiveMass(const SolverBodies& bodies, const ContactRow& row, const RowOrigin& origin,
                     const RigidUnknowns& rigids, const std::array<double, 2>& stiffer) {
  const auto along = [&](const btVector3& direction) {
    double sum = 0.0;
    for (std::size_t e = 0; e < 2; ++e) {
      const RowEnd& end = row.ends[e];
      sum += end.isSoft()
                 ? compliance(bodies.bodies()[end.body], origin.points[e], origin.position, direction, stiffer[e])
                 : rigids.compliance(end.rigid, direction);
    }
    return sum;
  };
  const double sum = row.joined ? (along({1, 0, 0}) + along({0, 1, 0}) + along({0, 0, 1})) / 3 : along(row.normal);
  return sum > 0.0 ? 1.0 / sum : 0.0;
}

/// The speed at which a point would penetrate the object, without what gravity adds in the step.
btScalar approach(const SolverBodies& bodies, const ContactRow& row, btScalar seconds) {
  const btScalar falls = bodies.bodies()[row.ends[0].body].gravity.length() * seconds;
  return -row.normal.dot(row.relative) - row.gapVelocity - kFallsAtRest * falls;
}

/// The factor on a contact's D that keeps the violation of the gap invisible at this approach speed.
double stiffening(const SolverBodies& bodies, const ContactRow& row, btScalar seconds) {
  assert(!row.joined && row.ends[0].isSoft());
  btScalar size = sizeOf(*bodies.bodies()[row.ends[0].body].body);
  if (row.ends[1].isSoft()) size = std::min(size, sizeOf(*bodies.bodies()[row.ends[1].body].body));
  const auto way = static_cast<double>(approach(bodies, row, seconds) * seconds);
  const double seen = kStiffness * kViolation * static_cast<double>(size);
  return way > seen ? std::min(way / seen, kMostStiffening) : 1.0;
}

}  // namespace

/// False if the point is farther away than gravity moves it in a usual step, and does not come near.
bool RowStiffness::mayTouch(const SolverBodies& bodies, const ContactRow& row, btScalar seconds) const {
  const auto usual = static_cast<btScalar>(usualStep_);
  const btScalar near = kFallsAtRest * bodies.bodies()[row.ends[0].body].gravity.length() * usual * usual;
  return row.gapVelocity * seconds < near || approach(bodies, row, seconds) > 0;
}

void RowStiffness::followStep(btScalar seconds) {
  const auto now = static_cast<double>(seconds);
  usualStep_ += (usualStep_ > 0.0 ? kFollowed : 1.0) * (now - usualStep_);
}

btScalar RowStiffness::likeUsual(btScalar seconds) const {
  assert(usualStep_ > 0.0);
  const double steps = static_cast<double>(seconds) / usualStep_;
  return static_cast<btScalar>(std::min(std::max(steps * steps, 1.0 / kMostOtherwise), kMostOtherwise));
}

/// Counts touching rows, and others only if they are as near as in a step of usual length: longer steps have more of
/// them.
void RowStiffness::listLoads(const std::vector<ContactRow>& rows, const std::vector<RowOrigin>& origins,
                             const SolverBodies& bodies, btScalar seconds) {
  loads_.resize(bodies.bodies().size());
  for (std::size_t b = 0; b < loads_.size(); ++b) {
    loads_[b].assign(bodies.bodies()[b].acted.rowCount > 0 ? bodies.bodies()[b].dynamics->nodeCount() : 0, 0);
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const ContactRow& row = rows[r];
    if (row.joined || !row.ends[0].isSoft() || !mayTouch(bodies, row, seconds)) continue;
    for (std::size_t e = 0; e < 2; ++e) {
      if (!row.ends[e].isSoft()) continue;
      std::vector<btScalar>& load = loads_[row.ends[e].body];
      load.resize(bodies.bodies()[row.ends[e].body].dynamics->nodeCount(), 0);
      const CarriedPoint& point = origins[r].points[e];
      for (std::uint32_t k = 0; k < point.count; ++k) {
        load[static_cast<std::size_t>(point.nodes[k])] += std::abs(point.weights[k]);
      }
    }
  }
}

/// The largest sum of weights at a node of the row, at least 1.
btScalar RowStiffness::sharing(const ContactRow& row, const RowOrigin& origin) const {
  btScalar most = 1;
  for (std::size_t e = 0; e < 2 && !row.joined; ++e) {
    if (!row.ends[e].isSoft()) continue;
    const std::vector<btScalar>& load = loads_[row.ends[e].body];
    const CarriedPoint& point = origin.points[e];
    for (std::uint32_t k = 0; k < point.count && !load.empty(); ++k) {
      if (std::abs(point.weights[k]) < kSmallWeight) continue;
      most = std::max(most, load[static_cast<std::size_t>(point.nodes[k])]);
    }
  }
  return most;
}

/// A node shared by several rows gets no stiffer than with one row.
void RowStiffness::set(std::vector<ContactRow>& rows, const std::vector<RowOrigin>& origins, const SolverBodies& bodies,
                       const RigidUnknowns& rigids, btScalar seconds) {
  assert(rows.size() == origins.size() && seconds > 0);
  followStep(seconds);
  listLoads(rows, origins, bodies, seconds);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    ContactRow& row = rows[r];
    if (row.constant) continue;
    const std::array<double, 2> asIs = {1.0, 1.0}, asUsual = alphaRatios(bodies, row, usualStep_);
    const double mass = effectiveMass(bodies, row, origins[r], rigids, asIs);
    const double usualMass = asUsual == asIs ? mass : effectiveMass(bodies, row, origins[r], rigids, asUsual);
    // A higher stiffness makes no visible difference, and would amplify the residual of the solve.
    const bool mounted = !row.ends[1].isSoft() && row.ends[1].rigid.unknown < 0;
    const double times = !row.joined ? kStiffness * stiffening(bodies, row, seconds)
                         : mounted   ? kMountStiffness
                                     : kJointStiffness;
    const auto maximum = static_cast<btScalar>(times * usualMass) * likeUsual(seconds) / sharing(row, origins[r]);
    row.stiffness = row.stiffness > 0 ? std::min(row.stiffness, maximum) : maximum;
    row.tangentStiffness = kTangentShare * row.stiffness;
    row.effectiveMass = static_cast<btScalar>(mass);
  }
}

}  // namespace tetskin::bullet_detail
