// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Passive fibres, by exact solutions.
#include <tetskin/elastic/elastic_body.h>

#include <array>
#include <cmath>
#include <random>

#include "elastic_motion.h"
#include "support/bars.h"

namespace tetskin::test {
namespace {

constexpr double kMatrix = 1e5, kFrameOfFibres = 1.0 / 60.0, kSection = 0.0625;  // Young's modulus; seconds; m^2

template <class S>
class FibresOf : public WithScalar<S> {};
TYPED_TEST_SUITE(FibresOf, Scalars);

/// A bar along x, of 1 x 0.25 x 0.25 m.
Cage fibreBar(bool quadratic) {
  return boxCage({8, 2, 2}, Vector3d(1.0, 0.25, 0.25), quadratic);
}

Fibres throughout(const Cage& bar, const Vector3d& direction, double stiffness, bool tensionOnly = false) {
  Fibres fibres;
  for (std::size_t t = 0; t < bar.mesh.tetCount(); ++t) fibres.tets.push_back(static_cast<int>(t));
  fibres.directions = {direction};
  fibres.stiffness = stiffness;
  fibres.tensionOnly = tensionOnly;
  return fibres;
}

ElasticOptions matrixOfFibres(double poissonRatio, double damping = 0.0) {
  ElasticOptions options;
  options.youngsModulus = kMatrix;
  options.poissonRatio = poissonRatio;
  options.density = 1000.0;
  options.stiffnessDamping = damping;
  options.tolerance = 1e-4;
  return options;
}

/// The pull of the end at x = 1 of a bar whose nodes are where a deformation takes them, and the largest force inside.
struct Pulled {
  double along = 0.0, across = 0.0, inside = 0.0;
};

template <class S>
Pulled pulled(ElasticBody<S>& body, const Cage& bar, const Eigen::Matrix3d& deformation) {
  for (std::size_t n = 0; n < body.nodeCount(); ++n) {
    const Vector3d to = deformation * bar.mesh.nodes[n];
    for (int k = 0; k < 3; ++k) body.positions()[n][k] = static_cast<S>(to[k]);
  }
  Pulled result;
  const auto forces = body.forces();
  for (std::size_t n = 0; n < body.nodeCount(); ++n) {
    const Vector3d& p = bar.mesh.nodes[n];
    if (p.x() > 0.999) result.along -= forces[n][0];
    if (p.y() > 0.249) result.across -= forces[n][1];
    const bool inner = p.x() > 1e-3 && p.x() < 0.999 && p.y() > 1e-3 && p.y() < 0.249 && p.z() > 1e-3 && p.z() < 0.249;
    if (inner) result.inside = std::max(result.inside, Vector3d(forces[n][0], forces[n][1], forces[n][2]).norm());
  }
  return result;
}

TYPED_TEST(FibresOf, ABarIsAsMuchStifferAlongThemAsTheyAre) {
  const double digits = sizeof(TypeParam) == sizeof(float) ? 2e-4 : 1e-9;
  for (const bool quadratic : {false, true}) {
    const Cage bar = fibreBar(quadratic);
    for (const double nu : {0.0, 0.3}) {
      for (const double stretch : {0.7, 0.99, 1.01, 1.5}) {
        for (const bool tensionOnly : {false, true}) {
          constexpr double kFibre = 7.0 * kMatrix;
          ElasticBody<TypeParam> body = made<TypeParam>(bar, matrixOfFibres(nu));
          ASSERT_TRUE(body.addFibres(throughout(bar, {3, 0, 0}, kFibre, tensionOnly)).ok());
          const double side = 1.0 - nu * (stretch - 1.0), strain = stretch - 1.0;
          const Pulled found = pulled(body, bar, Vector3d(stretch, side, side).asDiagonal());
          const double modulus = kMatrix + (tensionOnly && strain < 0.0 ? 0.0 : kFibre);
          const double pull = modulus * strain * kSection;
          EXPECT_NEAR(found.along / pull, 1.0, digits / std::abs(strain));
          EXPECT_NEAR(found.across / (modulus * strain * 0.25), 0.0, digits / std::abs(strain));
          EXPECT_LT(found.inside, digits * kMatrix * kSection) << "a patch";
          EXPECT_NEAR(body.energy() / (0.5 * pull * strain), 1.0, 2.0 * digits / std::abs(strain));
        }
      }
    }
  }
}

/// Strains count from the grown shape, forces on its area; the factor of a tet's stiffness is that of its fibres, too.
TYPED_TEST(FibresOf, AGrownAndScaledBarIsAsMuchStiffer) {
  const double digits = sizeof(TypeParam) == sizeof(float) ? 1e-3 : 1e-9;
  constexpr double kFibre = 7.0 * kMatrix, kScale = 3.0, kNu = 0.3;
  for (const bool quadratic : {false, true}) {
    const Cage bar = fibreBar(quadratic);
    for (const Vector3d& growth : {Vector3d(1.2, 1.0, 1.0), Vector3d(1.0, 1.3, 0.9), Vector3d(0.8, 1.1, 1.1)}) {
      for (const double strain : {-0.1, 0.05, 0.3}) {
        ElasticBody<TypeParam> body = made<TypeParam>(bar, matrixOfFibres(kNu));
        ASSERT_TRUE(body.addFibres(throughout(bar, {1, 0, 0}, kFibre)).ok());
        const std::array<double, 9> grown{growth.x(), 0, 0, 0, growth.y(), 0, 0, 0, growth.z()};
        ASSERT_TRUE(body.setGrowthTensors(std::vector<std::array<double, 9>>(bar.mesh.tetCount(), grown)).ok());
        ASSERT_TRUE(body.setStiffnessScale(std::vector<double>(bar.mesh.tetCount(), kScale)).ok());
        const Vector3d stretches(1.0 + strain, 1.0 - kNu * strain, 1.0 - kNu * strain);
        const Pulled found = pulled(body, bar, growth.cwiseProduct(stretches).asDiagonal());
        const double pull = kScale * (kMatrix + kFibre) * strain * kSection * growth.y() * growth.z();
        EXPECT_NEAR(found.along / pull, 1.0, digits);
        EXPECT_NEAR(found.across / (kScale * kMatrix * 0.25), 0.0, digits);
        EXPECT_NEAR(body.energy() / (0.5 * pull * strain * growth.x()), 1.0, 3.0 * digits);
      }
    }
  }
}

/// Across them, only Poisson's ratio makes them felt.
TYPED_TEST(FibresOf, ABarIsHardlyStifferAcrossThem) {
  const double digits = sizeof(TypeParam) == sizeof(float) ? 5e-4 : 1e-9;
  for (const double nu : {0.0, 0.3}) {
    const Cage bar = fibreBar(false);
    constexpr double kFibre = 20.0 * kMatrix, kStrain = 0.1;
    const double mu = kMatrix / (2.0 * (1.0 + nu)), lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu);
    // No stress along y, which has the fibres, and along z.
    Eigen::Matrix2d sides;
    sides << lambda + 2.0 * mu + kFibre, lambda, lambda, lambda + 2.0 * mu;
    const Eigen::Vector2d strains = sides.inverse() * Eigen::Vector2d(-lambda * kStrain, -lambda * kStrain);
    const double pull = (2.0 * mu * kStrain + lambda * (kStrain + strains.sum())) * kSection;
    ElasticBody<TypeParam> body = made<TypeParam>(bar, matrixOfFibres(nu));
    ASSERT_TRUE(body.addFibres(throughout(bar, {0, 1, 0}, kFibre)).ok());
    const Pulled found = pulled(body, bar, Vector3d(1.0 + kStrain, 1.0 + strains[0], 1.0 + strains[1]).asDiagonal());
    EXPECT_NEAR(found.along / pull, 1.0, digits);
    EXPECT_NEAR(found.across / pull, 0.0, 100.0 * digits);
    EXPECT_LT(pull, 1.1 * kMatrix * kStrain * kSection);
  }
}

/// In any state, turned and inverted ones too; with two families, one of which is slack where it is pressed.
TEST(Fibres, ForcesAreTheSlopeOfTheEnergyAndInBalance) {
  for (const bool quadratic : {false, true}) {
    Cage cube(makeBox({1, 1, 1}, Vector3d(1, 1, 1)));
    if (quadratic) cube = refineQuadratic(cube).value();
    ElasticBody<double> plain = made<double>(cube, matrixOfFibres(0.3)), body = made<double>(cube, matrixOfFibres(0.3));
    ASSERT_TRUE(body.addFibres(throughout(cube, {1, 2, -1}, 5.0 * kMatrix)).ok());
    ASSERT_TRUE(body.addFibres(throughout(cube, {1, 0, 3}, 30.0 * kMatrix, true)).ok());
    std::mt19937 random(7);
    std::uniform_real_distribution<double> some(-0.4, 0.4);
    for (int trial = 0; trial < 5; ++trial) {
      for (std::size_t n = 0; n < body.nodeCount(); ++n) {
        const Vector3d to = Eigen::AngleAxisd(2.0, Vector3d(1, 1, 0).normalized()) * cube.mesh.nodes[n];
        for (int k = 0; k < 3; ++k) body.positions()[n][k] = plain.positions()[n][k] = to[k] + some(random);
      }
      const auto ofFibres = [&] { return body.energy() - plain.energy(); };
      const auto forces = body.forces(), without = plain.forces();
      Vector3d sum = Vector3d::Zero(), torque = Vector3d::Zero();
      for (std::size_t n = 0; n < body.nodeCount(); ++n) {
        Vector3d force;
        for (int k = 0; k < 3; ++k)
          force[k] = forces[n][static_cast<std::size_t>(k)] - without[n][static_cast<std::size_t>(k)];
        sum += force;
        torque += Vector3d(body.positions()[n][0], body.positions()[n][1], body.positions()[n][2]).cross(force);
        const int k = static_cast<int>(n % 3);
        const double before = body.positions()[n][k];
        constexpr double kSmall = 1e-6;
        body.positions()[n][k] = plain.positions()[n][k] = before + kSmall;
        const double above = ofFibres();
        body.positions()[n][k] = plain.positions()[n][k] = before - kSmall;
        const double below = ofFibres();
        body.positions()[n][k] = plain.positions()[n][k] = before;
        EXPECT_NEAR((below - above) / (2.0 * kSmall), force[k], 1e-4 * kMatrix);
      }
      EXPECT_LT(sum.norm(), 1e-8 * kMatrix);
      EXPECT_LT(torque.norm(), 1e-8 * kMatrix);
    }
  }
}

/// A wave runs along a free bar at the root of (E + k) over the density.
TYPED_TEST(FibresOf, ABarRingsAsTheyMakeItStiff) {
  constexpr double kPi = 3.14159265358979324, kFibre = 8.0 * kMatrix;
  for (const bool quadratic : {false, true}) {
    Cage bar(makeBox(quadratic ? std::array<int, 3>{8, 1, 1} : std::array<int, 3>{16, 1, 1}, Vector3d(1, 0.05, 0.05)));
    if (quadratic) bar = refineQuadratic(bar).value();
    ElasticBody<TypeParam> body = made<TypeParam>(bar, matrixOfFibres(0.0));
    ASSERT_TRUE(body.addFibres(throughout(bar, {1, 0, 0}, kFibre)).ok());
    const std::vector<double> masses = lumped(bar.mesh);
    Points velocities;
    for (const Vector3d& p : bar.mesh.nodes) velocities.emplace_back(0.01 * std::cos(kPi * p.x()), 0.0, 0.0);
    fill(body.velocities(), velocities);
    const double wanted = kPi * std::sqrt((kMatrix + kFibre) / 1000.0), dt = 0.02 / wanted;
    int turns = 0;
    double time = 0.0, last = 0.0, before = 1.0;
    while (turns < 6 && time < 100.0 / wanted) {
      body.step(dt);
      time += dt;
      double speed = 0.0;
      for (std::size_t n = 0; n < masses.size(); ++n)
        speed += masses[n] * static_cast<double>(body.velocities()[n][0]) * std::cos(kPi * bar.mesh.nodes[n].x());
      if (speed * before < 0.0) {
        ++turns;
        last = time;
      }
      before = speed;
    }
    ASSERT_EQ(turns, 6);
    EXPECT_NEAR(5.5 * kPi / (last * wanted), 1.0, 0.02) << last;
  }
}

TYPED_TEST(FibresOf, EnergyNeverGrows) {
  for (const bool quadratic : {false, true}) {
    const Cage bar = fibreBar(quadratic);
    const std::vector<double> masses = lumped(bar.mesh);
    for (const double stiffness : {3.0, 300.0}) {
      for (const bool tensionOnly : {false, true}) {
        for (const double dt : {1.0 / 60.0, 1.0 / 240.0, 1.0 / 960.0}) {
          ElasticBody<TypeParam> body = made<TypeParam>(bar, matrixOfFibres(0.3));
          ASSERT_TRUE(body.addFibres(throughout(bar, {1, 0.3, 0}, stiffness * kMatrix, tensionOnly)).ok());
          Points velocities;  // it bends, twists, shears and is stretched
          for (const Vector3d& p : bar.mesh.nodes) {
            velocities.emplace_back(3.0 * p.y() + p.x(), 8.0 * (p.x() - 0.5) * (p.x() - 0.5), 4.0 * p.x() * p.y());
          }
          fill(body.velocities(), velocities);
          const auto energyOf = [&] {
            const Motion motion = motionOf(body, masses);
            return 1000.0 * motion.kinetic + motion.elastic;
          };
          const double start = energyOf();
          double mean = start;
          for (int step = 0; step < 300; ++step) {
            body.step(dt);
            const double now = energyOf();
            mean += 0.1 * (now - mean);
            ASSERT_LT(mean, 1.05 * start) << stiffness << " " << tensionOnly << " " << dt << " " << step;
          }
        }
      }
    }
  }
}

/// Stretched between its ends, and struck: it swings, and settles.
TYPED_TEST(FibresOf, ATautRopeDoesNotFlutter) {
  for (const bool quadratic : {false, true}) {
    Cage rope(makeBox(quadratic ? std::array<int, 3>{8, 1, 1} : std::array<int, 3>{16, 2, 2}, Vector3d(1, 0.05, 0.05)));
    if (quadratic) rope = refineQuadratic(rope).value();
    for (const double dt : {1.0 / 60.0, 1.0 / 240.0, 1.0 / 960.0}) {
      ElasticBody<TypeParam> body = made<TypeParam>(rope, matrixOfFibres(0.3, 1e-3));
      ASSERT_TRUE(body.addFibres(throughout(rope, {1, 0, 0}, 1e3 * kMatrix, true)).ok());
      for (std::size_t n = 0; n < body.nodeCount(); ++n) {
        const double x = rope.mesh.nodes[n].x();
        if (x < 1e-6 || x > 1.0 - 1e-6) body.setPinned(n);
        body.positions()[n][0] = static_cast<TypeParam>(1.1 * x);
        body.velocities()[n][1] = static_cast<TypeParam>(x > 0.4 && x < 0.6 ? 1.0 : 0.0);
      }
      for (int step = 0; step < 300; ++step) {
        body.step(dt);
        ASSERT_LT(fastest(body), 3.0) << dt << " " << step;
      }
      EXPECT_LT(fastest(body), 0.01) << dt << ", of the 1 m/s of the blow";
    }
  }
}

TYPED_TEST(FibresOf, ACrushedBodyComesBack) {
  for (const bool quadratic : {false, true}) {
    const Cage bar = fibreBar(quadratic);
    for (const bool tensionOnly : {false, true}) {
      ElasticBody<TypeParam> body = made<TypeParam>(bar, matrixOfFibres(0.3, 0.05));
      ASSERT_TRUE(body.addFibres(throughout(bar, {1, 1, 0}, 10.0 * kMatrix, tensionOnly)).ok());
      for (std::size_t n = 0; n < body.nodeCount(); ++n) body.positions()[n][0] *= static_cast<TypeParam>(-0.2);
      for (int step = 0; step < 360; ++step) body.step(kFrameOfFibres);
      EXPECT_LT(fastest(body), 0.1);
      EXPECT_GT(smallestVolume(bar.mesh, pointsOf(body.positions())), 0.9) << quadratic << tensionOnly;
    }
  }
}

TYPED_TEST(FibresOf, GrowWithTheirBodyAndResistAMuscle) {
  const Cage bar = fibreBar(false);
  ElasticBody<TypeParam> body = made<TypeParam>(bar, matrixOfFibres(0.0, 0.05));
  ASSERT_TRUE(body.addFibres(throughout(bar, {1, 0, 0}, 4.0 * kMatrix)).ok());
  ASSERT_TRUE(body.setGrowth(1.5).ok());
  for (int step = 0; step < 180; ++step) body.step(kFrameOfFibres);
  EXPECT_NEAR(boundingBox(pointsOf(body.positions())).sizes().x(), 1.5, 1e-4);
  ASSERT_TRUE(body.setGrowth(1.0).ok());
  Muscle muscle;
  for (std::size_t t = 0; t < bar.mesh.tetCount(); ++t) muscle.tets.push_back(static_cast<int>(t));
  muscle.fibres = {Vector3d(1, 0, 0)};
  muscle.stress = kMatrix;
  muscle.lengthFactors = {{1.0, 1.0}};  // E (1 - s) + k (1 - s) = stress
  ASSERT_TRUE(body.addMuscle(muscle).ok());
  ASSERT_TRUE(body.setActivation(0, 1.0).ok());
  for (int step = 0; step < 240; ++step) body.step(kFrameOfFibres);
  EXPECT_NEAR(boundingBox(pointsOf(body.positions())).sizes().x(), 0.8, 1e-3);
}

TEST(Fibres, BadOnesAreRefused) {
  const Cage bar = fibreBar(false);
  ElasticBody<double> body = made<double>(bar, matrixOfFibres(0.3));
  EXPECT_EQ(body.addFibres({}).code, StatusCode::InvalidOption);
  EXPECT_EQ(body.addFibres(throughout(bar, {0, 0, 0}, 1.0)).code, StatusCode::InvalidOption);
  EXPECT_EQ(body.addFibres(throughout(bar, {1, 0, 0}, 0.0)).code, StatusCode::InvalidOption);
  const Status unknown = body.addFibres(throughout(bar, {1, 0, 0}, std::nan("")));
  EXPECT_NE(unknown.message.find("stiffness of fibres"), std::string::npos) << unknown.message;
  Fibres fibres = throughout(bar, {1, 0, 0}, 1.0);
  fibres.tets[3] = -1;
  EXPECT_EQ(body.addFibres(fibres).code, StatusCode::IndexOutOfRange);
  fibres.tets = {1, 2};
  fibres.directions = {Vector3d(1, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 0, 0)};
  EXPECT_EQ(body.addFibres(fibres).code, StatusCode::SizeMismatch);
  body.step(kFrameOfFibres);
  EXPECT_EQ(body.energy(), 0.0);
}

/// Those that are there already count, and so does what a stiffness factor multiplies.
TEST(Fibres, TheirSumMustNotBeTooStiff) {
  const Cage bar = fibreBar(false);
  const auto refused = [](const Status& status) {
    EXPECT_EQ(status.code, StatusCode::InvalidOption);
    EXPECT_NE(status.message.find("with these fibres"), std::string::npos) << status.message;
  };
  const double volume = 0.0625, most = 1e16 * 1000.0 * std::cbrt(volume * volume);  // without damping
  ElasticBody<double> body = made<double>(bar, matrixOfFibres(0.3));
  refused(body.addFibres(throughout(bar, {1, 0, 0}, 1.1 * most)));
  ASSERT_TRUE(body.addFibres(throughout(bar, {1, 0, 0}, 0.6 * most)).ok());
  refused(body.addFibres(throughout(bar, {0, 1, 0}, 0.6 * most)));
  const std::vector<double> factors(bar.mesh.tetCount(), 2.0);
  refused(body.setStiffnessScale(factors));
  ASSERT_TRUE(body.addFibres(throughout(bar, {0, 1, 0}, 0.3 * most)).ok());
  ElasticBody<double> damped = made<double>(bar, matrixOfFibres(0.3, 1.0 / 60.0));  // half of it, then
  ASSERT_TRUE(damped.addFibres(throughout(bar, {1, 0, 0}, 0.4 * most)).ok());
  refused(damped.setDampingScale(factors));
}

}  // namespace
}  // namespace tetskin::test
