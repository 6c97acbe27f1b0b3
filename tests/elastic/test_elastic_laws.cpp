// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Laws of elasticity at large strains, by their closed forms.
#include <tetskin/elastic/elastic_body.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <functional>

#include "elastic_motion.h"
#include "support/bars.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

constexpr double kE = 1e5, kArea = 0.0625;  // Young's modulus; m^2

template <class S>
class ElasticLawsOf : public WithScalar<S> {};
TYPED_TEST_SUITE(ElasticLawsOf, Scalars);

const std::vector<ElasticLaw>& lawsOfTests() {
  static const std::vector<ElasticLaw> laws{ElasticLaw::neoHookean(), ElasticLaw::yeoh(0.1, 0.01),
                                            ElasticLaw::yeoh(-0.04, 0.005), ElasticLaw::yeoh(3.0, 8.0)};
  return laws;
}

ElasticOptions lawOptions(double nu, double damping = 0.0, double youngsModulus = kE) {
  ElasticOptions options;
  options.youngsModulus = youngsModulus;
  options.poissonRatio = nu;
  options.density = 1000.0;
  options.stiffnessDamping = damping;
  options.tolerance = 1e-4;
  return options;
}

/// The energy per volume over Young's modulus, as it stands in hyperelasticity.h, by principal stretches.
double closedEnergy(const ElasticLaw& law, double nu, const Vector3d& s) {
  const double mu = 0.5 / (1.0 + nu), lambda = nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  const double i = s.squaredNorm(), j = s.prod(), grown = j - 1.0;
  const double power = grown < 3.0 ? 3.0 + 2.0 * grown - grown * grown / 3.0 : 6.0;  // of 3 J^(2/3)
  const double distortion = std::max(i - power, 0.0), b = std::pow(std::max(3.0 - i, 0.0) / 3.0, 3.0);
  const double k = std::min(distortion, largestDistortion(law));  // beyond, in proportion
  const double stiffened = k * k * (law.c2 + law.c3 * k) + k * (2.0 * law.c2 + 3.0 * law.c3 * k) * (distortion - k);
  return 0.5 * mu * (i - 3.0 + b + stiffened) - mu * grown + 0.5 * (lambda + mu) * grown * grown;
}

/// The first Piola-Kirchhoff stress along the axes, over Young's modulus, by differences.
Vector3d closedStress(const ElasticLaw& law, double nu, const Vector3d& s) {
  constexpr double kStep = 1e-5;
  Vector3d stress;
  for (int k = 0; k < 3; ++k) {
    Vector3d more = s, less = s;
    more[k] += kStep;
    less[k] -= kStep;
    stress[k] = (closedEnergy(law, nu, more) - closedEnergy(law, nu, less)) / (2.0 * kStep);
  }
  return stress;
}

/// The forces on the faces at the ends of x and y of a bar of 1 x 0.25 x 0.25, over their areas at rest.
template <class S>
std::array<Vector3d, 2> tractions(ElasticBody<S>& body, const Cage& bar, const Eigen::Matrix3d& deformation) {
  Points nodes;
  for (const Vector3d& p : bar.mesh.nodes) nodes.push_back(deformation * p);
  fill(body.positions(), nodes);
  const auto forces = body.forces();
  std::array<Vector3d, 2> sums{Vector3d::Zero(), Vector3d::Zero()};
  for (std::size_t n = 0; n < body.nodeCount(); ++n) {
    const Vector3d& p = bar.mesh.nodes[n];
    const Vector3d force(forces[n][0], forces[n][1], forces[n][2]);
    // Each face has all of its edges' nodes: those of a corner or an edge belong to other faces, too. So the sums are
    // over half of the body: the force on a plane section.
    if (p.x() > 0.501) sums[0] -= force;
    if (p.y() > 0.126) sums[1] -= force;
  }
  return {Vector3d(sums[0] / kArea), Vector3d(sums[1] / 0.25)};
}

struct Deformed {
  const char* name;
  std::function<Vector3d(double)> stretches;
};

