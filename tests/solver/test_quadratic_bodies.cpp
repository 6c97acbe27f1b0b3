// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies of quadratic tets in Bullet, which has the eight linear tets of each.
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/elastic/elastic_body.h>
#include <tetskin/solver/src/forces/forced_bodies.h>

#include "deformable_test.h"

namespace tetskin::test {
namespace {

using bullet_detail::quadraticShapes;
using bullet_detail::restTetsOf;
using bullet_detail::withQuadraticTets;
using elastic_detail::RestTets;

constexpr double kHighUp = 50.0;

/// A bar along x of quadratic tets, far above the ground.
Cage bar() {
  TetMesh mesh = lifted(latticeCage(6, 1, 1, 0.5), kHighUp);
  return refineQuadratic(mesh).value();
}

/// A body of this cage, and its tets as the force takes them.
class QuadraticTets : public testing::Test {
 protected:
  RestTets rest(const std::vector<double>& scale = {}) {
    return withQuadraticTets(restTetsOf(*body).value(), scale, quadraticShapes(cage, {}).value());
  }

  Cage cage = refineQuadratic(jittered(latticeCage(2, 1, 1), 0.1, 3)).value();
  btSoftBodyWorldInfo info;
  std::unique_ptr<btSoftBody> body = createSoftBody(cage, info).value();
};

void expectNear(const std::array<double, 9>& gradients, const std::array<double, 9>& expected, double factor) {
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(gradients[k], factor * expected[k], 1e-5) << k;
}

TEST_F(QuadraticTets, HaveTheRestShapesAndTheMaterialOfTheCage) {
  EXPECT_EQ(static_cast<std::size_t>(body->m_tetras.size()), 8 * 12u);
  const RestTets expected = elastic_detail::restTets(cage, quadraticTets(cage).value()), found = rest();
  EXPECT_EQ(found.count(), 0u);
  ASSERT_EQ(found.quadratic.size(), 12u);
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_EQ(found.quadratic[k].nodes, expected.quadratic[k].nodes);
    EXPECT_EQ(found.quadratic[k].points, expected.quadratic[k].points);
    EXPECT_NEAR(found.quadratic[k].volume, expected.quadratic[k].volume, 1e-6);
    expectNear(found.quadratic[k].gradients, expected.quadratic[k].gradients, 1.0);
  }
}

TEST_F(QuadraticTets, AreFilledAsTheCageSays) {
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    cage.volumeFraction.push_back(0.1 + 0.9 * static_cast<double>(t % 7) / 7.0);
    cage.stiffnessFactor.push_back(0.5);
  }
  const RestTets expected = elastic_detail::restTets(cage, quadraticTets(cage).value()), found = rest();
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_NEAR(found.quadratic[k].volume, expected.quadratic[k].volume, 1e-6);
    EXPECT_EQ(found.quadratic[k].points, expected.quadratic[k].points);
  }
}

TEST_F(QuadraticTets, FollowABodyThatIsMovedAndScaled) {
  const RestTets before = rest();
  body->rotate(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)));
  body->translate(btVector3(5, 6, 7));
  body->scale(btVector3(2, 2, 2));
  const RestTets after = rest();
  ASSERT_EQ(after.quadratic.size(), 12u);
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_NEAR(after.quadratic[k].volume, 8.0 * before.quadratic[k].volume, 1e-4);
    EXPECT_EQ(after.quadratic[k].points, before.quadratic[k].points);
    double squares = 0.0, squaresBefore = 0.0;
    for (const double g : after.quadratic[k].gradients) squares += g * g;
    for (const double g : before.quadratic[k].gradients) squaresBefore += g * g;
    EXPECT_NEAR(squares / squaresBefore, 0.25, 1e-4);
  }
}

TEST_F(QuadraticTets, BecomeLinearOnesWhereTheirEdgesAreStraightNoMore) {
  const QuadraticTet bent = quadraticTets(cage).value()[4];
  body->m_nodes[bent.nodes[7]].m_x += btVector3(0, btScalar(0.1), 0);
  body->initializeDmInverse();
  std::size_t touched = 0;
  const std::vector<QuadraticTet> quadratic = quadraticTets(cage).value();
  for (const QuadraticTet& tet : quadratic) {
    touched += std::count(tet.nodes.begin(), tet.nodes.end(), bent.nodes[7]) > 0;
  }
  ASSERT_LT(touched, 12u);
  const std::vector<double> scale(cage.mesh.tetCount(), 3.0);
  const RestTets linear = restTetsOf(*body).value(), found = rest(scale);
  EXPECT_EQ(found.quadratic.size(), 12u - touched);
  ASSERT_EQ(found.count(), kSubTets * touched);
  const auto same = std::find(linear.tets.begin(), linear.tets.end(), found.tets[0]) - linear.tets.begin();
  EXPECT_EQ(found.gradients[0], linear.gradients[static_cast<std::size_t>(same)]);
  EXPECT_EQ(found.volumes[0], 3.0 * linear.volumes[static_cast<std::size_t>(same)]);
}

