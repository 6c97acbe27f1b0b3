// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/BulletReducedDeformableBody/btReducedDeformableBody.h>
#include <tetskin/reduced/src/modes/cage_modes.h>

#include <vector>

namespace tetskin::reduced_detail {

/// In the world's units.
struct ModalMaterial {
  double youngsModulus = 0.0, density = 0.0;
  double damping = 0.0;  ///< seconds
};

/// Bullet's reduced body, set right once in each substep: when Bullet asks for its box, which it does after it has
/// predicted where bodies go, and before it looks for contacts.
///
/// What of that is Bullet's to be set right:
/// - gravity pulls sleeping bodies, too, and they fall through what they lie on;
/// - gravity pulls the frame of a held body, but does not bend it;
/// - damping is explicit, and explodes from a sixth of the frequencies on that the step itself would bear;
/// - nodes are numbered through all bodies, which contacts of a later, larger body take for its own numbers;
/// - a body at rest has the speed that gravity gives it in a step, and never sleeps.
class ModalBody : public btReducedDeformableBody {
 public:
  /// eigenvalues  by mode, for a stiffness and density of 1
  /// held         its modes have pinned nodes: its frame stays where it is
  /// Elements, margins and trees are the caller's to give it, before `begin`.
  ModalBody(btSoftBodyWorldInfo& worldInfo, const std::vector<btVector3>& nodes, bool held);
  void begin(const CageModes& modes, const std::vector<double>& eigenvalues, const ModalMaterial& material);

  /// Without motion, as it is bent.
  /// placement  from rest
  void placeAt(const btTransform& placement);

  btMatrix3x3 getImpulseFactor(int node) override;

 private:
  class Shape;

  void setMasses(const CageModes& modes, double density);
  void setFrame(const btTransform& frame);
  void correctPrediction();
  void stay();
  void rest();
  void vibrate(btScalar seconds, const btVector3& gravity);

  bool held_, slept_ = false;
  btScalar damping_ = 0;
  btTransform frame_ = btTransform::getIdentity();  ///< where a held or sleeping body is
  std::vector<btVector3> momenta_;                  ///< by mode: over gravity, in the body's frame
  btScalar sleepSpeed_, threshold_;                 ///< as the application has it; with what gravity gives in a substep
};

}  // namespace tetskin::reduced_detail
