// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A single vibration, whose steps are exact functions of its frequency, the damping and the step.
#include <tetskin/elastic/src/dynamics/time_scheme.h>

#include <Eigen/Eigenvalues>
#include <complex>

namespace tetskin::test {
namespace {

using elastic_detail::TimeScheme;
using Complex = std::complex<double>;

const std::vector<double> kDampings = {0.0, 1e-3, 0.1, 0.3, 0.6, 0.74, 0.76, 0.99, 1.0, 1.01, 1.5, 2.0, 4.8, 30, 1e3};

/// One step of a unit mass at position x, with velocity u and history H, on a spring of this frequency.
Eigen::Matrix3d stepOf(const TimeScheme& scheme, double seconds, double frequency) {
  const double stiffness = frequency * frequency, a = scheme.filter;
  const Eigen::RowVector3d u =
      Eigen::RowVector3d(-seconds * stiffness, 1.0 + scheme.carried * scheme.alpha(seconds) * stiffness, a) /
      (1.0 + scheme.alpha(seconds) * stiffness);
  Eigen::Matrix3d step;
  step.row(0) = Eigen::RowVector3d(1, 0, 0) + seconds * u;
  step.row(1) = u;
  step.row(2) = Eigen::RowVector3d(0, 0, a) + (1.0 - a) * seconds * (seconds - scheme.damping) * stiffness * u;
  return step;
}

/// The factors by which a step multiplies its vibrations, largest first.
std::vector<Complex> factorsOf(const TimeScheme& scheme, double seconds, double frequency) {
  const auto values = stepOf(scheme, seconds, frequency).eigenvalues().eval();
  std::vector<Complex> factors(values.begin(), values.end());
  std::sort(factors.begin(), factors.end(),
            [](const Complex& p, const Complex& q) { return std::abs(p) > std::abs(q); });
  return factors;
}

/// The error of a step's rate of decay and of its frequency, relative to the frequency.
double errorOf(const TimeScheme& scheme, double seconds, double frequency) {
  const double decay = scheme.damping * frequency * frequency / 2.0;
  const Complex exact(-decay, std::sqrt(frequency * frequency - decay * decay));
  double least = 1e9;
  for (const Complex& factor : factorsOf(scheme, seconds, frequency)) {
    least = std::min(least, std::abs(std::log(factor) / seconds - exact));
  }
  return least / frequency;
}

TEST(TimeScheme, NoVibrationGrowsAtAnyFrequencyAndDamping) {
  for (const double damping : kDampings) {
    for (double frequency = 1e-3; frequency < 1e6; frequency *= 1.3) {
      for (const TimeScheme& scheme :
           {elastic_detail::secondOrder(1.0, damping), elastic_detail::backwardEuler(1.0, damping),
            elastic_detail::carryingOn(1.0, damping, 1.0), elastic_detail::carryingOn(1.0, damping, 0.5)}) {
        // A step that carries on does not use its history, which is as large as the stiffness.
        const double rounding = scheme.carried > 0.0 ? 1e-15 * frequency * frequency : 0.0;
        EXPECT_LE(std::abs(factorsOf(scheme, 1.0, frequency).front()), 1.0 + 1e-9 + rounding)
            << damping << ' ' << frequency;
        EXPECT_TRUE(scheme.filter >= 0.0 && scheme.filter <= 1.0) << damping << ": it weighs a mean";
      }
    }
  }
}

TEST(TimeScheme, TheFastestVibrationsFallToAThirdInAStepOrAsSlowlyAsTheMaterialLetsThem) {
  for (const double damping : kDampings) {
    for (const Complex& factor : factorsOf(elastic_detail::secondOrder(1.0, damping), 1.0, 1e6)) {
      EXPECT_GT(factor.real(), -0.334) << damping;
      EXPECT_LT(factor.real(), 1.0 - 0.4 / std::max(damping, 1.0)) << damping;
      EXPECT_LT(std::abs(factor.imag()), 0.01) << damping;
    }
  }
}

/// Over all lengths of the step: long steps have less damping in units of their own, and another a.
TEST(TimeScheme, IsOfSecondOrderAtEveryDamping) {
  for (const double damping : {0.0, 0.002, 0.01, 0.03, 0.1}) {
    const double frequency = damping > 0.05 ? 8.0 : 10.0;
    double before = 0.0;
    for (const double seconds : {0.01, 0.005, 0.0025, 0.00125}) {
      const double error = errorOf(elastic_detail::secondOrder(seconds, damping), seconds, frequency);
      EXPECT_LT(error, 0.6 * std::pow(frequency * seconds, 2)) << damping << ' ' << seconds;
      EXPECT_TRUE(before < 1e-6 || error < 0.5 * before) << damping << ' ' << seconds;
      before = error;
    }
  }
}

TEST(TimeScheme, BackwardEulerDampsByOneStepMoreThanTheMaterial) {
  const double seconds = 1e-3, frequency = 2.0;
  for (const double damping : {0.0, 0.005, 0.02}) {
    const Complex factor = factorsOf(elastic_detail::backwardEuler(seconds, damping), seconds, frequency).front();
    const double decay = -std::log(std::abs(factor)) / seconds;
    EXPECT_NEAR(decay / (frequency * frequency / 2.0), damping + seconds, 0.01 * seconds);
  }
}

TEST(TimeScheme, AStepThatCarriesOnWhatItBeginsWithKeepsAnUndampedVibration) {
  double before = 0.0;
  for (const double seconds : {0.02, 0.01, 0.005, 0.0025}) {
    const TimeScheme scheme = elastic_detail::carryingOn(seconds, 0.0, 1.0);
    EXPECT_NEAR(std::abs(factorsOf(scheme, seconds, 10.0).front()), 1.0, 1e-9);
    const double phase = std::arg(factorsOf(scheme, seconds, 10.0).front()) / seconds;
    const double error = std::abs(std::abs(phase) - 10.0) / 10.0;
    EXPECT_LT(error, 0.25 * std::pow(10.0 * seconds, 2));
    EXPECT_TRUE(before == 0.0 || error < 0.3 * before);
    before = error;
  }
}

/// The same, where forces are twice as stiff as the matrix.
TEST(TimeScheme, AStepThatCarriesOnBearsForcesTwiceAsStiffAsItsMatrix) {
  for (double stiffness = 1e-6; stiffness < 1e12; stiffness *= 3.0) {
    const TimeScheme scheme = elastic_detail::carryingOn(1.0, 0.0, 1.0);
    const double alpha = scheme.alpha(1.0);
    const Eigen::RowVector2d u =
        Eigen::RowVector2d(-2.0 * stiffness, 1.0 + scheme.carried * alpha * stiffness) / (1.0 + alpha * stiffness);
    Eigen::Matrix2d step;
    step << Eigen::RowVector2d(1, 0) + u, u;
    const double largest = step.eigenvalues().cwiseAbs().maxCoeff();
    EXPECT_LE(largest, 1.0 + 1e-9) << stiffness;
  }
}

TEST(TimeScheme, AStepWithoutHistoryIsImplicitEnoughToBeStable) {
  for (const double damping : kDampings) {
    const TimeScheme first = elastic_detail::firstOrder(1.0, damping);
    EXPECT_DOUBLE_EQ(first.alpha(1.0), std::max(damping, 1.0));
    EXPECT_EQ(first.damping, damping);
  }
}

}  // namespace
}  // namespace tetskin::test
