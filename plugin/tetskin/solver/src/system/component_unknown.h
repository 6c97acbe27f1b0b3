// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the rigid motion of a component of a stiff body as a separate unknown; the nodes'
// velocities are relative to it. Sweeps would find it slowly, and for the stiffest bodies rounding would hide its
// inertia.
#pragma once

#include <tetskin/core/src/base/aligned.h>
#include <tetskin/core/src/base/arithmetic/small_matrix.h>
#include <tetskin/solver/src/base/carried_point.h>
#include <tetskin/solver/src/forces/forced_bodies.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

namespace tetskin::bullet_detail {

/// The velocity of a row's point in each of the six motions.
using RowMotions = Small3x6;

/// Six vectors of all nodes of a body, in the wide layout; 0 where a lane has no node.
using MotionFields = AlignedVector<btScalar>[Dynamics::kRigidMotions];

/// Z and A Z of all components of a body: each node belongs to one. Z are the six motions, A is the matrix without
/// rows.
struct ComponentFields {
  MotionFields motions, images;
};

/// b is the right side.
struct ComponentUnknown {
  /// Where nodes of a component are in the wide layout: chunks that belong to no other component, or a node in a chunk
  /// of several. Sums over a component then take as long as it is large.
  struct Span {
    std::size_t first = 0, last = 0;  ///< of chunks; equal: of a node, its first scalar
  };

  std::size_t body = 0;       ///< in SolverBodies::bodies
  std::size_t component = 0;  ///< of the body
  Eigen::Index first = 0;     ///< index of its six among the system's reduced unknowns
  Small6x6 mass;              ///< Z^T A Z
  Small6 began;               ///< Z^T b

  /// Those of a body's first `most` components, without components that have a pinned node.
  /// dynamics  whose matrix has no rows added yet
  static std::vector<ComponentUnknown> makeAll(const Dynamics& dynamics, std::size_t most, ParallelFor* threads);

  /// Z^T A times a vector in the wide layout.
  Small6 imageProducts(const btScalar* wide) const;
  /// Z^T times a vector in the wide layout.
  Small6 motionProducts(const btScalar* wide) const;
  /// Adds A Z q to a vector in the wide layout.
  void addImages(const Small6& q, btScalar* wide) const;
  /// Adds Z q to the solution.
  void addMotions(const Small6& q, Dynamics& dynamics) const;
  /// Z at the point where a row acts on the body; 0 if it belongs to another component.
  RowMotions motionsAt(const Dynamics& dynamics, const CarriedPoint& point) const;

  const std::vector<Span>& spans() const { return spans_; }
  const ComponentFields& fields() const { return *fields_; }

 private:
  double rounding(const Dynamics& dynamics) const;
  void leaveOutElasticity(const Dynamics& dynamics);
  void findMass(const Dynamics& dynamics, bool elastic, AlignedVector<btScalar>& right);

  std::shared_ptr<ComponentFields> fields_;  ///< of all components of the body
  std::vector<std::size_t> nodes_;           ///< of the component, ascending
  std::vector<Span> spans_;                  ///< in the order of the wide layout
};

}  // namespace tetskin::bullet_detail
