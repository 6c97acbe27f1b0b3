// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "reduced_test.h"

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/elastic/elastic_body.h>

#include <Eigen/LU>

namespace tetskin {
namespace {

using namespace test;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

Vector3d toEigen(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// The inverse inertia, which gives the angular velocity for an angular impulse.
Matrix3d inverseInertia(btReducedDeformableBody& body) {
  Matrix3d result;
  for (int k = 0; k < 3; ++k) {
    btVector3 push(0, 0, 0);
    push[k] = 1;
    body.setRigidAngularVelocity(btVector3(0, 0, 0));
    body.applyTorqueImpulse(push);
    result.col(k) = toEigen(body.getAngularVelocity());
  }
  return result;
}

TEST(ReducedMotion, HasTheMassAndInertiaOfTheFineTets) {
  World world;
  const auto body = added(world, barModes());
  EXPECT_NEAR(body->body().getTotalMass(), 2.0 * 0.5, 1e-5);
  Matrix3d inertia = Matrix3d::Zero();
  for (std::size_t n = 0; n < barModes().nodeCount(); ++n) {
    const Vector3d& p = barModes().nodes[n];
    inertia += 2.0 * barModes().masses[n] * (p.squaredNorm() * Matrix3d::Identity() - p * p.transpose());
  }
  const Matrix3d ratio = inertia * inverseInertia(body->body());
  EXPECT_LT((ratio - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.01);
}

TEST(ReducedMotion, FallsAsABody) {
  World world;
  const auto body = added(world, barModes());
  const double before = lowest(body->body());
  world.step(120);
  EXPECT_NEAR(lowest(body->body()) - before, -0.5 * 10 * 0.25 * (1 + 1.0 / 120), 1e-4);
}

TEST(ReducedMotion, SpinsOnWithoutGravity) {
  World world(btVector3(0, 0, 0));
  const auto body = added(world, barModes());
  body->body().setRigidAngularVelocity(btVector3(0, 0, 2));
  world.step(240);
  EXPECT_NEAR(body->body().getAngularVelocity().z(), 2.0, 1e-4);
  EXPECT_TRUE(allFinite(body->body()));
}

/// The fine tets, stepped by symplectic Euler so that energy and timing are right, with forces of the library's own
/// tets.
class FineBar {
 public:
  explicit FineBar(const ReducedBodyOptions& options, const VibrationModes& modes)
      : masses_(modes.masses), density_(options.density), pinned_(modes.pinned) {
    ElasticOptions elastic;
    elastic.youngsModulus = options.youngsModulus.value();
    elastic.poissonRatio = modes.poissonRatio;
    elastic.density = options.density;
    body_ = std::move(ElasticBody<double>::create(fineBar(), elastic)).value();
  }
  PointView<double> velocities() { return body_.velocities(); }
  void step(double seconds, const Vector3d& gravity) {
    const std::vector<std::array<double, 3>> forces = body_.forces();
    const PointView<double> x = body_.positions(), v = body_.velocities();
    for (std::size_t n = 0; n < forces.size(); ++n) {
      for (std::size_t k = 0; k < 3; ++k) {
        v[n][k] += seconds * (forces[n][k] / (density_ * masses_[n]) + gravity[static_cast<Eigen::Index>(k)]);
      }
    }
    for (const int n : pinned_) std::fill_n(v[static_cast<std::size_t>(n)], 3, 0.0);
    for (std::size_t n = 0; n < forces.size(); ++n) {
      for (std::size_t k = 0; k < 3; ++k) x[n][k] += seconds * v[n][k];
    }
  }
  Vector3d displacement(std::size_t n) { return Eigen::Map<const Vector3d>(body_.positions()[n]) - fineBarNodes()[n]; }

 private:
  static const std::vector<Vector3d>& fineBarNodes() {
    static const std::vector<Vector3d> nodes = fineBar().nodes;
    return nodes;
  }

  std::vector<double> masses_;
  double density_;
  std::vector<int> pinned_;
  ElasticBody<double> body_;
};

/// Compares, over the period of the softest mode, the skin of all fine nodes in the cage with the fine tets themselves.
/// Returns the root mean square of the difference over nodes and frames, relative to that of the displacement.
double errorOver(World& world, ReducedBody& body, FineBar& fine, const Vector3d& gravity, double period) {
  SoftBodySkin skin;
  const TetMesh bar = fineBar();
  EXPECT_TRUE(skin.bind(body.body(), barCage(), viewOf(bar.nodes)).ok());
  constexpr int kFineSteps = 4;
  constexpr double kStep = 1.0 / 960.0;
  double difference = 0.0, all = 0.0, largest = 0.0;
  for (int k = 0; k < static_cast<int>(std::lround(period / kStep)); ++k) {
    world.step(1, kStep);
    for (int s = 0; s < kFineSteps; ++s) fine.step(kStep / kFineSteps, gravity);
    EXPECT_EQ(skin.update(), StatusCode::Ok);
    for (std::size_t n = 0; n < bar.nodeCount(); ++n) {
      const Vector3d right = fine.displacement(n);
      const Vector3d ours = Eigen::Map<const Eigen::Matrix<btScalar, 3, 1>>(skin.positions()[n]).cast<double>();
      difference += (ours - bar.nodes[n] - right).squaredNorm();
      all += right.squaredNorm();
      largest = std::max(largest, right.norm());
    }
  }
  EXPECT_GT(largest, 1e-3) << "of a size of 2";
  EXPECT_LT(largest, 3e-3);
  return std::sqrt(difference / all);
}

TEST(ReducedMotion, OfACantileverIsThatOfItsTetsWhereItIsSmall) {
  const VibrationModes& modes = barModes(true);
  ReducedBodyOptions options = barOptions();
  options.stiffnessDamping = 0.0;
  options.timeStep = 1.0 / 960.0;
  const double omega = modes.frequencies(*options.youngsModulus, options.density)[0];
  // About twice the deflection at rest, which is g over the squared frequency.
  const Vector3d gravity(0.0, -0.6e-3 * omega * omega, 0.3e-3 * omega * omega);
  World world(btVector3(0, static_cast<btScalar>(gravity.y()), static_cast<btScalar>(gravity.z())));
  const auto body = added(world, modes, options);
  FineBar fine(options, modes);
  EXPECT_LT(errorOver(world, *body, fine, gravity, 2 * kPi / omega), 0.02);
}

TEST(ReducedMotion, OfAFreeBarIsThatOfItsTetsWhereItIsSmall) {
  const VibrationModes& modes = barModes();
  ReducedBodyOptions options = barOptions();
  options.stiffnessDamping = 0.0;
  options.timeStep = 1.0 / 960.0;
  World world(btVector3(0, 0, 0));
  const auto body = added(world, modes, options);
  FineBar fine(options, modes);
  const double omega = modes.frequencies(*options.youngsModulus, options.density)[0];
  // Four modes start at once; in Bullet's body this sets the velocities that it uses as those before the step.
  for (std::size_t r = 0; r < 4; ++r) {
    const double speed = 0.6e-3 * omega / (1.0 + r);
    for (std::size_t n = 0; n < modes.nodeCount(); ++n) {
      for (std::size_t k = 0; k < 3; ++k) fine.velocities()[n][k] += speed * modes.shapes[r][3 * n + k];
    }
    body->body().m_reducedVelocityBuffer[static_cast<int>(r)] =
        static_cast<btScalar>(speed * std::sqrt(options.density));
  }
  EXPECT_LT(errorOver(world, *body, fine, Vector3d::Zero(), 2 * kPi / omega), 0.02);
}

TEST(ReducedMotion, OfAHeldBodyEndsWhereItsTetsWouldHang) {
  World world;
  const auto body = added(world, barModes(true));
  const double before = lowest(body->body());
  world.step(2400);
  // Euler's deflection under its own weight, with a small addition for shear: rho g A L^4 / (8 E I).
  const double expected = 2.0 * 10 * 16 / (8 * 2000 * (0.25 / 12)) * 1.0;
  EXPECT_NEAR((before - lowest(body->body())) / expected, 1.0, 0.12);
  for (int n = 0; n < body->body().m_nodes.size(); ++n) {
    if (barCage().mesh.nodes[static_cast<std::size_t>(n)].x() > -1.01) continue;
    EXPECT_LT((nodeOf(body->body(), n) - barCage().mesh.nodes[static_cast<std::size_t>(n)]).norm(), 0.03);
  }
}

TEST(ReducedMotion, OfATurnedHeldBodyBendsByGravityInTheWorld) {
  World world;
  // The body is upside down, so it bends the other way in its own frame.
  const auto body =
      added(world, barModes(true), barOptions(btTransform(btQuaternion(btVector3(1, 0, 0), btScalar(kPi)))));
  const double before = lowest(body->body());
  world.step(1200);
  EXPECT_LT(lowest(body->body()), before - 0.5);
}

TEST(ReducedMotion, IsDampedAtFrequenciesThatBulletsDampingDoesNotBear) {
  World world(btVector3(0, 0, 0));
  ReducedBodyOptions options = barOptions();
  options.stiffnessDamping = 1.0;
  const auto body = added(world, barModes(), options);
  ASSERT_GT(body->report().maxFrequency / 240, 0.3);
  for (int r = 0; r < body->body().m_nReduced; ++r) body->body().m_reducedVelocityBuffer[r] = btScalar(0.1);
  world.step(1200);
  EXPECT_TRUE(allFinite(body->body()));
  for (int r = 0; r < body->body().m_nReduced; ++r) EXPECT_LT(std::abs(body->body().m_reducedVelocity[r]), 0.01);
}

TEST(ReducedMotion, OfTheSameBodyElsewhereIsTheSame) {
  World world, other;
  const btTransform placement(btQuaternion(btVector3(0, 1, 0), btScalar(0.7)), btVector3(3, 5, -2));
  const auto here = added(world, barModes()), there = added(other, barModes(), barOptions(placement));
  here->body().m_reducedVelocityBuffer[0] = there->body().m_reducedVelocityBuffer[0] = btScalar(0.2);
  world.step(60);
  other.step(60);
  for (int n = 0; n < here->body().m_nodes.size(); ++n) {
    EXPECT_LT((placement * here->body().m_nodes[n].m_x - there->body().m_nodes[n].m_x).length(), 1e-4);
  }
}

TEST(ReducedMotion, PlacesABodyElsewhereAsItIsBent) {
  World world;
  const auto body = added(world, barModes());
  body->body().m_reducedVelocityBuffer[0] = btScalar(0.5);
  world.step(20);
  std::vector<btVector3> bent;
  for (int n = 0; n < body->body().m_nodes.size(); ++n) bent.push_back(body->body().m_nodes[n].m_x);
  body->setPlacement(at(4, 4, 4));
  for (int n = 1; n < body->body().m_nodes.size(); ++n) {
    const btVector3 before = bent[static_cast<std::size_t>(n)] - bent[0];
    EXPECT_LT((body->body().m_nodes[n].m_x - body->body().m_nodes[0].m_x - before).length(), 1e-5);
  }
  const double y = lowest(body->body());
  world.step(1);
  EXPECT_NEAR(lowest(body->body()), y, 1e-2);
}

/// The farthest motion in the first half second.
double farthestOf(World& world, ReducedBody& body) {
  double farthest = 0.0;
  for (int k = 0; k < 30; ++k) {
    world.step(4);
    for (int n = 0; n < body.body().m_nodes.size(); ++n) farthest = std::max(farthest, nodeOf(body.body(), n).norm());
  }
  return farthest;
}

/// The pinned end is flush with a wall or inside it: contacts of parts that cannot move have no effect.
TEST(ReducedMotion, OfABarThatIsHeldInAWallIsThatOfOneInTheAir) {
  for (const int modes : {5, 20}) {
    ReducedBodyOptions options = barOptions();
    options.modeCount = modes;
    World air;
    const auto alone = added(air, barModes(true), options);
    const double expected = farthestOf(air, *alone);
    for (const double depth : {0.0, 0.03}) {
      World world;
      const Rigid wall(*world.world, std::make_unique<btBoxShape>(btVector3(btScalar(0.5), 1, 1)), 0,
                       at(-1.52 + depth, 0, 0));
      const auto body = added(world, barModes(true), options);
      EXPECT_NEAR(farthestOf(world, *body), expected, 1e-3) << modes << " " << depth;
    }
  }
}

}  // namespace
}  // namespace tetskin
