// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Rigid bodies for the tests of the solver, and the momentum of rigid and soft bodies.
#pragma once

#include "deformable_test.h"
#include "support/rigids.h"

#include <btBulletDynamicsCommon.h>

#include <functional>
#include <memory>
#include <utility>

namespace tetskin::test {

inline std::unique_ptr<btCollisionShape> ball() {
  return std::make_unique<btSphereShape>(btScalar(0.25));
}

/// Angular momentum about the origin.
inline btVector3 spinOf(const btSoftBody& body) {
  btVector3 sum(0, 0, 0);
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    sum += body.m_nodes[n].m_x.cross(body.m_nodes[n].m_v / body.m_nodes[n].m_im);
  }
  return sum;
}

inline void forEachSubstep(TetskinWorld& world, int steps, const std::function<void()>& then) {
  for (int k = 0; k < steps; ++k) {
    world.deformable().stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
    then();
  }
}

/// A block that flies at whatever is above the origin, in a world without gravity.
struct FlyingBlock {
  explicit FlyingBlock(double height = 5.0) {
    world.deformable().setGravity(btVector3(0, 0, 0));
    TetMesh cage = shifted(latticeCage(3, 3, 3, 0.3), Eigen::Vector3d(-0.45, height, -0.45));
    block = added(world, cage);
    block->body().m_cfg.kDF = btScalar(0.5);
  }
  btSoftBody& body() { return block->body(); }

  TetskinWorld world;
  std::unique_ptr<DeformableBody> block;
};

}  // namespace tetskin::test
