// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: applies a push that a Jacobian has divided into impulses or forces on nodes.
#pragma once

#include <tetskin/solver/src/base/node_loads.h>
#include <tetskin/touch/src/points/point_jacobian.h>

namespace tetskin::touch_detail {

using bullet_detail::NodePush;
using bullet_detail::NodePushes;

void addPush(const PointJacobian& jacobian, const Eigen::Vector3d& push, NodePushes& pushes);

/// Adds the impulses to the nodes' velocities at once; pinned nodes absorb theirs. Wakes the body.
void applyImpulses(const NodePushes& impulses, btSoftBody& body);

/// Applies the forces in the next steps. Wakes the body.
/// Errors  NotInWorld, InvalidOption
StatusCode applyForces(NodePushes forces, int steps, btSoftBody& body);

}  // namespace tetskin::touch_detail
