// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A body of elastic tets on its own, for any engine. With Bullet, use `DeformableBody` (tetskin/solver).
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/types.h>
#include <tetskin/elastic/elastic_law.h>
#include <tetskin/elastic/material_changes.h>

#include <array>
#include <memory>
#include <vector>

namespace tetskin {

/// An isotropic elastic material.
struct ElasticModuli {
  double youngsModulus = 0.0;  ///< pressure units
  double poissonRatio = 0.0;   ///< from -1 to below 0.5
};

/// Converts Lame's parameters: E = mu (3 lambda + 2 mu) / (lambda + mu) and nu = lambda / (2 (lambda + mu)).
/// mu      the shear modulus, pressure units, above 0
/// lambda  pressure units; above -2/3 mu
inline ElasticModuli fromLame(double mu, double lambda) {
  return {mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu), 0.5 * lambda / (lambda + mu)};
}

/// Material and solver settings of an ElasticBody.
struct ElasticOptions {
  double youngsModulus = 1e5;  ///< in pressure units, above 0; the default, in Pa, is that of soft foam
  double poissonRatio = 0.3;   ///< 0 to 0.4999 in float, to 0.499999 in double
  /// Seconds: Rayleigh damping; damping forces are this times the rate of the elastic ones. The cage's `paintedDamping`
  /// multiplies it
  double stiffnessDamping = 0.0;
  double density = 1.0;  ///< mass per volume, above 0
  /// tetCount, above 0: factors of the stiffness. Empty: the cage's `stiffnessScale()`, or 1
  std::vector<double> stiffnessScale;
  /// nodeCount, above 0. Empty: the cage's `masses` times the density or, if it has none, a quarter of each tet's mass
  /// to each node
  std::vector<double> nodeMasses;
  double tolerance = 5e-3;  ///< remaining forces of a step, relative to acting ones; 0 to below 1
  int maxIterations = 200;  ///< limit of the conjugate gradient per step; at least 1
  /// Whether everything is computed in the same order of operations on every processor, without fused multiply-adds,
  /// see `DeformableSolver::setDeterministic`.
  bool deterministic = false;
};

/// Corotated linear elasticity of a cage, in implicit steps: stable, of second order in the step, and conserving linear
/// and angular momentum. Vibrations decay as given by `stiffnessDamping`, and no faster unless they are too fast for
/// the step. Positions are those at the end of the last step, velocities those at its middle; for an energy, average
/// the velocities of two steps. The first step takes the velocities as those at its beginning. Undeformed components
/// move as rigid bodies, at any stiffness and any spin below one radian per step: only the deviation from rigid motion
/// is solved for. Tets recover from being flat or inverted, and find their rotation from any start.
///
/// The quadratic tets of a cage (`Cage::quadraticTet`, `refineQuadratic`) are simulated as such, with a rotation at
/// each of four points; a body may mix them with linear ones. At equal error in bending they need a thirtieth of the
/// nodes.
///
/// This work is based on:
///     Matthias Müller, Markus Gross, "Interactive Virtual Materials", Graphics Interface 2004
///     David Baraff, Andrew Witkin, "Large Steps in Cloth Simulation", SIGGRAPH 1998, doi 10.1145/280814.280821
///     John C. Houbolt, "A Recurrence Matrix Solution for the Dynamic Response of Elastic Aircraft", Journal of the
///     Aeronautical Sciences 17(9), 1950, doi 10.2514/8.1722
template <class Scalar>
class TETSKIN_ELASTIC_API ElasticBody {
 public:
  /// An empty body, as after a move: it has no nodes, and its step does nothing. Use `create`.
  ElasticBody() = default;
  ElasticBody(ElasticBody&&) noexcept = default;             ///< the other one has no nodes afterwards
  ElasticBody& operator=(ElasticBody&&) noexcept = default;  ///< the other one has no nodes afterwards

  /// Creates a body at rest, at the position of the cage.
  /// cage    valid (see `validate`), without flat tets; any unit; not kept. A plain TetMesh converts to one. Its volume
  ///         fractions, stiffness factors and masses are used unless the options give their own
  /// Cost    O(T log T) for T tets; memory about 700 bytes per tet in float, alone or as an eighth of a quadratic one
  /// Errors  those of `validate(const Cage&)`; NonFinite: a node that is not finite or beyond Limits::kMaxCoordinate;
  ///         Degenerate: flat tets; SizeMismatch: an array of the wrong length; InvalidOption: options out of range,
  ///         also if stiffness over density and squared size (the cube root of the volume) is above 1e12 in float or
  ///         1e16 in double, in 1 / s^2
  static Result<ElasticBody> create(const Cage& cage, const ElasticOptions& options);

