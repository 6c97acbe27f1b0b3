// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the trees of bodies. Bullet refits them twice per step; here they are refitted only
// when they must be.
#pragma once

#include <tetskin/bullet/src/forces/forced_bodies.h>

#include <utility>
#include <vector>

namespace tetskin {

struct SolvedBody;

/// True if Bullet tests the body against any soft body, itself included.
bool collidesWithSoftBodies(btSoftBody& body);
/// True if Bullet searches for contacts on the body's faces, whose nodes must then be at their predicted positions.
bool collidesByFaces(btSoftBody& body);

/// Where the nodes were when a body's trees were fitted. The leaves are padded: as long as nodes stay in them, searches
/// for contacts and rays miss nothing.
struct PaddedTrees {
  std::vector<btScalar> points;  ///< 3 scalars per node
  btScalar pad = 0;              ///< width of the padding
  btScalar drift = 0;  ///< largest distance that a node has moved since the fit, at the beginning of this step
  bool ready = false;

  /// Fits the trees, unless their boxes still hold the nodes.
  /// step  distance that the fastest node moves in this step
  void fit(btSoftBody& body, Dynamics& dynamics, btScalar step);
  /// Fits the trees as Bullet does when a step has been solved: they also hold the nodes at the end of the step.
  void fitBefore(btSoftBody& body, btScalar step);
  /// True if the boxes still hold nodes that move this far in this step.
  bool holds(btScalar step) const { return ready && drift + step < pad; }

 private:
  void keep(Dynamics& dynamics);
  btScalar furthest(Dynamics& dynamics) const;
};

/// Bodies that are marked as sleeping for a part of the step. Between the solve and the integration, Bullet looks for
/// nodes that go through faces of other soft bodies, whether or not the two may collide, removes their relative
/// velocity, and refits trees for the search. It must not do so for bodies whose contacts are found otherwise, and it
/// skips bodies that sleep.
class HiddenBodies {
 public:
  void hide(const std::vector<SolvedBody>& bodies, btScalar dt);
  /// Restores their states, except for bodies that have been woken, put to sleep or removed from the world since.
  void show(const btAlignedObjectArray<btSoftBody*>& alive);

 private:
  std::vector<std::pair<btSoftBody*, int>> hidden_;  ///< with their states before
};

}  // namespace tetskin
