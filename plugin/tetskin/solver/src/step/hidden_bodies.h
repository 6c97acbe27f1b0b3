// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: bodies that Bullet must not look at during a part of the step.
#pragma once

#include <tetskin/solver/src/rows/solver_bodies.h>

#include <utility>
#include <vector>

namespace tetskin::bullet_detail {

/// Bodies that are marked as sleeping for a part of the step. Between the solve and the integration, Bullet looks for
/// nodes that pass through faces of other soft bodies, whether or not the two may collide, removes their relative
/// velocity, and refits trees for this search. It must not do so for bodies whose contacts are found in another way,
/// and it skips bodies that sleep.
class HiddenBodies {
 public:
  void hide(const std::vector<SolvedBody>& bodies, btScalar dt);
  /// Restores their states, except for bodies that have been woken, put to sleep or removed from the world since.
  void show(const btAlignedObjectArray<btSoftBody*>& alive);

 private:
  std::vector<std::pair<btSoftBody*, int>> hidden_;  ///< with their former states
};

}  // namespace tetskin::bullet_detail
