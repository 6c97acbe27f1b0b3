// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/system/schur_complement.h>

#include <gtest/gtest.h>
#include <Eigen/LU>
#include <Eigen/QR>

namespace tetskin::test {

using namespace bullet_detail;

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Eigen::Index kReduced = 12, kRigid = 7;

/// The same numbers from -1 to 1 each time.
MatrixXd numbers(Eigen::Index rows, Eigen::Index columns, double seed) {
  return MatrixXd::NullaryExpr(rows, columns, [&](Eigen::Index row, Eigen::Index column) {
    return std::sin(seed + 1.7 * static_cast<double>(row * row) + 2.9 * static_cast<double>(column));
  });
}
/// With these eigenvalues.
MatrixXd symmetric(const VectorXd& eigenvalues, double seed) {
  const Eigen::Index size = eigenvalues.size();
  const MatrixXd turn = Eigen::HouseholderQR<MatrixXd>(numbers(size, size, seed)).householderQ();
  return turn * eigenvalues.asDiagonal() * turn.transpose();
}
MatrixXd someStiffness() {
  return symmetric(VectorXd::LinSpaced(kReduced, 0.5, 20.0), 3.0);
}

/// By rows W (K x - b) + x = 0 of the rigid bodies, for the inverse mass W, and K x = b of the others.
VectorXd denseSolution(const MatrixXd& inverseMass, const MatrixXd& stiffness, const VectorXd& right) {
  const Eigen::Index rigid = inverseMass.rows();
  MatrixXd all = stiffness;
  VectorXd b = right;
  all.topRows(rigid) = inverseMass * stiffness.topRows(rigid);
  all.topLeftCorner(rigid, rigid) += MatrixXd::Identity(rigid, rigid);
  b.head(rigid) = inverseMass * right.head(rigid);
  return all.fullPivLu().solve(b);
}

void expectDenseSolution(SchurComplement& complement, const MatrixXd& inverseMass, const MatrixXd& stiffness) {
  complement.setInverseMass(inverseMass);
  complement.factor(stiffness);
  ASSERT_EQ(complement.size(), stiffness.rows());
  for (const double seed : {1.0, 2.0}) {
    const VectorXd right = numbers(stiffness.rows(), 1, seed);
    const VectorXd wanted = denseSolution(inverseMass, stiffness, right);
    EXPECT_LT((complement.solve(right) - wanted).norm(), 1e-9 * (1.0 + wanted.norm()));
  }
}

TEST(SchurComplement, SolvesForRigidBodiesAndOtherUnknowns) {
  SchurComplement complement;
  for (const Eigen::Index rigid : {kRigid, kReduced, Eigen::Index(0)}) {
    SCOPED_TRACE(rigid);
    expectDenseSolution(complement, symmetric(VectorXd::LinSpaced(rigid, 0.1, 5.0), 4.0), someStiffness());
  }
}

TEST(SchurComplement, LockedAxesDoNotMove) {
  MatrixXd inverseMass = symmetric(VectorXd::LinSpaced(kRigid, 0.1, 5.0), 4.0);
  for (const Eigen::Index locked : {0, 4}) inverseMass.row(locked).setZero(), inverseMass.col(locked).setZero();
  SchurComplement complement;
  expectDenseSolution(complement, inverseMass, someStiffness());
  const VectorXd moved = complement.solve(numbers(kReduced, 1, 1.0));
  for (const Eigen::Index locked : {0, 4}) EXPECT_NEAR(moved[locked], 0.0, 1e-12);
  EXPECT_GT(moved.norm(), 0.1);
}

TEST(SchurComplement, TheInverseMassMayBeSingularInAnyDirection) {
  VectorXd eigenvalues = VectorXd::LinSpaced(kRigid, 0.1, 5.0);
  eigenvalues.head(3).setZero();
  SchurComplement complement;
  expectDenseSolution(complement, symmetric(eigenvalues, 4.0), someStiffness());
  expectDenseSolution(complement, MatrixXd::Zero(kRigid, kRigid), someStiffness());
}

TEST(SchurComplement, IsFactoredWithPivotsWhereItIsNotPositive) {
  VectorXd eigenvalues = VectorXd::LinSpaced(kReduced, 0.5, 20.0);
  eigenvalues[5] = -1e-3;
  SchurComplement complement;
  const MatrixXd none(0, 0), inverseMass = 1e-6 * MatrixXd::Identity(kRigid, kRigid);
  expectDenseSolution(complement, none, symmetric(eigenvalues, 3.0));
  expectDenseSolution(complement, inverseMass, -someStiffness());
  expectDenseSolution(complement, none, someStiffness());
}

}  // namespace
}  // namespace tetskin::test