const std::vector<Deformed>& waysToDeform() {
  static const std::vector<Deformed> ways{
      {"uniaxial", [](double s) { return Vector3d(s, 1.0 / std::sqrt(s), 1.0 / std::sqrt(s)); }},
      {"narrow", [](double s) { return Vector3d(s, 1.0 - 0.3 * (s - 1.0), 1.0 - 0.3 * (s - 1.0)); }},
      {"equibiaxial", [](double s) { return Vector3d(s, s, 1.0 / (s * s)); }},
      {"planar", [](double s) { return Vector3d(s, 1.0 / s, 1.0); }},
      {"volumetric", [](double s) { return Vector3d(s, s, s); }},
      {"along one axis", [](double s) { return Vector3d(s, 1.0, 1.0); }},
      {"inside out", [](double s) { return Vector3d(-s, 1.0, 0.9); }},
  };
  return ways;
}

TYPED_TEST(ElasticLawsOf, StressesAndEnergiesAreThoseOfTheLaw) {
  const bool single = sizeof(TypeParam) == sizeof(float);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  for (const bool quadratic : {false, true}) {
    const Cage bar = boxCage({4, 2, 2}, Vector3d(1.0, 0.25, 0.25), quadratic);
    for (const ElasticLaw& law : lawsOfTests()) {
      for (const double nu : {0.0, 0.3, 0.45}) {
        ElasticBody<TypeParam> body = made<TypeParam>(bar, lawOptions(nu));
        ASSERT_TRUE(body.setElasticLaw(law).ok());
        for (const Deformed& way : waysToDeform()) {
          for (const double s : {0.4, 0.7, 0.99, 1.001, 1.3, 1.8, 2.5}) {
            const Vector3d stretches = way.stretches(s);
            // A quadratic tet that is inside out is taken as a whole, and is corotated.
            if (quadratic && stretches.prod() < 0.0) continue;
            const Eigen::Matrix3d along = stretches.asDiagonal();
            const std::array<Vector3d, 2> found = tractions(body, bar, turn * along);
            const Vector3d wanted = closedStress(law, nu, stretches);
            const double size = std::max(wanted.cwiseAbs().maxCoeff(), 0.01), digits = single ? 2e-4 : 1e-7;
            const std::string where = std::string(way.name) + " " + std::to_string(s) + " nu " + std::to_string(nu) +
                                      " c3 " + std::to_string(law.c3) + (quadratic ? " quadratic" : "");
            EXPECT_LT((found[0] / kE - wanted[0] * turn.col(0)).norm(), digits * size) << where;
            EXPECT_LT((found[1] / kE - wanted[1] * turn.col(1)).norm(), digits * size) << where;
            const double energy = closedEnergy(law, nu, stretches);
            EXPECT_NEAR(body.energy() / (kE * kArea), energy, digits * std::max(energy, 0.01)) << where;
          }
        }
      }
    }
  }
}

TYPED_TEST(ElasticLawsOf, SimpleShearHasTheLawsStress) {
  const double digits = sizeof(TypeParam) == sizeof(float) ? 2e-4 : 1e-7, nu = 0.45;
  const Cage bar = boxCage({4, 2, 2}, Vector3d(1.0, 0.25, 0.25), false);
  for (const ElasticLaw& law : lawsOfTests()) {
    ElasticBody<TypeParam> body = made<TypeParam>(bar, lawOptions(nu));
    ASSERT_TRUE(body.setElasticLaw(law).ok());
    for (const double shear : {0.01, 0.5, 1.5}) {
      Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
      f(0, 1) = shear;
      const std::array<Vector3d, 2> found = tractions(body, bar, f);
      // The volume stays: P = mu (1 + 2 c2 K + 3 c3 K^2) (F - F^-T), K = shear^2.
      const double k = std::min(shear * shear, largestDistortion(law)), mu = 0.5 / (1.0 + nu);
      const double factor = 1.0 + 2.0 * law.c2 * k + 3.0 * law.c3 * k * k;
      const Eigen::Matrix3d stress = mu * factor * (f - f.inverse().transpose());
      EXPECT_LT((found[0] / kE - stress.col(0)).norm(), digits * stress.norm()) << shear;
      EXPECT_LT((found[1] / kE - stress.col(1)).norm(), digits * stress.norm()) << shear;
    }
  }
}

