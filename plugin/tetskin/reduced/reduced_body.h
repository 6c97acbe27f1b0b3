// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A body that moves by a few vibrations instead of its tets: the other way to real time, beside embedding.
#pragma once

#include <BulletSoftBody/BulletReducedDeformableBody/btReducedDeformableBody.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/elastic/vibration_modes.h>

#include <memory>
#include <string>
#include <vector>

namespace tetskin {

/// A mode is stable up to 2, and by no more than this its frequency is off by a fifth at most.
constexpr double kMostOmegaDt = 1.6;

/// What a reduced body is made of, beside its modes. Lengths are world lengths.
struct ReducedBodyOptions {
  int modes = 0;           ///< softest ones to take; 0: all that there are
  double mass = 0.0;       ///< total, in kg; 0: from density
  double density = 100.0;  ///< mass per volume of the tets that the modes are of; the default as in SoftBodyOptions
  /// As in SoftBodyOptions, and never bounded: modes that are too fast for timeStep are refused, or left out.
  double youngsModulus = 0.0;
  double relativeStiffness = 50.0;  ///< the same
  double damping = 0.02;            ///< seconds, as in SoftBodyOptions
  double timeStep = 1.0 / 240.0;    ///< seconds: the longest substep that the world is stepped by
  /// Modes of an angular frequency times timeStep above kMostOmegaDt are left out, instead of the body being refused.
  bool leaveOutFastModes = false;
  double margin = -1.0;   ///< as in SoftBodyOptions
  double friction = 0.5;  ///< as in SoftBodyOptions
  /// nodeCount of the tets that the modes are of: the tet of the cage that each belongs to. Needed where the cage is
  /// split, as the place of a node does not tell then. Empty: by its place.
  std::vector<int> nodeTets;
  /// From where cage and modes are to where the body shall be. A rotation and a translation.
  btTransform placement = btTransform::getIdentity();
};

/// How well a cage's nodes tell the modes of the fine tets in it.
struct TETSKIN_REDUCED_API ReductionReport {
  /// By mode in use: how far the fine nodes are, carried by the cage, from where the mode has them; over the mode
  /// itself, in the mean of squares by mass. 0: the cage tells all.
  std::vector<double> projectionErrors;
  std::size_t leftOut = 0;    ///< modes that are too fast
  std::size_t outside = 0;    ///< fine nodes in no tet of the cage, which are extrapolated
  double fastest = 0.0;       ///< angular frequency of the last mode in use, radians a second
  double milliseconds = 0.0;  ///< wall time

  /// One line a fact, for people.
  std::string describe() const;
};

/// A btReducedDeformableBody with the nodes of a cage, which the vibrations of fine tets move: its step costs some
/// modes x nodes, whatever the fineness of the tets, and its nodes are drawn and touched as any body's: bind a
/// SoftBodySkin to `body()`.
///
/// Modes are linear: deformations look right up to a tenth of the body's size or so, and swell beyond that; the body as
/// a whole turns freely. Nothing else moves than the modes: where it is touched it yields as a whole. The README says
/// when that serves better than embedding.
///
/// Where Bullet's own step of such bodies fails, this one does not: it sleeps where it lies instead of falling, is
/// damped at any frequency, is held by the pinned nodes of its modes and bends by gravity then, and is touched at the
/// right nodes beside other bodies. The world's solver is Bullet's own. Gravity is what `world.setGravity` has said
/// since the solver was made, not worldInfo.
///
/// It should go before its world does; if not, or if the application has taken the body out, it only frees its memory.
/// It belongs to that world alone. Bullet must ask for all boxes (`setForceUpdateAllAabbs`, as it does by default): by
/// them sleeping bodies know that they are to stay.
class TETSKIN_REDUCED_API ReducedBody {
 public:
  /// world   made with a btReducedDeformableBodySolver, and without soft bodies of other kinds; its gravity now serves
  ///         as the scale of the default stiffness
  /// modes   of fine tets (see `vibrationModes`), where the cage is
  /// cage    usable, without flat tets, around the tets. Its fill, factor and masses do not matter: the modes have them
  /// Cost    that of `embed` of the fine nodes, and a factorisation of a matrix of the cage's nodes
  /// Errors  InvalidOption: options out of range, modes too fast for the time step (or all of them, where they may be
  ///         left out), another solver, a world that does not ask for all boxes, a soft body in it that is not reduced;
  ///         Empty: no modes; SizeMismatch; IndexOutOfRange: of nodeTets, or a pinned node; Degenerate: the modes do
  ///         not tell where the cage's nodes go; OutsideCage: modes and cage are not at one place; those of
  ///         `makeSoftBody` about the cage, and of `embed`
  static Result<std::unique_ptr<ReducedBody>> add(btDeformableMultiBodyDynamicsWorld& world,
                                                  const VibrationModes& modes, const Cage& cage,
                                                  const ReducedBodyOptions& options = {});
  ~ReducedBody();
  ReducedBody(const ReducedBody&) = delete;
  ReducedBody& operator=(const ReducedBody&) = delete;

  btReducedDeformableBody& body();              ///< Bullet's own, of which this is the owner
  const btReducedDeformableBody& body() const;  ///< the same
  const ReductionReport& report() const;        ///< how well the cage tells the modes
  double youngsModulus() const;                 ///< in use, in pressure units
  std::size_t modeCount() const;                ///< in use

  /// Puts the body elsewhere, as it is bent and without any motion; it wakes. Bullet's own `transform` would take the
  /// bent shape for the rest shape.
  /// placement  as in the options
  void placeAt(const btTransform& placement);

 private:
  struct Parts;
  explicit ReducedBody(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace tetskin
