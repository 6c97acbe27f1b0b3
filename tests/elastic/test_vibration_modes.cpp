// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Stephen Timoshenko, "On the correction for shear of the differential equation for transverse vibrations of
//     prismatic bars", Phil. Mag. 41, 1921; George Cowper, "The Shear Coefficient in Timoshenko's Beam Theory",
//     J. Appl. Mech. 33, 1966 (10 (1 + nu) / (12 + 11 nu) for a rectangle)
#include <gtest/gtest.h>
#include <support/bars.h>
#include <tetskin/core/cage.h>
#include <tetskin/elastic/src/matrix/block_rows.h>
#include <tetskin/elastic/vibration_modes.h>

#include <cmath>
#include <random>

#include "dense_reference.h"

namespace tetskin::test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kPi = 3.14159265358979323846;

/// The nodes at x = 0.
std::vector<int> end(const TetMesh& bar) {
  std::vector<int> nodes;
  for (std::size_t n = 0; n < bar.nodeCount(); ++n) {
    if (bar.nodes[n].x() < 1e-9) nodes.push_back(static_cast<int>(n));
  }
  return nodes;
}

/// About 500 tets of various shapes, in a box with three different sides.
TetMesh makeJagged() {
  TetMesh mesh = makeBox({7, 5, 3}, Vector3d(1.7, 1.1, 0.6));
  std::mt19937 generator(5);
  const auto random = [&] { return static_cast<double>(generator()) / 4294967296.0 - 0.5; };
  for (Vector3d& node : mesh.nodes) {
    const double x = random(), y = random();
    node += 0.06 * Vector3d(x, y, random());
  }
  return mesh;
}

VectorXd massesOf(const VibrationModes& modes) {
  VectorXd masses(static_cast<Eigen::Index>(3 * modes.nodeCount()));
  for (Eigen::Index k = 0; k < masses.size(); ++k) masses[k] = modes.masses[static_cast<std::size_t>(k / 3)];
  return masses;
}

MatrixXd shapesOf(const VibrationModes& modes) {
  MatrixXd shapes(static_cast<Eigen::Index>(3 * modes.nodeCount()), static_cast<Eigen::Index>(modes.modeCount()));
  for (Eigen::Index k = 0; k < shapes.cols(); ++k) {
    shapes.col(k) = Eigen::Map<const VectorXd>(modes.shapes[static_cast<std::size_t>(k)].data(), shapes.rows());
  }
  return shapes;
}

MatrixXd stiffnessOf(const Cage& mesh, double poissonRatio, const std::vector<double>& scale) {
  return elastic_detail::BlockRows(mesh, poissonRatio, scale).sparse();
}

/// Three translations and three rotations.
MatrixXd rigidMotionsOf(const TetMesh& mesh) {
  MatrixXd motions = MatrixXd::Zero(static_cast<Eigen::Index>(3 * mesh.nodeCount()), 6);
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) {
    for (int k = 0; k < 3; ++k) {
      motions.block<3, 1>(static_cast<Eigen::Index>(3 * n), k) = Vector3d::Unit(k);
      motions.block<3, 1>(static_cast<Eigen::Index>(3 * n), 3 + k) = Vector3d::Unit(k).cross(mesh.nodes[n]);
    }
  }
  return motions;
}

VibrationModes modesOf(const Cage& mesh, const VibrationOptions& options) {
  Result<VibrationModes> modes = computeVibrationModes(mesh, options);
  EXPECT_TRUE(modes.ok()) << modes.status().message;
  return std::move(modes).value();
}

void expectOrthonormal(const VibrationModes& modes) {
  const MatrixXd shapes = shapesOf(modes);
  const MatrixXd products = shapes.transpose() * massesOf(modes).asDiagonal() * shapes;
  EXPECT_LT((products - MatrixXd::Identity(products.rows(), products.cols())).cwiseAbs().maxCoeff(), 1e-8);
}

/// Every cluster of eigenvalues closer than 1e-4 spans the same space as that of the dense solver.
void expectAsDense(const TetMesh& mesh, const VibrationModes& modes, const MatrixXd& dense, const VectorXd& values,
                   Eigen::Index skipped) {
  const VectorXd masses = massesOf(modes).cwiseSqrt();
  const MatrixXd ours = masses.asDiagonal() * shapesOf(modes), theirs = masses.asDiagonal() * dense;
  const auto count = static_cast<Eigen::Index>(modes.modeCount());
  ASSERT_GT(mesh.tetCount(), 0u);
  for (Eigen::Index first = 0, last = 0; first < count; first = last) {
    do ++last;
    while (last < count && values[skipped + last] - values[skipped + last - 1] < 1e-4 * values[skipped + last]);
    for (Eigen::Index k = first; k < last; ++k) {
      EXPECT_NEAR(modes.eigenvalues[static_cast<std::size_t>(k)] / values[skipped + k], 1.0, 1e-6);
    }
    const MatrixXd span = ours.middleCols(first, last - first),
                   right = theirs.middleCols(skipped + first, last - first);
    // At least the sine of the largest principal angle, from what one space has outside the other.
    const MatrixXd left = span - right * (right.transpose() * span);
    EXPECT_LT(left.norm(), 1e-6) << "modes " << first << " to " << last - 1;
  }
}