  std::size_t nodeCount() const;  ///< number of nodes of the cage; 0 if empty
  /// nodeCount positions, world space, in the order of the cage; may be read and written between steps. Owned by the
  /// body. After a change of more than 1e-4 of the body's size the next step is of first order.
  PointView<Scalar> positions();
  PointView<Scalar>
  velocities();  ///< nodeCount velocities, world length per second; may be read and written between steps

  /// Pins a node, which then moves with its velocity and ignores forces, or releases it. The node must exist.
  void setPinned(std::size_t node, bool pinned = true);

  /// Sets the pressure in the body, above that outside, from the next step on; see `DeformableBody::setPressure`, which
  /// says on which surface. 0 ends it. Errors: NonFinite; InvalidOption: too large for the body's mass and size, or the
  /// tets enclose nothing; nothing is changed then
  Status setPressure(double pressure);
  /// Fills the body with a gas of this pressure: see `DeformableBody::setGas`.
  Status setGas(double pressure, double outside = 0.0);
  /// The present pressure inside, above that outside, of a gas at its present volume; 0: none.
  double pressure();
  /// The present volume in which the pressure is: that of the hollows, or of a body without. Cost O(faces), the first
  /// time O(T log T)
  double volume();

  /// Advances by one step; returns the number of iterations. Cost O(T) for T tets per iteration.
  /// seconds       above 0 and finite, otherwise nothing moves
  /// acceleration  for all nodes that are not pinned, such as gravity, world length / s^2; finite, otherwise nothing
  ///               moves
  /// threads       see `ParallelFor`; bit-identical with any number; null: none
  int step(double seconds, const std::array<double, 3>& acceleration = {}, ParallelFor* threads = nullptr);

  // ---- What changes the material, and the state in which it is at rest; each from the next step on. Errors of a
  // `Status`: InvalidOption, SizeMismatch or IndexOutOfRange, which say what is wrong; nothing is changed then.

  /// Lets the material flow where it yields; replaces what was set before. A step costs some 4 % more, a third
  /// more while all of it flows.
  Status setPlasticity(const Plasticity& plasticity);
  Status endPlasticity();  ///< nothing flows any more; what has flowed stays
  /// The body returns to its first shape; it flows again when it has been there, below its yield stress, for half a
  /// second.
  Status resetPlasticFlow();
  /// tetCount equivalent plastic strains, 0 or more: how much each tet has flowed in all, to and fro. A quadratic tet's
  /// parts have its mean.
  std::vector<double> plasticStrains() const;
  /// Makes tets grow to multiples of their first size, at which they are at rest; masses stay. Beside it, plastic flow
  /// stays. A large change in one step is a blow: change it over some steps.
  /// length  factor of length, 0.05 to 20; 1: none
  Status setGrowth(double length);
  Status setGrowth(const std::vector<double>& lengths);  ///< tetCount factors of length
  /// The same along axes.
  /// deformations  by tet, 3 x 3 by rows, symmetric: factors of length along three axes, rest space
  Status setGrowthTensors(const std::vector<std::array<double, 9>>& deformations);
  /// Multiplies the stiffness of each tet, as it was when the body was made. A large change in one step is a blow to a
  /// body under load.
  /// factors  tetCount, 1e-6 to 1e6; with the largest, the body must not be too stiff, as for `create`
  Status setStiffnessScale(const std::vector<double>& factors);
  /// Multiplies the damping of each tet, on top of what is painted in the cage. Fibres have that of the least damped
  /// tet: none where a factor is 0.
  /// factors  tetCount, 0 or more; with the largest, the body must not be too stiff, as for `create`
  Status setDampingScale(const std::vector<double>& factors);
  /// The law of elasticity of some tets, or of all: see ElasticLaw. Muscles and plastic flow count strains as with the
  /// corotated one.
  /// tets  of the cage, each once; none: all
  Status setElasticLaw(const ElasticLaw& law, const std::vector<int>& tets = {});
  /// Adds fibres, for good. Tets may have several. With the largest sum of their stiffness in a tet, the body must not
  /// become too stiff, as for `create`
  Status addFibres(const Fibres& fibres);
  Result<int> addMuscle(const Muscle& muscle);  ///< returns its number; it is relaxed
  /// activation  0 to 1, see Muscle. A large change in one step is a blow, as it is in an animal
  Status setActivation(int muscle, double activation);
  double activation(int muscle) const;  ///< that was set last; 0 for a muscle that does not exist

  /// nodeCount elastic forces at the current positions, with those of pressure, world space, pressure times area.
  std::vector<std::array<double, 3>> forces();
  /// Elastic energy at the current positions, pressure times volume; minus the work that pressure has done since it was
  /// set: a gas from its volume then on, a constant one from the volume at rest on.
  double energy();

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;  ///< null: no nodes; never shared
};

}  // namespace tetskin
