// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>
#include <tetskin/elastic/src/matrix/block_rows.h>

#include <cmath>

#include "dense_reference.h"
#include "support/bars.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using elastic_detail::BlockRows;
using elastic_detail::Fields;

constexpr double kPoissonOfRows = 0.3;

TetMesh jitteredBox() {
  return jittered(latticeCage(3, 2, 2), 0.2, 3);
}

std::vector<double> variedScale(const TetMesh& mesh) {
  std::vector<double> scale;
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) scale.push_back(0.1 + static_cast<double>(t % 7));
  return scale;
}

/// The stiffness matrix, summed tet by tet.
MatrixXd denseStiffness(const TetMesh& mesh, const std::vector<double>& scale) {
  const auto size = static_cast<Eigen::Index>(3 * mesh.nodeCount());
  MatrixXd matrix = MatrixXd::Zero(size, size);
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
    const Tet& tet = mesh.tets[t];
    const MatrixXd stiffness = scale[t] * elastic_detail::tetStiffness(cornersOf(mesh, tet), kPoissonOfRows);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) matrix.block<3, 3>(3 * tet[a], 3 * tet[b]) += stiffness.block<3, 3>(3 * a, 3 * b);
    }
  }
  return matrix;
}

TEST(BlockRows, EnergyOfAnEvenStrainIsExact) {
  const TetMesh mesh = jitteredBox();
  const BlockRows stiffness(mesh, kPoissonOfRows, std::vector<double>(mesh.tetCount(), 1.0));
  Matrix3d gradient;
  gradient << 0.1, 0.3, -0.2, 0.0, -0.4, 0.1, 0.5, 0.2, 0.3;
  const Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  const double mu = 1.0 / (2.0 * (1.0 + kPoissonOfRows)),
               lambda = kPoissonOfRows / ((1.0 + kPoissonOfRows) * (1.0 - 2.0 * kPoissonOfRows));
  const double density = mu * strain.squaredNorm() + 0.5 * lambda * strain.trace() * strain.trace();
  VectorXd u(3 * mesh.nodeCount());
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) {
    u.segment<3>(3 * n) = gradient * mesh.nodes[n] + Eigen::Vector3d(1, 2, 3);
  }
  EXPECT_NEAR(0.5 * u.dot(stiffness.sparse() * u), density * totalVolume(mesh), 1e-10);
}

TEST(BlockRows, AreTheSumOfTheTets) {
  const TetMesh mesh = jitteredBox();
  const std::vector<double> scale = variedScale(mesh);
  const BlockRows rows(mesh, kPoissonOfRows, scale);
  const MatrixXd dense = denseStiffness(mesh, scale);
  EXPECT_LT((MatrixXd(rows.sparse()) - dense).norm(), 1e-13 * dense.norm());
  EXPECT_LT((rows.diagonal() - dense.diagonal()).norm(), 1e-13 * dense.norm());
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) {
    const Matrix3d block = dense.block<3, 3>(3 * n, 3 * n);
    EXPECT_LT((rows.diagonalBlock(n) - block).norm(), 1e-13 * block.norm()) << n;
  }
}

TEST(BlockRows, MultiplyAnyNumberOfFields) {
  const TetMesh mesh = jitteredBox();
  const std::vector<double> scale = variedScale(mesh);
  const BlockRows rows(mesh, kPoissonOfRows, scale);
  const MatrixXd dense = denseStiffness(mesh, scale);
  for (const int count : {1, 3, 6, 13}) {  // alone, and together in registers
    const Fields fields = Fields::Random(dense.rows(), count);
    Fields product = fields;
    rows.multiply(fields, product);
    const MatrixXd right = dense * MatrixXd(fields);
    EXPECT_LT((product - right).norm(), 1e-12 * right.norm()) << count;
  }
}

/// Energy density of a displacement gradient, for a Young's modulus of 1.
double densityOf(const Matrix3d& gradient) {
  const Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  const double mu = 1.0 / (2.0 * (1.0 + kPoissonOfRows)),
               lambda = kPoissonOfRows / ((1.0 + kPoissonOfRows) * (1.0 - 2.0 * kPoissonOfRows));
  return mu * strain.squaredNorm() + 0.5 * lambda * strain.trace() * strain.trace();
}

/// A displacement that is a polynomial of order two: the coefficients of 1, x, y, z, xx, xy, xz, yy, yz, zz by columns.
struct Polynomial {
  Eigen::Matrix<double, 3, 10> coefficients;