/// Angular frequency of a beam with a square cross-section of side 1, unit stiffness and density: a cantilever, or
/// free.
double timoshenko(double length, double poissonRatio, int which, bool clamped = true) {
  const double area = 1.0, inertia = 1.0 / 12.0, shear = 0.5 / (1.0 + poissonRatio);
  const double coefficient = 10.0 * (1.0 + poissonRatio) / (12.0 + 11.0 * poissonRatio);
  // Deflection, rotation, moment and force along the bar, from an end that is clamped, or has neither moment nor force,
  // to one that has neither.
  const auto atEnd = [&](double omega) {
    Eigen::Matrix4d rates;
    rates << 0, 1, 0, 1 / (coefficient * shear * area), 0, 0, 1 / inertia, 0, 0, -inertia * omega * omega, 0, -1,
        -area * omega * omega, 0, 0, 0;
    // The exponential: its series for a small piece, squared ten times.
    const Eigen::Matrix4d piece = rates * length / 1024.0;
    Eigen::Matrix4d sum = Eigen::Matrix4d::Identity(), term = sum;
    for (int k = 1; k < 12; ++k) sum += term = term * piece / k;
    for (int k = 0; k < 10; ++k) sum = (sum * sum).eval();
    return sum.block<2, 2>(2, clamped ? 2 : 0).determinant();
  };
  double low = 1e-4;
  for (const double step = 1e-4;; low += step) {
    if (atEnd(low) * atEnd(low + step) < 0.0 && --which < 0) break;
  }
  double high = low + 1e-4;
  for (int k = 0; k < 50; ++k) (atEnd(low) * atEnd(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  return low;
}

TEST(VibrationModes, OfAFreeBarHaveItsLongitudinalFrequencies) {
  const double length = 3.0;
  const TetMesh bar = makeBox({48, 4, 4}, Vector3d(length, 0.8, 0.8));
  VibrationOptions options;
  options.poissonRatio = 0.0;  // with this ratio, the sides do not move
  options.modeCount = 30;
  const VibrationModes modes = modesOf(bar, options);
  const VectorXd masses = massesOf(modes);
  int found = 0;
  for (std::size_t k = 0; k < modes.modeCount() && found < 3; ++k) {
    double along = 0.0;
    for (std::size_t n = 0; n < modes.nodeCount(); ++n) {
      along += modes.masses[n] * modes.shapes[k][3 * n] * modes.shapes[k][3 * n];
    }
    if (along < 0.99) continue;
    ++found;
    EXPECT_NEAR(modes.frequencies(1.0, 1.0)[k] / (found * kPi / length), 1.0, 0.005) << found;
  }
  EXPECT_EQ(found, 3);
}

TEST(VibrationModes, OfACantileverApproachTimoshenkosWithOrderTwo) {
  const double length = 20.0;
  double errors[3][2];
  const int across[3] = {2, 3, 5};
  for (int size = 0; size < 3; ++size) {
    const TetMesh bar = makeBox({32 * across[size], across[size], across[size]}, Vector3d(length, 1, 1));
    VibrationOptions options;
    options.modeCount = 4;
    options.pinned = end(bar);
    const VibrationModes modes = modesOf(bar, options);
    for (int pair = 0; pair < 2; ++pair) {
      const double right = timoshenko(length, options.poissonRatio, pair);
      errors[size][pair] = std::sqrt(modes.eigenvalues[static_cast<std::size_t>(2 * pair)]) / right - 1.0;
      const double other = std::sqrt(modes.eigenvalues[static_cast<std::size_t>(2 * pair + 1)]) / right - 1.0;
      EXPECT_NEAR(other, errors[size][pair], 1e-3);
      if (size < 2) continue;
      EXPECT_EQ(bar.tetCount(), 20000u);
      EXPECT_LT(std::max(other, errors[size][pair]), 0.03);
    }
  }
  for (int pair = 0; pair < 2; ++pair) {
    for (int size = 1; size < 3; ++size) {
      const double order = std::log(errors[size - 1][pair] / errors[size][pair]) /
                           std::log(static_cast<double>(across[size]) / across[size - 1]);
      EXPECT_GT(order, 1.7) << "pair " << pair << ", size " << size;
    }
  }
}

/// Compares with the dense solver's modes of a free body with the default material.
void expectThoseOfADenseSolver(const TetMesh& mesh, const VibrationModes& modes) {
  const MatrixXd stiffness = stiffnessOf(mesh, modes.poissonRatio, std::vector<double>(mesh.tetCount(), 1.0));
  const Spectrum dense = spectrumOf(stiffness, massesOf(modes));
  expectAsDense(mesh, modes, dense.vectors, dense.values, 6);
}

TEST(VibrationModes, AreThoseOfADenseSolver) {
  const TetMesh mesh = makeJagged();
  ASSERT_NEAR(static_cast<double>(mesh.tetCount()), 500, 30);
  VibrationOptions options;
  options.modeCount = 10;
  const VibrationModes modes = modesOf(mesh, options);
  EXPECT_GT(modes.iterations, 0);
  expectThoseOfADenseSolver(mesh, modes);
}

TEST(VibrationModes, WithPinnedNodesAndStiffnessesAndMassesOfTheirOwnAreThoseOfADenseSolver) {
  const TetMesh mesh = makeJagged();
  VibrationOptions options;
  options.modeCount = 10;
  options.poissonRatio = 0.4;
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) options.stiffnessScale.push_back(0.2 + 0.8 * (t % 7) / 6.0);
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) options.nodeMasses.push_back(0.002 + 0.001 * (n % 5));
  options.pinned = {3, 40, 41, 90, 3};
  const VibrationModes modes = modesOf(mesh, options);
  EXPECT_EQ(modes.pinned, (std::vector<int>{3, 40, 41, 90}));
  MatrixXd stiffness = stiffnessOf(mesh, options.poissonRatio, options.stiffnessScale);
  for (const int node : modes.pinned) {
    for (int k = 3 * node; k < 3 * node + 3; ++k) {
      stiffness.row(k).setZero();
      stiffness.col(k).setZero();
      stiffness(k, k) = 1e3;
      for (const std::vector<double>& shape : modes.shapes) EXPECT_EQ(shape[static_cast<std::size_t>(k)], 0.0);
    }
  }
  const Spectrum dense = spectrumOf(stiffness, massesOf(modes));
  expectAsDense(mesh, modes, dense.vectors, dense.values, 0);
}

