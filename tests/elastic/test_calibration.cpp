// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>
#include <tetskin/elastic/calibration.h>
#include <tetskin/elastic/src/calibration/refined_bodies.h>
#include <tetskin/elastic/src/calibration/strain_energies.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dense_reference.h"
#include "support/component_models.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using elastic_detail::RestBody;

constexpr double kPoisson = 0.3;

/// A beam four times as long as it is wide, with `cubes` cubes across.
TetMesh beam(int cubes) {
  return latticeCage(4 * cubes, cubes, cubes, 0.5 / cubes);
}

std::vector<double> ones(const TetMesh& mesh) {
  return std::vector<double>(mesh.tetCount(), 1.0);
}

TEST(ElasticModes, AreTheSoftestOfADenseSolver) {
  const TetMesh mesh = jittered(latticeCage(4, 2, 1), 0.1, 5);
  const RestBody body(mesh, kPoisson, ones(mesh), elastic_detail::lumpedVolumes(mesh, ones(mesh)));
  const auto size = body.masses.size();
  const Eigen::MatrixXd dense = body.stiffness.selfadjointView<Eigen::Lower>() * Eigen::MatrixXd::Identity(size, size);
  const VectorXd all = eigenvaluesOf(dense, body.masses);
  const elastic_detail::DirectSolver solver(body);
  ASSERT_TRUE(solver.ok());
  const Eigen::MatrixXd modes = elastic_detail::softestModes(body, solver, 4);
  ASSERT_EQ(modes.cols(), 4);
  for (int k = 0; k < 4; ++k) {
    const VectorXd mode = modes.col(k);
    EXPECT_NEAR(mode.dot(body.masses.cwiseProduct(mode)), 1.0, 1e-9);
    EXPECT_NEAR(mode.dot(dense * mode) / all[6 + k], 1.0, 1e-3) << k;  // follows six rigid motions
  }
}

/// The stiffness factor of a cage; 0 if the cage was refused.
double factorOf(Cage cage) {
  const Result<CalibrationReport> report = calibrate(cage);
  return report.ok() ? report.value().stiffnessFactor : 0.0;
}

TEST(RefinedBodies, SolveAsADirectSolverDoes) {
  const Cage cage = beam(1);
  const elastic_detail::RefinedBodies bodies(cage, kPoisson, 2);
  ASSERT_EQ(bodies.levelCount(), 3u);
  const TetMesh mesh = refineUniformly(refineUniformly(cage.mesh).mesh).mesh;
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

/// Quadratic tets at one end of a beam, linear ones at the other.
Cage mixedBeam() {
  Cage cage = refineQuadratic(beam(1)).value();
  for (std::size_t t = cage.mesh.tetCount() / 2; t < cage.mesh.tetCount(); ++t) cage.quadraticTet[t] = -1;
  EXPECT_FALSE(quadraticTets(cage).value().empty());
  return cage;
}

TEST(StrainEnergies, AddUpToWhatTheLoadsDo) {
  const Cage cage = mixedBeam();
  std::vector<double> scale;
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) scale.push_back(0.5 + static_cast<double>(t % 3));
  const elastic_detail::BlockRows stiffness(cage, kPoisson, scale);
  const elastic_detail::Fields moved = elastic_detail::Fields::Random(static_cast<int>(3 * cage.mesh.nodeCount()), 3);
  elastic_detail::Fields forces = moved;
  stiffness.multiply(moved, forces);
  const Eigen::MatrixXd energies = elastic_detail::strainEnergies(cage, kPoisson, scale, moved);
  ASSERT_EQ(energies.rows(), static_cast<Eigen::Index>(cage.mesh.tetCount()));
  EXPECT_GT(energies.minCoeff(), 0.0);
  const Eigen::RowVectorXd works = moved.cwiseProduct(forces).colwise().sum();
  EXPECT_LT((energies.colwise().sum() - works).norm(), 1e-12 * works.norm());
}

