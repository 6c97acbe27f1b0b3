// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the rigid motion of a part of a stiff body as an unknown of its own, beside which the
// nodes' velocities are. Sweeps would be slow to find it, and of the stiffest bodies rounding would hide what it
// weighs.
#pragma once

#include <tetskin/bullet/src/forces/forced_bodies.h>
#include <tetskin/bullet/src/solver/contact_row.h>
#include <tetskin/core/src/shared/base/aligned.h>

#include <Eigen/Core>
#include <optional>

namespace tetskin {

using Vector6 = Eigen::Matrix<double, 6, 1>;
/// By how much the six motions move a row's point.
using RowMotions = Eigen::Matrix<double, 3, 6>;

/// Z are six motions, A the matrix without rows, b the right side.
struct PartUnknown {
  std::size_t body = 0;                                                    ///< in SolverBodies::bodies
  Eigen::Index first = 0;                                                  ///< of its six in the system's few unknowns
  AlignedVector<btScalar> motions[Dynamics::kRigidMotions];                ///< Z: 4 scalars a slot
  AlignedVector<btScalar> images[Dynamics::kRigidMotions];                 ///< A Z, wide
  Eigen::Matrix<double, 6, 6> mass = Eigen::Matrix<double, 6, 6>::Zero();  ///< Z^T A Z
  Vector6 began = Vector6::Zero();                                         ///< Z^T b

  /// Nothing where the part is held.
  /// dynamics  in which rows have not been added to the matrix yet
  static std::optional<PartUnknown> make(const Dynamics& dynamics, std::size_t part, ParallelFor* threads);

  /// Z^T A times a wide vector.
  Vector6 imageProducts(const btScalar* wide) const;
  /// Z^T times a wide vector.
  Vector6 motionProducts(const Dynamics& dynamics, const btScalar* wide) const;
  /// Adds A Z q to a wide vector.
  void addImages(const Vector6& q, btScalar* wide) const;
  /// Adds Z q to the solution.
  void addMotions(const Vector6& q, Dynamics& dynamics) const;
  /// Z where a row of the body acts; 0 where it is of another part.
  RowMotions motionsAt(const Dynamics& dynamics, const RowEnd& end) const;

 private:
  void findImages(const Dynamics& dynamics, bool rounded, ParallelFor* threads);
};

}  // namespace tetskin
