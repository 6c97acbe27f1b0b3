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
  Eigen::Matrix3d angular = Eigen::Matrix3d::Zero();  ///< the same for how fast all of them turn together
};
using Lever = std::vector<LeverNode>;  ///< 4 to 12, each node once

/// For the nodes where they are now. A corner inside its tet: weights. One outside: those of the tet's closest point,
/// and a couple, as weights that extrapolate would throw single nodes about.
Lever leverOf(const PointData& point, const btSoftBody& body);

/// Of a body's point, now, by its corners' weights: where it is acted at.
btVector3 linearPosition(const PointData& point, const btSoftBody& body);

/// Of the nodes now, with what contacts have added for this step.
/// split  also of that by which they push apart what is too near
Eigen::Vector3d velocityOf(const Lever& lever, const btSoftBody& body, bool split = true);
Eigen::Vector3d spinOf(const Lever& lever, const btSoftBody& body, bool split = true);

/// Inverse mass: how fast the point moves by a unit impulse.
Eigen::Matrix3d linearResponse(const Lever& lever, const btSoftBody& body);

/// How the nodes have turned, by the best fit, from where they were.
/// before  as many, in the lever's order, about any middle
Eigen::Matrix3d turnSince(const std::vector<Eigen::Vector3d>& before, const Lever& lever, const btSoftBody& body);
std::vector<Eigen::Vector3d> placesOf(const Lever& lever, const btSoftBody& body);

/// Of a mass of which the response is this: infinite where nothing can move.
double massOf(const Eigen::Matrix3d& response);

inline Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

inline Eigen::Matrix3d toMatrix(const btMatrix3x3& m) {
  Eigen::Matrix3d out;
  for (int i = 0; i < 3; ++i) out.row(i) = toEigen(m[i]);
  return out;
}

}  // namespace tetskin::touch_detail
