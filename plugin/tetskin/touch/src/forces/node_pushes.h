// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: impulses and forces on nodes, once a lever has shared them out.
#pragma once

#include <tetskin/touch/src/points/lever.h>

#include <memory>

namespace tetskin::touch_detail {

struct NodePush {
  int node = 0;
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
};
using NodePushes = std::vector<NodePush>;  ///< a node may have several

void addPush(const Lever& lever, const Eigen::Vector3d& push, NodePushes& pushes);

/// Into velocities, at once; what comes to pinned nodes is lost. Wakes the body.
void applyImpulses(const NodePushes& impulses, btSoftBody& body);

/// Through the next steps. Wakes the body.
/// owner   gets what applies them; null: the body, which then must be one of `makeSoftBody`
/// Errors  OutOfWorld, InvalidOption
TouchStatus applyForces(NodePushes forces, int steps, btSoftBody& body, std::shared_ptr<void>* owner);

}  // namespace tetskin::touch_detail