/// One layer of cubes whose lower half is filled: a beam of half the height bends eight times as far as a full one, but
/// its volume fraction alone accounts for no more than a factor of two.
TEST(Calibration, SeesTheFill) {
  Cage half = latticeCage(8, 1, 1);
  half.volumeFraction.assign(half.mesh.tetCount(), 0.5);
  const double blind = factorOf(half);
  const TetMesh fine = refineUniformly(refineUniformly(half.mesh).mesh).mesh;
  for (const Tet& tet : fine.tets) {
    double height = 0.0;
    for (const int n : tet) height += 0.25 * fine.nodes[n].y();
    half.fineVolumeFraction.push_back(height < 0.5 ? 255 : 0);
  }
  ASSERT_EQ(half.fineVolumeFraction.size(), kFineTets * half.mesh.tetCount());
  EXPECT_LT(factorOf(half), 0.6 * blind);
}

/// A jaw of few tets, whose prongs are closer to each other than the size of a tet.
Cage splitJaw() {
  CageOptions options;
  options.targetTets = 300;
  Cage cage = createCage(jaw(0.12).mesh, options).value();
  EXPECT_TRUE(cage.hasDuplicates());
  EXPECT_FALSE(cage.volumeFraction.empty());
  return cage;
}

TEST(Calibration, OfASplitCageSetsItsFactorAndNothingElse) {
  const Cage before = splitJaw();
  Cage cage = before;
  const Result<CalibrationReport> report = calibrate(cage);
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(cage.stiffnessFactor, std::vector<double>(cage.mesh.tetCount(), report.value().stiffnessFactor));
  EXPECT_GT(report.value().stiffnessFactor, 0.05);
  EXPECT_LT(report.value().stiffnessFactor, 0.95);
  EXPECT_EQ(report.value().skippedModes, 0);
  EXPECT_TRUE(validateAttributes(cage).ok());
  EXPECT_EQ(cage.mesh.nodes, before.mesh.nodes);
  EXPECT_EQ(cage.mesh.tets, before.mesh.tets);
  EXPECT_EQ(cage.vertexTets, before.vertexTets);
  EXPECT_EQ(cage.volumeFraction, before.volumeFraction);
  EXPECT_EQ(cage.fineVolumeFraction, before.fineVolumeFraction);
  EXPECT_EQ(cage.masses, before.masses);
  EXPECT_EQ(cage.component, before.component);
  EXPECT_EQ(cage.sourceTet, before.sourceTet);
  EXPECT_EQ(cage.meshHash, before.meshHash);
}

TEST(Calibration, StartsFromScratchWhateverTheFactorsWere) {
  Cage fresh = splitJaw(), used = fresh;
  for (std::size_t t = 0; t < used.mesh.tetCount(); ++t)
    used.stiffnessFactor.push_back(0.01 + static_cast<double>(t % 5));
  ASSERT_TRUE(calibrate(fresh).ok());
  ASSERT_TRUE(calibrate(used).ok());
  EXPECT_EQ(used.stiffnessFactor, fresh.stiffnessFactor);
  ASSERT_TRUE(calibrate(used).ok());  // once more
  EXPECT_EQ(used.stiffnessFactor, fresh.stiffnessFactor);
}

/// A beam with additional tets that share this many nodes with it.
Cage beamWithScraps(int sharedNodes) {
  Cage cage = latticeCage(4, 2, 2, 0.5);
  const std::vector<std::array<int, 3>> faces = boundaryFaces(cage.mesh);
  for (std::size_t k = 0; k < 6; ++k) {
    const std::array<int, 3>& face = faces[5 * k];
    const Vector3d a = cage.mesh.nodes[face[0]], b = cage.mesh.nodes[face[1]], c = cage.mesh.nodes[face[2]];
    const Vector3d up = 0.5 * (b - a).cross(c - a).normalized();
    Tet scrap = {face[0], face[1], face[2], static_cast<int>(cage.mesh.nodeCount())};
    cage.mesh.nodes.push_back((a + b + c) / 3.0 + up);
    for (int corner = sharedNodes; corner < 3; ++corner) {
      scrap[corner] = static_cast<int>(cage.mesh.nodeCount());
      cage.mesh.nodes.push_back(cage.mesh.nodes[face[corner]] + 0.5 * up);
    }
    cage.mesh.tets.push_back(scrap);
  }
  return cage;
}

/// By the number of nodes that the beam has in common with each scrap.
class CalibrationOfScraps : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(, CalibrationOfScraps, testing::Values(1, 2, 3), testing::PrintToStringParamName());

