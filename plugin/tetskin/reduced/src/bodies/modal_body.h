// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/BulletReducedDeformableBody/btReducedDeformableBody.h>
#include <tetskin/reduced/src/modes/cage_modes.h>

#include <vector>

namespace tetskin::reduced_detail {

/// Material values in the world's units.
struct ModalMaterial {
  double youngsModulus = 0.0, density = 0.0;
  double damping = 0.0;  ///< seconds
};

/// Bullet's reduced body, corrected once per substep: when Bullet asks for its box, which it does after it has
/// predicted positions, and before it looks for contacts.
///
/// It corrects the following properties of Bullet's body:
/// - gravity also pulls sleeping bodies, which fall through what they lie on;
/// - gravity pulls the frame of a pinned body, but does not bend the body;
/// - damping is explicit, and unstable from a sixth of the frequency up to which the step itself is stable;
/// - nodes are numbered over all bodies, and contacts of a later, larger body take these numbers for their own;
/// - a body at rest has the speed that gravity gives it in a step, and never sleeps.
class ModalBody : public btReducedDeformableBody {
 public:
  /// pinned  its modes have pinned nodes: its frame does not move
  ModalBody(btSoftBodyWorldInfo& worldInfo, const std::vector<btVector3>& nodes, bool pinned);
  /// The caller must add elements, margins and trees first.
  /// eigenvalues  by mode, for a stiffness and density of 1
  void begin(const CageModes& modes, const std::vector<double>& eigenvalues, const ModalMaterial& material);

  /// Places the body without velocity, in its current deformation.
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

  bool pinned_, slept_ = false;
  btScalar damping_ = 0;
  btTransform frame_ = btTransform::getIdentity();  ///< of a pinned or sleeping body
  std::vector<btVector3> momenta_;                  ///< by mode: response to gravity, in the body's frame
  btScalar sleepSpeed_;                             ///< the application's sleep threshold
  btScalar threshold_;                              ///< that, plus the speed that gravity adds in a substep
};

}  // namespace tetskin::reduced_detail
