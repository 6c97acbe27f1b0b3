// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: applies the impulses and forces on nodes among which a Jacobian has divided a push.
#pragma once

#include <tetskin/touch/src/points/point_jacobian.h>
#include <tetskin/touch/src/rows/surface_joint_rows.h>

#include <memory>

namespace tetskin::touch_detail {

struct NodePush {
  int node = 0;
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
};
using NodePushes = std::vector<NodePush>;  ///< a node may have several

void addPush(const PointJacobian& jacobian, const Eigen::Vector3d& push, NodePushes& pushes);

/// Adds the impulses to the nodes' velocities at once; those on pinned nodes are lost. Wakes the body.
void applyImpulses(const NodePushes& impulses, btSoftBody& body);

/// Applies the forces in the next steps. Wakes the body.
/// owner   keeps the object that applies them; null: the body does, which then must come from `createSoftBody`
/// Errors  OutOfWorld, InvalidOption
StatusCode applyForces(NodePushes forces, int steps, btSoftBody& body, std::shared_ptr<void>* owner);

/// What such forces have described, for recorded runs; null: it is damaged.
std::shared_ptr<ActiveJoint> buildLoad(BuildStream& stream);

}  // namespace tetskin::touch_detail
