// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "touch_test.h"

#include <tetskin/touch/src/tree/ray_triangle.h>

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

Vector3d corner(const SoftBodySkin& skin, int v) {
  const btScalar* p = skin.positions()[static_cast<std::size_t>(v)];
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

struct Found {
  int triangle = -1;
  double distance = HUGE_VAL;
};

/// The hit found by testing all triangles, and by volumes, independently of the tree.
Found bruteForce(const SoftBodySkin& skin, const TriangleMesh& mesh, const Vector3d& from, const Vector3d& to) {
  Found best;
  const Vector3d along = (to - from).normalized();
  const double length = (to - from).norm();
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const auto& [ia, ib, ic] = mesh.triangles[t];
    const Vector3d a = corner(skin, ia) - from, b = corner(skin, ib) - from, c = corner(skin, ic) - from;
    const double u = along.dot(b.cross(c)), v = along.dot(c.cross(a)), w = along.dot(a.cross(b));
    if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) || u + v + w == 0) continue;
    const double distance = (u * a + v * b + w * c).dot(along) / (u + v + w);
    if (distance < 0 || distance > length || distance >= best.distance) continue;
    best.triangle = static_cast<int>(t);
    best.distance = distance;
  }
  return best;
}

/// Compares rays with brute force.
void compare(TouchedBody& body, int rays, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-0.7, 1.7);
  int hits = 0;
  for (int r = 0; r < rays; ++r) {
    const Vector3d from(number(random), number(random), number(random)),
        to(number(random), number(random), number(random));
    const btVector3 a = toBullet(from), b = toBullet(to);
    const SurfaceHit hit = body.tree.raycast(body.skin, a, b);
    const Found wanted = bruteForce(body.skin, body.model.mesh, toEigen(a), toEigen(b));
    ASSERT_EQ(static_cast<bool>(hit), wanted.triangle >= 0) << r;
    if (!hit) continue;
    ++hits;
    ASSERT_NEAR(static_cast<double>(hit.distance), wanted.distance, 1e-6) << r;
    if (hit.triangle == wanted.triangle) continue;
    // The ray then hits two triangles at once, at their common edge.
    ASSERT_LT(std::min({hit.weights[0], hit.weights[1], hit.weights[2]}), 1e-6) << r;
  }
  EXPECT_GT(hits, rays / 10);
}

TEST(SurfaceTree, MeetsWhatBruteForceMeetsAtDeformedStates) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  for (int state = 0; state < 5; ++state) {
    deform(body.body(), 0.06);
    ASSERT_EQ(body.skin.update(), StatusCode::Ok);
    compare(body, 2000, static_cast<unsigned>(state));
  }
}

TEST(SurfaceTree, MeetsQuadraticSurfacesAsTheyAreDrawn) {
  auto world = deformableWorld();
  BindingOptions quadratic;
  quadratic.interpolation = Interpolation::Quadratic;
  TouchedBody body(*world, TouchModel(0.55), {}, quadratic);
  deform(body.body(), 0.1);
  ASSERT_EQ(body.skin.update(), StatusCode::Ok);
  compare(body, 1000, 9);
  const SurfaceHit hit = body.tree.raycast(body.skin, btVector3(btScalar(0.53), 3, btScalar(0.48)),
                                           btVector3(btScalar(0.5), -3, btScalar(0.5)));
  ASSERT_TRUE(hit);
  const SurfacePoint point = body.tree.pointAt(body.body(), hit).value();
  EXPECT_LT((*point.position(body.skin) - hit.point).length(), 1e-5);
  EXPECT_GT((*point.position() - hit.point).length(), 1e-4);
}

TEST(SurfaceTree, TellsThePointTheNormalAndTheWeights) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  deform(body.body());
  const btVector3 from(btScalar(0.41), 3, btScalar(0.57)), to(btScalar(0.45), -3, btScalar(0.52));
  const SurfaceHit hit = body.tree.raycast(body.skin, from, to);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.body, &body.body());
  EXPECT_LT((from + (to - from).normalized() * hit.distance - hit.point).length(), 2e-6);
  const SurfacePoint point = body.tree.pointAt(body.body(), hit).value();
  EXPECT_LT((*point.position() - hit.point).length(), 2e-6);
  EXPECT_GT(point.frame()->normal.dot(hit.normal), 0.97);  // the first normal is smooth, the second is the facet's
  EXPECT_GT(hit.normal.y(), 0.5);
}

