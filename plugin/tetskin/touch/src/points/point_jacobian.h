// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: how a point moves with the nodes around it, and how a push is divided among them.
#pragma once

#include <tetskin/touch/src/points/point_data.h>
#include <tetskin/touch/surface_point.h>

#include <vector>

namespace tetskin::touch_detail {

/// One node of a Jacobian: the point's velocity is the sum of `linear` times the nodes' velocities. The transposed
/// matrices divide a push among the nodes, so that the work at the point equals the work at the nodes, and momentum is
/// preserved.
struct PointJacobianNode {
  int node = 0;
  Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();
};
using PointJacobian = std::vector<PointJacobianNode>;  ///< 4 to 12 nodes, all distinct

/// The Jacobian of a point at the current node positions. A corner inside its tet uses barycentric weights. A corner
/// outside uses those of the tet's closest point, plus a couple: weights that extrapolate would give single nodes very
/// large shares.
PointJacobian jacobianAt(const PointData& point, const btSoftBody& body);

/// Inverse mass: the velocity of the point per unit impulse.
Eigen::Matrix3d linearResponse(const PointJacobian& jacobian, const btSoftBody& body);

/// The mass that corresponds to this response: infinite if nothing can move.
double massOf(const Eigen::Matrix3d& response);

}  // namespace tetskin::touch_detail
