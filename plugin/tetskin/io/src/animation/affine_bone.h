// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Any linear map as two nodes of a scene, which only have rotations and scales: A = U S V^T, a rotation and a scale
// above a rotation.
#pragma once

#include <Eigen/Geometry>

namespace tetskin::io {

struct AffineBone {
  Eigen::Matrix3d upper = Eigen::Matrix3d::Identity();  ///< U, a rotation
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();      ///< S; one factor is negative if A mirrors
  Eigen::Matrix3d lower = Eigen::Matrix3d::Identity();  ///< V, a rotation; the lower node has its transpose

  /// Decomposes another map by Jacobi's method on the columns of A V (M. Hestenes, "Inversion of Matrices by
  /// Biorthogonalization", 1958), starting with the present V, so that both rotations change little from frame to
  /// frame, and players may interpolate them.
  void set(const Eigen::Matrix3d& map);
};

}  // namespace tetskin::io