TEST(SurfaceTree, ServesHiddenSkinsOtherTargetsOrdersAndOrigins) {
  auto world = deformableWorld();
  BindingOptions sorted;
  sorted.order = VertexOrder::Sorted;
  TouchedBody body(*world, TouchModel(), {}, sorted);
  std::vector<Eigen::Vector3f> buffer(body.model.mesh.vertexCount());
  SoftBodySkin other;
  InstanceOptions elsewhere;
  elsewhere.target = viewOf(buffer);
  elsewhere.origin = Vector3d(100, 0, 0);
  ASSERT_TRUE(other.bind(body.body(), body.binding, elsewhere).ok());
  other.setVisible(false);
  deform(body.body());
  SoftBodySkin plain;
  ASSERT_TRUE(plain.bind(body.body(), body.model.cage, body.model.mesh).ok());
  const SurfaceTree plainTree = SurfaceTree::create(plain.binding(), body.model.mesh).value();
  const btVector3 from(btScalar(0.41), 3, btScalar(0.57)), to(btScalar(0.45), -3, btScalar(0.52));
  const SurfaceHit hit = body.tree.raycast(other, from, to), wanted = plainTree.raycast(plain, from, to);
  ASSERT_TRUE(hit && wanted);
  EXPECT_EQ(hit.triangle, wanted.triangle);
  EXPECT_NEAR(hit.distance, wanted.distance, 1e-6);
}

TEST(SurfaceTree, FollowsBodiesOfOneBindingInTurn) {
  auto world = deformableWorld();
  TouchedBody first(*world);
  const auto second = added(*world, first.model.cage);
  for (int n = 0; n < second->body().m_nodes.size(); ++n)
    second->body().m_nodes[n].m_x.setX(second->body().m_nodes[n].m_x.x() + 4);
  SoftBodySkin skin;
  ASSERT_TRUE(skin.bind(second->body(), first.binding).ok());
  for (int turn = 0; turn < 3; ++turn) {
    const btScalar x = btScalar(0.5);
    EXPECT_TRUE(first.tree.raycast(first.skin, btVector3(x, 3, x), btVector3(x, -3, x)));
    EXPECT_FALSE(first.tree.raycast(skin, btVector3(x, 3, x), btVector3(x, -3, x)));
    const SurfaceHit hit = first.tree.raycast(skin, btVector3(x + 4, 3, x), btVector3(x + 4, -3, x));
    EXPECT_EQ(hit.body, &second->body());
    EXPECT_FALSE(first.tree.pointAt(first.body(), hit).ok());  // hit of another body
  }
}

TEST(SurfaceTree, LetsRaysPassWhatAFilterLeavesOut) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  const btVector3 from(btScalar(0.51), 3, btScalar(0.52)), to(btScalar(0.51), -3, btScalar(0.52));
  const SurfaceHit first = body.tree.raycast(body.skin, from, to);
  const SurfaceHit second = body.tree.raycast(body.skin, from, to, [&](int t) { return t != first.triangle; });
  ASSERT_TRUE(first && second);
  EXPECT_NE(first.triangle, second.triangle);
  EXPECT_NEAR(second.distance - first.distance, 0.76, 0.03);  // after passing through the ball
  EXPECT_FALSE(body.tree.raycast(body.skin, from, to, [](int) { return false; }));
}

TEST(SurfaceTree, SaysWhyARayMeetsNothing) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  const btVector3 from(btScalar(0.5), 3, btScalar(0.5)), to(btScalar(0.5), -3, btScalar(0.5));
  EXPECT_EQ(body.tree.raycast(body.skin, from, btVector3(3, 3, 3)).status, StatusCode::NoHit);
  EXPECT_EQ(body.tree.raycast(body.skin, from, from).status, StatusCode::NoHit);
  EXPECT_EQ(body.tree.raycast({}, from, to).status, StatusCode::Unbound);
  SoftBodySkin other;
  ASSERT_TRUE(other.bind(body.body(), body.model.cage, body.model.mesh).ok());
  EXPECT_EQ(body.tree.raycast(other, from, to).status, StatusCode::OtherBody);
  EXPECT_EQ(body.tree.raycast(body.skin, btVector3(NAN, 0, 0), to).status, StatusCode::NonFinite);
  body.body().m_nodes[7].m_x.setX(NAN);
  EXPECT_EQ(body.tree.raycast(body.skin, from, to).status, StatusCode::NonFinite);
  body.body().m_nodes[7].m_x.setX(0);
  EXPECT_TRUE(body.tree.raycast(body.skin, from, to));
}

TEST(SurfaceTree, RefusesWhatIsNoSurface) {
  const TouchModel model;
  const auto binding = model.bind();
  EXPECT_EQ(SurfaceTree::create(nullptr, model.mesh).status().code, StatusCode::Empty);
  TriangleMesh points = model.mesh;
  points.triangles.clear();
  EXPECT_EQ(SurfaceTree::create(binding, points).status().code, StatusCode::Empty);
  EXPECT_EQ(SurfaceTree::create(binding, sphere(5, 0.3, {0, 0, 0})).status().code, StatusCode::SizeMismatch);
  EXPECT_TRUE(SurfaceTree::create(binding, model.mesh).ok());
}

