// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/solver/schur_complement.h>

#include <gtest/gtest.h>
#include <Eigen/LU>
#include <Eigen/QR>

namespace tetskin::test {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr Eigen::Index kReduced = 12, kRigid = 7;

/// The same numbers from -1 to 1 each time.
Matrix numbers(Eigen::Index rows, Eigen::Index columns, double seed) {
  return Matrix::NullaryExpr(rows, columns, [&](Eigen::Index row, Eigen::Index column) {
    return std::sin(seed + 1.7 * static_cast<double>(row * row) + 2.9 * static_cast<double>(column));
  });
}
/// With these eigenvalues.
Matrix symmetric(const Vector& eigenvalues, double seed) {
  const Eigen::Index size = eigenvalues.size();
  const Matrix turn = Eigen::HouseholderQR<Matrix>(numbers(size, size, seed)).householderQ();
  return turn * eigenvalues.asDiagonal() * turn.transpose();
}
Matrix someStiffness() {
  return symmetric(Vector::LinSpaced(kReduced, 0.5, 20.0), 3.0);
}

/// By rows W (K x - b) + x = 0 of the rigid bodies, for the inverse mass W, and K x = b of the others.
Vector denseSolution(const Matrix& inverseMass, const Matrix& stiffness, const Vector& right) {
  const Eigen::Index rigid = inverseMass.rows();
  Matrix all = stiffness;
  Vector b = right;
  all.topRows(rigid) = inverseMass * stiffness.topRows(rigid);
  all.topLeftCorner(rigid, rigid) += Matrix::Identity(rigid, rigid);
  b.head(rigid) = inverseMass * right.head(rigid);
  return all.fullPivLu().solve(b);
}

void expectDenseSolution(SchurComplement& complement, const Matrix& inverseMass, const Matrix& stiffness) {
  complement.setInverseMass(inverseMass);
  complement.factor(stiffness);
  ASSERT_EQ(complement.size(), stiffness.rows());
  for (const double seed : {1.0, 2.0}) {
    const Vector right = numbers(stiffness.rows(), 1, seed);
    const Vector wanted = denseSolution(inverseMass, stiffness, right);
    EXPECT_LT((complement.solve(right) - wanted).norm(), 1e-9 * (1.0 + wanted.norm()));
  }
}

TEST(SchurComplement, SolvesForRigidBodiesAndOtherUnknowns) {
  SchurComplement complement;
  for (const Eigen::Index rigid : {kRigid, kReduced, Eigen::Index(0)}) {
    SCOPED_TRACE(rigid);
    expectDenseSolution(complement, symmetric(Vector::LinSpaced(rigid, 0.1, 5.0), 4.0), someStiffness());
  }
}

TEST(SchurComplement, LockedAxesDoNotMove) {
  Matrix inverseMass = symmetric(Vector::LinSpaced(kRigid, 0.1, 5.0), 4.0);
  for (const Eigen::Index locked : {0, 4}) inverseMass.row(locked).setZero(), inverseMass.col(locked).setZero();
  SchurComplement complement;
  expectDenseSolution(complement, inverseMass, someStiffness());
  const Vector moved = complement.solve(numbers(kReduced, 1, 1.0));
  for (const Eigen::Index locked : {0, 4}) EXPECT_NEAR(moved[locked], 0.0, 1e-12);
  EXPECT_GT(moved.norm(), 0.1);
}

TEST(SchurComplement, TheInverseMassMayBeSingularInAnyDirection) {
  Vector eigenvalues = Vector::LinSpaced(kRigid, 0.1, 5.0);
  eigenvalues.head(3).setZero();
  SchurComplement complement;
  expectDenseSolution(complement, symmetric(eigenvalues, 4.0), someStiffness());
  expectDenseSolution(complement, Matrix::Zero(kRigid, kRigid), someStiffness());
}

TEST(SchurComplement, IsFactoredWithPivotsWhereItIsNotPositive) {
  Vector eigenvalues = Vector::LinSpaced(kReduced, 0.5, 20.0);
  eigenvalues[5] = -1e-3;
  SchurComplement complement;
  const Matrix none(0, 0), inverseMass = 1e-6 * Matrix::Identity(kRigid, kRigid);
  expectDenseSolution(complement, none, symmetric(eigenvalues, 3.0));
  expectDenseSolution(complement, inverseMass, -someStiffness());
  expectDenseSolution(complement, none, someStiffness());
}

}  // namespace
}  // namespace tetskin::test
