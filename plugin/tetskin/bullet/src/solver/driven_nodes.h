// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: held nodes (m_im is 0) that the application moves by their m_x. They go there within
// the steps until it is likely to move them again, so that their velocity is that of their motion; for the application
// they are at once where it has put them.
//
// A node was moved if its m_x is not its m_q: after a step both are the same, and a body that is translated, rotated or
// scaled has both moved. If free nodes were moved by hand as well, it is a state that is put in, and no motion.
#pragma once

#include <BulletSoftBody/btSoftBody.h>

#include <unordered_map>
#include <vector>

namespace tetskin {

struct DrivenNode {
  int node = -1;
  btVector3 position{0, 0, 0};  ///< in the steps
  btVector3 target{0, 0, 0};    ///< its m_x for the application
  btVector3 velocity{0, 0, 0};  ///< that it has been given: another one is the application's own
  btScalar sinceMoved = 0;      ///< seconds, of steps
  btScalar interval = 0;        ///< seconds, between the last two times that it was moved
  btScalar left = 0;            ///< seconds, until it shall have arrived
};

class DrivenNodes {
 public:
  /// Those of bodies that are here no more are forgotten.
  void keepOnly(const btAlignedObjectArray<btSoftBody*>& bodies);
  /// When a step begins, before anything reads nodes: gives them their velocities. Costs a pass over the nodes.
  void begin(const btAlignedObjectArray<btSoftBody*>& awake, btScalar dt);
  /// Before positions are integrated: a node that was moved since the step began is where it was moved to.
  void beforeIntegration(const btAlignedObjectArray<btSoftBody*>& awake);
  /// When the step has ended.
  void end(const btAlignedObjectArray<btSoftBody*>& awake, btScalar dt);

 private:
  using Nodes = std::vector<DrivenNode>;
  Nodes* find(const btSoftBody& body);
  void beginBody(btSoftBody& body, btScalar dt);

  std::unordered_map<const btSoftBody*, Nodes> bodies_;  ///< by node
  Nodes found_;
};

}  // namespace tetskin