TEST(SurfaceTree, MakesNoPointsOfWhatIsNotThere) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  EXPECT_EQ(body.tree.pointAtVertex(body.body(), -1).status().code, StatusCode::IndexOutOfRange);
  EXPECT_EQ(body.tree.pointAtVertex(body.body(), 1 << 30).status().code, StatusCode::IndexOutOfRange);
  EXPECT_EQ(body.tree.pointAt(body.body(), {}).status().code, StatusCode::InvalidOption);
  EXPECT_EQ(body.tree.pointAtRest(body.body(), {NAN, 0, 0}).status().code, StatusCode::NonFinite);
  EXPECT_EQ(body.tree.pointAtRest(body.body(), {1e200, 0, 0}).status().code, StatusCode::NonFinite);
  const auto small = added(*world, smallCageAbove(5));
  EXPECT_EQ(body.tree.pointAtVertex(small->body(), 0).status().code, StatusCode::SizeMismatch);
}

TEST(SurfaceTree, MakesNoPointsOfWeightsThatDoNotAddUp) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  SurfaceHit hit;
  hit.status = StatusCode::Ok;
  hit.body = &body.body();
  hit.triangle = 0;
  const auto codeOf = [&](btScalar a, btScalar b, btScalar c) {
    hit.weights[0] = a;
    hit.weights[1] = b;
    hit.weights[2] = c;
    return body.tree.pointAt(body.body(), hit).status().code;
  };
  const btScalar nan = std::numeric_limits<btScalar>::quiet_NaN(), infinite = std::numeric_limits<btScalar>::infinity();
  EXPECT_EQ(codeOf(nan, 0, 1), StatusCode::InvalidOption);
  EXPECT_EQ(codeOf(1, 0, nan), StatusCode::InvalidOption);
  EXPECT_EQ(codeOf(infinite, -infinite, 1), StatusCode::InvalidOption);
  EXPECT_EQ(codeOf(1, 1, 1), StatusCode::InvalidOption);
  EXPECT_EQ(codeOf(btScalar(0.25), btScalar(0.25), btScalar(0.5)), StatusCode::Ok);
}

TEST(SurfaceTree, ThatWasMovedFromIsEmpty) {
  auto world = deformableWorld();
  TouchedBody body(*world);
  const SurfaceTree elsewhere(std::move(body.tree));
  EXPECT_TRUE(elsewhere.pointAtVertex(body.body(), 0).ok());
  const SurfaceTree& empty = body.tree;  // NOLINT: moved from
  EXPECT_EQ(empty.raycast(body.skin, btVector3(0, 9, 0), btVector3(0, -9, 0)).status, StatusCode::NoHit);
  EXPECT_EQ(empty.pointAtVertex(body.body(), 0).status().code, StatusCode::Empty);
  EXPECT_EQ(empty.pointAtRest(body.body(), {0, 0, 0}).status().code, StatusCode::Empty);
  EXPECT_EQ(empty.pointAt(body.body(), {}).status().code, StatusCode::Empty);
  EXPECT_NE(empty.applyImpulse(body.body(), {btVector3(0, 0, 0), 1, 1}).status, StatusCode::Ok);
  EXPECT_NE(empty.applyForce(body.body(), {btVector3(0, 0, 0), 1, 1}).status, StatusCode::Ok);
}

TEST(RayTriangle, IsMetFromBothSidesWithinTheRayUnlessItIsFlat) {
  const TriangleCorners triangle = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)};
  const TriangleCorners flat = {triangle[0], Eigen::Vector3d(0.5, 0, 0), triangle[1]};
  const auto collidesWithIt = [](const touch_detail::Ray& ray, const TriangleCorners& corners) {
    touch_detail::RayHit hit;
    return touch_detail::collides(ray, corners, hit) ? hit.at : -1.0;
  };
  EXPECT_NEAR(collidesWithIt({{0.2, 0.3, 1}, {0, 0, -2}}, triangle), 0.5, 1e-12);
  EXPECT_NEAR(collidesWithIt({{0.2, 0.3, -1}, {0, 0, 2}}, triangle), 0.5, 1e-12);
  EXPECT_EQ(collidesWithIt({{0.2, 0.3, 1}, {0, 0, -0.9}}, triangle), -1.0);
  EXPECT_EQ(collidesWithIt({{0.2, 0.3, 1}, {0, 0, 2}}, triangle), -1.0);
  EXPECT_EQ(collidesWithIt({{0.8, 0.3, 1}, {0, 0, -2}}, triangle), -1.0);
  EXPECT_NEAR(collidesWithIt({{0.25, 0, 1}, {0, 0, -2}}, triangle), 0.5, 1e-12) << "on its edge";
  EXPECT_EQ(collidesWithIt({{0.25, 0, 1}, {0, 0, -2}}, flat), -1.0);
}

}  // namespace
}  // namespace tetskin::test
