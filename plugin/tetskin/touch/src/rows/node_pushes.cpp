// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/touch/src/rows/node_pushes.h>

#include <cassert>
#include <utility>

namespace tetskin::touch_detail {

using bullet_detail::deformableSolverOf;

void addPush(const PointJacobian& jacobian, const Eigen::Vector3d& push, NodePushes& pushes) {
  for (const PointJacobianNode& node : jacobian) pushes.push_back({node.node, node.linear.transpose() * push});
}

void applyImpulses(const NodePushes& impulses, btSoftBody& body) {
  for (const NodePush& push : impulses) {
    assert(push.node >= 0 && push.node < body.m_nodes.size());
    btSoftBody::Node& node = body.m_nodes[push.node];
    const btVector3 change = toBullet(static_cast<double>(node.m_im) * push.push);
    node.m_v += change;
    node.m_vn += change;  // implicit worlds start the step from this one
  }
  body.activate();
}

StatusCode applyForces(NodePushes forces, int steps, btSoftBody& body) {
  if (!body.getBroadphaseHandle()) return StatusCode::NotInWorld;
  DeformableSolver* solver = deformableSolverOf(body);
  if (!solver || steps < 1) return StatusCode::InvalidOption;
  Access<DeformableSolver>::addLoads(*solver, body, std::move(forces), steps);
  return StatusCode::Ok;
}

}  // namespace tetskin::touch_detail
