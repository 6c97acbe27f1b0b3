// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "deformable_test.h"

#include <tetskin/bullet/src/base/body_trees.h>

namespace tetskin::test {

using namespace bullet_detail;

namespace {

struct Ray {
  btVector3 from, to;
};

/// Rays from all around through points in and near the body; some miss it.
std::vector<Ray> raysAround(const btSoftBody& body, unsigned seed) {
  Box3 box;
  for (int n = 0; n < body.m_nodes.size(); ++n) box.extend(toEigen(body.m_nodes[n].m_x));
  std::vector<Ray> rays;
  for (const Eigen::Vector3d& at : test::randomPoints(200, Box3(box.min() - 0.1 * box.sizes(), box.max()), seed)) {
    const Eigen::Vector3d direction = (at - box.center()).cross(Eigen::Vector3d(0.3, 0.5, -0.8)).normalized();
    const Eigen::Vector3d reach = 2.0 * box.diagonal().norm() * direction;
    rays.push_back({toBullet(at - reach), toBullet(at + reach)});
  }
  return rays;
}

/// Where the ray first hits a face of the body, as a fraction of the ray; 1 if it hits none.
double nearestHit(const btSoftBody& body, const Ray& ray) {
  btScalar nearest = 1;
  for (int f = 0; f < body.m_faces.size(); ++f) {
    btSoftBody::Node* const* n = body.m_faces[f].m_n;
    const btScalar t = btSoftBody::RayFromToCaster::rayFromToTriangle(ray.from, ray.to, ray.to - ray.from, n[0]->m_x,
                                                                      n[1]->m_x, n[2]->m_x, nearest);
    if (t > 0) nearest = t;
  }
  return static_cast<double>(nearest);
}

double hitIn(const btCollisionWorld& world, const btSoftBody& body, const Ray& ray) {
  btCollisionWorld::ClosestRayResultCallback callback(ray.from, ray.to);
  world.rayTest(ray.from, ray.to, callback);
  return callback.hasHit() && callback.m_collisionObject == &body ? static_cast<double>(callback.m_closestHitFraction)
                                                                  : 1.0;
}

/// Every ray that hits the body before the floor hits it where brute force says.
void expectRaysAsByBruteForce(const btCollisionWorld& world, const btSoftBody& body, unsigned seed) {
  int hits = 0;
  for (const Ray& ray : raysAround(body, seed)) {
    const double expected = nearestHit(body, ray);
    const btVector3 collides = ray.from + static_cast<btScalar>(expected) * (ray.to - ray.from);
    if (collides.y() < 0 || ray.from.y() < 0) continue;
    ASSERT_NEAR(hitIn(world, body, ray), expected, 1e-6) << "ray " << hits;
    hits += expected < 1.0;
  }
  EXPECT_GT(hits, 10);
}

TEST(BodyTrees, RaysMeetABodyOfTwoPartsAsByBruteForce) {
  TetskinWorld world;
  const auto body = added(world, twoComponents(smallCageAbove(0.5)));
  expectRaysAsByBruteForce(world.deformable(), body->body(), 1);
  step(world, 3);
  expectRaysAsByBruteForce(world.deformable(), body->body(), 2);
  step(world, 60);
  expectRaysAsByBruteForce(world.deformable(), body->body(), 3);
}

TEST(BodyTrees, FollowABodyThatIsMovedByHand) {
  TetskinWorld world;
  const auto body = added(world, twoComponents(smallCageAbove(0.5)));
  step(world, 10);
  body->body().translate(btVector3(5, 1, 0));
  expectRaysAsByBruteForce(world.deformable(), body->body(), 1);
  body->body().rotate(btQuaternion(btVector3(0, 1, 0), btScalar(0.3)));
  expectRaysAsByBruteForce(world.deformable(), body->body(), 2);
  body->body().scale(btVector3(1, btScalar(1.5), 1));
  expectRaysAsByBruteForce(world.deformable(), body->body(), 3);
}

TEST(BodyTrees, AreRightForASleeperAlsoOnceItIsMoved) {
  TetskinWorld world;
  const auto body = added(world, twoComponents(smallCageAbove(0.05)));
  for (int frame = 0; body->body().isActive() && frame < 900; ++frame) step(world, 1);
  ASSERT_FALSE(body->body().isActive());
  step(world, 2);
  expectRaysAsByBruteForce(world.deformable(), body->body(), 1);
  body->body().translate(btVector3(0, 2, 1));
  expectRaysAsByBruteForce(world.deformable(), body->body(), 2);
  step(world, 2);
  EXPECT_TRUE(body->body().isActive()) << "it is in the air";
  expectRaysAsByBruteForce(world.deformable(), body->body(), 3);
}

template <class World>
class ClassicTrees : public testing::Test {};
using ClassicWorlds = testing::Types<test::RigidWorld, test::MultiBodyWorld>;
TYPED_TEST_SUITE(ClassicTrees, ClassicWorlds);

TYPED_TEST(ClassicTrees, RaysMeetABodyOfTwoPartsAsByBruteForce) {
  TypeParam world(twoComponents(smallCageAbove(0.5)));
  expectRaysAsByBruteForce(*world.world, world.body(), 1);
  for (int k = 0; k < 20; ++k) world.world->stepSimulation(btScalar(1) / 60);
  expectRaysAsByBruteForce(*world.world, world.body(), 2);
}

TEST(BodyTrees, StayThroughNewMassesSoThatTheNextStepDoesNotHang) {
  test::DeformableWorld bare(twoComponents(smallCageAbove(0.5)));
  const auto stepped = [&] {
    bare.world->stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
    expectRaysAsByBruteForce(*bare.world, bare.body(), 1);
  };
  setTotalMass(bare.body(), 3);
  EXPECT_NEAR(bare.body().getTotalMass(), 3, 1e-4);
  stepped();
  setMass(bare.body(), 7, 0);
  stepped();
  setMass(bare.body(), 7, btScalar(0.01));
  EXPECT_NEAR(bare.body().getMass(7), 0.01, 1e-6);
  stepped();
}

TEST(BodyTrees, OfADeformableBodyStayThroughBulletsOwnSetMass) {
  TetskinWorld world;
  SoftBodyOptions options;
  options.pinned = [](const Eigen::Vector3d& p) { return p.y() > 1.2; };
  const auto body = added(world, twoComponents(smallCageAbove(0.5)), options);
  step(world, 5);
  for (int n = 0; n < body->body().m_nodes.size(); ++n) {
    if (body->isPinned(n)) body->body().setMass(n, btScalar(0.01));
  }
  body->body().setTotalMass(2);
  step(world, 5);
  EXPECT_FALSE(body->body().m_bUpdateRtCst);
  expectRaysAsByBruteForce(world.deformable(), body->body(), 1);
}

TEST(BodyTrees, AreBuiltAnewForFacesAndNodesThatWereAdded) {
  TetskinWorld world;
  const auto body = added(world, twoComponents(smallCageAbove(0.5)));
  btSoftBody& soft = body->body();
  const btDbvtNode* root = soft.m_fdbvt.m_root;
  soft.m_bUpdateRtCst = true;
  updateConstants(soft);
  EXPECT_EQ(soft.m_fdbvt.m_root, root);  // nothing needs to be done
  soft.m_bUpdateRtCst = true;
  soft.appendFace(0, 30, 60);  // the array of faces moves, and so does everything that points into it
  updateConstants(soft);
  EXPECT_FALSE(soft.m_bUpdateRtCst);
  expectRaysAsByBruteForce(world.deformable(), soft, 1);
}

TEST(BodyTrees, LeftOutLetRaysMissAndNothingHang) {
  SoftBodyOptions options;
  options.faceTree = false;
  TetskinWorld world;
  const auto body = added(world, twoComponents(smallCageAbove(0.5)), options);
  const auto expectMisses = [&] {
    for (const Ray& ray : raysAround(body->body(), 1)) EXPECT_EQ(hitIn(world.deformable(), body->body(), ray), 1.0);
  };
  expectMisses();
  step(world, 5);
  expectMisses();
  body->body().setTotalMass(3);
  step(world, 5);
  expectMisses();
  body->body().translate(btVector3(1, 0, 0));
  expectMisses();
  step(world, 120);
  EXPECT_GT(test::lowest(body->body()), -0.05);
}

TEST(BodyTrees, LeftOutInAClassicWorldMeetTheTets) {
  SoftBodyOptions options;
  options.faceTree = false;
  options.forceModel = ForceModel::MassSpring;
  test::RigidWorld world(twoComponents(smallCageAbove(3)), options);
  for (int k = 0; k < 5; ++k) world.world->stepSimulation(btScalar(1) / 60);
  expectRaysAsByBruteForce(*world.world, world.body(), 1);
  world.body().translate(btVector3(0, 1, 0));
  for (int k = 0; k < 5; ++k) world.world->stepSimulation(btScalar(1) / 60);
  expectRaysAsByBruteForce(*world.world, world.body(), 2);
}

TYPED_TEST(ClassicTrees, AreThereAgainAfterAStepThatDeletesThem) {
  TypeParam world(twoComponents(smallCageAbove(3)));
  btSoftBody& body = world.body();
  body.setTotalMass(5);  // Bullet's own: the next step deletes the tree of faces, but the faces keep pointing into it
  world.world->stepSimulation(btScalar(1) / 60);
  expectRaysAsByBruteForce(*world.world, body, 1);
  ASSERT_EQ(body.m_nodes.size(), body.m_nodes.capacity());
  body.appendNode(btVector3(0, 9, 0), 1);  // moves the nodes and updates every leaf
  for (int f = 0; f < body.m_faces.size(); ++f) ASSERT_EQ(body.m_faces[f].m_leaf->data, &body.m_faces[f]);
}

TEST(BodyTrees, LeftOutStayLeftOutWhereNodesAreAppended) {
  btSoftBodyWorldInfo info;
  SoftBodyOptions options;
  options.faceTree = false;
  const std::unique_ptr<btSoftBody> body(createSoftBody(smallCageAbove(0), info, options).value());
  body->appendNode(btVector3(0, 9, 0), 1);
  for (const Ray& ray : raysAround(*body, 1)) {
    btSoftBody::sRayCast hit;
    EXPECT_FALSE(body->rayFaceTest(ray.from, ray.to, hit));
  }
  updateConstants(*body);
  EXPECT_TRUE(body->m_fdbvt.m_root->isleaf());
}

TEST(BodyTrees, OfAnExplodedBodyAreBuilt) {
  btSoftBodyWorldInfo info;
  const std::unique_ptr<btSoftBody> body(createSoftBody(smallCageAbove(0), info).value());
  for (int n = 0; n < body->m_nodes.size(); n += 3) body->m_nodes[n].m_x.setX(btScalar(NAN));
  buildTrees(*body);
  EXPECT_EQ(body->m_fdbvt.m_leaves, body->m_faces.size());
  EXPECT_EQ(body->m_ndbvt.m_leaves, body->m_nodes.size());
}

}  // namespace
}  // namespace tetskin::test
