// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What else may be in a world, beside bodies that the library's solver solves for: it goes on as with Bullet's solver.
#include "deformable_test.h"

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletSoftBody/btDeformableMassSpringForce.h>
#include <BulletSoftBody/btDeformableMousePickingForce.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <tetskin/bullet/elastic_force.h>

#include <cmath>

namespace tetskin {
namespace {

using test::added;
using test::cageAbove;
using test::EmptyWorld;
using test::lowest;
using test::rmsSpeed;
using test::smallCageAbove;
using test::step;
using test::TetskinWorld;

btVector3 centreOf(const btSoftBody& body) {
  btVector3 sum(0, 0, 0);
  for (int n = 0; n < body.m_nodes.size(); ++n) sum += body.m_nodes[n].m_x;
  return sum / btScalar(body.m_nodes.size());
}

double largestDifference(const btSoftBody& a, const btSoftBody& b) {
  btScalar most = 0;
  for (int n = 0; n < a.m_nodes.size(); ++n) most = std::max(most, (a.m_nodes[n].m_x - b.m_nodes[n].m_x).length());
  return static_cast<double>(most);
}

/// A square of cloth with springs of Bullet's, held at two corners, as in Bullet's own examples.
class Cloth {
 public:
  explicit Cloth(EmptyWorld& ofWorld, bool held = true) : world(ofWorld.deformable()) {
    const btScalar s = 1, y = 3;
    body.reset(btSoftBodyHelpers::CreatePatch(world.getWorldInfo(), btVector3(-s, y, -s), btVector3(s, y, -s),
                                              btVector3(-s, y, s), btVector3(s, y, s), 9, 9, held ? 1 + 2 : 0, true));
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

TEST(SolverWithOthers, ClothHangsAsWithBulletsSolver) {
  TetskinWorld ours;
  EmptyWorld bullets;
  const auto beside = added(ours, smallCageAbove(8));
  Cloth a(ours), b(bullets);
  double swung = 0.0;
  for (int f = 0; f < 60; ++f) {
    step(ours, 1);
    step(bullets, 1);
    swung = std::max(swung, 3.0 - lowest(*b.body));
    ASSERT_LT(largestDifference(*a.body, *b.body), 0.01) << "frame " << f;
  }
  EXPECT_GT(swung, 0.5);
}

TEST(SolverWithOthers, ClothLandsAsWithBulletsSolver) {
  TetskinWorld ours;
  EmptyWorld bullets;
  Cloth a(ours, false), b(bullets, false);
  step(ours, 120);
  step(bullets, 120);
  EXPECT_LT(lowest(*b.body), 0.1);
  EXPECT_NEAR(lowest(*a.body), lowest(*b.body), 0.01);
  EXPECT_LT((centreOf(*a.body) - centreOf(*b.body)).length(), btScalar(0.02));
}

TEST(SolverWithOthers, BulletsMaterialsLandAsWithBulletsSolver) {
  for (const ForceModel model : {ForceModel::NeoHookean, ForceModel::LinearElasticity}) {
    TetskinWorld ours;
    EmptyWorld bullets;
    SoftBodyOptions options;
    options.forceModel = model;
    const auto beside = added(ours, smallCageAbove(8));
    const auto a = added(ours, cageAbove(0.3), options), b = added(bullets, cageAbove(0.3), options);
    for (int f = 0; f < 40; ++f) {
      step(ours, 1);
      step(bullets, 1);
      ASSERT_LT(largestDifference(a->body(), b->body()), 0.01) << "frame " << f;
    }
    step(ours, 140);
    EXPECT_LT(rmsSpeed(a->body()), 0.05);
    EXPECT_GT(lowest(a->body()), -0.01);
  }
}

TEST(SolverWithOthers, BodiesOfAllKindsLandInImplicitWorlds) {
  for (const bool lineSearch : {false, true}) {
    TetskinWorld world;
    world.deformable().setImplicit(true);
    world.deformable().setLineSearch(lineSearch);
    SoftBodyOptions options;
    options.forceModel = ForceModel::NeoHookean;
    const auto a = added(world, cageAbove(0.3)), b = added(world, smallCageAbove(2.5), options);
    // Bullet's line search reads past the end of an array where a neo-Hookean body sleeps.
    b->body().setActivationState(DISABLE_DEACTIVATION);
    EXPECT_EQ(a->solverPath(), SolverPath::Solver);
    step(world, 1);
    EXPECT_EQ(a->solverPath(), lineSearch ? SolverPath::ForceOnly : SolverPath::Solver);
    step(world, 11);
    EXPECT_NEAR(static_cast<double>(centreOf(b->body()).y()), 2.8 - 0.5 * 10.0 * 0.2 * 0.2, 0.02);
    step(world, 168);
    EXPECT_LT(rmsSpeed(a->body()), 0.1) << lineSearch;
    EXPECT_GT(lowest(a->body()), -0.01);
    EXPECT_LT(lowest(a->body()), 0.1);
  }
}

TEST(SolverWithOthers, MousePicksBodies) {
  TetskinWorld world;
  const auto body = added(world, cageAbove(0.03));
  step(world, 60);
  btDeformableMousePickingForce pick(200, 1, body->body().m_faces[0], btVector3(0, 3, 0), 100);
  world.deformable().addForce(&body->body(), &pick);
  step(world, 120);
  const btSoftBody::Face& face = body->body().m_faces[0];
  const btVector3 held = (face.m_n[0]->m_x + face.m_n[1]->m_x + face.m_n[2]->m_x) / 3;
  EXPECT_LT((held - btVector3(0, 3, 0)).length(), btScalar(0.5));
  world.deformable().removeForce(&body->body(), &pick);
  step(world, 120);
  EXPECT_LT(lowest(body->body()), 0.1);
}

TEST(SolverWithOthers, AnchorsHoldBodies) {
  TetskinWorld world;
  btBoxShape shape(btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2)));
  btRigidBody box(0, nullptr, &shape);
  btTransform above(btQuaternion::getIdentity(), btVector3(0, btScalar(6.2), 0));
  box.setWorldTransform(above);
  box.setInterpolationWorldTransform(above);
  world.deformable().addRigidBody(&box);
  const auto body = added(world, cageAbove(5));
  int node = 0;
  for (int n = 0; n < body->body().m_nodes.size(); ++n) {
    const auto distance = [&](int k) { return (body->body().m_nodes[k].m_x - btVector3(0, 6, 0)).length(); };
    if (distance(n) < distance(node)) node = n;
  }
  const btVector3 where = body->body().m_nodes[node].m_x;
  body->body().appendDeformableAnchor(node, &box);
  step(world, 120);
  EXPECT_LT((body->body().m_nodes[node].m_x - where).length(), btScalar(1e-3));
  EXPECT_GT(lowest(body->body()), 3.0);
  EXPECT_LT(rmsSpeed(body->body()), 5.0);
  body->body().m_deformableAnchors.clear();
  world.deformable().removeRigidBody(&box);
}

/// A multibody of a base and a link falls on a body.
TEST(SolverWithOthers, MultibodiesRestOnBodies) {
  TetskinWorld world;
  SoftBodyOptions options;
  options.youngsModulus = 1e4;
  const auto body = added(world, cageAbove(0.02), options);
  btBoxShape shape(btVector3(btScalar(0.4), btScalar(0.1), btScalar(0.4)));
  btVector3 inertia;
  shape.calculateLocalInertia(btScalar(0.2), inertia);
  btMultiBody multi(0, btScalar(0.2), inertia, false, false);
  multi.finalizeMultiDof();
  multi.setBaseWorldTransform(
      btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.5), btScalar(1.1), btScalar(0.5))));
  btMultiBodyLinkCollider collider(&multi, -1);
  collider.setCollisionShape(&shape);
  collider.setWorldTransform(multi.getBaseWorldTransform());
  collider.setInterpolationWorldTransform(multi.getBaseWorldTransform());
  multi.setBaseCollider(&collider);
  world.deformable().addCollisionObject(&collider, 2, 1 + 2);
  world.deformable().addMultiBody(&multi);
  step(world, 180);
  EXPECT_GT(multi.getBasePos().y(), 0.8);
  EXPECT_LT(multi.getBasePos().y(), 1.1);
  world.deformable().removeMultiBody(&multi);
  world.deformable().removeCollisionObject(&collider);
}

