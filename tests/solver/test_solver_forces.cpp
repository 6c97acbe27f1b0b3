// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// An application's own forces, and several forces at once, on bodies that the library's solver solves for.
#include "deformable_test.h"

#include <BulletSoftBody/btDeformableMousePickingForce.h>

namespace tetskin::test {
namespace {

TEST(SolverWithOthers, MousePicksBodies) {
  TetskinWorld world;
  const auto body = added(world, cageAbove(0.03));
  step(world, 60);
  btDeformableMousePickingForce pick(200, 1, body->body().m_faces[0], btVector3(0, 3, 0), 100);
  world.deformable().addForce(&body->body(), &pick);
  body->body().activate();
  step(world, 120);
  const btSoftBody::Face& face = body->body().m_faces[0];
  const btVector3 held = (face.m_n[0]->m_x + face.m_n[1]->m_x + face.m_n[2]->m_x) / 3;
  EXPECT_LT((held - btVector3(0, 3, 0)).length(), btScalar(0.5));
  world.deformable().removeForce(&body->body(), &pick);
  step(world, 240);  // it falls, and bounces
  EXPECT_LT(lowest(body->body()), 0.1);
}

/// An application's own spring from a node to a position, which counts how often Bullet's interface is used.
class OwnSpring : public btDeformableLagrangianForce {
 public:
  OwnSpring(const btSoftBody::Node& ofNode, const btVector3& to) : node(ofNode), position(to) {}
  void addScaledForces(btScalar scale, TVStack& force) override {
    addScaledExplicitForce(scale, force);
    addScaledDampingForce(scale, force);
  }
  void addScaledExplicitForce(btScalar scale, TVStack& force) override {
    force[node.index] += scale * stiffness * (position - node.m_q);
  }
  void addScaledDampingForce(btScalar scale, TVStack& force) override {
    force[node.index] -= scale * damping * node.m_v;
  }
  void addScaledDampingForceDifferential(btScalar scale, const TVStack& dv, TVStack& df) override {
    ++products;
    df[node.index] -= scale * damping * dv[node.index];
  }
  void addScaledElasticForceDifferential(btScalar scale, const TVStack& dx, TVStack& df) override {
    ++elasticProducts;
    df[node.index] -= scale * stiffness * dx[node.index];
  }
  void buildDampingForceDifferentialDiagonal(btScalar, TVStack&) override {}
  void reinitialize(bool) override { ++steps; }
  btDeformableLagrangianForceType getForceType() override { return type; }

  const btSoftBody::Node& node;
  btVector3 position;
  btScalar stiffness = 50, damping = 5;
  btDeformableLagrangianForceType type = BT_MASSSPRING_FORCE;
  int products = 0, elasticProducts = 0, steps = 0;
};

TEST(SolverWithOthers, OwnForcesHaveTheirPartInEveryProduct) {
  for (const bool implicit : {false, true}) {
    for (const bool mouse : {false, true}) {
      TetskinWorld world;
      world.deformable().setImplicit(implicit);
      const auto body = added(world, cageAbove(1));
      OwnSpring spring(body->body().m_nodes[0], btVector3(0, 3, 0));
      if (mouse) spring.type = BT_MOUSE_PICKING_FORCE;
      world.deformable().addForce(&body->body(), &spring);
      for (int k = 1; k <= 8; ++k) {
        const int before = spring.products;
        world.deformable().stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
        EXPECT_EQ(spring.steps, k);
        EXPECT_GE(spring.products - before, world.bodySolver().iterations() / 2);
      }
      EXPECT_GT(spring.products, 8);
      EXPECT_EQ(spring.elasticProducts > 0, mouse);
      step(world, 240);
      EXPECT_LT((spring.node.m_x - spring.position).length(), btScalar(0.6));
      world.deformable().removeForce(&body->body(), &spring);
    }
  }
}

/// The force is stiff enough to explode if it were left out of the matrix: dt d / m is 100.
TEST(SolverWithOthers, OwnForcesAreSolvedForImplicitly) {
  TetskinWorld world;
  const auto body = added(world, smallCageAbove(1));
  OwnSpring spring(body->body().m_nodes[0], btVector3(0, 1, 0));
  spring.damping = 1000;
  world.deformable().addForce(&body->body(), &spring);
  step(world, 30);
  EXPECT_LT((spring.node.m_x - spring.position).length(), btScalar(0.1));
  EXPECT_LT(rmsSpeed(body->body()), 5.0);
  world.deformable().removeForce(&body->body(), &spring);
}

/// A mouse that holds a resting body still must leave it at rest, even where the solve stops early.
TEST(SolverWithOthers, BulletsForcesGainNoEnergyOnElasticBodies) {
  for (const double youngsModulus : {2e4, 2e5}) {
    TetskinWorld world;
    world.deformable().setGravity(btVector3(0, 0, 0));
    SoftBodyOptions options;
    options.youngsModulus = youngsModulus;
    TetMesh cage = lifted(test::latticeCage(4, 4, 4, 0.25), 2);
    const auto body = added(world, cage, options);
    btSoftBody& soft = body->body();
    soft.setActivationState(DISABLE_DEACTIVATION);
    const btSoftBody::Face& face = soft.m_faces[0];
    btVector3 at(0, 0, 0);
    for (const btSoftBody::Node* node : face.m_n) at += node->m_x / 3;
    btDeformableMousePickingForce mouse(100, btScalar(0.5), face, at, 20);
    world.deformable().addForce(&soft, &mouse);
    double fastest = 0;
    for (int f = 0; f < 90; ++f) {
      step(world, 1);
      fastest = std::max(fastest, std::sqrt(static_cast<double>(soft.m_maxSpeedSquared)));
    }
    EXPECT_LT(fastest, 0.3) << youngsModulus;
    world.deformable().removeForce(&soft, &mouse);
  }
}

}  // namespace
}  // namespace tetskin::test
