// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Damping that differs from tet to tet.
#include <tetskin/elastic/elastic_body.h>

#include <cmath>

#include "elastic_motion.h"
#include "support/bars.h"

namespace tetskin::test {
namespace {

template <class S>
class DampingByTetOf : public WithScalar<S> {};
TYPED_TEST_SUITE(DampingByTetOf, Scalars);

constexpr double kHalfTurn = 3.14159265358979324, kSpeedOfSound = 10.0;  // of a bar with E 1e5 and a density of 1000

Cage dampedBar(bool quadratic) {
  return boxCage({20, 2, 2}, Vector3d(1.0, 0.1, 0.1), quadratic);
}

ElasticOptions ringing(double damping) {
  ElasticOptions options;
  options.youngsModulus = 1e5;
  options.poissonRatio = 0.0;
  options.density = 1000.0;
  options.stiffnessDamping = damping;
  options.tolerance = 1e-5;
  return options;
}

/// Factors of the left half and of the right one.
std::vector<double> halves(const Cage& bar, double left, double right) {
  std::vector<double> factors;
  for (const Tet& tet : bar.mesh.tets) {
    double x = 0.0;
    for (const int n : tet) x += 0.25 * bar.mesh.nodes[static_cast<std::size_t>(n)].x();
    factors.push_back(x < 0.5 ? left : right);
  }
  return factors;
}

/// The rate at which a free bar's first longitudinal mode decays, per second, from its amplitudes.
template <class S>
double decayOf(ElasticBody<S>& body, const Cage& bar, double dt) {
  const std::vector<double> masses = lumped(bar.mesh);
  Points velocities;
  for (const Vector3d& p : bar.mesh.nodes) velocities.emplace_back(0.01 * std::cos(kHalfTurn * p.x()), 0.0, 0.0);
  fill(body.velocities(), velocities);
  const auto amplitude = [&] {  // of the mode: its displacement and its speed
    double shift = 0.0, speed = 0.0;
    for (std::size_t n = 0; n < masses.size(); ++n) {
      const double shape = masses[n] * std::cos(kHalfTurn * bar.mesh.nodes[n].x());
      shift += shape * (static_cast<double>(body.positions()[n][0]) - bar.mesh.nodes[n].x());
      speed += shape * static_cast<double>(body.velocities()[n][0]);
    }
    return std::hypot(shift * kHalfTurn * kSpeedOfSound, speed);
  };
  // The ripple of velocities that belong to the middle of a step has twice the mode's frequency: a mean over periods.
  const double period = 2.0 / kSpeedOfSound;
  const auto meanOverPeriod = [&] {
    const long steps = std::lround(period / dt);
    double sum = 0.0;
    for (long k = 0; k < steps; ++k) {
      body.step(dt, {});
      sum += amplitude();
    }
    return sum / static_cast<double>(steps);
  };
  const double first = meanOverPeriod();
  for (int k = 0; k < 3; ++k) (void)meanOverPeriod();
  return std::log(first / meanOverPeriod()) / (4.0 * period);
}

/// A weak damping takes half of its energy's rate: each half of the bar has half of the mode's strain energy.
TYPED_TEST(DampingByTetOf, AModeDecaysByTheMeanOverItsEnergy) {
  constexpr double kDamping = 2e-3;
  for (const bool quadratic : {false, true}) {
    Cage bar = dampedBar(quadratic);
    for (const auto& [left, right] : {std::pair(0.0, 2.0), std::pair(1.0, 3.0), std::pair(0.5, 0.5)}) {
      for (const double dt : {1.0 / 240.0, 1.0 / 960.0}) {
        bar.paintedDamping = halves(bar, left, right);
        ElasticBody<TypeParam> body = made<TypeParam>(bar, ringing(kDamping));
        const double omega = kHalfTurn * kSpeedOfSound, wanted = 0.5 * omega * omega * 0.5 * (left + right) * kDamping;
        EXPECT_NEAR(decayOf(body, bar, dt) / wanted, 1.0, dt < 2e-3 ? 0.02 : 0.06) << left << " " << right << " " << dt;
      }
    }
  }
}

/// Also where it is set later, and in contact with no history.
TYPED_TEST(DampingByTetOf, OnePaintedAllOverIsThatDamping) {
  for (const bool quadratic : {false, true}) {
    Cage bar = dampedBar(quadratic);
    ElasticBody<TypeParam> plain = made<TypeParam>(bar, ringing(0.03));
    bar.paintedDamping.assign(bar.mesh.tetCount(), 1.5);
    ElasticBody<TypeParam> painted = made<TypeParam>(bar, ringing(0.01));
    ASSERT_TRUE(painted.setDampingScale(std::vector<double>(bar.mesh.tetCount(), 2.0)).ok());
    for (ElasticBody<TypeParam>* body : {&plain, &painted}) {
      pinTheEnd(*body, bar.mesh);
      for (int step = 0; step < 60; ++step) body->step(1.0 / 240.0, {0, -9.8, 0});
    }
    for (std::size_t n = 0; n < plain.nodeCount(); ++n) {
      for (int k = 0; k < 3; ++k) EXPECT_EQ(plain.positions()[n][k], painted.positions()[n][k]);
    }
  }
}

/// What is damped most, of what is bent, twisted and thrown, at large steps and large ratios.
TYPED_TEST(DampingByTetOf, EnergyNeverGrows) {
  for (const bool quadratic : {false, true}) {
    Cage bar = dampedBar(quadratic);
    const std::vector<double> masses = lumped(bar.mesh);
    for (const double most : {1.0, 100.0, 1e4}) {
      for (const double dt : {1.0 / 60.0, 1.0 / 240.0}) {
        ElasticBody<TypeParam> body = made<TypeParam>(bar, ringing(1e-2));
        ASSERT_TRUE(body.setDampingScale(halves(bar, 0.0, most)).ok());
        Points velocities;
        for (const Vector3d& p : bar.mesh.nodes) {
          velocities.emplace_back(p.y(), 4.0 * (p.x() - 0.5) * (p.x() - 0.5), 3.0 * p.x() * p.y());
        }
        fill(body.velocities(), velocities);
        const auto energyOf = [&] {
          const Motion motion = motionOf(body, masses);
          return 1000.0 * motion.kinetic + motion.elastic;
        };
        const double start = energyOf();
        for (int step = 0; step < 240; ++step) {
          body.step(dt, {});
          ASSERT_LT(energyOf(), 1.02 * start) << most << " " << dt << " " << step;
        }
      }
    }
  }
}

TEST(DampingByTet, BadFactorsAreRefused) {
  Cage bar = dampedBar(false);
  ElasticBody<double> body = made<double>(bar, ringing(1e-2));
  EXPECT_EQ(body.setDampingScale({1.0}).code, StatusCode::SizeMismatch);
  std::vector<double> factors(bar.mesh.tetCount(), 1.0);
  factors[5] = -1.0;
  const Status status = body.setDampingScale(factors);
  EXPECT_EQ(status.code, StatusCode::InvalidOption);
  EXPECT_NE(status.message.find("tet 5"), std::string::npos) << status.message;
  factors[5] = 1e18;
  const Status tooStiff = body.setDampingScale(factors);
  EXPECT_EQ(tooStiff.code, StatusCode::InvalidOption);
  EXPECT_NE(tooStiff.message.find("too stiff"), std::string::npos) << tooStiff.message;
  factors[5] = std::nan("");
  bar.paintedDamping.assign(bar.mesh.tetCount(), 2.0);
  ElasticBody<double> painted = made<double>(bar, ringing(1e-2));
  EXPECT_EQ(painted.setDampingScale({1.0}).code, StatusCode::SizeMismatch);
  EXPECT_NE(painted.setDampingScale(factors).message.find("tet 5"), std::string::npos) << "not that it is too stiff";
  bar.paintedDamping.assign(bar.mesh.tetCount(), -1.0);
  EXPECT_EQ(ElasticBody<double>::create(bar, ringing(1e-2)).status().code, StatusCode::InvalidOption);
}

}  // namespace
}  // namespace tetskin::test