TEST(VibrationModes, OfQuadraticTetsAreThoseOfADenseSolver) {
  const Cage cage = refineQuadratic(makeBox({3, 2, 1}, Vector3d(1.7, 1.1, 0.6))).value();
  VibrationOptions options;
  options.modeCount = 10;
  const VibrationModes modes = modesOf(cage, options);
  EXPECT_GT(modes.iterations, 0);
  const Spectrum dense = spectrumOf(stiffnessOf(cage, options.poissonRatio, {}), massesOf(modes));
  expectAsDense(cage.mesh, modes, dense.vectors, dense.values, 6);
}

TEST(VibrationModes, OfACageHaveItsStiffnessAndMassesUnlessOthersAreGiven) {
  Cage cage = makeJagged();
  VibrationOptions options;
  options.modeCount = 3;
  const VibrationModes plain = modesOf(cage, options);
  cage.stiffnessFactor.assign(cage.mesh.tetCount(), 0.5);
  cage.volumeFraction.assign(cage.mesh.tetCount(), 0.4);
  for (const double mass : plain.masses) cage.masses.push_back(2.0 * mass);
  const VibrationModes own = modesOf(cage, options);
  options.stiffnessScale.assign(cage.mesh.tetCount(), 1.0);
  options.nodeMasses = plain.masses;
  const VibrationModes given = modesOf(cage, options);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(own.eigenvalues[k] / plain.eigenvalues[k], 0.5 * 0.4 / 2.0, 1e-9);
    EXPECT_NEAR(given.eigenvalues[k] / plain.eigenvalues[k], 1.0, 1e-9);
  }
}

/// With masses lumped at the nodes of the eight linear tets of each.
TEST(VibrationModes, OfAFreeBeamOfFewQuadraticTetsAreWithinAPerCentOfTimoshenkos) {
  const double length = 10.0;
  const Cage beam = refineQuadratic(makeBox({10, 2, 2}, Vector3d(length, 1, 1))).value();
  ASSERT_LT(beam.mesh.nodeCount(), 600u);
  VibrationOptions options;
  options.modeCount = 2;
  const double right = timoshenko(length, options.poissonRatio, 0, false);
  const std::vector<double> found = modesOf(beam, options).frequencies(1.0, 1.0);
  for (const double frequency : found) EXPECT_NEAR(frequency / right, 1.0, 0.01);
  for (const double frequency : modesOf(beam.mesh, options).frequencies(1.0, 1.0)) {
    EXPECT_GT(frequency / right, 1.05) << "linear tets of the same nodes";
  }
}

