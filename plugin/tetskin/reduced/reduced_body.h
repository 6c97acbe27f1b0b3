// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A body that moves by a few vibration modes instead of its tets: the other way to real time, beside embedding.
#pragma once

#include <BulletSoftBody/BulletReducedDeformableBody/btReducedDeformableBody.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/elastic/vibration_modes.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tetskin {

/// Material and settings of a reduced body, beside its modes. Lengths are world lengths.
struct ReducedBodyOptions {
  std::optional<int> modeCount;  ///< how many of the softest modes to use, at least 1; not given: all
  std::optional<double> mass;    ///< total, in kg, above 0; not given: from density
  double density = 100.0;        ///< mass per volume of the modes' tets; the default is that of SoftBodyOptions
  /// Young's modulus in pressure units, above 0; not given: relativeStiffness x density x gravity x size. Never limited
  /// by timeStep: modes that are too fast for it are refused, or left out.
  std::optional<double> youngsModulus;
  double relativeStiffness = 50.0;  ///< dimensionless, from 30 (wobbles, sags) to 300 (firm)
  double stiffnessDamping = 0.02;   ///< seconds: Rayleigh damping, as in SoftBodyOptions
  double timeStep = 1.0 / 240.0;    ///< seconds: the longest substep of the world
  /// Leave out modes whose angular frequency times timeStep is above Limits::kMaxOmegaDt, instead of refusing the body.
  bool skipFastModes = false;
  std::optional<double> margin;  ///< collision margin, world length, as in SoftBodyOptions
  double friction = 0.5;         ///< Bullet's m_cfg.kDF, 0 to 1
  /// For each node of the modes' tets, the index of the cage's tet that it belongs to. Needed for a cage with duplicate
  /// elements, where a node's position does not determine it. Empty: determined by position.
  std::vector<int> nodeTets;
  /// Rotation and translation from the position of cage and modes to the body's initial position in the world.
  btTransform placement = btTransform::getIdentity();
};

/// How well a cage's nodes represent the modes of the fine tets in it.
struct TETSKIN_REDUCED_API ReductionReport {
  /// For each mode in use: the difference between the fine nodes' positions as carried by the cage and as displaced by
  /// the mode, relative to the mode itself, as a mass-weighted root mean square. 0: the cage represents the mode
  /// exactly.
  std::vector<double> projectionErrors;
  std::size_t skippedModes = 0;  ///< modes left out as too fast
  std::size_t outside = 0;       ///< fine nodes in no tet of the cage, which are extrapolated
  double maxFrequency = 0.0;     ///< angular frequency of the last mode in use, radians per second
  double milliseconds = 0.0;     ///< wall time

  /// Readable summary, one line per item.
  std::string describe() const;
};

/// A btReducedDeformableBody with the nodes of a cage, moved by the vibration modes of fine tets. A step costs about
/// modes x nodes, however fine the tets are. Its nodes are drawn and collide like those of any body: bind a
/// SoftBodySkin to `body()`.
///
/// Modes are linear: deformations look right up to about a tenth of the body's size, and swell beyond that; the body as
/// a whole rotates freely. Only the modes move: where it is touched, it yields as a whole. The README says when this is
/// a better choice than embedding.
///
/// It corrects defects of Bullet's own step for such bodies: it sleeps where it lies instead of falling, is damped at
/// any frequency, is held by the pinned nodes of its modes and still bends by gravity, and is touched at the right
/// nodes if there are other bodies. The world's solver is Bullet's own. Gravity is the last value passed to
/// `world.setGravity` since the solver was created, not that of worldInfo.
///
/// Destroy it before its world; otherwise, or if the application has removed the body from the world, it only frees its
/// memory. The body may only be used in that world. Bullet must update all bounding boxes (`setForceUpdateAllAabbs`, on
/// by default): sleeping bodies depend on it to stay in place.
class TETSKIN_REDUCED_API ReducedBody {
 public:
  /// Creates the body and adds it to the world.
  /// world   created with a btReducedDeformableBodySolver, and without soft bodies of other kinds; its gravity at the
  ///         time of the call sets the scale of the default stiffness
  /// modes   of fine tets (see `computeVibrationModes`), linear or quadratic, at the position of the cage
  /// cage    valid (see `validate`), without flat tets, around the fine tets. Its volume fractions, stiffness factors,
  ///         masses and quadratic tets are not used: the modes include them
  /// Cost    that of `embed` of the fine nodes, and a factorisation of a matrix of the cage's nodes
  /// Errors  InvalidOption: options out of range, modes too fast for the time step (or all of them, with
  ///         `skipFastModes`), another solver, a world that does not update all boxes, a soft body in it that is not
  ///         reduced; Empty: no modes; SizeMismatch: an array of the wrong length; IndexOutOfRange: in nodeTets, or a
  ///         pinned node; Degenerate: the modes do not determine the motion of the cage's nodes; OutsideCage: modes and
  ///         cage are at different positions; those of `createSoftBody` about the cage, and of `embed`
  static Result<std::unique_ptr<ReducedBody>> add(btDeformableMultiBodyDynamicsWorld& world,
                                                  const VibrationModes& modes, const Cage& cage,
                                                  const ReducedBodyOptions& options = {});
  ~ReducedBody();
  ReducedBody(const ReducedBody&) = delete;
  ReducedBody& operator=(const ReducedBody&) = delete;

  btReducedDeformableBody& body();              ///< Bullet's body, owned by this object
  const btReducedDeformableBody& body() const;  ///< Bullet's body, owned by this object
  const ReductionReport& report() const;        ///< how well the cage represents the modes
  double youngsModulus() const;                 ///< in use, in pressure units
  std::size_t modeCount() const;                ///< number of modes in use

  /// Moves the body, in its current deformation and without velocity; it wakes. Bullet's own `transform` would take the
  /// deformed shape for the rest shape.
  /// placement  from the position of cage and modes to the world, as in the options
  void setPlacement(const btTransform& placement);

 private:
  struct Impl;
  explicit ReducedBody(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

}  // namespace tetskin
