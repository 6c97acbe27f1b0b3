// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A body of elastic tets by itself, in an engine of any kind. With Bullet, take `ElasticForce` (tetskin/bullet).
#pragma once

#include <tetskin/core/parallel_for.h>
#include <tetskin/core/tet_mesh.h>

#include <array>
#include <memory>
#include <vector>

namespace tetskin {

/// What an ElasticBody is made of, and how closely it is solved for.
struct ElasticOptions {
  double youngsModulus = 0.0;          ///< in pressure units, above 0
  double poissonRatio = 0.3;           ///< 0 to below 0.5
  double damping = 0.0;                ///< seconds: damping forces are this times the rate of the elastic ones
  double density = 1.0;                ///< mass per volume
  std::vector<double> stiffnessScale;  ///< tetCount, above 0: times the stiffness; empty: 1
  std::vector<double> nodeMasses;      ///< nodeCount, above 0: instead of a quarter of each tet's; empty: from density
  double tolerance = 5e-3;             ///< of a step's residual over that at its start; 0 to below 1
  int iterations = 200;                ///< of the conjugate gradient in a step, at most; at least 1
};

/// Corotated linear elasticity of a cage, stepped by backward Euler: stable, of first order in the step, and with the
/// linear and angular momentum that it began with. Parts that nothing deforms move as rigid bodies do, at any stiffness
/// and spin below one radian per step: only what deviates from that is solved for. Tets come back from being flat or
/// inside out, and find their rotation from any other.
///
/// This work is based on:
///   Matthias Müller, Markus Gross, "Interactive Virtual Materials", Graphics Interface 2004
///   David Baraff, Andrew Witkin, "Large Steps in Cloth Simulation", SIGGRAPH 1998, doi 10.1145/280814.280821
template <class Scalar>
class TETSKIN_ELASTIC_API ElasticBody {
 public:
  /// Empty, as one that was moved from: it has no nodes, and a step of it does nothing. Use `make`.
  ElasticBody();
  ~ElasticBody();
  ElasticBody(ElasticBody&&) noexcept;
  ElasticBody& operator=(ElasticBody&&) noexcept;

  /// At rest, where the cage is.
  /// cage    usable (see `usable`), without flat tets; any unit
  /// Cost    O(T log T) for T tets; memory about 700 bytes a tet in float
  /// Errors  those of `usable`; Degenerate for flat tets; SizeMismatch; InvalidOption, also for a stiffness over
  /// density
  ///         and squared size (the cube root of the volume) above 1e12 in float or 1e16 in double, in 1 / s^2
  static Result<ElasticBody> make(const TetMesh& cage, const ElasticOptions& options);

  std::size_t nodeCount() const;  ///< of the cage; 0 if empty
  /// World space, nodeCount, in the order of the cage; to be read and written between steps.
  PointView<Scalar> positions();
  PointView<Scalar> velocities();  ///< likewise, a second

  /// Holds a node, which then moves with the velocity that it is given and by no force; or lets it go. The node exists.
  void hold(std::size_t node, bool held = true);

  /// One step; returns the iterations that it took. Cost O(T)
  /// seconds       above 0 and finite, as the acceleration; else nothing moves
  /// acceleration  of all nodes that are not held: gravity
  /// threads       see `ParallelFor`; the bits are the same with any number
  int step(double seconds, const std::array<double, 3>& acceleration = {}, ParallelFor* threads = nullptr);

  /// Elastic forces at the positions as they are, nodeCount.
  std::vector<std::array<double, 3>> forces();
  /// What they have stored, in the unit of pressure times volume.
  double energy();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace tetskin
