// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The claims about ElasticBody at their limits: stiff and light, spinning, turned at once, pinned and led.
#include <tetskin/elastic/elastic_body.h>

#include <limits>

#include "elastic_motion.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

/// A slender bar about 1 m long, aligned with no axis of the world.
TetMesh obliqueBar() {
  TetMesh bar = jittered(latticeCage(6, 1, 1), 0.1, 3);
  for (Vector3d& p : bar.nodes) p = turnBy(33.0, {1, 2, 3}) * (p / 6.0);
  return bar;
}

TetMesh block() {
  TetMesh cube = jittered(latticeCage(3, 3, 3), 0.1, 4);
  for (Vector3d& p : cube.nodes) p /= 3.0;
  return cube;
}

/// Of quadratic tets.
Cage quadraticBlock() {
  TetMesh cube = jittered(latticeCage(2, 2, 2), 0.1, 4);
  for (Vector3d& p : cube.nodes) p /= 2.0;
  return refineQuadratic(cube).value();
}

template <class S>
void spin(ElasticBody<S>& body, const Vector3d& rate, const Vector3d& drift) {
  Points v = pointsOf(body.positions());
  for (Vector3d& p : v) p = drift + rate.cross(p);
  fill(body.velocities(), v);
}

template <class S>
class ElasticClaimsOf : public WithScalar<S> {
 protected:
  /// The rounding of positions appears as this fraction of E V.
  static constexpr double kRounding = sizeof(S) == sizeof(float) ? 1e-11 : 1e-27;
};
TYPED_TEST_SUITE(ElasticClaimsOf, Scalars);

TYPED_TEST(ElasticClaimsOf, SpinningFreelyKeepsMomentumAndGainsNoEnergyFromSoftToStiff) {
  struct Case {
    double youngsModulus, density, damping, rate, seconds, tolerance;
  };
  // Every pair of values occurs.
  const Case cases[] = {
      {1, 2, 0, 0.1, 1.0 / 60, 5e-3},       {1, 1000, 0.02, 1, 1.0 / 240, 1e-6},
      {1e3, 2, 0.02, 10, 1.0 / 1000, 5e-3}, {1e3, 1000, 0, 1, 1.0 / 60, 1e-6},
      {1e5, 2, 0.02, 1, 1.0 / 240, 5e-3},   {1e5, 1000, 0, 10, 1.0 / 60, 1e-6},
      {1e7, 2, 0, 10, 1.0 / 240, 1e-6},     {1e7, 1000, 0.02, 0.1, 1.0 / 1000, 1e-6},
      {1e8, 2, 0.02, 1, 1.0 / 240, 5e-3},   {1e9, 2, 0.02, 10, 1.0 / 60, 5e-3},
      {1e9, 2, 0, 1, 1.0 / 1000, 1e-6},     {1e9, 2, 0.02, 0.1, 1.0 / 240, 1e-6},
      {1e9, 1000, 0, 10, 1.0 / 240, 5e-3},  {1e11, 2, 0, 1, 1.0 / 60, 5e-3},
  };
  for (const Cage& of : {Cage(obliqueBar()), Cage(block()), quadraticBlock()}) {
    const TetMesh& cage = of.mesh;
    const double volume = totalVolume(cage);
    for (const Case& c : cases) {
      ElasticOptions options;
      options.youngsModulus = c.youngsModulus;
      options.density = c.density;
      options.stiffnessDamping = c.damping;
      options.tolerance = c.tolerance;
      options.maxIterations = c.tolerance < 1e-3 ? 2000 : 200;
      std::vector<double> masses = lumped(cage);
      for (double& m : masses) m *= c.density;
      ElasticBody<TypeParam> body = made<TypeParam>(of, options);
      spin(body, c.rate * Vector3d(1, 1, 0.3).normalized(), {0.1, -0.2, 0.05});
      const Motion before = motionOf(body, masses);
      const double chord = 1.0 / std::pow(std::cos(0.5 * c.rate * c.seconds), 2);
      const double maximum = 1.02 * chord * before.kinetic + this->kRounding * c.youngsModulus * volume;
      for (int k = 0; k < 300; ++k) {
        body.step(c.seconds);
        const Motion now = motionOf(body, masses);
        ASSERT_LT(now.kinetic + body.energy(), maximum + 1e-3 * this->kRounding / 1e-11 * before.kinetic)
            << c.youngsModulus << " Pa, " << c.density << " kg/m3, " << c.rate << " rad/s, step " << k;
        ASSERT_LT((now.momentum - before.momentum).norm(), 1e-4 * before.momentum.norm());
        ASSERT_LT((now.angular - before.angular).norm(), 1e-3 * before.angular.norm());
      }
    }
  }
}