/// The curve of a testing machine: a bar whose sides are free, with Poisson's ratio near a half.
TYPED_TEST(ElasticLawsOf, ABarWithFreeSidesMeetsTheCurve) {
  constexpr double kNu = 0.499;
  const Cage bar = boxCage({4, 2, 2}, Vector3d(1.0, 0.25, 0.25), false);
  const std::vector<ElasticLaw> laws{ElasticLaw::corotated(), ElasticLaw::neoHookean(), ElasticLaw::yeoh(0.1, 0.01),
                                     ElasticLaw::yeoh(-0.04, 0.005)};
  for (const ElasticLaw& law : laws) {
    ElasticBody<double> body = made<double>(bar, lawOptions(kNu));
    ASSERT_TRUE(body.setElasticLaw(law).ok());
    for (const double s : {0.5, 0.8, 1.2, 2.0, 2.5}) {
      double low = 0.2, high = 2.0;  // width at which nothing pulls across
      for (int k = 0; k < 60; ++k) {
        const double width = 0.5 * (low + high);
        const Eigen::Matrix3d f = Vector3d(s, width, width).asDiagonal();
        (tractions(body, bar, f)[1].y() > 0.0 ? high : low) = width;
      }
      const Eigen::Matrix3d f = Vector3d(s, low, low).asDiagonal();
      const double wanted = nominalStress(law, Loading::Uniaxial, s);
      EXPECT_NEAR(tractions(body, bar, f)[0].x() / kE / wanted, 1.0, 0.01) << s << " c3 " << law.c3;
    }
  }
}

TEST(ElasticLaws, NominalStressesAreThoseOfTextbooks) {
  const ElasticLaw nh = ElasticLaw::neoHookean();
  EXPECT_NEAR(nominalStress(nh, Loading::Uniaxial, 2.0), 0.58333, 1e-5);
  EXPECT_NEAR(nominalStress(nh, Loading::Uniaxial, 0.5), -1.16667, 1e-5);
  EXPECT_NEAR(nominalStress(nh, Loading::Equibiaxial, 2.0), (2.0 - 1.0 / 32.0) / 3.0, 1e-12);
  EXPECT_NEAR(nominalStress(nh, Loading::Planar, 2.0), (2.0 - 0.125) / 3.0, 1e-12);
  EXPECT_NEAR(nominalStress(ElasticLaw::yeoh(0.1, 0.01), Loading::Uniaxial, 2.0), 0.58333 * (1.0 + 0.4 + 0.12), 1e-5);
  EXPECT_NEAR(nominalStress(ElasticLaw(), Loading::Planar, 1.5), 2.0 / 3.0, 1e-12);
}

TEST(ElasticLaws, BeyondAHundredTimesTheStiffnessTheyGoOnInProportion) {
  EXPECT_EQ(largestDistortion(ElasticLaw::neoHookean()), 60.0);
  EXPECT_EQ(largestDistortion(ElasticLaw::yeoh(-0.0097, 0.00027)), 60.0);
  for (const auto& [c2, c3] : {std::pair(1.0, 0.0), std::pair(0.4, 0.2), std::pair(-0.1, 0.05), std::pair(0.0, 0.1)}) {
    const double k = largestDistortion(ElasticLaw::yeoh(c2, c3));
    EXPECT_NEAR(1.0 + 2.0 * c2 * k + 3.0 * c3 * k * k, 100.0, 1e-9);
  }
  const ElasticLaw steep = ElasticLaw::yeoh(0.4, 0.2), nh = ElasticLaw::neoHookean();
  EXPECT_NEAR(nominalStress(steep, Loading::Uniaxial, 6.0), 100.0 * nominalStress(nh, Loading::Uniaxial, 6.0), 1e-9);
}

