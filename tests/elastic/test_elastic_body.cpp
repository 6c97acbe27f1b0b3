// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/elastic_body.h>

#include <limits>

#include "elastic_motion.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <class S>
class ElasticBodyOf : public WithScalar<S> {};
TYPED_TEST_SUITE(ElasticBodyOf, Scalars);

/// Options that are refused.
struct Refused {
  const char* word;  ///< expected in the message
  std::function<void(ElasticOptions&)> spoil;
  StatusCode code = StatusCode::InvalidOption;
};

/// Unless options say otherwise, a body uses the data of its cage.
TYPED_TEST(ElasticBodyOf, TakesFactorsAndMassesFromItsCage) {
  Cage cage(latticeCage(2, 1, 1));
  ElasticOptions options = soft();
  const Points stretched = mapped(cage.mesh.nodes, Vector3d(1.1, 1.0, 1.0).asDiagonal(), Vector3d::Zero());
  const auto energyOf = [&] {
    ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
    fill(body.positions(), stretched);
    return body.energy();
  };
  const double plain = energyOf();
  cage.stiffnessFactor.assign(cage.mesh.tetCount(), 0.5);
  cage.volumeFraction.assign(cage.mesh.tetCount(), 0.25);
  EXPECT_NEAR(energyOf() / plain, 0.125, 1e-5);
  options.stiffnessScale.assign(cage.mesh.tetCount(), 3.0);
  EXPECT_NEAR(energyOf() / plain, 3.0, 1e-5);

  // The momentum that a stretched body keeps reveals its masses.
  cage.masses = lumped(cage.mesh);
  cage.masses[0] *= 100.0;
  options.density = 7.0;
  ElasticBody<TypeParam> heavy = made<TypeParam>(cage, options);
  fill(heavy.positions(), stretched);
  heavy.step(1e-3);
  std::vector<double> masses = cage.masses;
  Vector3d momentum = Vector3d::Zero();
  for (std::size_t n = 0; n < masses.size(); ++n) momentum += 7.0 * masses[n] * pointsOf(heavy.velocities())[n];
  ASSERT_GT(fastest(heavy), 0.1);
  EXPECT_LT(momentum.norm(), 1e3 * this->kEpsilon * fastest(heavy));

  cage.masses.pop_back();
  EXPECT_EQ(ElasticBody<TypeParam>::create(cage, options).status().code, StatusCode::SizeMismatch);
}

/// Bends a bar a little; the energy of that is E I / 2 times the square of the curvature and the length.
TYPED_TEST(ElasticBodyOf, SimulatesTheQuadraticTetsOfItsCage) {
  constexpr double kCurvature = 0.01;
  const Cage cage = refineQuadratic(latticeCage(3, 1, 1)).value();
  const auto energyOf = [&](const Cage& of) {
    const double poisson = soft().poissonRatio;
    Points bent = cage.mesh.nodes;
    for (Vector3d& p : bent) {
      const double x = p.x() - 1.5, y = p.y() - 0.5, z = p.z() - 0.5;
      p += kCurvature * Vector3d(x * y, 0.5 * (poisson * (z * z - y * y) - x * x), -poisson * y * z);
    }
    ElasticBody<TypeParam> body = made<TypeParam>(of, soft());
    fill(body.positions(), bent);
    return body.energy();
  };
  const double expected = 0.5 * soft().youngsModulus / 12.0 * kCurvature * kCurvature * 3.0;
  EXPECT_NEAR(energyOf(cage) / expected, 1.0, 0.01);
  EXPECT_GT(energyOf(Cage(cage.mesh)) / expected, 1.1);

  Cage wrong = cage;
  std::swap(wrong.quadraticTet[0], wrong.quadraticTet[20]);
  EXPECT_EQ(ElasticBody<TypeParam>::create(wrong, soft()).status().code, StatusCode::InvalidOption);
}