TEST_P(CalibrationOfScraps, SurvivesWhatHangsLoosely) {
  for (const double fill : {1.0, 0.01, 0.0}) {
    Cage cage = beamWithScraps(GetParam());
    cage.volumeFraction.assign(cage.mesh.tetCount(), 1.0);
    std::fill(cage.volumeFraction.end() - 6, cage.volumeFraction.end(), fill);
    const Result<CalibrationReport> result = calibrate(cage);
    if (!result.ok()) {  // with a hinge, the stiffness matrix may have no factorization
      EXPECT_LT(GetParam(), 3);
      EXPECT_EQ(result.status().code, StatusCode::Degenerate);
      EXPECT_TRUE(cage.stiffnessFactor.empty());
      continue;
    }
    const CalibrationReport& report = result.value();
    EXPECT_GT(report.stiffnessFactor, 0.0) << fill;
    EXPECT_LE(report.stiffnessFactor, 1.0);
    EXPECT_GE(report.skippedModes, 0);
    EXPECT_LE(report.skippedModes, CalibrationOptions().modeCount);
    EXPECT_TRUE(std::isfinite(report.remainingError) && report.remainingError >= 0.0) << report.remainingError;
    for (const double response : report.responses) EXPECT_TRUE(std::isfinite(response));
    EXPECT_TRUE(validateAttributes(cage).ok());
  }
}

TEST(Calibration, GivesACoarseBeamTheSoftnessOfItsLimit) {
  for (const int cubes : {2, 3}) {
    Cage cage = beam(cubes);
    const Result<CalibrationReport> report = calibrate(cage);
    ASSERT_TRUE(report.ok());
    ASSERT_EQ(cage.stiffnessFactor, std::vector<double>(cage.mesh.tetCount(), report.value().stiffnessFactor));
    for (std::size_t k = 1; k < report.value().responses.size(); ++k) {
      EXPECT_GT(report.value().responses[k], report.value().responses[k - 1]) << "a finer body is softer";
    }
    // The factor of its refinement is closer to 1, and both have the same limit.
    const double finer = factorOf(refineUniformly(cage.mesh).mesh);
    EXPECT_NEAR(report.value().responses[1] / finer, 1.0, 0.05) << cubes;
    EXPECT_LT(report.value().remainingError, 0.3);
  }
}

TEST(Calibration, OfFullQuadraticTetsIsNeedlessAndSaysSo) {
  Cage cage = refineQuadratic(beam(1)).value();
  cage.stiffnessFactor.assign(cage.mesh.tetCount(), 0.3);
  const CalibrationReport report = calibrate(cage).value();
  EXPECT_TRUE(report.needless);
  EXPECT_EQ(report.stiffnessFactor, 1.0);
  EXPECT_EQ(cage.stiffnessFactor, std::vector<double>(cage.mesh.tetCount(), 1.0));
  EXPECT_NE(report.describe().find("all tets are quadratic and full"), std::string::npos);
  cage.volumeFraction.assign(cage.mesh.tetCount(), 1.0);
  EXPECT_TRUE(calibrate(cage).value().needless);
  cage.volumeFraction[0] = 0.5;
  EXPECT_FALSE(calibrate(cage).value().needless);
}

TEST(Calibration, OfAMixedCageIsBetweenThoseOfLinearAndQuadraticOnes) {
  Cage mixed = mixedBeam();
  const double linear = factorOf(mixed.mesh);
  const CalibrationReport report = calibrate(mixed).value();
  EXPECT_FALSE(report.needless);
  EXPECT_GT(report.stiffnessFactor, linear + 0.03);
  EXPECT_LT(report.stiffnessFactor, 0.99);
  const std::vector<QuadraticTet> tets = quadraticTets(mixed).value();
  for (const QuadraticTet& tet : tets) {
    for (const int t : tet.tets) EXPECT_EQ(mixed.stiffnessFactor[t], mixed.stiffnessFactor[tet.tets[0]]);
  }
}

/// In a beam with one quadratic half, only the other half was too stiff.
TEST(Calibration, OfAMixedCageLeavesFullQuadraticTetsAlone) {
  Cage mixed = mixedBeam();
  const CalibrationReport report = calibrate(mixed).value();
  EXPECT_LT(std::max(report.modeError, report.sagError), 0.15);
  for (std::size_t t = 0; t < mixed.mesh.tetCount(); ++t) {
    const double least = mixed.quadraticTet[t] < 0 ? 0.1 : 1.0, most = mixed.quadraticTet[t] < 0 ? 0.9 : 1.0;
    EXPECT_GE(mixed.stiffnessFactor[t], least);
    EXPECT_LE(mixed.stiffnessFactor[t], most);
  }
  EXPECT_LT(report.leastFactor, report.greatestFactor);
}