TEST(ElasticLaws, AFitFindsTheLawOfACurve) {
  for (const ElasticLaw& law : lawsOfTests()) {
    std::vector<StressPoint> points;
    for (const Loading loading : {Loading::Uniaxial, Loading::Equibiaxial, Loading::Planar}) {
      for (const double s : {0.6, 0.9, 1.1, 1.5, 2.0, 3.0}) {
        const double across = loading == Loading::Equibiaxial ? s
                              : loading == Loading::Planar    ? 1.0
                                                              : 1.0 / std::sqrt(s);
        if (Vector3d(s, across, 1.0 / (s * across)).squaredNorm() - 3.0 < largestDistortion(law))
          points.push_back({s, 2e5 * nominalStress(law, loading, s), loading});
      }
    }
    const Result<FittedLaw> fit = fitElasticLaw(ElasticLaw::Kind::Yeoh, points);
    ASSERT_TRUE(fit.ok());
    EXPECT_NEAR(fit.value().youngsModulus, 2e5, 1.0);
    EXPECT_NEAR(fit.value().law.c2, law.c2, 1e-6 * (1.0 + law.c3));
    EXPECT_NEAR(fit.value().law.c3, law.c3, 1e-6 * (1.0 + law.c3));
    EXPECT_LT(fit.value().error, 1e-9);
  }
}

/// L. R. G. Treloar, "Stress-strain data for vulcanised rubber under various types of deformation", Trans. Faraday Soc.
/// 40 (1944), doi 10.1039/TF9444000059: vulcanised rubber, MPa, as tabulated by P. Steinmann, M. Hossain, G. Possart,
/// "Hyperelastic models for rubber-like materials", Arch. Appl. Mech. 82 (2012), doi 10.1007/s00419-012-0610-z.
std::vector<StressPoint> treloarsRubber() {
  std::vector<StressPoint> points;
  const auto add = [&](Loading loading, const std::vector<std::array<double, 2>>& curve) {
    for (const auto& [stretch, stress] : curve) points.push_back({stretch, 1e6 * stress, loading});
  };
  add(Loading::Uniaxial, {{1.12, 0.14},
                          {1.24, 0.23},
                          {1.39, 0.32},
                          {1.61, 0.41},
                          {1.89, 0.50},
                          {2.17, 0.58},
                          {2.42, 0.67},
                          {3.01, 0.85},
                          {3.58, 1.04},
                          {4.03, 1.21},
                          {4.76, 1.58},
                          {5.36, 1.94},
                          {5.76, 2.29},
                          {6.16, 2.67}});
  add(Loading::Planar, {{1.14, 0.16},
                        {1.21, 0.24},
                        {1.32, 0.33},
                        {1.46, 0.42},
                        {1.87, 0.59},
                        {2.40, 0.76},
                        {2.98, 0.93},
                        {3.48, 1.11},
                        {3.96, 1.28},
                        {4.36, 1.46},
                        {4.69, 1.62},
                        {4.96, 1.79}});
  return points;
}

TEST(ElasticLaws, YeohsLawMeetsRubberFarBetterThanTheOthers) {
  const std::vector<StressPoint> rubber = treloarsRubber();
  const FittedLaw yeoh = fitElasticLaw(ElasticLaw::Kind::Yeoh, rubber).value();
  const FittedLaw neoHookean = fitElasticLaw(ElasticLaw::Kind::NeoHookean, rubber).value();
  const FittedLaw linear = fitElasticLaw(ElasticLaw::Kind::Corotated, rubber).value();
  RecordProperty("yeoh", std::to_string(yeoh.error));
  std::printf("E %.3g c2 %.4g c3 %.4g: %.3f; neo-Hookean %.3f; linear %.3f\n", yeoh.youngsModulus, yeoh.law.c2,
              yeoh.law.c3, yeoh.error, neoHookean.error, linear.error);
  EXPECT_LT(yeoh.error, 0.12);
  EXPECT_LT(yeoh.error, 0.7 * neoHookean.error);
  EXPECT_LT(yeoh.error, 0.7 * linear.error);
}

