// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/system/momentum_errors.h>

#include <algorithm>
#include <cassert>

namespace tetskin::bullet_detail {
namespace {

using HeldPoint = elastic_detail::HeldPoint<btScalar>;

/// Sum of the impulses' sizes on a body, over the size of their sum, from which on it counts as squeezed. The error
/// that a solve leaves is a share of the impulses: if a light body between heavy ones took it up, it would keep
/// shaking, by tens of its sizes per second under 100 times its mass. Joints do not count: they hold what spins around
/// what it is joined to, as a tyre its hub, and impulses that were changed would turn the other body.
constexpr double kSqueezed = 30.0;

/// True if a joint connects the body to an object whose motion is prescribed. Such an object takes up any momentum, and
/// a point with a joint of that stiffness depends on where in the step its impulse acts.
bool isHung(const SystemBodies& bodies, const SystemBody& body) {
  return std::any_of(body.ends.list().begin(), body.ends.list().end(), [&](const BodyEnd& end) {
    const ContactRow& row = bodies.row(end.row);
    return end.index == 0 && row.joined && !row.constant && row.ends[1].rigid.unknown < 0;
  });
}

/// What a joint gives to a rigid body acts at its point of that body, from which the soft body's may have gone astray:
/// the two are to get opposite torques.
void addTorqueOfGap(const SystemBodies& bodies, const SystemBody& body, const BodyEnd& end, const btVector3& impulse,
                    std::vector<std::array<double, 3>>& torques) {
  const ContactRow& row = bodies.row(end.row);
  if (end.index != 0 || row.constant || row.ends[1].rigid.unknown < 0) return;
  const CarriedPoint& point = bodies.pointOf(end.row, 0);
  const btVector3 gap = bodies.input().rows.originOf(row).position - point.position(*body.solved.body);
  const btVector3 torque = gap.cross(impulse);
  std::array<double, 3>& to = torques[body.solved.dynamics->componentOf(static_cast<std::size_t>(point.nodes[0]))];
  for (int k = 0; k < 3; ++k) to[static_cast<std::size_t>(k)] += static_cast<double>(torque[k]);
}

/// The contacts with rigid objects that resist a motion of the whole body. Contacts with soft bodies keep their
/// impulses, as these count for two bodies.
void findHeld(const SystemBodies& bodies, const SystemBody& body, std::vector<HeldPoint>& held,
              std::vector<ContactRow*>& rows) {
  for (const BodyEnd& of : body.ends.list()) {
    ContactRow& row = bodies.row(of.row);
    if (of.index != 0 || row.ends[1].isSoft() || row.constant || row.state == ContactRow::State::Apart) continue;
    const CarriedPoint& carried = bodies.pointOf(of.row, 0);
    HeldPoint& point = held.emplace_back();
    point.nodes = carried.nodes.data();
    point.weights = carried.weights.data();
    point.nodeCount = carried.count;
    for (int k = 0; k < 9; ++k) {
      point.stiffness[static_cast<std::size_t>(k)] = static_cast<double>(row.tangent[k / 3][k % 3]);
    }
    rows.push_back(&row);
  }
}

void removeMomentumError(const SystemBodies& bodies, const SystemBody& body) {
  std::vector<std::array<double, 3>> impulses(body.dynamics().nodeCount(), {0.0, 0.0, 0.0});
  std::vector<std::array<double, 3>> torques(body.dynamics().componentCount(), {0.0, 0.0, 0.0});
  Small3 net;
  double pressed = 0.0;
  for (const BodyEnd& of : body.ends.list()) {
    const CarriedPoint& point = bodies.pointOf(of.row, of.index);
    const btVector3 impulse = btScalar(signOf(of.index)) * bodies.row(of.row).impulse;
    const ContactRow& row = bodies.row(of.row);
    if (row.joined) {
      addTorqueOfGap(bodies, body, of, impulse, torques);
    } else {
      net += toSmall(impulse);
      pressed += norm(toSmall(impulse));
    }
    for (std::uint32_t n = 0; n < point.count; ++n) {
      auto& to = impulses[static_cast<std::size_t>(point.nodes[n])];
      for (std::size_t k = 0; k < 3; ++k) {
        to[k] += static_cast<double>(point.weights[n]) * static_cast<double>(impulse[static_cast<int>(k)]);
      }
    }
  }
  std::vector<HeldPoint> held;
  std::vector<ContactRow*> rows;
  if (pressed > kSqueezed * norm(net)) findHeld(bodies, body, held, rows);
  body.dynamics().removeMomentum([&](std::size_t node) { return impulses[node]; }, torques, &held);
  assert(rows.size() == held.size());
  for (std::size_t k = 0; k < held.size(); ++k) {
    const btVector3 change = fromSmall({{held[k].change[0], held[k].change[1], held[k].change[2]}});
    rows[k]->impulse -= rows[k]->tangent * change;
    rows[k]->slip += change - rows[k]->normal.dot(change) * rows[k]->normal;
  }
}

}  // namespace

void removeMomentumErrors(SystemBodies& bodies) {
  if (!bodies.hasRows() || bodies.hasForces()) return;
  bodies.forEachBody([&](SystemBody& body, ParallelFor*) {
    if (body.solved.elastic && body.solved.acted.fixed.empty() && !isHung(bodies, body))
      removeMomentumError(bodies, body);
  });
}

}  // namespace tetskin::bullet_detail
