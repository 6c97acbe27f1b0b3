// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to Recorder: hashes that tell which object moves differently, and the transforms that the application gives
// its kinematic bodies.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/replay/src/record/state_patch.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tetskin::bullet_detail {

/// By object of the world: a hash of positions and velocities. Cost O(nodes + objects)
std::vector<std::uint32_t> hashesOfMotion(btDeformableMultiBodyDynamicsWorld& world);
/// The object's index in the world, and what it is.
std::string nameOf(const btCollisionObject& object);

/// Where motion states have put kinematic bodies in the last step: Bullet asks them when a step begins, and no snapshot
/// holds the answer. Empty without such bodies.
Bytes kinematicTargets(btDeformableMultiBodyDynamicsWorld& world);

/// While this exists, kinematic bodies go to recorded targets: their motion states, which are the application's, are
/// neither asked nor informed. Those of Bullet's own class, which only store a place, get the new one. Bullet asks
/// once, when a step begins, and gets this class's answer; later calls reach the bodies' own motion states.
class LedToTargets {
 public:
  LedToTargets(btDeformableMultiBodyDynamicsWorld& world, const Bytes& bytes);
  ~LedToTargets();
  LedToTargets(const LedToTargets&) = delete;
  LedToTargets& operator=(const LedToTargets&) = delete;
  /// False if the targets belong to other bodies; then nothing has been changed.
  bool fits() const { return fits_; }

 private:
  class StandIn;
  btDeformableMultiBodyDynamicsWorld& world_;
  std::vector<std::unique_ptr<StandIn>> standIns_;
  bool fits_ = false;
};

}  // namespace tetskin::bullet_detail