TEST(ElasticLaws, BadOnesAreRefused) {
  ElasticBody<double> body = made<double>(Cage(singleTet()), lawOptions(0.3));
  EXPECT_EQ(body.setElasticLaw(ElasticLaw::yeoh(-0.1, 0.0)).code, StatusCode::InvalidOption);
  EXPECT_EQ(body.setElasticLaw(ElasticLaw::yeoh(-0.5, 0.05)).code, StatusCode::InvalidOption);
  EXPECT_EQ(body.setElasticLaw(ElasticLaw::yeoh(kInfinity, 0.0)).code, StatusCode::InvalidOption);
  EXPECT_EQ(body.setElasticLaw(ElasticLaw::yeoh(std::nan(""), 0.0)).code, StatusCode::InvalidOption);
  EXPECT_EQ(body.setElasticLaw({ElasticLaw::Kind::NeoHookean, 0.1, 0.0}).code, StatusCode::InvalidOption);
  EXPECT_EQ(body.setElasticLaw(ElasticLaw::neoHookean(), {1}).code, StatusCode::IndexOutOfRange);
  EXPECT_EQ(body.setElasticLaw(ElasticLaw::neoHookean(), {0, 0}).code, StatusCode::InvalidOption);
  EXPECT_TRUE(body.setElasticLaw(ElasticLaw::neoHookean(), {0}).ok());
  EXPECT_FALSE(fitElasticLaw(ElasticLaw::Kind::Yeoh, {{1.5, 1.0}, {2.0, 2.0}}).ok());
  EXPECT_FALSE(fitElasticLaw(ElasticLaw::Kind::NeoHookean, {{1.5, -1.0}}).ok());
}

TYPED_TEST(ElasticLawsOf, EachRegionHasItsOwn) {
  const Cage bar = boxCage({4, 2, 2}, Vector3d(1.0, 0.25, 0.25), false);
  std::vector<int> half;
  for (std::size_t t = 0; t < bar.mesh.tetCount(); ++t) {
    double x = 0.0;
    for (const int n : bar.mesh.tets[t]) x += 0.25 * bar.mesh.nodes[static_cast<std::size_t>(n)].x();
    if (x > 0.5) half.push_back(static_cast<int>(t));
  }
  ElasticBody<TypeParam> mixed = made<TypeParam>(bar, lawOptions(0.3)), linear = made<TypeParam>(bar, lawOptions(0.3)),
                         other = made<TypeParam>(bar, lawOptions(0.3));
  ASSERT_TRUE(mixed.setElasticLaw(ElasticLaw::yeoh(0.5, 0.2), half).ok());
  ASSERT_TRUE(other.setElasticLaw(ElasticLaw::yeoh(0.5, 0.2)).ok());
  const Eigen::Matrix3d f = Vector3d(1.6, 0.9, 0.8).asDiagonal();
  (void)tractions(mixed, bar, f);
  (void)tractions(linear, bar, f);
  (void)tractions(other, bar, f);
  const auto ofMixed = mixed.forces(), ofLinear = linear.forces(), ofOther = other.forces();
  for (std::size_t n = 0; n < ofMixed.size(); ++n) {
    const double x = bar.mesh.nodes[n].x();
    if (x != 0.5) {
      EXPECT_EQ(ofMixed[n], x < 0.5 ? ofLinear[n] : ofOther[n]);
    }
  }
  EXPECT_NEAR(mixed.energy(), 0.5 * (linear.energy() + other.energy()), 1e-5 * mixed.energy());
  ASSERT_TRUE(mixed.setElasticLaw(ElasticLaw(), half).ok());
  EXPECT_EQ(mixed.forces(), ofLinear);
}

TYPED_TEST(ElasticLawsOf, WhatIsFlatCollapsedOrInsideOutComesBack) {
  const std::vector<std::function<Vector3d(const Vector3d&)>> damages{
      [](const Vector3d& p) { return Vector3d(p.x(), p.y(), 0.3); },
      [](const Vector3d& p) { return Vector3d(p.x(), 0.0, 0.3); },
      [](const Vector3d&) { return Vector3d(0.1, 0.2, 0.3); },
      [](const Vector3d& p) { return Vector3d(p.x(), p.y(), -p.z()); },
      [](const Vector3d& p) { return Vector3d(-p); },
  };
  for (const Cage& of : {Cage(singleTet()), Cage(jittered(latticeCage(3, 2, 2), 0.1, 3)),
                         refineQuadratic(jittered(latticeCage(2, 1, 1), 0.1, 3)).value()}) {
    for (const ElasticLaw& law : {ElasticLaw::neoHookean(), ElasticLaw::yeoh(0.5, 0.2)}) {
      for (const double nu : {0.3, 0.45}) {
        for (const double youngsModulus : {1e3, 1e5, 1e7}) {
          for (std::size_t d = 0; d < damages.size(); ++d) {
            ElasticBody<TypeParam> body =
                made<TypeParam>(of, lawOptions(nu, 0.01 * std::sqrt(1e5 / youngsModulus), youngsModulus));
            ASSERT_TRUE(body.setElasticLaw(law).ok());
            Points nodes;
            for (const Vector3d& p : of.mesh.nodes) nodes.push_back(damages[d](p));
            fill(body.positions(), nodes);
            int steps = 0;
            const int most = youngsModulus < 1e4 ? 3000 : 600;
            while (steps < most && !(smallestVolume(of.mesh, pointsOf(body.positions())) > 0.9)) {
              body.step(1.0 / 60.0);
              ++steps;
            }
            EXPECT_LT(steps, most) << d << " of " << of.mesh.tetCount() << " tets, c3 " << law.c3 << " nu " << nu
                                   << " E " << youngsModulus << " least "
                                   << smallestVolume(of.mesh, pointsOf(body.positions()));
          }
        }
      }
    }
  }
}