/// No rigid motion along straight lines turns so fast: bodies swell, but conserve their momenta.
TYPED_TEST(ElasticClaimsOf, KeepsAngularMomentumBeyondOneRadianPerStep) {
  const TetMesh cage = block();
  for (const double youngsModulus : {1e3, 1e6, 1e9}) {
    for (const double rate : {65.0, 200.0}) {
      ElasticOptions options;
      options.youngsModulus = youngsModulus;
      ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
      spin(body, {0, 0, rate}, {0, 0, 0});
      const Motion before = motionOf(body, lumped(cage));
      for (int k = 0; k < 120; ++k) body.step(1.0 / 60);
      const Motion after = motionOf(body, lumped(cage));
      EXPECT_LT((after.angular - before.angular).norm(), 1e-4 * before.angular.norm()) << youngsModulus << " " << rate;
    }
  }
}

TYPED_TEST(ElasticClaimsOf, ABodyTurnedAtOnceStaysAtRest) {
  Random random(71);
  std::vector<Vector3d> axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}};
  for (int k = 0; k < 4; ++k) axes.push_back(random.vector());
  const auto turnAbout = [&](const Cage& cage) {
    for (const double youngsModulus : {500.0, 1e8}) {
      ElasticOptions options;
      options.youngsModulus = youngsModulus;
      ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
      for (const Vector3d& axis : axes) {
        for (const double degrees : {180.0, 179.9, 90.0, 123.0}) {
          Points turned = pointsOf(body.positions());
          for (Vector3d& p : turned) p = turnBy(degrees, axis) * p + Vector3d(1, -1, 0.5) * (degrees < 100.0 ? 1 : -1);
          fill(body.positions(), turned);
          for (int k = 0; k < 3; ++k) body.step(1.0 / 240);
          // The speed that the rounding of positions causes in one step.
          ASSERT_LT(fastest(body), 1e3 * this->kEpsilon * 240.0) << degrees << " about " << axis.transpose();
          fill(body.velocities(), Points(cage.mesh.nodeCount(), Vector3d::Zero()));
        }
      }
    }
  };
  for (const Cage& cage : {Cage(block()), quadraticBlock()}) onEachInstructionSet([&] { turnAbout(cage); });
}

TYPED_TEST(ElasticClaimsOf, ABodyOnAnAxleGoesOnTurningAtAnyStiffness) {
  const TetMesh cage = latticeCage(2, 2, 2);  // turns about its middle, along z
  for (const double youngsModulus : {1e4, 1e9}) {
    ElasticOptions options;
    options.youngsModulus = youngsModulus;
    ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
    Points v;
    for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
      const Vector3d arm = cage.nodes[n] - Vector3d(1, 1, 0);
      if (arm.head<2>().norm() < 1e-9) body.setPinned(n);
      v.push_back(Vector3d(0, 0, 3.0).cross(arm));
    }
    fill(body.velocities(), v);
    const auto spinAbout = [&] {
      double sum = 0.0;
      const Points x = pointsOf(body.positions()), now = pointsOf(body.velocities());
      const std::vector<double> masses = lumped(cage);
      for (std::size_t n = 0; n < x.size(); ++n) sum += masses[n] * (x[n] - Vector3d(1, 1, 0)).cross(now[n]).z();
      return sum;
    };
    const double before = spinAbout();
    for (int k = 0; k < 480; ++k) body.step(1.0 / 240);
    EXPECT_NEAR(spinAbout(), before, 1e-3 * before) << youngsModulus;
    EXPECT_LT(fastest(body), 1.1 * 3.0 * std::sqrt(2.0)) << youngsModulus;
  }
}

