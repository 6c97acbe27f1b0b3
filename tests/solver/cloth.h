// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "deformable_test.h"

#include <BulletSoftBody/btDeformableMassSpringForce.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>

namespace tetskin::test {

/// A square of cloth with Bullet's springs, pinned at two corners, as in Bullet's own examples.
class Cloth {
 public:
  explicit Cloth(EmptyWorld& ofWorld, bool pinned = true) : world(ofWorld.deformable()) {
    const btScalar s = 1, y = 3;
    body.reset(btSoftBodyHelpers::CreatePatch(world.getWorldInfo(), btVector3(-s, y, -s), btVector3(s, y, -s),
                                              btVector3(-s, y, s), btVector3(s, y, s), 9, 9, pinned ? 1 + 2 : 0, true));
    body->getCollisionShape()->setMargin(btScalar(0.02));
    body->generateBendingConstraints(2);
    body->setTotalMass(1);
    body->m_cfg.kKHR = body->m_cfg.kCHR = 1;
    body->m_cfg.kDF = btScalar(0.5);
    body->m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
    world.addSoftBody(body.get());
    world.addForce(body.get(), &springs);
    world.addForce(body.get(), &gravity);
  }
  ~Cloth() {
    world.removeForce(body.get(), &springs);
    world.removeForce(body.get(), &gravity);
    world.removeSoftBody(body.get());
  }

  btDeformableMultiBodyDynamicsWorld& world;
  btDeformableMassSpringForce springs{30, 1, true};
  btDeformableGravityForce gravity{btVector3(0, -10, 0)};
  std::unique_ptr<btSoftBody> body;
};

}  // namespace tetskin::test