TYPED_TEST(ElasticBodyOf, NamesTheOptionThatIsWrong) {
  const TetMesh cage = latticeCage(1, 1, 1);
  std::vector<Refused> refused;
  for (const double value : {0.0, -1.0, kNan, kInfinity}) {
    refused.push_back({"Young's modulus", [=](auto& o) { o.youngsModulus = value; }});
    refused.push_back({"density", [=](auto& o) { o.density = value; }});
    refused.push_back({"stiffnessScale[3]", [=](auto& o) {
                         o.stiffnessScale.assign(6, 1.0);
                         o.stiffnessScale[3] = value;
                       }});
    refused.push_back({"nodeMasses[7]", [=](auto& o) {
                         o.nodeMasses.assign(8, 1.0);
                         o.nodeMasses[7] = value;
                       }});
  }
  refused.push_back({"stiff", [](auto& o) {
                       o.youngsModulus = 0.99 * std::numeric_limits<TypeParam>::max(), o.poissonRatio = 0.49;
                     }});
  for (const double value : {-0.1, 0.5, 0.7, kNan}) {
    refused.push_back({"Poisson's ratio", [=](auto& o) { o.poissonRatio = value; }});
  }
  for (const double value : {-1.0, kNan, kInfinity}) {
    refused.push_back({"damping", [=](auto& o) { o.stiffnessDamping = value; }});
  }
  for (const double value : {-1.0, 1.0, kNan}) {
    refused.push_back({"tolerance", [=](auto& o) { o.tolerance = value; }});
  }
  for (const int value : {0, -1}) refused.push_back({"iteration", [=](auto& o) { o.maxIterations = value; }});
  refused.push_back(
      {"stiffnessScale has 5 values", [](auto& o) { o.stiffnessScale.assign(5, 1.0); }, StatusCode::SizeMismatch});
  refused.push_back(
      {"nodeMasses has 9 values", [](auto& o) { o.nodeMasses.assign(9, 1.0); }, StatusCode::SizeMismatch});
  for (const Refused& wrong : refused) {
    ElasticOptions options = soft();
    ASSERT_TRUE(ElasticBody<TypeParam>::create(cage, options).ok());
    wrong.spoil(options);
    const Result<ElasticBody<TypeParam>> body = ElasticBody<TypeParam>::create(cage, options);
    EXPECT_EQ(body.status().code, wrong.code) << wrong.word;
    EXPECT_NE(body.status().message.find(wrong.word), std::string::npos) << wrong.word << ": " << body.status().message;
  }
}

TYPED_TEST(ElasticBodyOf, RefusesCagesThatCannotBeUsed) {
  const auto codeOf = [](const TetMesh& cage) { return ElasticBody<TypeParam>::create(cage, soft()).status().code; };
  EXPECT_EQ(codeOf({}), StatusCode::Empty);
  TetMesh cage = latticeCage(1, 1, 1);
  cage.tets[2][1] = 99;
  EXPECT_EQ(codeOf(cage), StatusCode::IndexOutOfRange);
  cage = latticeCage(1, 1, 1);
  cage.nodes[5].y() = kNan;
  EXPECT_EQ(codeOf(cage), StatusCode::NonFinite);
  cage = latticeCage(1, 1, 1);
  cage.tets.push_back({0, 1, 2, 3});  // one face of a cube
  Result<ElasticBody<TypeParam>> flat = ElasticBody<TypeParam>::create(cage, soft());
  EXPECT_EQ(flat.status().code, StatusCode::Degenerate);
  EXPECT_NE(flat.status().message.find("tet 6"), std::string::npos) << flat.status().message;
  cage.tets.back() = {0, 0, 1, 7};
  EXPECT_EQ(codeOf(cage), StatusCode::Degenerate);
}

TYPED_TEST(ElasticBodyOf, IsEmptyUnlessItIsMade) {
  ElasticBody<TypeParam> nothing;
  EXPECT_EQ(nothing.nodeCount(), 0u);
  ElasticBody<TypeParam> body = made<TypeParam>(singleTet(), soft());
  EXPECT_EQ(body.nodeCount(), 4u);
  nothing = std::move(body);
  EXPECT_EQ(nothing.nodeCount(), 4u);
  EXPECT_EQ(nothing.positions()[1][0], 1);
  EXPECT_EQ(body.nodeCount(), 0u);  // NOLINT: moved from
  const ElasticBody<TypeParam> last(std::move(nothing));
  EXPECT_EQ(last.nodeCount(), 4u);
  EXPECT_EQ(nothing.nodeCount(), 0u);  // NOLINT: moved from
  nothing.setPinned(0);
  EXPECT_EQ(nothing.step(0.01), 0);
  EXPECT_TRUE(nothing.forces().empty());
  EXPECT_EQ(nothing.energy(), 0.0);
}

TYPED_TEST(ElasticBodyOf, IsAtRestWhereTheCageIs) {
  TetMesh cage = jittered(latticeCage(3, 2, 1), 0.15, 3);
  for (std::size_t t = 0; t < cage.tetCount(); t += 2) std::swap(cage.tets[t][0], cage.tets[t][1]);  // negative tets
  ElasticBody<TypeParam> body = made<TypeParam>(cage, soft());
  for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(body.positions()[n][k], static_cast<TypeParam>(cage.nodes[n][k]));
      EXPECT_EQ(body.velocities()[n][k], TypeParam(0));
    }
  }
  const double stiffness = 1e4;
  double maximum = 0.0;
  for (const auto& f : body.forces()) maximum = std::max(maximum, Vector3d(f[0], f[1], f[2]).norm());
  EXPECT_LT(maximum, 15.0 * stiffness * this->kEpsilon);
  EXPECT_LT(body.energy(), 100.0 * stiffness * this->kEpsilon * this->kEpsilon);
}

