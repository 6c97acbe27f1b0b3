// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Rest shapes that change, by exact solutions.
#include <tetskin/elastic/elastic_body.h>

#include <array>
#include <cmath>
#include <string>

#include "elastic_motion.h"
#include "support/bars.h"

namespace tetskin::test {
namespace {

constexpr double kYoung = 1e6, kFrame = 1.0 / 60.0;

template <class S>
class MaterialChangesOf : public WithScalar<S> {};
TYPED_TEST_SUITE(MaterialChangesOf, Scalars);

enum class Order { Linear, Quadratic };

/// A bar along x, of 1 x 0.25 x 0.25 m.
Cage barOf(Order order) {
  Cage bar;
  bar.mesh = makeBox(order == Order::Linear ? std::array<int, 3>{8, 2, 2} : std::array<int, 3>{4, 1, 1},
                     Vector3d(1.0, 0.25, 0.25));
  return order == Order::Linear ? bar : refineQuadratic(bar).value();
}

ElasticOptions material(double poissonRatio = 0.3) {
  ElasticOptions options;
  options.youngsModulus = kYoung;
  options.poissonRatio = poissonRatio;
  options.density = 1000.0;
  options.stiffnessDamping = 0.01;
  options.tolerance = 1e-4;
  return options;
}

Plasticity yielding(double strain) {
  Plasticity plasticity;
  plasticity.yieldStress = strain * kYoung;
  return plasticity;
}

std::vector<std::size_t> nodesAt(const Cage& cage, double x) {
  std::vector<std::size_t> nodes;
  for (std::size_t n = 0; n < cage.mesh.nodeCount(); ++n) {
    if (std::abs(cage.mesh.nodes[n].x() - x) < 1e-6) nodes.push_back(n);
  }
  return nodes;
}

template <class S>
void run(ElasticBody<S>& body, double seconds, double dt) {
  for (long step = std::lround(seconds / dt); step > 0; --step) body.step(dt, {});
}

/// The strain of the middle half of a bar, by least squares.
template <class S>
double middleStrain(ElasticBody<S>& body, const Cage& bar) {
  const Points now = pointsOf(body.positions());
  double xx = 0.0, xy = 0.0, x = 0.0, y = 0.0, count = 0.0;
  for (std::size_t n = 0; n < now.size(); ++n) {
    const double at = bar.mesh.nodes[n].x();
    if (std::abs(at - 0.5) > 0.2501) continue;
    xx += at * at, xy += at * now[n].x(), x += at, y += now[n].x(), count += 1.0;
  }
  return (count * xy - x * y) / (count * xx - x * x) - 1.0;
}

double volumeOf(const TetMesh& cage, const Points& nodes) {
  return totalVolume(TetMesh{nodes, cage.tets});
}

struct PulledBar {
  double held = 0.0, kept = 0.0;  ///< strain of its middle, at the end of the pull, and after it was let go
  double volume = 0.0;            ///< over that at rest
};

/// Pulls a bar by its ends, holds it, and lets it go.
template <class S>
PulledBar pull(const Cage& bar, const Plasticity& plasticity, double strain, double dt) {
  constexpr double kPulls = 0.5, kHolds = 0.3, kRests = 1.5;
  ElasticBody<S> body = made<S>(bar, material());
  EXPECT_TRUE(body.setPlasticity(plasticity).ok());
  const std::vector<std::size_t> ends[2] = {nodesAt(bar, 0.0), nodesAt(bar, 1.0)};
  for (const auto& end : ends) {
    for (const std::size_t n : end) body.setPinned(n);
  }
  const auto pullAt = [&](double speed) {
    for (const std::size_t n : ends[1]) body.velocities()[n][0] = static_cast<S>(speed);
  };
  pullAt(strain / kPulls);
  run(body, kPulls, dt);
  pullAt(0.0);
  run(body, kHolds, dt);
  PulledBar result;
  result.held = middleStrain(body, bar);
  for (const std::size_t n : ends[1]) body.setPinned(n, false);
  run(body, kRests, dt);
  result.kept = middleStrain(body, bar);
  result.volume = volumeOf(bar.mesh, pointsOf(body.positions())) / totalVolume(bar.mesh);
  return result;
}

TYPED_TEST(MaterialChangesOf, APulledBarKeepsItsStrainMinusThatAtWhichItYields) {
  constexpr double kYield = 0.02;
  for (const Order order : {Order::Linear, Order::Quadratic}) {
    const Cage bar = barOf(order);
    for (const double strain : {0.05, 0.2, 0.5}) {
      double kept[3] = {};
      int k = 0;
      for (const int substeps : {1, 4, 16}) {
        const PulledBar bars = pull<TypeParam>(bar, yielding(kYield), strain, kFrame / substeps);
        EXPECT_NEAR(bars.kept / (bars.held - kYield), 1.0, 0.05) << strain << " " << substeps;
        EXPECT_NEAR(bars.volume, 1.0, 0.01);
        kept[k++] = bars.kept;
      }
      EXPECT_NEAR(kept[1] / kept[2], 1.0, 0.02) << "it does not depend on the step";
      EXPECT_NEAR(kept[0] / kept[2], 1.0, 0.08) << "one step per frame lets the motion differ";
    }
  }
}

/// A cube whose nodes are all led: stretched along x by a factor, with its volume.
template <class S>
void leadTo(ElasticBody<S>& body, const TetMesh& cube, double stretch, double dt) {
  const double across = 1.0 / std::sqrt(stretch);
  const Points now = pointsOf(body.positions());
  for (std::size_t n = 0; n < now.size(); ++n) {
    const Vector3d to = cube.nodes[n].cwiseProduct(Vector3d(stretch, across, across));
    for (int k = 0; k < 3; ++k) body.velocities()[n][k] = static_cast<S>((to[k] - now[n][k]) / dt);
  }
  body.step(dt, {});
}

/// The equivalent plastic strain after strains of +a, -a, +a ...: elastic up to the yield stress, which grows by
/// `hardening` times it. 3 mu is the von Mises stress per logarithmic strain.
double cyclicStrain(double amplitude, int turns, double yield, double hardening) {
  const double modulus = 3.0 * kYoung / (2.0 * 1.3);
  double plastic = 0.0, sum = 0.0;
  for (int turn = 0; turn < turns; ++turn) {
    const double at = turn % 2 == 0 ? amplitude : -amplitude, trial = modulus * (at - plastic);
    const double beyond = std::abs(trial) - (yield + hardening * sum);
    if (beyond <= 0.0) continue;
    sum += beyond / (modulus + hardening);
    plastic += std::copysign(beyond / (modulus + hardening), trial);
  }
  return sum;
}

TYPED_TEST(MaterialChangesOf, CyclicLoadsHardenAsTheClosedFormSays) {
  constexpr double kAmplitude = 0.02, kYield = 4e3, kHardening = 2e5;
  for (const bool quadratic : {false, true}) {
    Cage cube;
    cube.mesh = makeBox({2, 2, 2}, Vector3d(0.2, 0.2, 0.2));
    if (quadratic) cube = refineQuadratic(cube).value();
    for (const int steps : {5, 40}) {
      ElasticBody<TypeParam> body = made<TypeParam>(cube, material());
      Plasticity plasticity;
      plasticity.yieldStress = kYield;
      plasticity.hardening = kHardening;
      ASSERT_TRUE(body.setPlasticity(plasticity).ok());
      for (std::size_t n = 0; n < body.nodeCount(); ++n) body.setPinned(n);
      double strain = 0.0;
      for (int turn = 0; turn < 6; ++turn) {
        const double from = strain, to = turn % 2 == 0 ? kAmplitude : -kAmplitude;
        for (int k = 1; k <= steps; ++k) {
          strain = from + (to - from) * k / steps;
          leadTo(body, cube.mesh, std::exp(strain), 1e-3);
        }
        leadTo(body, cube.mesh, std::exp(strain), 1e-3);  // what a step reaches flows in the next one
        const double expected = cyclicStrain(kAmplitude, turn + 1, kYield, kHardening);
        ASSERT_GT(expected, 0.01);
        for (const double found : body.plasticStrains()) ASSERT_NEAR(found / expected, 1.0, 0.03) << turn;
      }
    }
  }
}

TYPED_TEST(MaterialChangesOf, FlowAtARateDoesNotDependOnTheStep) {
  const Cage bar = barOf(Order::Linear);
  Plasticity plasticity = yielding(0.02);
  plasticity.flowRate = 2.0;
  const double fine = pull<TypeParam>(bar, plasticity, 0.2, kFrame / 16).kept;
  EXPECT_GT(fine, 0.05);
  EXPECT_LT(fine, 0.15) << "not all of it has flowed";
  for (const int substeps : {1, 4}) {
    EXPECT_NEAR(pull<TypeParam>(bar, plasticity, 0.2, kFrame / substeps).kept / fine, 1.0, 0.02) << substeps;
  }
}

TYPED_TEST(MaterialChangesOf, NoMorePlasticStrainRemainsThanAllowed) {
  Cage cube;
  cube.mesh = makeBox({1, 1, 1}, Vector3d(0.2, 0.2, 0.2));
  Plasticity plasticity = yielding(0.01);
  plasticity.largestStrain = 0.1;
  ElasticBody<TypeParam> body = made<TypeParam>(cube, material());
  ASSERT_TRUE(body.setPlasticity(plasticity).ok());
  for (std::size_t n = 0; n < body.nodeCount(); ++n) body.setPinned(n);
  for (int k = 1; k <= 30; ++k) leadTo(body, cube.mesh, std::exp(0.01 * k), 1e-3);
  leadTo(body, cube.mesh, std::exp(0.3), 1e-3);
  for (const double strain : body.plasticStrains()) EXPECT_NEAR(strain, 0.1, 5e-3);
  // The way back is free, to a stretch the other way.
  for (int k = 30; k >= -30; --k) leadTo(body, cube.mesh, std::exp(0.01 * k), 1e-3);
  leadTo(body, cube.mesh, std::exp(-0.3), 1e-3);
  for (const double strain : body.plasticStrains()) EXPECT_NEAR(strain, 0.3, 1e-2);
}

/// Large ones, too; and without a limit a stretch by 20.
TYPED_TEST(MaterialChangesOf, ATetIsDrawnOutAsFarAsAllowed) {
  Cage cube;
  cube.mesh = makeBox({1, 1, 1}, Vector3d(0.2, 0.2, 0.2));
  for (const double largest : {0.02, 0.5, 1.0, 2.0, 3.0, kInfinity}) {
    Plasticity plasticity = yielding(0.01);
    plasticity.largestStrain = largest;
    ElasticBody<TypeParam> body = made<TypeParam>(cube, material());
    ASSERT_TRUE(body.setPlasticity(plasticity).ok());
    for (std::size_t n = 0; n < body.nodeCount(); ++n) body.setPinned(n);
    const double remains = std::min(largest, 3.0), last = remains + 0.1;
    for (int k = 1; k <= 100; ++k) leadTo(body, cube.mesh, std::exp(0.01 * k * last), 1e-3);
    leadTo(body, cube.mesh, std::exp(last), 1e-3);
    for (const double strain : body.plasticStrains()) EXPECT_NEAR(strain / remains, 1.0, 0.05) << largest;
  }
}

TYPED_TEST(MaterialChangesOf, ARigidMotionLetsNothingFlow) {
  const Cage bar = barOf(Order::Linear);
  ElasticBody<TypeParam> body = made<TypeParam>(bar, material());
  ASSERT_TRUE(body.setPlasticity(yielding(1e-2)).ok());
  Points velocities;
  for (const Vector3d& p : bar.mesh.nodes) velocities.push_back(Vector3d(0, 0, 3).cross(p - Vector3d(0.5, 0.1, 0.1)));
  fill(body.velocities(), velocities);
  run(body, 1.0, kFrame / 4);
  for (const double strain : body.plasticStrains()) EXPECT_EQ(strain, 0.0);
}

TYPED_TEST(MaterialChangesOf, FlowTakesEnergyAndGivesNone) {
  for (const Order order : {Order::Linear, Order::Quadratic}) {
    const Cage bar = barOf(order);
    for (const double damping : {0.0, 0.01}) {
      ElasticOptions options = material();
      options.stiffnessDamping = damping;
      ElasticBody<TypeParam> body = made<TypeParam>(bar, options);
      ASSERT_TRUE(body.setPlasticity(yielding(0.02)).ok());
      const std::vector<double> masses = lumped(bar.mesh);
      Points velocities;  // it bends, twists and shears
      for (const Vector3d& p : bar.mesh.nodes) {
        velocities.emplace_back(3.0 * p.y(), 12.0 * (p.x() - 0.5) * (p.x() - 0.5), 8.0 * p.x() * p.y());
      }
      fill(body.velocities(), velocities);
      const auto energyOf = [&] {
        const Motion motion = motionOf(body, masses);
        return 1000.0 * motion.kinetic + motion.elastic;
      };
      const double start = energyOf();
      double mean = start;
      for (int step = 0; step < 480; ++step) {
        body.step(kFrame / 4, {});
        const double now = energyOf();
        ASSERT_LT(now, 1.02 * start);
        mean += 0.05 * (now - mean);
      }
      const std::vector<double> strains = body.plasticStrains();
      EXPECT_GT(*std::max_element(strains.begin(), strains.end()), 0.01);
      EXPECT_LT(mean, 0.9 * start) << "what has flowed is lost";
    }
  }
}

TYPED_TEST(MaterialChangesOf, AResetBodyReturnsToItsFirstShape) {
  const Cage bar = barOf(Order::Linear);
  ElasticOptions options = material();
  options.stiffnessDamping = 0.1;
  ElasticBody<TypeParam> body = made<TypeParam>(bar, options);
  ASSERT_TRUE(body.setPlasticity(yielding(0.01)).ok());
  pinTheEnd(body, bar.mesh);
  for (int step = 0; step < 30; ++step) body.step(kFrame, {0, -30, 0});
  run(body, 3.0, kFrame);
  const double bent = (pointsOf(body.positions())[nodesAt(bar, 1.0)[0]] - bar.mesh.nodes[nodesAt(bar, 1.0)[0]]).norm();
  EXPECT_GT(bent, 0.05);
  ASSERT_TRUE(body.resetPlasticFlow().ok());
  run(body, 3.0, kFrame);
  const Points now = pointsOf(body.positions());
  for (std::size_t n = 0; n < now.size(); ++n) EXPECT_LT((now[n] - bar.mesh.nodes[n]).norm(), 2e-3 * bent + 1e-4);
}

TYPED_TEST(MaterialChangesOf, AFreeBodyThatGrowsHasNoStress) {
  for (const bool quadratic : {false, true}) {
    Cage cube;
    cube.mesh = makeBox({3, 3, 3}, Vector3d(0.3, 0.3, 0.3));
    if (quadratic) cube = refineQuadratic(cube).value();
    for (const int substeps : {1, 4}) {
      ElasticBody<TypeParam> body = made<TypeParam>(cube, material());
      ASSERT_TRUE(body.setGrowth(1.5).ok());
      run(body, 2.0, kFrame / substeps);
      EXPECT_NEAR(volumeOf(cube.mesh, pointsOf(body.positions())) / totalVolume(cube.mesh), 3.375, 1e-4);
      for (const auto& force : body.forces()) {
        for (const double f : force) EXPECT_LT(std::abs(f), 1e-5 * kYoung * 0.0225);
      }
      ASSERT_TRUE(body.setGrowth(1.0).ok());
      run(body, 2.0, kFrame / substeps);
      EXPECT_NEAR(volumeOf(cube.mesh, pointsOf(body.positions())) / totalVolume(cube.mesh), 1.0, 1e-4);
    }
  }
}

TYPED_TEST(MaterialChangesOf, GrowthAlongAnAxisLeavesTheOthers) {
  const Cage bar = barOf(Order::Linear);
  ElasticBody<TypeParam> body = made<TypeParam>(bar, material());
  ASSERT_TRUE(body.setGrowthTensors({bar.mesh.tetCount(), {1.3, 0, 0, 0, 1, 0, 0, 0, 1}}).ok());
  run(body, 3.0, kFrame);
  const Points now = pointsOf(body.positions());
  const auto box = boundingBox(now);
  EXPECT_NEAR(box.sizes().x(), 1.3, 1e-4);
  EXPECT_NEAR(box.sizes().y(), 0.25, 1e-4);
}

/// One half grows by 1 %: Timoshenko, "Analysis of bi-metal thermostats", J. Opt. Soc. Am. 11, 1925; with two equal
/// layers the curvature is 3 / 2 of the difference over the thickness.
TYPED_TEST(MaterialChangesOf, ABimetalStripBendsAsTimoshenkoSays) {
  constexpr double kThickness = 0.05, kGrowth = 0.01;
  Cage strip;
  strip.mesh = makeBox({20, 1, 2}, Vector3d(1.0, 0.05, kThickness));
  strip = refineQuadratic(strip).value();
  std::vector<double> growth;
  for (const Tet& tet : strip.mesh.tets) {
    double z = 0.0;
    for (const int n : tet) z += 0.25 * strip.mesh.nodes[static_cast<std::size_t>(n)].z();
    growth.push_back(z > 0.5 * kThickness ? 1.0 + kGrowth : 1.0);
  }
  const auto nodeAt = [&](double x) {
    for (const std::size_t n : nodesAt(strip, x)) {
      const Vector3d& p = strip.mesh.nodes[n];
      if (p.y() < 1e-9 && std::abs(p.z() - 0.5 * kThickness) < 1e-6) return n;
    }
    ADD_FAILURE() << "no node at " << x;
    return std::size_t(0);
  };
  for (const int substeps : {1, 4}) {
    ElasticOptions options = material(0.0);
    options.stiffnessDamping = 0.05;
    ElasticBody<TypeParam> body = made<TypeParam>(strip, options);
    ASSERT_TRUE(body.setGrowth(growth).ok());
    run(body, 6.0, kFrame / substeps);
    const Points now = pointsOf(body.positions());
    const Vector3d a = now[nodeAt(0.2)], middle = now[nodeAt(0.5)], b = now[nodeAt(0.8)];
    const double sagitta = (middle - 0.5 * (a + b)).norm(), half = 0.5 * (b - a).norm();
    const double curvature = 2.0 * sagitta / (half * half + sagitta * sagitta);
    EXPECT_NEAR(curvature / (1.5 * kGrowth / (1.0 + 0.5 * kGrowth) / kThickness), 1.0, 0.03) << substeps;
  }
}

/// A bar whose tets are all one muscle along it.
Muscle wholeBar(const Cage& bar, double stress) {
  Muscle muscle;
  for (std::size_t t = 0; t < bar.mesh.tetCount(); ++t) muscle.tets.push_back(static_cast<int>(t));
  muscle.fibres = {Vector3d(2, 0, 0)};
  muscle.stress = stress;
  return muscle;
}

TYPED_TEST(MaterialChangesOf, AMusclePullsWithItsStressAndShortensByItsLaw) {
  constexpr double kActivation = 0.5;
  for (const Order order : {Order::Linear, Order::Quadratic}) {
    const Cage bar = barOf(order);
    for (const double tension : {0.05, 0.3}) {  // over Young's modulus
      for (const double nu : {0.0, 0.3}) {
        for (const bool held : {false, true}) {
          ElasticBody<TypeParam> body = made<TypeParam>(bar, material(nu));
          const Result<int> muscle = body.addMuscle(wholeBar(bar, tension * kYoung / kActivation));
          ASSERT_TRUE(muscle.ok()) << muscle.status().message;
          const std::vector<std::size_t> ends[2] = {nodesAt(bar, 0.0), nodesAt(bar, 1.0)};
          for (const auto& end : ends) {
            for (const std::size_t n : end) body.setPinned(n, held);
          }
          ASSERT_TRUE(body.setActivation(muscle.value(), kActivation).ok());
          run(body, 3.0, kFrame / 4);
          double force = 0.0, length = 0.0;
          const auto forces = body.forces();
          for (const std::size_t n : ends[1]) force -= forces[n][0];
          for (const std::size_t n : ends[1]) length += body.positions()[n][0] / static_cast<double>(ends[1].size());
          for (const std::size_t n : ends[0]) length -= body.positions()[n][0] / static_cast<double>(ends[0].size());
          if (held) {
            EXPECT_NEAR(force / (tension * kYoung * 0.0625), 1.0, 0.02) << tension << " " << nu;
          } else {
            const double w = 2.0 * tension / (1.0 + std::sqrt(1.0 + 8.0 * nu * tension));
            EXPECT_NEAR(length, 1.0 / (1.0 + w), 1e-3) << tension << " " << nu;
          }
        }
      }
    }
  }
}

TYPED_TEST(MaterialChangesOf, ARelaxedMuscleIsTheBodyWithoutIt) {
  const Cage bar = barOf(Order::Linear);
  ElasticBody<TypeParam> plain = made<TypeParam>(bar, material()), body = made<TypeParam>(bar, material());
  ASSERT_TRUE(body.addMuscle(wholeBar(bar, 1e5)).ok());
  for (ElasticBody<TypeParam>* one : {&plain, &body}) {
    pinTheEnd(*one, bar.mesh);
    for (int step = 0; step < 20; ++step) one->step(kFrame, {0, -9.8, 0});
  }
  for (std::size_t n = 0; n < body.nodeCount(); ++n) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(plain.positions()[n][k], body.positions()[n][k]);
  }
}

/// Internal forces turn nothing and push nothing, whatever the rest shapes are.
TYPED_TEST(MaterialChangesOf, ForcesOfChangedShapesAreInBalance) {
  for (const Order order : {Order::Linear, Order::Quadratic}) {
    const Cage bar = barOf(order);
    ElasticBody<TypeParam> body = made<TypeParam>(bar, material());
    Muscle muscle = wholeBar(bar, 4e5);
    muscle.fibres = {Vector3d(1, 2, -1)};
    ASSERT_TRUE(body.addMuscle(muscle).ok());
    ASSERT_TRUE(body.setActivation(0, 1.0).ok());
    ASSERT_TRUE(body.setPlasticity(yielding(0.02)).ok());
    std::vector<double> growth;
    for (std::size_t t = 0; t < bar.mesh.tetCount(); ++t) growth.push_back(1.0 + 0.002 * static_cast<double>(t % 90));
    ASSERT_TRUE(body.setGrowth(growth).ok());
    for (int step = 0; step < 2; ++step) body.step(kFrame, {});
    const Points now = pointsOf(body.positions());
    const auto forces = body.forces();
    Vector3d sum = Vector3d::Zero(), torque = Vector3d::Zero();
    double largest = 0.0;
    for (std::size_t n = 0; n < now.size(); ++n) {
      const Vector3d f(forces[n][0], forces[n][1], forces[n][2]);
      sum += f, torque += now[n].cross(f), largest = std::max(largest, f.norm());
    }
    ASSERT_GT(largest, 1.0);
    const double tolerance = sizeof(TypeParam) == sizeof(float) ? 1e-4 : 1e-9;
    EXPECT_LT(sum.norm(), tolerance * largest);
    EXPECT_LT(torque.norm(), tolerance * largest);
  }
}

TYPED_TEST(MaterialChangesOf, ExtremesStayFiniteAndComeBack) {
  const Cage bar = barOf(Order::Linear);
  for (const double growth : {0.05, 20.0}) {
    ElasticOptions options = material();
    options.stiffnessDamping = 0.1;
    ElasticBody<TypeParam> body = made<TypeParam>(bar, options);
    ASSERT_TRUE(body.setPlasticity(yielding(1e-6)).ok());
    ASSERT_TRUE(body.setGrowth(growth).ok());
    run(body, 1.0, kFrame);
    EXPECT_LT(fastest(body), kInfinity);
    ASSERT_TRUE(body.setGrowth(1.0).ok());
    ASSERT_TRUE(body.endPlasticity().ok() && body.resetPlasticFlow().ok());
    run(body, 8.0, kFrame);
    EXPECT_GT(smallestVolume(bar.mesh, pointsOf(body.positions())), 0.5) << growth;
  }
  ElasticBody<TypeParam> crushed = made<TypeParam>(bar, material());
  ASSERT_TRUE(crushed.setPlasticity(yielding(0.01)).ok());
  Points points = bar.mesh.nodes;
  for (Vector3d& p : points) p.x() *= -0.2;
  fill(crushed.positions(), points);
  run(crushed, 3.0, kFrame);
  EXPECT_LT(fastest(crushed), 0.1);
}

TEST(MaterialChanges, BadValuesAreRefusedAndNothingChanges) {
  const Cage bar = barOf(Order::Linear);
  ElasticBody<double> body = made<double>(bar, material());
  const auto refused = [](const Status& status, StatusCode code, const std::string& part) {
    EXPECT_EQ(status.code, code) << status.message;
    EXPECT_NE(status.message.find(part), std::string::npos) << status.message;
  };
  Plasticity plasticity;
  refused(body.setPlasticity(plasticity), StatusCode::InvalidOption, "yield stress");
  plasticity = yielding(0.01);
  plasticity.yieldStresses = {1.0, 2.0};
  refused(body.setPlasticity(plasticity), StatusCode::SizeMismatch, "2 values");
  plasticity.yieldStresses.assign(bar.mesh.tetCount(), 1.0);
  plasticity.yieldStresses[7] = 0.0;
  refused(body.setPlasticity(plasticity), StatusCode::InvalidOption, "tet 7");
  plasticity = yielding(0.01);
  plasticity.hardening = -1.0;
  refused(body.setPlasticity(plasticity), StatusCode::InvalidOption, "hardening");
  plasticity = yielding(0.01);
  plasticity.flowRate = 0.0;
  refused(body.setPlasticity(plasticity), StatusCode::InvalidOption, "rate of flow");
  plasticity = yielding(0.01);
  plasticity.largestStrain = std::nan("");
  refused(body.setPlasticity(plasticity), StatusCode::InvalidOption, "largest");
  refused(body.setGrowth(0.0), StatusCode::InvalidOption, "0.05 to 20");
  refused(body.setGrowth(std::vector<double>{1.0, 1.0}), StatusCode::SizeMismatch, "growth");
  refused(body.setGrowthTensors({bar.mesh.tetCount(), {1, 0.5, 0, 0, 1, 0, 0, 0, 1}}), StatusCode::InvalidOption,
          "symmetric");
  Muscle muscle;
  refused(body.addMuscle(muscle).status(), StatusCode::InvalidOption, "at least one tet");
  muscle = wholeBar(bar, 1e5);
  muscle.tets[3] = static_cast<int>(bar.mesh.tetCount());
  refused(body.addMuscle(muscle).status(), StatusCode::IndexOutOfRange, "does not exist");
  muscle.tets[3] = 2;
  refused(body.addMuscle(muscle).status(), StatusCode::InvalidOption, "twice");
  muscle = wholeBar(bar, 1e5);
  muscle.fibres = {Vector3d::Zero()};
  refused(body.addMuscle(muscle).status(), StatusCode::InvalidOption, "fibre 0");
  refused(body.setActivation(0, 0.5), StatusCode::IndexOutOfRange, "muscle 0");
  ASSERT_TRUE(body.addMuscle(wholeBar(bar, 1e5)).ok());
  refused(body.setActivation(0, 1.5), StatusCode::InvalidOption, "0 to 1");
  run(body, 0.5, kFrame);
  EXPECT_EQ(body.energy(), 0.0);
  ElasticBody<double> none;
  EXPECT_FALSE(none.setGrowth(1.1).ok());
  EXPECT_FALSE(none.setPlasticity(yielding(0.1)).ok());
}

TEST(MaterialChanges, FibresFollowTheNearestPieceOfACurve) {
  const Cage bar = barOf(Order::Linear);
  const std::vector<int> all = wholeBar(bar, 1e5).tets;
  const Vector3d start(0, 0.1, 0.1), bend(0.5, 0.1, 0.1), end(0.5, 0.1, 9.0);
  const std::vector<Vector3d> fibres = fibresAlong(bar.mesh, all, {start, start, bend, end}).value();
  ASSERT_EQ(fibres.size(), all.size());
  int along = 0;
  for (const int t : all) {
    const Vector3d& fibre = fibres[static_cast<std::size_t>(t)];
    const bool isAlong = fibre.isApprox(Vector3d(1, 0, 0));
    EXPECT_TRUE(isAlong || fibre.isApprox(Vector3d(0, 0, 1)));
    double x = 0.0;
    for (const int n : bar.mesh.tets[static_cast<std::size_t>(t)])
      x += 0.25 * bar.mesh.nodes[static_cast<std::size_t>(n)].x();
    if (x < 0.35) {
      EXPECT_TRUE(isAlong) << x;
    }
    along += isAlong;
  }
  EXPECT_LT(along, static_cast<int>(all.size()));
  for (const auto& curve : {std::vector<Vector3d>{}, std::vector<Vector3d>{start, start}}) {
    EXPECT_EQ(fibresAlong(bar.mesh, all, curve).status().code, StatusCode::InvalidOption);
  }
}

TEST(MaterialChanges, AYieldStrainConvertsToTheStressAtWhichABarYields) {
  // In a pulled bar of strain e the deviator's norm is sqrt(2/3) (1 + nu) e.
  const double strain = 0.01, nu = 0.3;
  EXPECT_NEAR(yieldStressOf(std::sqrt(2.0 / 3.0) * (1.0 + nu) * strain, kYoung, nu), strain * kYoung, 1e-9 * kYoung);
}

TYPED_TEST(MaterialChangesOf, StiffnessByTetMovesTheMiddleOfAStretchedBar) {
  constexpr double kStretch = 0.02;
  for (const Order order : {Order::Linear, Order::Quadratic}) {
    const Cage bar = barOf(order);
    ElasticBody<TypeParam> body = made<TypeParam>(bar, material());
    for (const double end : {0.0, 1.0}) {
      for (const std::size_t n : nodesAt(bar, end)) {
        body.setPinned(n);
        body.positions()[n][0] += static_cast<TypeParam>(kStretch * end);
      }
    }
    std::vector<double> factors;
    for (const Tet& tet : bar.mesh.tets) {
      Vector3d centre(0, 0, 0);
      for (const int n : tet) centre += 0.25 * bar.mesh.nodes[static_cast<std::size_t>(n)];
      factors.push_back(centre.x() < 0.5 ? 1.0 : 4.0);
    }
    const auto middle = [&] {
      run(body, 2.0, kFrame);
      double sum = 0.0;
      const std::vector<std::size_t> nodes = nodesAt(bar, 0.5);
      for (const std::size_t n : nodes) sum += static_cast<double>(body.positions()[n][0]) - 0.5;
      return sum / static_cast<double>(nodes.size()) / kStretch;
    };
    EXPECT_NEAR(middle(), 0.5, 0.01);
    ASSERT_TRUE(body.setStiffnessScale(factors).ok());
    EXPECT_NEAR(middle(), 0.8, 0.02);
    ASSERT_TRUE(body.setStiffnessScale(std::vector<double>(factors.size(), 1.0)).ok());
    EXPECT_NEAR(middle(), 0.5, 0.01);
    const double before = body.energy();
    ASSERT_TRUE(body.setStiffnessScale(std::vector<double>(factors.size(), 4.0)).ok());
    EXPECT_NEAR(body.energy() / before, 4.0, 1e-4);
    EXPECT_EQ(body.setStiffnessScale({1.0}).code, StatusCode::SizeMismatch);
    factors[3] = 0.0;
    EXPECT_EQ(body.setStiffnessScale(factors).code, StatusCode::InvalidOption);
    EXPECT_NEAR(body.energy() / before, 4.0, 1e-4);
  }
}

}  // namespace
}  // namespace tetskin::test