/// The body is turned by its pinned nodes, through a full turn.
TYPED_TEST(ElasticClaimsOf, ABodyThatIsTurnedByItsHeldNodesFollowsUnstrained) {
  const TetMesh cage = latticeCage(3, 1, 1);
  for (const double youngsModulus : {1e4, 1e9}) {
    ElasticOptions options;
    options.youngsModulus = youngsModulus;
    options.stiffnessDamping = 0.02;
    ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
    pinTheEnd(body, cage);
    const double degrees = 3.0;
    for (int k = 1; k <= 120; ++k) {
      const auto at = [&](int step, const Vector3d& p) -> Vector3d { return turnBy(degrees * step, {0, 0, 1}) * p; };
      for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
        if (cage.nodes[n].x() != 0.0) continue;
        const Vector3d v = 240.0 * (at(k, cage.nodes[n]) - at(k - 1, cage.nodes[n]));
        for (int i = 0; i < 3; ++i) body.velocities()[n][i] = static_cast<TypeParam>(v[i]);
      }
      body.step(1.0 / 240);
      ASSERT_LT(fastest(body), 2.0 * 240.0 * 3.5 * degrees * 3.14159265358979323846 / 180.0)
          << youngsModulus << " Pa, step " << k;
    }
    const Points end = pointsOf(body.positions());
    double off = 0.0;
    for (std::size_t n = 0; n < end.size(); ++n) off = std::max(off, (end[n] - cage.nodes[n]).norm());
    EXPECT_LT(off, youngsModulus > 1e6 ? 1e-2 : 3.0) << youngsModulus;
  }
}

/// Each component moves as a separate rigid body.
TYPED_TEST(ElasticClaimsOf, PartsThatShareNoNodeSpinByThemselves) {
  TetMesh cage = block();
  const auto first = static_cast<int>(cage.nodeCount());
  const std::vector<Tet> tets = cage.tets;
  for (int n = 0; n < first; ++n) cage.nodes.push_back(cage.nodes[static_cast<std::size_t>(n)] + Vector3d(3, 0, 0));
  for (const Tet& t : tets) cage.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
  ElasticOptions options;
  options.youngsModulus = 1e9;
  ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
  Points v;
  for (int n = 0; n < 2 * first; ++n) {
    const Vector3d& p = cage.nodes[static_cast<std::size_t>(n)];
    v.push_back(n < first ? Vector3d(0, 0, 5).cross(p) : Vector3d(0, -7, 0).cross(p - Vector3d(3, 0, 0)));
  }
  fill(body.velocities(), v);
  const Motion before = motionOf(body, lumped(cage));
  for (int k = 0; k < 240; ++k) body.step(1.0 / 60);
  const Motion after = motionOf(body, lumped(cage));
  EXPECT_NEAR(after.kinetic, before.kinetic, 0.02 * before.kinetic);
  EXPECT_LT((after.angular - before.angular).norm(), 1e-3 * before.angular.norm());
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-4 * before.angular.norm());
}

TYPED_TEST(ElasticClaimsOf, RefusesWhatIsTooStiffForItsMassWithTheNumber) {
  const TetMesh cage = block();
  const double maximum =
      (sizeof(TypeParam) == sizeof(float) ? 1e12 : 1e16) * 2.0 * std::pow(totalVolume(cage), 2.0 / 3.0);
  ElasticOptions options;
  options.density = 2.0;
  options.youngsModulus = 0.99 * maximum;
  EXPECT_TRUE(ElasticBody<TypeParam>::create(cage, options).ok());
  options.youngsModulus = 1.01 * maximum;
  const Status status = ElasticBody<TypeParam>::create(cage, options).status();
  EXPECT_EQ(status.code, StatusCode::InvalidOption);
  EXPECT_NE(status.message.find("at most"), std::string::npos) << status.message;
  options.youngsModulus = 0.99 * maximum;
  options.stiffnessDamping = 1.0;
  EXPECT_EQ(ElasticBody<TypeParam>::create(cage, options).status().code, StatusCode::InvalidOption);
}

TYPED_TEST(ElasticClaimsOf, StandsStillInAStepThatIsNone) {
  const TetMesh cage = block();
  ElasticOptions options;
  options.youngsModulus = 1e4;
  ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
  spin(body, {0, 0, 1}, {1, 0, 0});
  const Points before = pointsOf(body.positions());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double seconds : {0.0, -1.0, nan, kInfinity}) EXPECT_EQ(body.step(seconds), 0);
  EXPECT_EQ(body.step(0.01, {0, nan, 0}), 0);
  EXPECT_EQ(pointsOf(body.positions()), before);
}

}  // namespace
}  // namespace tetskin::test