/// A spring of the application's own, from a node to a place, and how often Bullet's interface is used.
class OwnSpring : public btDeformableLagrangianForce {
 public:
  OwnSpring(const btSoftBody::Node& ofNode, const btVector3& to) : node(ofNode), place(to) {}
  void addScaledForces(btScalar scale, TVStack& force) override {
    addScaledExplicitForce(scale, force);
    addScaledDampingForce(scale, force);
  }
  void addScaledExplicitForce(btScalar scale, TVStack& force) override {
    force[node.index] += scale * stiffness * (place - node.m_q);
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
  btVector3 place;
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
      EXPECT_EQ(spring.elasticProducts > 0, implicit || mouse);
      step(world, 240);
      EXPECT_LT((spring.node.m_x - spring.place).length(), btScalar(0.6));
      world.deformable().removeForce(&body->body(), &spring);
    }
  }
}

/// Stiff enough to explode if it had no part in the matrix: dt d / m is 100.
TEST(SolverWithOthers, OwnForcesAreSolvedForImplicitly) {
  TetskinWorld world;
  const auto body = added(world, smallCageAbove(1));
  OwnSpring spring(body->body().m_nodes[0], btVector3(0, 1, 0));
  spring.damping = 1000;
  world.deformable().addForce(&body->body(), &spring);
  step(world, 30);
  EXPECT_LT((spring.node.m_x - spring.place).length(), btScalar(0.1));
  EXPECT_LT(rmsSpeed(body->body()), 5.0);
  world.deformable().removeForce(&body->body(), &spring);
}