TYPED_TEST(ElasticBodyOf, StoresTheEnergyOfItsStrain) {
  const TetMesh cage = jittered(latticeCage(2, 2, 2), 0.15, 3);
  Matrix3d strain;
  strain << 0.02, 0.01, -0.03, 0.01, -0.04, 0.02, -0.03, 0.02, 0.03;
  for (const double poisson : {0.0, 0.3, 0.49}) {
    ElasticOptions options = soft();
    options.poissonRatio = poisson;
    options.stiffnessScale.assign(cage.tetCount(), 0.5);
    const double modulus = 0.5 * options.youngsModulus;
    const double mu = modulus / (2.0 * (1.0 + poisson));
    const double lambda = modulus * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    const double density = mu * strain.squaredNorm() + 0.5 * lambda * strain.trace() * strain.trace();
    ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
    fill(body.positions(), mapped(cage.nodes, turnBy(50, {1, 2, 3}) * (Matrix3d::Identity() + strain), {1, 2, 3}));
    // At a Poisson's ratio of 0.49, the rounding of volumes has fifty times the effect.
    EXPECT_NEAR(body.energy() / (totalVolume(cage) * density), 1.0, 300.0 * this->kEpsilon);
  }
}

TEST(ElasticBody, DampingTakesTheVibrationAndLeavesTheTurning) {
  const TetMesh cage = latticeCage(3, 2, 2, 0.25);
  const std::vector<double> masses = lumped(cage);
  Vector3d centre = Vector3d::Zero();
  for (std::size_t n = 0; n < masses.size(); ++n) centre += masses[n] * cage.nodes[n] / totalVolume(cage);
  const auto energies = [&](double damping) {
    ElasticOptions options = soft();
    options.density = 1.0;
    options.stiffnessDamping = damping;
    ElasticBody<double> body = made<double>(cage, options);
    Points velocities;
    for (const Vector3d& p : cage.nodes) velocities.push_back(Vector3d(0, 0, 1).cross(p - centre));
    fill(body.velocities(), velocities);
    fill(body.positions(), mapped(cage.nodes, Vector3d(1.05, 0.98, 1.0).asDiagonal(), Vector3d::Zero()));
    const Motion start = motionOf(body, masses);
    for (int k = 0; k < 1000; ++k) body.step(1e-4);
    const Motion end = motionOf(body, masses);
    EXPECT_LT((end.angular - start.angular).norm(), 1e-10);
    return std::make_pair(end.energy() / start.energy(), end.kinetic / start.kinetic);
  };
  const auto free = energies(0.0), damped = energies(0.01);
  EXPECT_GT(free.first, 0.1);
  EXPECT_LT(damped.first, 0.02);
  EXPECT_NEAR(damped.second, 1.0, 0.15);
}

TYPED_TEST(ElasticBodyOf, HeldNodesMoveAsTheyAreToldAndByNothingElse) {
  const TetMesh cage = latticeCage(3, 1, 1);
  onEachInstructionSet([&] {
    ElasticBody<TypeParam> body = made<TypeParam>(cage, soft());
    body.setPinned(0);
    body.setPinned(5);
    body.velocities()[5][1] = TypeParam(0.5);
    double expected = static_cast<double>(body.positions()[5][1]);
    for (int k = 0; k < 50; ++k) {
      body.step(0.01, {0, 0, -9.8});
      expected += 0.01 * 0.5;
      EXPECT_EQ(body.positions()[5][1], static_cast<TypeParam>(expected)) << "no digit is lost from step to step";
    }
    for (const std::size_t n : {0u, 5u}) {
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(body.velocities()[n][k], n == 5 && k == 1 ? TypeParam(0.5) : TypeParam(0));
        if (n == 5 && k == 1) continue;
        EXPECT_EQ(body.positions()[n][k], static_cast<TypeParam>(cage.nodes[n][k]));
      }
    }
    EXPECT_LT(body.positions()[3][2], TypeParam(-0.1)) << "the others fall";
    body.setPinned(5, false);
    body.step(0.01, {0, 0, -9.8});
    EXPECT_NE(body.velocities()[5][1], TypeParam(0.5));
    EXPECT_LT(body.velocities()[5][2], TypeParam(0));
    // With no pinned node left, the body falls as a whole.
    body.setPinned(0, false);
    const std::vector<double> masses = lumped(cage);
    const Vector3d before = motionOf(body, masses).momentum;
    body.step(0.01, {0, 0, -9.8});
    EXPECT_NEAR((motionOf(body, masses).momentum - before).z() / (-0.098 * totalVolume(cage)), 1.0, 1e-3);
  });
}

}  // namespace
}  // namespace tetskin::test
