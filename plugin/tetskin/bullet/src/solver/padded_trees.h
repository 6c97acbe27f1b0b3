// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the trees of bodies, which Bullet refits twice in each step, fitted only when they must
// be.
#pragma once

#include <tetskin/bullet/src/forces/forced_bodies.h>

#include <utility>
#include <vector>

namespace tetskin {

struct SolvedBody;

/// Whether Bullet looks for what a body meets among soft ones, itself included, whatever there is.
bool meetsSoftBodies(btSoftBody& body);
/// Whether contacts are looked for on a body's faces, which must then be where they are predicted.
bool meetsByFaces(btSoftBody& body);

/// Where the nodes were when a body's trees were fitted. The leaves are padded: as long as nodes stay in them, contacts
/// and rays find all there is.
struct PaddedTrees {
  std::vector<btScalar> points;  ///< 3 a node
  btScalar pad = 0;              ///< around them
  btScalar drift = 0;            ///< how far a node has moved since, at the beginning of this step
  bool ready = false;

  /// Fits them, unless they hold the nodes.
  /// step  how far the fastest node moves in this step
  void fit(btSoftBody& body, Dynamics& dynamics, btScalar step);
  /// As Bullet does when a step has been solved: they hold the nodes at the end of it, too.
  void fitBefore(btSoftBody& body, btScalar step);
  /// Whether they still hold nodes that move so far in this step.
  bool holds(btScalar step) const { return ready && drift + step < pad; }

 private:
  void keep(Dynamics& dynamics);
  btScalar furthest(Dynamics& dynamics) const;
};

/// Bodies that are marked as sleeping. Bullet looks between the solve and the integration for nodes that go through
/// faces of other soft bodies, whether or not these are to collide, takes their velocity over them, and refits trees
/// for it. Of bodies that are not to meet others by Bullet it shall not, and passes over those that sleep.
class HiddenBodies {
 public:
  void hide(const std::vector<SolvedBody>& bodies, btScalar dt);
  /// Unless somebody has woken a body, or put it to sleep, or taken it out of the world.
  void show(const btAlignedObjectArray<btSoftBody*>& alive);

 private:
  std::vector<std::pair<btSoftBody*, int>> hidden_;  ///< and the state before
};

}  // namespace tetskin