  static Eigen::Matrix<double, 10, 1> powers(const Vector3d& p) {
    Eigen::Matrix<double, 10, 1> values;
    values << 1, p.x(), p.y(), p.z(), p.x() * p.x(), p.x() * p.y(), p.x() * p.z(), p.y() * p.y(), p.y() * p.z(),
        p.z() * p.z();
    return values;
  }
  Vector3d operator()(const Vector3d& p) const { return coefficients * powers(p); }
  /// By central differences, which are exact for such polynomials.
  Matrix3d gradient(const Vector3d& p) const {
    Matrix3d result;
    for (int k = 0; k < 3; ++k) {
      result.col(k) = 0.5 * ((*this)(p + Vector3d::Unit(k)) - (*this)(p - Vector3d::Unit(k)));
    }
    return result;
  }
  /// By the rule of the corners and the centroid, which is exact for densities of order two.
  double energyIn(const TetCorners& corners) const {
    const Vector3d centroid = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    double mean = 0.8 * densityOf(gradient(centroid));
    for (const Vector3d& corner : corners) mean += 0.05 * densityOf(gradient(corner));
    return mean * std::abs(signedVolume(corners));
  }
};

VectorXd displacementsOf(const TetMesh& mesh, const Polynomial& polynomial) {
  VectorXd u(3 * mesh.nodeCount());
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) u.segment<3>(3 * n) = polynomial(mesh.nodes[n]);
  return u;
}

/// Quadratic tets of various shapes, every third of them made linear again; the tets are unordered.
Cage mixedCage() {
  Cage cage = refineQuadratic(jittered(latticeCage(2, 1, 1), 0.2, 3)).value();
  int number = 0;
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    const int whole = cage.quadraticTet[t];
    cage.quadraticTet[t] = whole % 3 == 1 ? -1 : number;
    if (t % kSubTets == kSubTets - 1 && whole % 3 != 1) ++number;
  }
  const std::size_t half = cage.mesh.tetCount() / 2;
  for (std::size_t t = 0; t < half; t += 3) {
    std::swap(cage.mesh.tets[t], cage.mesh.tets[half + t]);
    std::swap(cage.quadraticTet[t], cage.quadraticTet[half + t]);
  }
  return cage;
}

TEST(QuadraticRows, EnergyIsThatOfAPolynomialInTheMaterial) {
  const Cage cage = refineQuadratic(jittered(latticeCage(2, 1, 1), 0.2, 3)).value();
  const std::vector<double> scale = variedScale(cage.mesh);  // eight of them in each quadratic tet
  const BlockRows stiffness(cage, kPoissonOfRows, scale);
  for (int seed = 0; seed < 3; ++seed) {
    const Polynomial polynomial{Eigen::Matrix<double, 3, 10>::Random()};
    double energy = 0.0;
    for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
      energy += scale[t] * polynomial.energyIn(cornersOf(cage.mesh, cage.mesh.tets[t]));
    }
    const VectorXd u = displacementsOf(cage.mesh, polynomial);
    EXPECT_NEAR(0.5 * u.dot(stiffness.sparse() * u) / energy, 1.0, 1e-10);
  }
}

TEST(QuadraticRows, CountTheMaterialThatTheCageHas) {
  Cage cage = refineQuadratic(singleTet()).value();
  for (std::size_t k = 0; k < kFineTets * cage.mesh.tetCount(); ++k) {
    cage.fineVolumeFraction.push_back(static_cast<std::uint8_t>(k * 37 % 256));
  }
  cage.volumeFraction.assign(cage.mesh.tetCount(), 0.5);
  cage.stiffnessFactor.assign(cage.mesh.tetCount(), 0.8);
  const Polynomial polynomial{Eigen::Matrix<double, 3, 10>::Random()};
  double energy = 1e-3 * polynomial.energyIn(cornersOf(singleTet(), singleTet().tets[0]));  // of the whole, see kGhost
  const std::uint8_t* fraction = cage.fineVolumeFraction.data();
  for (const Tet& tet : cage.mesh.tets) {
    for (const TetCorners& piece : refinedTet(cornersOf(cage.mesh, tet))) {
      for (const TetCorners& cell : refinedTet(piece)) energy += *fraction++ / 255.0 * polynomial.energyIn(cell);
    }
  }
  const VectorXd u = displacementsOf(cage.mesh, polynomial);
  const BlockRows stiffness(cage, kPoissonOfRows, {});
  EXPECT_NEAR(0.5 * u.dot(stiffness.sparse() * u) / (0.8 * energy), 1.0, 1e-10);
}

