// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/cage/cage_builder.h>
#include <tetskin/core/src/shared/mesh/uniform_refinement.h>
#include <tetskin/elastic/calibration.h>
#include <tetskin/elastic/src/calibration/refined_bodies.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "support/odd_meshes.h"
#include "support/part_models.h"

namespace tetskin {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using elastic_detail::RestBody;

constexpr double kPoisson = 0.3;

/// A beam four times as long as wide, `cubes` across.
TetMesh beam(int cubes) {
  return test::latticeCage(4 * cubes, cubes, cubes, 0.5 / cubes);
}

std::vector<double> ones(const TetMesh& mesh) {
  return std::vector<double>(mesh.tetCount(), 1.0);
}

TEST(ElasticModes, AreTheSoftestOfADenseSolver) {
  const TetMesh mesh = test::jittered(test::latticeCage(4, 2, 1), 0.1, 5);
  const RestBody body(mesh, kPoisson, ones(mesh), elastic_detail::lumpedVolumes(mesh, ones(mesh)));
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

/// The factor of a cage; 0 if it was refused.
double factorOf(Cage cage) {
  const Result<CalibrationReport> report = calibrate(cage);
  return report.ok() ? report.value().factor : 0.0;
}

TEST(RefinedBodies, SolveAsADirectSolverDoes) {
  const Cage cage = beam(1);
  const elastic_detail::RefinedBodies bodies(cage, kPoisson, 2);
  ASSERT_EQ(bodies.levelCount(), 3u);
  const TetMesh mesh = refineUniformly(refineUniformly(cage).mesh).mesh;
  const RestBody finest(mesh, kPoisson, ones(mesh), bodies.masses(2));
  elastic_detail::Fields loads(finest.masses.size(), 2);
  for (Eigen::Index k = 0; k < loads.rows(); ++k) {
    loads(k, 0) = std::sin(0.7 * static_cast<double>(k)) * finest.masses[k];
    loads(k, 1) = std::cos(0.01 * static_cast<double>(k * k)) * finest.masses[k];
  }
  loads.block<3, 1>(0, 0) += Vector3d(0.1, -0.2, 0.3);
  bodies.balance(2, loads);
  const elastic_detail::Fields found = bodies.solve(2, loads, 0.0 * loads);
  const elastic_detail::Fields right = elastic_detail::DirectSolver(finest).solve(loads);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(loads.col(k).dot(found.col(k)) / loads.col(k).dot(right.col(k)), 1.0, 1e-3);
}

/// One layer of cubes of which the lower half is filled: a beam half as high bends eight times as far as a full one,
/// and its share of the stiffness says no more than twice.
TEST(Calibration, SeesTheFill) {
  Cage half = test::latticeCage(8, 1, 1);
  half.fill.assign(half.tetCount(), 0.5);
  const double blind = factorOf(half);
  const TetMesh fine = refineUniformly(refineUniformly(half).mesh).mesh;
  for (const Tet& tet : fine.tets) {
    double height = 0.0;
    for (const int n : tet) height += 0.25 * fine.nodes[n].y();
    half.fineFill.push_back(height < 0.5 ? 255 : 0);
  }
  ASSERT_EQ(half.fineFill.size(), kFineTets * half.tetCount());
  EXPECT_LT(factorOf(half), 0.6 * blind);
}

/// A jaw of few tets, whose prongs lie nearer to each other than these.
Cage splitJaw() {
  CageOptions options;
  options.targetTets = 300;
  Cage cage = buildCage(test::jaw(0.12).mesh, options).value();
  EXPECT_TRUE(cage.split());
  EXPECT_FALSE(cage.fill.empty());
  return cage;
}

TEST(Calibration, OfASplitCageSetsItsFactorAndNothingElse) {
  const Cage before = splitJaw();
  Cage cage = before;
  const Result<CalibrationReport> report = calibrate(cage);
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(cage.factor, std::vector<double>(cage.tetCount(), report.value().factor));
  EXPECT_GT(report.value().factor, 0.05);
  EXPECT_LT(report.value().factor, 0.95);
  EXPECT_EQ(report.value().skippedModes, 0);
  EXPECT_TRUE(cage.check().ok());
  EXPECT_EQ(cage.nodes, before.nodes);
  EXPECT_EQ(cage.tets, before.tets);
  EXPECT_EQ(cage.vertexTets, before.vertexTets);
  EXPECT_EQ(cage.fill, before.fill);
  EXPECT_EQ(cage.fineFill, before.fineFill);
  EXPECT_EQ(cage.masses, before.masses);
  EXPECT_EQ(cage.parts, before.parts);
  EXPECT_EQ(cage.latticeTets, before.latticeTets);
  EXPECT_EQ(cage.meshHash, before.meshHash);
}

TEST(Calibration, StartsFromScratchWhateverTheFactorsWere) {
  Cage fresh = splitJaw(), used = fresh;
  for (std::size_t t = 0; t < used.tetCount(); ++t) used.factor.push_back(0.01 + static_cast<double>(t % 5));
  ASSERT_TRUE(calibrate(fresh).ok());
  ASSERT_TRUE(calibrate(used).ok());
  EXPECT_EQ(used.factor, fresh.factor);
  ASSERT_TRUE(calibrate(used).ok());  // and again
  EXPECT_EQ(used.factor, fresh.factor);
}

/// A beam with tets that hang on it by so many nodes.
Cage beamWithScraps(int sharedNodes) {
  Cage cage = test::latticeCage(4, 2, 2, 0.5);
  const std::vector<std::array<int, 3>> faces = boundaryFaces(cage);
  for (std::size_t k = 0; k < 6; ++k) {
    const std::array<int, 3>& face = faces[5 * k];
    const Vector3d a = cage.nodes[face[0]], b = cage.nodes[face[1]], c = cage.nodes[face[2]];
    const Vector3d up = 0.5 * (b - a).cross(c - a).normalized();
    Tet scrap = {face[0], face[1], face[2], static_cast<int>(cage.nodeCount())};
    cage.nodes.push_back((a + b + c) / 3.0 + up);
    for (int corner = sharedNodes; corner < 3; ++corner) {
      scrap[corner] = static_cast<int>(cage.nodeCount());
      cage.nodes.push_back(cage.nodes[face[corner]] + 0.5 * up);
    }
    cage.tets.push_back(scrap);
  }
  return cage;
}

TEST(Calibration, SurvivesWhatHangsLoosely) {
  for (const int sharedNodes : {1, 2, 3}) {
    for (const double fill : {1.0, 0.01, 0.0}) {
      Cage cage = beamWithScraps(sharedNodes);
      cage.fill.assign(cage.tetCount(), 1.0);
      std::fill(cage.fill.end() - 6, cage.fill.end(), fill);
      const Result<CalibrationReport> result = calibrate(cage);
      if (!result.ok()) {  // of a hinge, the stiffness may have no factors
        EXPECT_LT(sharedNodes, 3);
        EXPECT_EQ(result.status().code, StatusCode::Degenerate);
        EXPECT_TRUE(cage.factor.empty());
        continue;
      }
      const CalibrationReport& report = result.value();
      EXPECT_GT(report.factor, 0.0) << sharedNodes << " " << fill;
      EXPECT_LE(report.factor, 1.0);
      EXPECT_GE(report.skippedModes, 0);
      EXPECT_LE(report.skippedModes, CalibrationOptions().modes);
      EXPECT_TRUE(std::isfinite(report.left) && report.left >= 0.0) << report.left;
      for (const double response : report.responses) EXPECT_TRUE(std::isfinite(response));
      EXPECT_TRUE(cage.check().ok());
    }
  }
}

TEST(Calibration, GivesACoarseBeamTheSoftnessOfItsLimit) {
  for (const int cubes : {2, 3}) {
    Cage cage = beam(cubes);
    const Result<CalibrationReport> report = calibrate(cage);
    ASSERT_TRUE(report.ok());
    ASSERT_EQ(cage.factor, std::vector<double>(cage.tetCount(), report.value().factor));
    for (std::size_t k = 1; k < report.value().responses.size(); ++k) {
      EXPECT_GT(report.value().responses[k], report.value().responses[k - 1]) << "a finer body is softer";
    }
    // That of its refinement is nearer to 1, and both have the same limit.
    const double finer = factorOf(refineUniformly(cage).mesh);
    EXPECT_NEAR(report.value().responses[1] / finer, 1.0, 0.05) << cubes;
    EXPECT_LT(report.value().left, 0.3);
  }
}

TEST(Calibration, FinerCagesNeedLess) {
  double before = 0.0;
  for (const int cubes : {1, 2, 4}) {
    const double factor = factorOf(beam(cubes));
    EXPECT_GT(factor, before + 0.02);
    EXPECT_LT(factor, 1.0);
    before = factor;
  }
  EXPECT_GT(before, 0.88);
}

TEST(Calibration, DoesNotDependOnUnitPlaceOrOrder) {
  const TetMesh cage = test::jittered(beam(2), 0.02, 7);
  TetMesh moved = cage;
  for (Vector3d& p : moved.nodes) p = 1000.0 * p + Vector3d(5e3, -2e4, 1e3);
  moved.nodes.emplace_back(0, 0, 0);  // used by no tet
  std::reverse(moved.tets.begin(), moved.tets.end());
  for (Tet& tet : moved.tets) std::swap(tet[0], tet[1]);  // negative
  EXPECT_NEAR(factorOf(moved), factorOf(cage), 2e-3);
}

TEST(Calibration, RefinesNoMoreThanItMay) {
  for (const auto& [length, refinements] : {std::pair{2, 2}, std::pair{10, 1}}) {
    Cage cage = test::latticeCage(length, 9, 9);
    const Result<CalibrationReport> report = calibrate(cage);
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.value().refinements, refinements);
    EXPECT_LE(report.value().refinedTets, kMostRefinedTets);
  }
  Cage large = test::latticeCage(20, 20, 20);
  const CalibrationReport none = calibrate(large).value();
  EXPECT_EQ(none.refinements, 0);
  EXPECT_EQ(none.factor, 1.0);
  EXPECT_NE(none.describe().find("not calibrated"), std::string::npos);
}

TEST(Calibration, TakesASingleTet) {
  const double factor = factorOf(test::singleTet());
  EXPECT_GT(factor, 0.0);
  EXPECT_LE(factor, 1.0);
}

TEST(Calibration, RefusesBadInput) {
  const auto refusal = [](Cage cage, const CalibrationOptions& options = {}) {
    const Result<CalibrationReport> report = calibrate(cage, options);
    EXPECT_TRUE(cage.factor.empty());
    return report.status().code;
  };
  EXPECT_EQ(refusal(TetMesh()), StatusCode::Empty);
  TetMesh flat = test::latticeCage(1, 1, 1);
  flat.nodes.push_back(flat.nodes[0]);
  flat.tets.push_back({0, 1, 2, static_cast<int>(flat.nodeCount()) - 1});
  EXPECT_EQ(refusal(flat), StatusCode::Degenerate);
  TetMesh infinite = test::singleTet();
  infinite.nodes[1].x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(infinite), StatusCode::NonFinite);
  CalibrationOptions options;
  options.poissonRatio = 0.5;
  EXPECT_EQ(refusal(test::singleTet(), options), StatusCode::InvalidOption);
  options = {};
  options.modes = 0;
  EXPECT_EQ(refusal(test::singleTet(), options), StatusCode::InvalidOption);
}

}  // namespace
}  // namespace tetskin