/// Work of gravity along an axis on a body that is held where `held` says so, by stiff springs.
template <class Held>
double sagOf(const Cage& cage, int axis, Held&& held) {
  Eigen::SparseMatrix<double> matrix = elastic_detail::BlockRows(cage, kPoisson, {}).sparse();
  VectorXd loads = elastic_detail::lumpedVolumes(cage.mesh, ones(cage.mesh));
  for (std::size_t n = 0; n < cage.mesh.nodeCount(); ++n) {
    for (int k = 0; k < 3; ++k) {
      const auto row = static_cast<Eigen::Index>(3 * n) + k;
      if (k != axis) loads[row] = 0.0;
      if (held(cage.mesh.nodes[n])) matrix.coeffRef(row, row) += 1e6;
      if (matrix.coeff(row, row) == 0.0) matrix.coeffRef(row, row) = 1.0;  // a node that no tet uses
    }
  }
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
  return loads.dot(VectorXd(factors.solve(loads)));
}

/// The calibration has seen neither where the body is held, nor these loads.
TEST(Calibration, HoldsForSagsOfABodyThatIsHeldAnywhere) {
  Cage cage = beam(2);
  const Cage uncalibrated = cage, fine = refineQuadratic(cage.mesh).value();
  ASSERT_TRUE(calibrate(cage).ok());
  for (const int axis : {1, 2}) {
    for (const double middle : {0.0, 1.0, 2.0}) {
      const auto held = [&](const Vector3d& p) { return std::abs(p.x() - middle) < 0.01; };
      const double limit = sagOf(fine, axis, held);
      EXPECT_LT(sagOf(uncalibrated, axis, held) / limit, 0.8);
      EXPECT_NEAR(sagOf(cage, axis, held) / limit, 1.0, 0.12) << axis << middle;
    }
  }
}

CalibrationReport reportOf(const ComponentModel& model, Cage& cage) {
  CageOptions options;
  options.targetTets = 500;
  cage = createCage(model.mesh, options).value();
  return calibrate(cage).value();
}

TEST(Calibration, IsByRegionWhereThatPredictsOtherLoadsAndOneFactorElsewhere) {
  Cage cage;
  const CalibrationReport regions = reportOf(claw(0.1), cage);
  EXPECT_TRUE(regions.byRegion);
  EXPECT_LT(std::max(regions.modeError, regions.sagError), 0.1);
  const auto [least, greatest] = std::minmax_element(cage.stiffnessFactor.begin(), cage.stiffnessFactor.end());
  EXPECT_EQ(*least, regions.leastFactor);
  EXPECT_EQ(*greatest, regions.greatestFactor);
  EXPECT_LT(1.3 * *least, *greatest);
  EXPECT_NE(regions.describe().find("by region"), std::string::npos);
  const CalibrationReport one = reportOf(coil(2, 0.1), cage);
  EXPECT_FALSE(one.byRegion);
  EXPECT_EQ(cage.stiffnessFactor, std::vector<double>(cage.mesh.tetCount(), one.stiffnessFactor));
}

TEST(Calibration, SaysBothErrors) {
  Cage cage = beam(2);
  const CalibrationReport report = calibrate(cage).value();
  EXPECT_GT(report.modeError, 0.0);
  EXPECT_GT(report.sagError, 0.0);
  EXPECT_LT(std::max(report.modeError, report.sagError), 0.2);
  EXPECT_NE(report.describe().find("% in sags"), std::string::npos);
}

