// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the trees of bodies' faces, which ray casts use. Bullet refits them twice per step;
// here they are refitted only when necessary. The tree of nodes is left alone: PointCollider has its own.
#pragma once

#include <tetskin/solver/src/forces/forced_bodies.h>

#include <vector>

namespace tetskin::bullet_detail {

/// True if Bullet tests the body against any soft body, including itself.
bool collidesWithSoftBodies(btSoftBody& body);
/// True if Bullet's own contact search is going to use the body's trees, because the application wants contact at its
/// faces, or some other kind than at nodes. Its nodes must then be at their predicted positions.
bool needsBulletsTrees(btSoftBody& body);
/// True if Bullet searches for the body's contacts with these trees.
bool collidesByBulletsTrees(btSoftBody& body);

/// Positions of the nodes when a body's tree of faces was fitted. The leaves are padded: as long as nodes stay within
/// the padding, rays miss nothing.
class PaddedTrees {
 public:
  /// Fits the tree, unless its boxes still contain the nodes.
  /// step  distance that the fastest node moves in this step
  void fit(btSoftBody& body, Dynamics& dynamics, btScalar step);
  /// Fits the tree again if its boxes do not contain the nodes at the end of the step, because velocities have changed
  /// since `fit`.
  void fitAgain(btSoftBody& body, Dynamics& dynamics, btScalar step);
  /// The tree must be fitted in the next step, because something else has changed it.
  void forget() { ready_ = false; }

 private:
  /// True if the boxes still contain nodes that move this far in this step.
  bool holds(btScalar step) const { return ready_ && drift_ + step < pad_; }
  btScalar farthest(Dynamics& dynamics) const;

  std::vector<btScalar> points_;  ///< 3 scalars per node: its position when the tree was fitted
  btScalar pad_ = 0;              ///< width of the padding
  btScalar drift_ = 0;  ///< largest distance that a node has moved since the fit, at the beginning of this step
  bool ready_ = false;
};

}  // namespace tetskin::bullet_detail
