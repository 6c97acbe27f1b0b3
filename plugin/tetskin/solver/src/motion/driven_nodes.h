// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: pinned nodes (m_im is 0) that the application moves by setting their m_x. The steps
// move them there by the time at which the application is likely to move them again, so that their velocity is that of
// their motion; for the application they are at once where it has put them.
//
// A node was moved if its m_x is not its m_q: after a step both are the same, and translating, rotating or scaling a
// body moves both. Between its places, a node goes along a FrameCurve. If free nodes were moved by hand as well, the
// application has set a state, which is no motion.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/solver/src/base/frame_curve.h>
#include <tetskin/solver/src/base/placement.h>

#include <functional>
#include <unordered_map>
#include <vector>

namespace tetskin::bullet_detail {

class WorldStream;

struct DrivenNode {
  int node = -1;
  btVector3 position{0, 0, 0};  ///< the position that the steps give the node
  btVector3 target{0, 0, 0};    ///< the m_x that the application sees
  btVector3 velocity{0, 0, 0};  ///< the velocity last set here: a different one is the application's own
  btScalar sinceMoved = 0;      ///< seconds of steps
  btScalar interval = 0;        ///< seconds between the last two moves
  btScalar left = 0;            ///< seconds until it has to arrive
  btVector3 from{0, 0, 0};      ///< position when it was moved
  int done = 0;                 ///< steps since then
  FrameCurve curve;             ///< from there
  FrameMotion motion;           ///< of the moves so far
};

class DrivenNodes {
 public:
  /// True if some nodes of the body are being moved.
  bool knows(const btSoftBody& body) const { return bodies_.count(&body) > 0; }
  /// Forgets a body that has left the world.
  void forget(const btSoftBody& body) { bodies_.erase(&body); }
  /// Takes the nodes that are being moved along, on their ways.
  /// moveNodes  moves the nodes of the body
  void carry(btSoftBody& body, const Placement& placement, const std::function<void()>& moveNodes);
  /// Call it when a step begins, before anything reads nodes: gives the nodes their velocities. Costs one pass over the
  /// nodes.
  void begin(const btAlignedObjectArray<btSoftBody*>& awake, btScalar dt);
  /// Call it before positions are integrated: a node that the application has moved since the step began is where it
  /// was moved to.
  void beforeIntegration(const btAlignedObjectArray<btSoftBody*>& awake);
  /// Call it when the step has ended.
  void end(const btAlignedObjectArray<btSoftBody*>& awake, btScalar dt);

  /// Writes or reads the nodes that are being moved.
  void visitState(WorldStream& stream);

 private:
  using Nodes = std::vector<DrivenNode>;
  Nodes* find(const btSoftBody& body);
  void beginBody(btSoftBody& body, btScalar dt);

  std::unordered_map<const btSoftBody*, Nodes> bodies_;  ///< by node
  Nodes found_;
};

}  // namespace tetskin::bullet_detail
