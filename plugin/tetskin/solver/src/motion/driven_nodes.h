// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: pinned nodes (m_im is 0) that the application moves by setting their m_x. Steps move
// such a node there by the time at which the application is likely to move it again, so that its velocity matches its
// motion; the application sees it at once where it put it.
//
// A node was moved if its m_x differs from its m_q: after a step both are the same, and translating, rotating or
// scaling a body moves both. Between its places, a node follows a FrameCurve. If free nodes were moved by hand as well,
// the application has set a state, not a motion.
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
  btVector3 velocity{0, 0, 0};  ///< the velocity last set here: any other is the application's
  btScalar sinceMoved = 0;      ///< seconds simulated since the last move
  btScalar interval = 0;        ///< seconds between the last two moves
  btScalar left = 0;            ///< seconds until it must arrive
  btVector3 from{0, 0, 0};      ///< position when it was last moved
  int done = 0;                 ///< steps since then
  FrameCurve curve;             ///< path from there
  FrameMotion motion;           ///< of the moves so far
};

class DrivenNodes {
 public:
  /// True if some nodes of the body are being moved.
  bool knows(const btSoftBody& body) const { return bodies_.count(&body) > 0; }
  /// Forgets a body that has left the world.
  void forget(const btSoftBody& body) { bodies_.erase(&body); }
  /// Moves the driven nodes of a body, and their paths, along with it.
  /// moveNodes  moves the nodes of the body
  void carry(btSoftBody& body, const Placement& placement, const std::function<void()>& moveNodes);
  /// Call it when a step begins, before anything reads nodes. Sets the nodes' velocities. Costs one pass over the
  /// nodes.
  void begin(const btAlignedObjectArray<btSoftBody*>& awake, btScalar dt);
  /// Call it before positions are integrated. Puts a node that the application has moved since the step began where it
  /// was moved to.
  void beforeIntegration(const btAlignedObjectArray<btSoftBody*>& awake);
  /// Call it when the step has ended.
  void end(const btAlignedObjectArray<btSoftBody*>& awake, btScalar dt);

  /// Writes or reads the nodes that are being moved.
  void serialize(WorldStream& stream);

 private:
  using Nodes = std::vector<DrivenNode>;
  Nodes* find(const btSoftBody& body);
  void beginBody(btSoftBody& body, btScalar dt);

  std::unordered_map<const btSoftBody*, Nodes> bodies_;  ///< by node
  Nodes found_;
};

}  // namespace tetskin::bullet_detail
