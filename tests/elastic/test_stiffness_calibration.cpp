// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/core/src/mesh/tet_geometry.h>
#include <tetskin/elastic/src/calibration/refined_bodies.h>
#include <tetskin/elastic/stiffness_calibration.h>

#include <Eigen/Eigenvalues>
#include <limits>

#include "support/odd_meshes.h"

namespace tetskin {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using elastic_detail::ElasticBody;

constexpr double kPoisson = 0.3;

/// A beam four times as long as wide, `cubes` across.
TetMesh beam(int cubes) {
  return test::latticeCage(4 * cubes, cubes, cubes, 0.5 / cubes);
}

VectorXd displacementBy(const TetMesh& mesh, const Matrix3d& gradient, const Vector3d& shift) {
  VectorXd result(3 * mesh.nodeCount());
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) result.segment<3>(3 * n) = gradient * mesh.nodes[n] + shift;
  return result;
}

TEST(LinearElasticity, EnergyOfAnEvenStrainIsExact) {
  const TetMesh mesh = test::jittered(test::latticeCage(3, 2, 2), 0.2, 3);
  const auto stiffness = elastic_detail::stiffnessMatrix(mesh, kPoisson);
  Matrix3d gradient;
  gradient << 0.1, 0.3, -0.2, 0.0, -0.4, 0.1, 0.5, 0.2, 0.3;
  const Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  const double mu = 1.0 / (2.0 * (1.0 + kPoisson)), lambda = kPoisson / ((1.0 + kPoisson) * (1.0 - 2.0 * kPoisson));
  const double density = mu * strain.squaredNorm() + 0.5 * lambda * strain.trace() * strain.trace();
  const VectorXd u = displacementBy(mesh, gradient, Vector3d(1, 2, 3));
  EXPECT_NEAR(0.5 * u.dot(stiffness.selfadjointView<Eigen::Lower>() * u), density * totalVolume(mesh), 1e-10);
}

TEST(LinearElasticity, RigidMotionsMeetNoResistanceAndAreTakenOutPartByPart) {
  TetMesh mesh = test::latticeCage(2, 1, 1);
  const TetMesh second = test::bodyCentredCage(2, 2, 2);  // apart from the first, and moving otherwise
  const auto offset = static_cast<int>(mesh.nodeCount());
  for (const Vector3d& p : second.nodes) mesh.nodes.push_back(p + Vector3d(10, 0, 0));
  for (const Tet& t : second.tets) mesh.tets.push_back({t[0] + offset, t[1] + offset, t[2] + offset, t[3] + offset});
  const ElasticBody body(mesh, kPoisson);
  Matrix3d turn;
  turn << 0, -1, 2, 1, 0, -3, -2, 3, 0;
  VectorXd u = displacementBy(mesh, turn, Vector3d(1, -2, 0.5));
  u.tail(3 * second.nodeCount()) *= -2.0;
  EXPECT_LT((body.stiffness.selfadjointView<Eigen::Lower>() * u).norm(), 1e-12 * u.norm());
  body.rigid.removeFrom(u);
  EXPECT_LT(u.norm(), 1e-10);
}

TEST(ElasticModes, AreTheSoftestOfADenseSolver) {
  const TetMesh mesh = test::jittered(test::latticeCage(4, 2, 1), 0.1, 5);
  const ElasticBody body(mesh, kPoisson);
  const auto size = body.masses.size();
  const Eigen::MatrixXd dense = body.stiffness.selfadjointView<Eigen::Lower>() * Eigen::MatrixXd::Identity(size, size);
  const Eigen::MatrixXd mass = body.masses.asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> all(dense, mass, Eigen::EigenvaluesOnly);
  const elastic_detail::DirectSolver solver(body);
  ASSERT_TRUE(solver.ok());
  const Eigen::MatrixXd modes = elastic_detail::softestModes(body, solver, 4);
  ASSERT_EQ(modes.cols(), 4);
  for (int k = 0; k < 4; ++k) {
    const VectorXd mode = modes.col(k);
    EXPECT_NEAR(mode.dot(body.masses.cwiseProduct(mode)), 1.0, 1e-9);
    EXPECT_NEAR(mode.dot(dense * mode) / all.eigenvalues()[6 + k], 1.0, 1e-3) << k;  // after six rigid motions
  }
}