TYPED_TEST(ElasticLawsOf, WhatIsCrushedGainsNoEnergy) {
  for (const bool quadratic : {false, true}) {
    const Cage block = boxCage({4, 4, 4}, Vector3d(0.4, 0.4, 0.4), quadratic);
    const std::vector<double> masses = [&] {
      std::vector<double> all = lumped(block.mesh);
      for (double& m : all) m *= 1000.0;
      return all;
    }();
    for (const ElasticLaw& law : {ElasticLaw::neoHookean(), ElasticLaw::yeoh(0.1, 0.01), ElasticLaw::yeoh(3.0, 8.0)}) {
      for (const double youngsModulus : {1e4, 1e6}) {
        for (const double crushed : {0.2, 2.2}) {
          for (const int substeps : {1, 4, 16}) {
            // Quadratic tets with points that are inside out change to another energy: damping takes what that gives.
            ElasticOptions options = lawOptions(0.45, quadratic ? 0.005 : 0.0, youngsModulus);
            options.nodeMasses = masses;
            ElasticBody<TypeParam> body = made<TypeParam>(block, options);
            ASSERT_TRUE(body.setElasticLaw(law).ok());
            Points nodes;
            for (const Vector3d& p : block.mesh.nodes) nodes.emplace_back(p.x(), crushed * p.y(), p.z());
            fill(body.positions(), nodes);
            const double start = body.energy();
            double most = 0.0;
            for (int k = 0; k < 60 * substeps; ++k) {
              body.step(1.0 / 60.0 / substeps);
              most = std::max(most, motionOf(body, options.nodeMasses).energy());
            }
            EXPECT_LT(most, 1.05 * start) << "E " << youngsModulus << " to " << crushed << " c3 " << law.c3 << " "
                                          << substeps << " substeps" << (quadratic ? ", quadratic" : "");
          }
        }
      }
    }
  }
}

/// The matrix of a step knows nothing of how stiff its neighbours become when a node is thrown back into them.
TYPED_TEST(ElasticLawsOf, WhatStiffensWithinAStepGainsNoEnergy) {
  const Cage block = boxCage({2, 4, 2}, Vector3d(0.2, 0.4, 0.2), false);
  std::vector<double> masses = lumped(block.mesh);
  for (double& m : masses) m /= 0.016;  // 1 kg
  for (const ElasticLaw& law : {ElasticLaw::neoHookean(), ElasticLaw::yeoh(0.4, 0.2)}) {
    for (int start = 0; start < 60; ++start) {
      ElasticOptions options = lawOptions(0.3, 0.0, 1000.0);
      options.nodeMasses = masses;
      ElasticBody<TypeParam> body = made<TypeParam>(block, options);
      ASSERT_TRUE(body.setElasticLaw(law).ok());
      Points nodes = block.mesh.nodes;
      const double by = std::pow(10.0, -1.0 + (start % 12) / 6.0);
      nodes[static_cast<std::size_t>(7 * start) % nodes.size()] +=
          by * Vector3d(std::sin(1.0 + start), std::sin(2.0 + 3.0 * start), std::sin(3.0 + 5.0 * start));
      fill(body.positions(), nodes);
      const double stored = body.energy();
      for (int k = 0; k < 30; ++k) {
        body.step(1.0 / 60.0);
        ASSERT_LT(motionOf(body, masses).energy(), 1.02 * stored)
            << "c2 " << law.c2 << " start " << start << " step " << k;
      }
    }
  }
}