TEST(VibrationModes, OfTheSmallestMeshesAreFoundAtOnce) {
  const TetMesh mesh = makeBox({1, 1, 1}, Vector3d(1, 2, 3));
  VibrationOptions options;
  options.modeCount = 8;
  const VibrationModes modes = modesOf(mesh, options);
  EXPECT_EQ(modes.iterations, 0);
  expectThoseOfADenseSolver(mesh, modes);
}

TEST(VibrationModes, AreOrthonormalAndWithoutTheRigidOnesWhichAreAtZero) {
  const TetMesh mesh = makeBox({24, 3, 2}, Vector3d(12, 1.2, 1));
  VibrationOptions options;
  options.modeCount = 20;
  const VibrationModes modes = modesOf(mesh, options);
  expectOrthonormal(modes);
  const MatrixXd stiffness = stiffnessOf(mesh, options.poissonRatio, std::vector<double>(mesh.tetCount(), 1.0));
  const VectorXd masses = massesOf(modes);
  MatrixXd rigid = rigidMotionsOf(mesh);
  for (Eigen::Index k = 0; k < 6; ++k) rigid.col(k) /= std::sqrt(rigid.col(k).dot(masses.cwiseProduct(rigid.col(k))));
  for (Eigen::Index k = 0; k < 6; ++k) {
    EXPECT_LT(std::abs(rigid.col(k).dot(stiffness * rigid.col(k))), 1e-8 * modes.eigenvalues[0]);
  }
  EXPECT_LT((rigid.transpose() * masses.asDiagonal() * shapesOf(modes)).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(VibrationModes, OfARoundSectionComeInPairsThatAreBothFound) {
  const TetMesh bar = makeBox({8, 4, 4}, Vector3d(2, 1, 1));  // the same in both directions across
  VibrationOptions options;
  options.modeCount = 14;
  const VibrationModes modes = modesOf(bar, options);
  const MatrixXd stiffness = stiffnessOf(bar, options.poissonRatio, std::vector<double>(bar.tetCount(), 1.0));
  const VectorXd dense = eigenvaluesOf(stiffness, massesOf(modes));
  for (std::size_t k = 0; k < modes.modeCount(); ++k) {
    EXPECT_NEAR(modes.eigenvalues[k] / dense[static_cast<Eigen::Index>(6 + k)], 1.0, 1e-8) << k;
  }
}

TEST(VibrationModes, ScaleWithTheUnitOfLength) {
  const TetMesh mesh = makeJagged();
  TetMesh small = mesh;
  for (Vector3d& node : small.nodes) node *= 1e-3;
  VibrationOptions options;
  options.modeCount = 6;
  const VibrationModes modes = modesOf(mesh, options), ofSmall = modesOf(small, options);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(ofSmall.eigenvalues[k] / (1e6 * modes.eigenvalues[k]), 1.0, 1e-9);
  EXPECT_NEAR(modes.frequencies(400.0, 4.0)[2], 10.0 * std::sqrt(modes.eigenvalues[2]), 1e-12);
}

TEST(VibrationModes, TellTheirProgress) {
  std::vector<double> fractions;
  VibrationOptions options;
  options.modeCount = 5;
  options.progress = [&](double fraction) { fractions.push_back(fraction); };
  (void)modesOf(makeJagged(), options);
  ASSERT_GT(fractions.size(), 2u);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_GE(fractions.front(), 0.0);
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST(VibrationModes, OfASlenderBarAreFound) {
  const TetMesh bar = makeBox({100, 1, 1}, Vector3d(100, 1, 1));
  VibrationOptions options;
  options.modeCount = 50;
  options.pinned = end(bar);
  const auto modes = computeVibrationModes(bar, options);
  ASSERT_TRUE(modes.ok()) << modes.status().message;
  expectOrthonormal(modes.value());
}

/// Only the free nodes are solved for.
TEST(VibrationModes, OfALargeBodyOfWhichNearlyAllIsPinned) {
  const TetMesh bar = makeBox({24, 20, 20}, Vector3d(1.2, 1, 1));
  VibrationOptions options;
  options.modeCount = 10;
  for (std::size_t n = 20; n < bar.nodeCount(); ++n) options.pinned.push_back(static_cast<int>(n));
  const auto modes = computeVibrationModes(bar, options);
  ASSERT_TRUE(modes.ok()) << modes.status().message;
  const MatrixXd shapes = shapesOf(modes.value());
  EXPECT_EQ(shapes.bottomRows(shapes.rows() - 60).cwiseAbs().maxCoeff(), 0.0);
  expectOrthonormal(modes.value());
}

}  // namespace
}  // namespace tetskin::test