/// A column under its own weight gives way as the report says.
TEST(Calibration, SaysHowMuchTooSoftACageIsWhereItIsPressed) {
  for (const int cubes : {1, 2}) {
    Cage cage = beam(cubes);
    const Cage plain = cage, fine = refineQuadratic(refineUniformly(cage.mesh).mesh).value();
    const CalibrationReport report = calibrate(cage).value();
    const auto held = [](const Vector3d& p) { return p.x() < 0.01; };
    const double limit = sagOf(fine, 0, held);
    EXPECT_NEAR(sagOf(plain, 0, held) / limit - 1.0, report.plainStretchError, 0.05) << cubes;
    EXPECT_NEAR(sagOf(cage, 0, held) / limit - 1.0, report.stretchError, 0.1) << cubes;
    EXPECT_LT(std::abs(report.plainStretchError), 0.05);
    EXPECT_GT(report.stretchError, 0.05);
    EXPECT_NE(report.describe().find("stretched or compressed"), std::string::npos);
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
  const TetMesh cage = jittered(beam(2), 0.02, 7);
  TetMesh moved = cage;
  for (Vector3d& p : moved.nodes) p = 1000.0 * p + Vector3d(5e3, -2e4, 1e3);
  moved.nodes.emplace_back(0, 0, 0);  // used by no tet
  std::reverse(moved.tets.begin(), moved.tets.end());
  for (Tet& tet : moved.tets) std::swap(tet[0], tet[1]);  // negative tets
  EXPECT_NEAR(factorOf(moved), factorOf(cage), 2e-3);
}

TEST(Calibration, RefinesNoMoreThanItMay) {
  for (const auto& [length, refinements] : {std::pair{2, 2}, std::pair{10, 1}}) {
    Cage cage = latticeCage(length, 9, 9);
    const Result<CalibrationReport> report = calibrate(cage);
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.value().refinements, refinements);
    EXPECT_LE(report.value().refinedTets, Limits::kMaxRefinedTets);
  }
  Cage large = latticeCage(20, 20, 20);
  const CalibrationReport none = calibrate(large).value();
  EXPECT_EQ(none.refinements, 0);
  EXPECT_EQ(none.stiffnessFactor, 1.0);
  EXPECT_NE(none.describe().find("not calibrated"), std::string::npos);
}

TEST(Calibration, TakesASingleTet) {
  const double factor = factorOf(singleTet());
  EXPECT_GT(factor, 0.0);
  EXPECT_LE(factor, 1.0);
}

TEST(Calibration, RefusesBadInput) {
  const auto refusal = [](Cage cage, const CalibrationOptions& options = {}) {
    const Result<CalibrationReport> report = calibrate(cage, options);
    EXPECT_TRUE(cage.stiffnessFactor.empty());
    return report.status().code;
  };
  EXPECT_EQ(refusal(TetMesh()), StatusCode::Empty);
  TetMesh flat = latticeCage(1, 1, 1);
  flat.nodes.push_back(flat.nodes[0]);
  flat.tets.push_back({0, 1, 2, static_cast<int>(flat.nodeCount()) - 1});
  EXPECT_EQ(refusal(flat), StatusCode::Degenerate);
  TetMesh infinite = singleTet();
  infinite.nodes[1].x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(infinite), StatusCode::NonFinite);
  CalibrationOptions options;
  options.poissonRatio = 0.5;
  EXPECT_EQ(refusal(singleTet(), options), StatusCode::InvalidOption);
  options = {};
  options.modeCount = 0;
  EXPECT_EQ(refusal(singleTet(), options), StatusCode::InvalidOption);
}

TEST(CalibrationProgress, AscendsToTheEndAndCancelsAtEachCall) {
  const Cage cage(beam(1));
  Cage silent = cage, told = cage;
  ASSERT_TRUE(calibrate(silent).ok());
  std::vector<double> fractions;
  std::size_t last = 100;
  CalibrationOptions options;
  options.progress = [&](double fraction) { return fractions.push_back(fraction), fractions.size() <= last; };
  ASSERT_TRUE(calibrate(told, options).ok());
  EXPECT_EQ(told.stiffnessFactor, silent.stiffnessFactor);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.front(), 0.0);
  EXPECT_EQ(fractions.back(), 1.0);
  const std::size_t all = fractions.size();
  EXPECT_GT(all, 3u);
  for (last = 0; last < all; ++last) {
    fractions.clear();
    Cage unchanged = cage;
    EXPECT_EQ(calibrate(unchanged, options).status().code, StatusCode::Cancelled);
    EXPECT_TRUE(unchanged.stiffnessFactor.empty());
    EXPECT_EQ(fractions.size(), last + 1);
  }
}

}  // namespace
}  // namespace tetskin::test