TEST(QuadraticRows, OfAMixedCageAreTheSumOfItsTets) {
  const Cage cage = mixedCage();
  const std::vector<QuadraticTet> tets = quadraticTets(cage).value();
  ASSERT_GT(tets.size(), 4u);
  const std::vector<double> scale = variedScale(cage.mesh);
  TetMesh linear = cage.mesh;
  std::vector<double> ofLinear;
  linear.tets.clear();
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    if (cage.quadraticTet[t] >= 0) continue;
    linear.tets.push_back(cage.mesh.tets[t]);
    ofLinear.push_back(scale[t]);
  }
  ASSERT_GT(linear.tetCount(), 16u);
  MatrixXd dense = denseStiffness(linear, ofLinear);
  for (const elastic_detail::RestQuadraticTet& tet : elastic_detail::restQuadraticTets(cage, tets, scale)) {
    const MatrixXd stiffness = elastic_detail::tetStiffness(tet, kPoissonOfRows);
    EXPECT_LT((stiffness - stiffness.transpose()).norm(), 1e-14 * stiffness.norm());
    for (int a = 0; a < 10; ++a) {
      for (int b = 0; b < 10; ++b) {
        dense.block<3, 3>(3 * tet.nodes[a], 3 * tet.nodes[b]) += stiffness.block<3, 3>(3 * a, 3 * b);
      }
    }
  }
  const BlockRows rows(cage, kPoissonOfRows, scale);
  EXPECT_LT((MatrixXd(rows.sparse()) - dense).norm(), 1e-13 * dense.norm());
  const Fields fields = Fields::Random(dense.rows(), 7);
  Fields product = fields;
  rows.multiply(fields, product);
  EXPECT_LT((product - dense * fields).norm(), 1e-12 * product.norm());
}

/// Everything but the rigid motions is resisted, however little of a tet is filled.
TEST(QuadraticRows, HaveNoDeformationWithoutResistance) {
  Cage cage = refineQuadratic(singleTet()).value();
  const auto freedoms = [](const Cage& body) {
    const MatrixXd dense = BlockRows(body, kPoissonOfRows, {}).sparse();
    const VectorXd values = eigenvaluesOf(dense, VectorXd::Ones(dense.rows()));
    return (values.array() > 1e-9 * values[values.size() - 1]).count();
  };
  EXPECT_EQ(freedoms(cage), 24);
  cage.volumeFraction.assign(cage.mesh.tetCount(), 0.0);
  cage.volumeFraction[2] = 0.01;
  EXPECT_EQ(freedoms(cage), 24);
}

/// Saint-Venant's solution, a polynomial of order two: the sides are free of forces, and the energy is that of beam
/// theory.
TEST(QuadraticRows, BendABlockExactly) {
  const double curvature = 0.3, length = 2.0, height = 0.8, width = 0.6;
  Cage cage = refineQuadratic(makeBox({2, 1, 1}, Vector3d(length, height, width))).value();
  for (Vector3d& p : cage.mesh.nodes) p -= Vector3d(0.0, 0.5 * height, 0.5 * width);
  const auto bent = [&](const Vector3d& p) {
    return Vector3d(curvature * p.x() * p.y(),
                    -0.5 * curvature * (p.x() * p.x() + kPoissonOfRows * (p.y() * p.y() - p.z() * p.z())),
                    -kPoissonOfRows * curvature * p.y() * p.z());
  };
  VectorXd u(3 * cage.mesh.nodeCount());
  for (std::size_t n = 0; n < cage.mesh.nodeCount(); ++n) u.segment<3>(3 * n) = bent(cage.mesh.nodes[n]);
  const auto energyAndForces = [&](const Cage& body) {
    const VectorXd forces = BlockRows(body, kPoissonOfRows, {}).sparse() * u;
    return std::pair(0.5 * u.dot(forces), forces);
  };
  const double right = 0.5 * width * std::pow(height, 3) / 12.0 * curvature * curvature * length;
  const auto [energy, forces] = energyAndForces(cage);
  EXPECT_NEAR(energy / right, 1.0, 1e-10);
  for (std::size_t n = 0; n < cage.mesh.nodeCount(); ++n) {
    const double x = cage.mesh.nodes[n].x();
    if (x > 1e-9 && x < length - 1e-9) {
      EXPECT_LT(forces.segment<3>(3 * n).norm(), 1e-12) << n;
    }
  }
  EXPECT_GT(energyAndForces(cage.mesh).first, 1.1 * right) << "linear tets are too stiff";
}

}  // namespace
}  // namespace tetskin::test
