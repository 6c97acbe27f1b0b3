// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: how a point moves with the nodes around it, and what of a push each of them gets.
#pragma once

#include <tetskin/touch/surface_point.h>

#include <vector>

namespace tetskin::touch_detail {

/// One node of a lever: the point's velocity is the sum of `linear` times the nodes'. A push is shared out by the
/// transposed matrices, so that what it does to the point and what it does to the nodes is the same work, and momentum
/// is what was put in.
struct LeverNode {
  int node = 0;
  Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();
};
using Lever = std::vector<LeverNode>;  ///< 4 to 12, each node once

/// For the nodes where they are now. A corner inside its tet: weights. One outside: those of the tet's closest point,
/// and a couple, as weights that extrapolate would throw single nodes about.
Lever leverOf(const PointData& point, const btSoftBody& body);

/// Inverse mass: how fast the point moves by a unit impulse.
Eigen::Matrix3d linearResponse(const Lever& lever, const btSoftBody& body);

/// Of a mass of which the response is this: infinite where nothing can move.
double massOf(const Eigen::Matrix3d& response);

}  // namespace tetskin::touch_detail
