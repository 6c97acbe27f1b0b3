// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Muscles whose tension depends on their length, by exact solutions.
#include <tetskin/elastic/elastic_body.h>

#include <array>
#include <cmath>

#include "elastic_motion.h"
#include "support/bars.h"

namespace tetskin::test {
namespace {

constexpr double kModulus = 1e6, kStep = 1.0 / 60.0, kArea = 0.0625;

/// Of a skeletal muscle: nothing below half of its length, or above 1.6 times.
const std::vector<std::array<double, 2>> kSkeletal = {{0.5, 0.0}, {0.9, 1.0}, {1.1, 1.0}, {1.6, 0.0}};

double skeletal(double stretch) {
  if (stretch < 0.9) return std::max(0.0, (stretch - 0.5) / 0.4);
  return stretch < 1.1 ? 1.0 : std::max(0.0, (1.6 - stretch) / 0.5);
}

template <class S>
class MuscleLengthsOf : public WithScalar<S> {};
TYPED_TEST_SUITE(MuscleLengthsOf, Scalars);

/// A bar along x, of 1 x 0.25 x 0.25 m.
Cage muscleBar(bool quadratic) {
  return boxCage({8, 2, 2}, Vector3d(1.0, 0.25, 0.25), quadratic);
}

/// All of it along x.
Muscle alongBar(const Cage& bar, double stress) {
  Muscle muscle;
  for (std::size_t t = 0; t < bar.mesh.tetCount(); ++t) muscle.tets.push_back(static_cast<int>(t));
  muscle.fibres = {Vector3d(2, 0, 0)};
  muscle.stress = stress;
  muscle.lengthFactors = kSkeletal;
  return muscle;
}

ElasticOptions flesh(double poissonRatio, double damping = 0.02) {
  ElasticOptions options;
  options.youngsModulus = kModulus;
  options.poissonRatio = poissonRatio;
  options.density = 1000.0;
  options.stiffnessDamping = damping;
  options.tolerance = 1e-4;
  return options;
}

std::array<std::vector<std::size_t>, 2> endsOf(const Cage& bar) {
  std::array<std::vector<std::size_t>, 2> ends;
  for (std::size_t n = 0; n < bar.mesh.nodeCount(); ++n) {
    for (const int end : {0, 1}) {
      if (std::abs(bar.mesh.nodes[n].x() - end) < 1e-9) ends[static_cast<std::size_t>(end)].push_back(n);
    }
  }
  return ends;
}

template <class S>
void stepFor(ElasticBody<S>& body, double seconds, double dt) {
  for (long step = std::lround(seconds / dt); step > 0; --step) body.step(dt, {});
}

/// Its pull, after it was brought to a stretch and held there.
template <class S>
double heldPull(const Cage& bar, double poissonRatio, double stress, double stretch, int substeps) {
  ElasticBody<S> body = made<S>(bar, flesh(poissonRatio));
  EXPECT_TRUE(body.addMuscle(alongBar(bar, stress)).ok());
  const auto ends = endsOf(bar);
  for (const auto& end : ends) {
    for (const std::size_t n : end) body.setPinned(n);
  }
  for (std::size_t n = 0; n < body.nodeCount(); ++n) {
    body.positions()[n][0] = static_cast<S>(stretch * bar.mesh.nodes[n].x());
  }
  if (stress > 1.0) {
    EXPECT_TRUE(body.setActivation(0, 1.0).ok());
  }
  stepFor(body, 1.2, kStep / substeps);
  EXPECT_LT(fastest(body), 1e-2) << "it flutters at " << stretch << " with " << substeps << " substeps";
  double force = 0.0;
  const auto forces = body.forces();
  for (const std::size_t n : ends[1]) force -= forces[n][0];
  return force;
}

/// Beside its elasticity, where it does not buckle. Ends that are held cannot become wider: that is a small share of
/// the pull.
TYPED_TEST(MuscleLengthsOf, AHeldMusclePullsByItsLength) {
  for (const bool quadratic : {false, true}) {
    const Cage bar = muscleBar(quadratic);
    for (const double nu : {0.0, 0.3}) {
      for (const double stretch : {0.85, 0.9, 1.0, 1.2, 1.4}) {
        const double passive = heldPull<TypeParam>(bar, nu, 1.0, stretch, 4);
        const double pull = heldPull<TypeParam>(bar, nu, 0.3 * kModulus, stretch, 4) - passive;
        const double wanted = 0.3 * kModulus * kArea * skeletal(stretch);
        EXPECT_NEAR(pull / wanted, 1.0, nu > 0.0 ? 0.02 : 1e-3) << stretch << " " << quadratic;
      }
    }
  }
}

/// s with E (1 - s) = stress factor(s), by bisection.
double freeLength(double stress) {
  double low = 0.1, high = 1.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (kModulus * (1.0 - middle) < stress * skeletal(middle) ? high : low) = middle;
  }
  return low;
}

TYPED_TEST(MuscleLengthsOf, AFreeMuscleShortensToWhereItsTensionEnds) {
  for (const bool quadratic : {false, true}) {
    const Cage bar = muscleBar(quadratic);
    for (const double share : {0.3, 10.0}) {
      for (const int substeps : {1, 4, 16}) {
        ElasticBody<TypeParam> body = made<TypeParam>(bar, flesh(0.3));
        ASSERT_TRUE(body.addMuscle(alongBar(bar, share * kModulus)).ok());
        for (int k = 1; k <= 30; ++k) {
          ASSERT_TRUE(body.setActivation(0, k / 30.0).ok());
          stepFor(body, kStep, kStep / substeps);
        }
        stepFor(body, 1.5, kStep / substeps);
        const auto ends = endsOf(bar);
        double length = 0.0;
        for (const std::size_t n : ends[1]) length += body.positions()[n][0] / static_cast<double>(ends[1].size());
        for (const std::size_t n : ends[0]) length -= body.positions()[n][0] / static_cast<double>(ends[0].size());
        EXPECT_NEAR(length, freeLength(share * kModulus), 2e-3) << share << " " << substeps;
        EXPECT_LT(fastest(body), 1e-2) << "it flutters: " << share << " " << substeps;
      }
    }
  }
}

/// One that grows with the length by thirty times Young's modulus, and hardly any damping: forces far stiffer than the
/// tets. It starts a tenth too long.
TYPED_TEST(MuscleLengthsOf, ASteepCurveDoesNotFlutter) {
  for (const bool quadratic : {false, true}) {
    const Cage bar = muscleBar(quadratic);
    for (const int substeps : {1, 4, 16}) {
      ElasticBody<TypeParam> body = made<TypeParam>(bar, flesh(0.3, 1e-3));
      Muscle muscle = alongBar(bar, 3.0 * kModulus);
      muscle.lengthFactors = {{0.95, 0.0}, {1.05, 1.0}};
      ASSERT_TRUE(body.addMuscle(muscle).ok());
      for (std::size_t n = 0; n < body.nodeCount(); ++n) {
        body.positions()[n][0] = static_cast<TypeParam>(1.1 * bar.mesh.nodes[n].x());
      }
      ASSERT_TRUE(body.setActivation(0, 1.0).ok());
      double first = 0.0;
      for (int k = 0; k < 120; ++k) {
        stepFor(body, kStep, kStep / substeps);
        if (k < 30) first = std::max(first, fastest(body));
      }
      EXPECT_LT(fastest(body), 0.2 * first) << substeps;
      EXPECT_LT(first, 60.0) << "the speed of its waves";
    }
  }
}

/// Beyond its optimum it pulls less the longer it is: a hanging weight that its elasticity holds does not swing up.
TYPED_TEST(MuscleLengthsOf, ATensionThatFallsWithTheLengthSettles) {
  const Cage bar = muscleBar(false);
  for (const int substeps : {1, 4, 16}) {
    ElasticBody<TypeParam> body = made<TypeParam>(bar, flesh(0.3));
    ASSERT_TRUE(body.addMuscle(alongBar(bar, 0.4 * kModulus)).ok());
    const auto ends = endsOf(bar);
    for (const std::size_t n : ends[0]) body.setPinned(n);
    for (std::size_t n = 0; n < body.nodeCount(); ++n) {
      body.positions()[n][0] = static_cast<TypeParam>(1.4 * bar.mesh.nodes[n].x());
    }
    ASSERT_TRUE(body.setActivation(0, 1.0).ok());
    const double weight = 300.0;  // acceleration: 1.2 of 0.25 E on the whole length
    for (long step = std::lround(4.0 * substeps / kStep); step > 0; --step) body.step(kStep / substeps, {weight, 0, 0});
    EXPECT_LT(fastest(body), 1e-2) << substeps;
    EXPECT_GT(smallestVolume(bar.mesh, pointsOf(body.positions())), 0.5);
  }
}

/// A tension of nearly 0 changes nearly nothing, also below 2 nu / (1 + 2 nu) of the length.
TYPED_TEST(MuscleLengthsOf, AShortMuscleHasNoJumpWhereItsTensionBegins) {
  for (const bool quadratic : {false, true}) {
    const Cage bar = muscleBar(quadratic);
    const auto ends = endsOf(bar);
    const auto pullAt = [&](double activation) {
      ElasticBody<TypeParam> body = made<TypeParam>(bar, flesh(0.3));
      Muscle muscle = alongBar(bar, 0.3 * kModulus);
      muscle.lengthFactors = {{0.2, 1.0}};
      EXPECT_TRUE(body.addMuscle(muscle).ok());
      for (std::size_t n = 0; n < body.nodeCount(); ++n) {
        body.setPinned(n);
        body.positions()[n][0] = static_cast<TypeParam>(0.3 * bar.mesh.nodes[n].x());
      }
      EXPECT_TRUE(body.setActivation(0, activation).ok());
      body.step(kStep);
      double force = 0.0;
      const auto forces = body.forces();
      for (const std::size_t n : ends[1]) force -= forces[n][0];
      return force;
    };
    const double relaxed = pullAt(0.0), hardly = pullAt(1e-6), flexed = pullAt(1.0);
    EXPECT_LT(relaxed, -0.5 * kModulus * kArea) << "it is pressed";
    EXPECT_NEAR(hardly / relaxed, 1.0, 5e-3);
    EXPECT_GT(std::abs(flexed / relaxed - 1.0), 0.1) << "a tension acts there";
  }
}

TEST(MuscleLengths, ACurveMustAscendAndBeFinite) {
  const Cage bar = muscleBar(false);
  ElasticBody<double> body = made<double>(bar, flesh(0.3));
  Muscle muscle = alongBar(bar, 1e5);
  const double nan = std::nan("");
  const std::vector<std::array<double, 2>> wrong = {{0.5, 1.0}, {0.4, 1.0}, {nan, 1.0}, {0.6, -0.1}, {0.6, nan}};
  for (const std::array<double, 2>& bad : wrong) {
    muscle.lengthFactors = {{0.5, 0.0}, bad};
    const Status status = body.addMuscle(muscle).status();
    EXPECT_EQ(status.code, StatusCode::InvalidOption);
    EXPECT_NE(status.message.find("point 1 of lengthFactors"), std::string::npos) << status.message;
  }
  muscle.lengthFactors = {{0.0, 1.0}};
  EXPECT_FALSE(body.addMuscle(muscle).ok());
}

/// From step to step, the shapes of its own tets alone are found anew: with the bits that they all would have.
TYPED_TEST(MuscleLengthsOf, AMuscleOfSomeTetsIsFoundAloneAsWithAll) {
  for (const bool quadratic : {false, true}) {
    const Cage bar = muscleBar(quadratic);
    Muscle muscle = alongBar(bar, 0.3 * kModulus);
    muscle.tets.clear();
    for (std::size_t t = 3; t < bar.mesh.tetCount(); t += 5) muscle.tets.push_back(static_cast<int>(t));
    Muscle other = muscle;  // of some of the same tets, in another order, and without a curve
    other.tets = {13, 8, 7, 3};
    other.lengthFactors.clear();
    std::vector<double> growth(bar.mesh.tetCount(), 1.0);
    for (std::size_t t = 0; t < growth.size(); t += 3) growth[t] = 1.1;
    const auto grow = [&](ElasticBody<TypeParam>& body) { ASSERT_TRUE(body.setGrowth(growth).ok()); };
    ElasticBody<TypeParam> alone = made<TypeParam>(bar, flesh(0.3)), all = made<TypeParam>(bar, flesh(0.3));
    for (ElasticBody<TypeParam>* body : {&alone, &all}) {
      Plasticity yields;
      yields.yieldStress = 0.05 * kModulus;
      ASSERT_TRUE(body->addMuscle(muscle).ok() && body->addMuscle(other).ok() && body->setPlasticity(yields).ok());
      grow(*body);
    }
    for (int step = 0; step < 20; ++step) {
      for (ElasticBody<TypeParam>* body : {&alone, &all}) {
        if (step % 4 == 0) {
          ASSERT_TRUE(body->setActivation(0, 0.04 * step).ok() && body->setActivation(1, 0.3).ok());
        }
        if (body == &all) grow(*body);
        body->step(kStep, {0, -9.81, 0});
      }
      for (std::size_t n = 0; n < alone.nodeCount(); ++n) {
        for (int k = 0; k < 3; ++k) ASSERT_EQ(alone.positions()[n][k], all.positions()[n][k]) << "step " << step;
      }
    }
    const auto box = boundingBox(pointsOf(alone.positions()));
    EXPECT_GT(std::abs(box.sizes().x() - 1.0), 0.01) << "it moves";
  }
}

/// A curve counts from the grown length.
TEST(MuscleLengths, AGrownMuscleIsAtItsRestLength) {
  const Cage bar = muscleBar(false);
  ElasticBody<double> body = made<double>(bar, flesh(0.0));
  ASSERT_TRUE(body.addMuscle(alongBar(bar, 0.1 * kModulus)).ok());
  ASSERT_TRUE(body.setGrowth(1.5).ok());
  stepFor(body, 2.0, kStep);
  ASSERT_TRUE(body.setActivation(0, 1.0).ok());
  stepFor(body, 2.0, kStep);
  const auto box = boundingBox(pointsOf(body.positions()));
  EXPECT_NEAR(box.sizes().x(), 1.5 * 0.9, 1e-3);
}

}  // namespace
}  // namespace tetskin::test