TEST(RefinedBodies, SolveAsADirectSolverDoes) {
  const elastic_detail::RefinedBodies bodies(beam(1), kPoisson, 2);
  ASSERT_EQ(bodies.levelCount(), 3u);
  const ElasticBody& finest = bodies.body(2);
  VectorXd load = VectorXd::Zero(finest.masses.size());
  for (Eigen::Index k = 0; k < load.size(); ++k) load[k] = std::sin(0.7 * static_cast<double>(k)) * finest.masses[k];
  load.segment<3>(0) += Vector3d(0.1, -0.2, 0.3);
  finest.rigid.balance(load);
  const double right = load.dot(elastic_detail::DirectSolver(finest).solve(load));
  const VectorXd found = bodies.solve(2, load, VectorXd::Zero(load.size()));
  EXPECT_NEAR(load.dot(found) / right, 1.0, 1e-3);
}

TEST(StiffnessCalibration, GivesACoarseBeamTheSoftnessOfItsLimit) {
  for (const int cubes : {2, 3, 4}) {
    const Result<StiffnessCalibration> quick = calibrateStiffness(beam(cubes));
    ASSERT_TRUE(quick.ok());
    // Two levels more than the quick one, extrapolated with the order seen.
    CalibrationOptions options;
    options.refinements = cubes == 2 ? 3 : 2;
    const StiffnessCalibration thorough = calibrateStiffness(beam(cubes), options).value();
    EXPECT_NEAR(quick.value().factor / thorough.factor, 1.0, 0.15) << cubes;
    EXPECT_GT(quick.value().factor, thorough.factor - 0.01) << "the quick one is the more careful";
    for (std::size_t k = 1; k < thorough.responses.size(); ++k) {
      EXPECT_GT(thorough.responses[k], thorough.responses[k - 1]) << "a finer body is softer";
    }
  }
}

TEST(StiffnessCalibration, FinerCagesNeedLess) {
  double before = 0.0;
  for (const int cubes : {2, 3, 5}) {
    const double factor = calibrateStiffness(beam(cubes)).value().factor;
    EXPECT_GT(factor, before + 0.02);
    EXPECT_LT(factor, 1.0);
    before = factor;
  }
  EXPECT_GT(before, 0.94);
}

TEST(StiffnessCalibration, DoesNotDependOnUnitPlaceOrOrder) {
  const TetMesh cage = test::jittered(beam(2), 0.02, 7);
  const double factor = calibrateStiffness(cage).value().factor;
  TetMesh moved = cage;
  for (Vector3d& p : moved.nodes) p = 1000.0 * p + Vector3d(5e3, -2e4, 1e3);
  moved.nodes.emplace_back(0, 0, 0);  // used by no tet
  std::reverse(moved.tets.begin(), moved.tets.end());
  for (Tet& tet : moved.tets) std::swap(tet[0], tet[1]);  // negative
  EXPECT_NEAR(calibrateStiffness(moved).value().factor, factor, 1e-3);
}

TEST(StiffnessCalibration, TakesASingleTet) {
  const Result<StiffnessCalibration> one = calibrateStiffness(test::singleTet());
  ASSERT_TRUE(one.ok());
  EXPECT_GT(one.value().factor, 0.0);
  EXPECT_LE(one.value().factor, 1.0);
}

TEST(StiffnessCalibration, RefusesBadInput) {
  EXPECT_EQ(calibrateStiffness(TetMesh()).status().code, StatusCode::Empty);
  TetMesh flat = test::latticeCage(1, 1, 1);
  flat.nodes.push_back(flat.nodes[0]);
  flat.tets.push_back({0, 1, 2, static_cast<int>(flat.nodeCount()) - 1});
  EXPECT_EQ(calibrateStiffness(flat).status().code, StatusCode::Degenerate);
  TetMesh infinite = test::singleTet();
  infinite.nodes[1].x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(calibrateStiffness(infinite).status().code, StatusCode::NonFinite);
  CalibrationOptions options;
  options.poissonRatio = 0.5;
  EXPECT_EQ(calibrateStiffness(test::singleTet(), options).status().code, StatusCode::InvalidOption);
  options = {};
  options.modes = 0;
  EXPECT_EQ(calibrateStiffness(test::singleTet(), options).status().code, StatusCode::InvalidOption);
}

}  // namespace
}  // namespace tetskin