TEST(SolverWithOthers, SleepersStayWhereTheyAreAndWake) {
  TetskinWorld world;
  SoftBodyOptions options;
  options.relativeStiffness = 300.0;
  options.damping = 0.1;
  std::vector<std::unique_ptr<DeformableBody>> bodies;
  for (int b = 0; b < 6; ++b) {
    TetMesh cage = smallCageAbove(0.02);
    for (Eigen::Vector3d& p : cage.nodes) p.x() += 3.0 * b;
    bodies.push_back(added(world, cage, options));
  }
  const auto asleep = [&] {
    return std::count_if(bodies.begin(), bodies.end(), [](const auto& body) { return !body->body().isActive(); });
  };
  std::vector<btVector3> before;
  btScalar jump = 0;
  int frames = 0;
  while (asleep() < 6 && ++frames < 1200) {
    before.clear();
    for (const auto& body : bodies) before.push_back(body->body().m_nodes[0].m_x);
    step(world, 1);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (!bodies[b]->body().isActive()) jump = std::max(jump, (bodies[b]->body().m_nodes[0].m_x - before[b]).length());
    }
  }
  ASSERT_EQ(asleep(), 6) << "after " << frames << " frames";
  EXPECT_LT(jump, btScalar(1e-3));
  step(world, 1);
  EXPECT_EQ(world.bodySolver().iterations(), 0);
  const btVector3 still = bodies[3]->body().m_nodes[5].m_x;
  step(world, 30);
  EXPECT_EQ((bodies[3]->body().m_nodes[5].m_x - still).length(), btScalar(0));

  bodies[3]->body().activate();
  bodies[3]->body().setVelocity(btVector3(0, 3, 0));
  step(world, 6);
  EXPECT_GT(lowest(bodies[3]->body()), 0.1);
  EXPECT_EQ(asleep(), 5);
}

TEST(SolverWithOthers, FollowsABodyThatIsScaled) {
  TetskinWorld world;
  const auto body = added(world, smallCageAbove(50));
  step(world, 2);
  body->body().scale(btVector3(2, 2, 2));
  step(world, 40);
  btScalar low = 1e9f, high = -1e9f;
  for (int n = 0; n < body->body().m_nodes.size(); ++n) {
    low = std::min(low, body->body().m_nodes[n].m_x.z());
    high = std::max(high, body->body().m_nodes[n].m_x.z());
  }
  EXPECT_NEAR(static_cast<double>(high - low), 2 * 0.9, 0.01);
}

/// Bullet's tets dangle after `appendNode`: they are not stepped any more, and nothing is read past its end.
TEST(SolverWithOthers, SurvivesNodesThatAreAppended) {
  TetskinWorld world;
  const auto body = added(world, smallCageAbove(5));
  step(world, 2);
  body->body().appendNode(btVector3(0, 9, 0), btScalar(0.1));
  body->body().m_tetras.resize(0);  // or Bullet itself reads through them
  step(world, 5);
  EXPECT_TRUE(std::isfinite(rmsSpeed(body->body())));
}

TEST(SolverWithOthers, TwoForcesOfOneBodyBothAct) {
  for (const bool ours : {false, true}) {
    std::unique_ptr<EmptyWorld> world = ours ? std::make_unique<TetskinWorld>() : std::make_unique<EmptyWorld>();
    const auto body = added(*world, smallCageAbove(5));
    const int tets = body->body().m_tetras.size();
    ElasticForce first({1e3}), second({1e3});
    ASSERT_TRUE(first.addTo(world->deformable(), body->body()).ok());
    ASSERT_TRUE(second.addTo(world->deformable(), body->body()).ok());
    step(*world, 10);
    EXPECT_EQ(body->body().m_tetras.size(), tets);
    first.removeFrom(body->body());
    second.removeFrom(body->body());
    step(*world, 10);
    EXPECT_TRUE(std::isfinite(rmsSpeed(body->body())));
  }
}