TEST_F(QuadraticTets, BecomeLinearOnesWhereTheirTetsAreOthers) {
  std::swap(body->m_tetras[3], body->m_tetras[60]);
  const RestTets found = rest();
  EXPECT_EQ(found.quadratic.size(), 10u);
  EXPECT_EQ(found.count(), 2 * kSubTets);
}

/// How far below the bar the lowest node is when it is held at one end and has come to rest.
double sagInBullet(const Cage& cage, ForceModel model) {
  const auto world = worldFor(model);
  SoftBodyOptions options;
  options.forceModel = model;
  options.density = 100.0;
  options.youngsModulus = 2e5;
  options.solverTolerance = 1e-4;
  options.stiffnessDamping = 0.1;
  options.pinned = [](const Eigen::Vector3d& p) { return p.x() == 0.0; };
  Result<std::unique_ptr<DeformableBody>> body = DeformableBody::add(world->deformable(), cage, options);
  EXPECT_TRUE(body.ok()) << body.status().message;
  body.value()->body().setActivationState(DISABLE_DEACTIVATION);
  step(*world, 300);
  return kHighUp - lowest(body.value()->body());
}

double sagAlone(const Cage& cage) {
  ElasticOptions options;
  options.density = 100.0;
  options.youngsModulus = 2e5;
  options.stiffnessDamping = 0.1;
  auto body = ElasticBody<double>::create(cage, options).value();
  for (std::size_t n = 0; n < body.nodeCount(); ++n) body.setPinned(n, cage.mesh.nodes[n].x() == 0.0);
  for (int k = 0; k < 1200; ++k) body.step(1.0 / 240.0, {0.0, -10.0, 0.0});
  double y = kHighUp;
  for (std::size_t n = 0; n < body.nodeCount(); ++n) y = std::min(y, body.positions()[n][1]);
  return kHighUp - y;
}

TEST(QuadraticBodies, SagInBulletAsByThemselvesAndNotAsTheirLinearTets) {
  const double quadratic = sagAlone(bar()), linear = sagAlone(bar().mesh);
  ASSERT_GT(quadratic, 1.15 * linear);
  EXPECT_NEAR(sagInBullet(bar(), ForceModel::Corotated) / quadratic, 1.0, 0.01);
  EXPECT_NEAR(sagInBullet(bar().mesh, ForceModel::Corotated) / linear, 1.0, 0.01);
}

TEST(QuadraticBodies, AreLinearOnesForBulletsOwnForces) {
  EXPECT_EQ(sagInBullet(bar(), ForceModel::NeoHookean), sagInBullet(bar().mesh, ForceModel::NeoHookean));
}

TEST(QuadraticBodies, AreRefusedWhereTheirTetsAreNoRefinement) {
  TetskinWorld world;
  Cage cage = bar();
  std::swap(cage.quadraticTet[0], cage.quadraticTet[100]);
  EXPECT_EQ(DeformableBody::add(world.deformable(), cage).status().code, StatusCode::InvalidOption);
}

/// The right end of a beam with edges of 5 cm after a quarter of a second, in lengths of the beam, created at a place
/// along x and z.
double fallOfABeamAt(double place, bool quadratic) {
  const double edge = 0.05;
  Cage cage;
  cage.mesh = latticeCage(8, 1, 1, edge);
  if (quadratic) cage = refineQuadratic(cage.mesh).value();
  const std::vector<Eigen::Vector3d> rest = cage.mesh.nodes;
  for (Eigen::Vector3d& p : cage.mesh.nodes) p += Eigen::Vector3d(place, 0, place);
  tetskin::DeformableWorld world;
  SoftBodyOptions options;
  options.density = 100.0;
  options.youngsModulus = 1e5;
  options.pinned = [&](const Eigen::Vector3d& p) { return p.x() < place + 0.1 * edge; };
  const auto body = DeformableBody::add(world, cage, options).value();
  for (int k = 0; k < 60; ++k) world.stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
  double fallen = 0.0, count = 0.0;
  for (std::size_t n = 0; n < rest.size(); ++n) {
    if (rest[n].x() < 7.9 * edge) continue;
    fallen += rest[n].y() - static_cast<double>(body->body().m_nodes[static_cast<int>(n)].m_x.y());
    ++count;
  }
  return fallen / count / (8 * edge);
}

/// In float, positions are rounded to 4 mm at the last place: the rest shapes are the cage's all the same.
TEST(QuadraticBodies, BendAsMuchWhereverTheyAreCreated) {
  for (const bool quadratic : {true, false}) {
    const double near = fallOfABeamAt(0.0, quadratic);
    EXPECT_GT(near, 0.02);
    for (const double place : {5e3, 2e4, 6e4}) {
      EXPECT_NEAR(fallOfABeamAt(place, quadratic), near, 0.01 * near) << quadratic << ' ' << place;
    }
  }
}

}  // namespace
}  // namespace tetskin::test