/// Seconds of damping in which a bar without inertia, whose length and widths begin as these, comes to a length: its
/// forces are those of the law, and its viscosity that of small strains.
double dampingsUntil(const ElasticLaw& law, double nu, Vector3d stretches, double length) {
  const double mu = 0.5 / (1.0 + nu), lambda = nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), step = 1e-3;
  Eigen::Matrix3d viscosity = lambda * Eigen::Matrix3d::Ones();
  viscosity.diagonal().array() += 2.0 * mu;
  double seconds = 0.0;
  for (; stretches[0] > length; seconds += step)
    stretches -= step * viscosity.ldlt().solve(closedStress(law, nu, stretches));
  return seconds;
}

TYPED_TEST(ElasticLawsOf, ViscosityDoesNotGrowWithTheStiffness) {
  constexpr double kDamping = 1.0, kStep = 1.0 / 240, kNu = 0.45, kEnd = 1.4;
  const Vector3d from(2.2, 0.6742, 0.6742);
  const Cage bar = boxCage({8, 2, 2}, Vector3d(1.0, 0.25, 0.25), true);
  for (const ElasticLaw& law : {ElasticLaw::neoHookean(), ElasticLaw::yeoh(0.4, 0.2)}) {
    ElasticOptions options = lawOptions(kNu, kDamping, 1e6);
    options.density = 1.0;
    ElasticBody<TypeParam> body = made<TypeParam>(bar, options);
    ASSERT_TRUE(body.setElasticLaw(law).ok());
    Points nodes;
    for (const Vector3d& p : bar.mesh.nodes) nodes.push_back(from.cwiseProduct(p));
    fill(body.positions(), nodes);
    int steps = 0;
    for (double length = from[0]; length > kEnd && steps < 2400; ++steps) {
      body.step(kStep);
      const Points now = pointsOf(body.positions());
      const auto [low, high] = std::minmax_element(now.begin(), now.end(),
                                                   [](const Vector3d& p, const Vector3d& q) { return p.x() < q.x(); });
      length = high->x() - low->x();
    }
    EXPECT_NEAR(steps * kStep / dampingsUntil(law, kNu, from, kEnd), 1.0, 0.05) << "c2 " << law.c2;
  }
}

/// A bar that hangs from its end, at rest: each section carries what is below it.
TYPED_TEST(ElasticLawsOf, AHangingBarIsAsLongAsTheLawSays) {
  const double density = 1000.0, gravity = 9.81;
  const Cage bar = boxCage({64, 2, 2}, Vector3d(1.0, 0.03125, 0.03125), true);
  for (const ElasticLaw& law : {ElasticLaw::neoHookean(), ElasticLaw::yeoh(0.3, 0.1)}) {
    ElasticOptions options = lawOptions(0.45, 0.1, 1.2e4);
    ElasticBody<TypeParam> body = made<TypeParam>(bar, options);
    ASSERT_TRUE(body.setElasticLaw(law).ok());
    pinTheEnd(body, bar.mesh);
    for (int k = 0; k < 1200; ++k) body.step(1.0 / 120.0, {gravity, 0.0, 0.0});
    double length = 0.0;
    for (int k = 0; k < 1000; ++k) {
      const double wanted = density * gravity * (1.0 - (k + 0.5) / 1000.0) / options.youngsModulus;
      double low = 1.0, high = 10.0;
      for (int i = 0; i < 60; ++i) {
        const double s = 0.5 * (low + high);
        (nominalStress(law, Loading::Uniaxial, s) < wanted ? low : high) = s;
      }
      length += low / 1000.0;
    }
    double reached = 0.0;
    for (const Vector3d& p : pointsOf(body.positions())) reached = std::max(reached, p.x());
    EXPECT_NEAR((reached - 1.0) / (length - 1.0), 1.0, 0.06) << "c3 " << law.c3 << ": " << reached << " of " << length;
  }
}

}  // namespace
}  // namespace tetskin::test