/// Bullet's addForce joins objects of one type: not those that a DeformableBody has for itself.
TEST(SolverWithOthers, ABodyGivenAForceByBulletsMeansHasThatForce) {
  TetskinWorld world;
  const auto ours = added(world, smallCageAbove(5));
  const auto own = makeSoftBody(smallCageAbove(9), world.deformable().getWorldInfo()).value();
  ElasticForce force({1e3});
  world.deformable().addSoftBody(own.get());
  world.deformable().addForce(own.get(), &force);
  EXPECT_EQ(force.m_softBodies.size(), 1);
  step(world, 5);
  // It has no gravity, as it was given none.
  EXPECT_LT(rmsSpeed(*own), 1e-3);
  force.removeFrom(*own);
  EXPECT_EQ(force.m_softBodies.size(), 0);
  world.deformable().removeSoftBody(own.get());
  step(world, 5);
}

TEST(SolverWithOthers, BodiesMayGoInBulletsCallbacks) {
  for (const bool afterSolve : {false, true}) {
    TetskinWorld world;
    struct Bodies {
      std::vector<std::unique_ptr<DeformableBody>> all;
      int calls = 0;
      static void goes(btScalar, btDeformableMultiBodyDynamicsWorld* in) {
        auto& bodies = *static_cast<Bodies*>(in->getWorldUserInfo());
        if (++bodies.calls == 8) bodies.all.erase(bodies.all.begin());
      }
    } bodies;
    for (int b = 0; b < 3; ++b) bodies.all.push_back(added(world, cageAbove(0.021 + 1.5 * b)));
    world.deformable().setWorldUserInfo(&bodies);
    if (afterSolve) {
      world.deformable().setSolverCallback(Bodies::goes);  // before and after
    } else {
      const auto tick = [](btDynamicsWorld* in, btScalar) {
        Bodies::goes(0, static_cast<btDeformableMultiBodyDynamicsWorld*>(in));
      };
      world.deformable().setInternalTickCallback(tick, &bodies, false);
    }
    step(world, 30);
    EXPECT_EQ(bodies.all.size(), 2u);
    for (const auto& body : bodies.all) EXPECT_TRUE(std::isfinite(rmsSpeed(body->body())));
    world.deformable().setSolverCallback(nullptr);
    world.deformable().setInternalTickCallback(nullptr);
  }
}

TEST(SolverWithOthers, IsElasticAgainAfterANodeWasNotANumber) {
  TetskinWorld world;
  const auto body = added(world, cageAbove(5));
  body->setGravity(btVector3(0, 0, 0));
  step(world, 2);
  std::vector<btVector3> before;
  for (int n = 0; n < body->body().m_nodes.size(); ++n) before.push_back(body->body().m_nodes[n].m_x);
  body->body().m_nodes[7].m_v.setX(btScalar(NAN));
  step(world, 2);
  for (int n = 0; n < body->body().m_nodes.size(); ++n) {
    btSoftBody::Node& node = body->body().m_nodes[n];
    node.m_x = node.m_q = before[static_cast<std::size_t>(n)] * btVector3(btScalar(1.2), 1, 1);
    node.m_v = node.m_vn = btVector3(0, 0, 0);
  }
  step(world, 120);
  btScalar length = 0;
  for (int n = 0; n < body->body().m_nodes.size(); ++n) {
    length = std::max(length, (body->body().m_nodes[n].m_x - body->body().m_nodes[0].m_x).x());
  }
  EXPECT_NEAR(static_cast<double>(length), 1.0, 0.01);
}

/// The world's choice is known in its first step only after the solver has been asked to begin it.
TEST(SolverWithOthers, WorldsWithoutProjectionKeepTheirRigidBodies) {
  TetskinWorld world;
  SoftBodyOptions options;
  options.configureWorld = false;
  world.deformable().setUseProjection(false);
  const auto body = added(world, cageAbove(0.01), options);
  btBoxShape shape(btVector3(btScalar(0.3), btScalar(0.1), btScalar(0.3)));
  btVector3 inertia;
  shape.calculateLocalInertia(btScalar(0.1), inertia);
  btRigidBody box(btScalar(0.1), nullptr, &shape, inertia);
  btTransform above(btQuaternion::getIdentity(), btVector3(btScalar(0.5), btScalar(0.9), btScalar(0.5)));
  box.setWorldTransform(above);
  box.setInterpolationWorldTransform(above);
  world.deformable().addRigidBody(&box);
  step(world, 10);
  EXPECT_TRUE(std::isfinite(box.getWorldTransform().getOrigin().length()));
  world.deformable().removeRigidBody(&box);
}

TEST(SolverWithOthers, BodiesComeAndGo) {
  TetskinWorld world;
  auto first = added(world, cageAbove(1)), second = added(world, cageAbove(4));
  step(world, 10);
  first.reset();
  step(world, 10);
  auto third = added(world, smallCageAbove(8));
  Cloth cloth(world);
  step(world, 10);
  world.deformable().removeSoftBody(&second->body());
  step(world, 10);
  second.reset();
  step(world, 100);
  EXPECT_GT(lowest(third->body()), -0.01);
}

}  // namespace
}  // namespace tetskin
