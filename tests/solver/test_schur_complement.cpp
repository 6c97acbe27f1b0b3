// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/system/schur_complement.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include <utility>

namespace tetskin::test {

using namespace bullet_detail;

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The same numbers from -1 to 1 each time.
MatrixXd numbers(Index rows, Index columns, double seed) {
  return MatrixXd::NullaryExpr(rows, columns, [&](Index row, Index column) {
    return std::sin(seed + 1.7 * static_cast<double>(row * row) + 2.9 * static_cast<double>(column));
  });
}
/// With these eigenvalues.
MatrixXd symmetric(const VectorXd& eigenvalues, double seed) {
  const Index size = eigenvalues.size();
  const MatrixXd turn = Eigen::HouseholderQR<MatrixXd>(numbers(size, size, seed)).householderQ();
  return turn * eigenvalues.asDiagonal() * turn.transpose();
}
MatrixXd someInverseMass(Index size, double seed = 4.0) {
  return symmetric(VectorXd::LinSpaced(size, 0.1, 5.0), seed);
}

/// By rows W (K x - b) + x = 0 of the rigid bodies, for the inverse mass W, and K x = b of the others.
/// rigid  1 for the unknowns of rigid bodies, 0 for others, the rows of which W leaves as they are
VectorXd denseSolution(const MatrixXd& inverseMass, const VectorXd& rigid, const MatrixXd& stiffness,
                       const VectorXd& right) {
  MatrixXd all = inverseMass * stiffness;
  all += rigid.asDiagonal();
  return all.fullPivLu().solve(inverseMass * right);
}

/// Groups in a SchurComplement, and the same matrices in dense form.
class Groups {
 public:
  using Couplings = std::vector<std::pair<std::size_t, std::size_t>>;

  std::size_t addRigid(const MatrixXd& inverseMass) { return add(complement.addRigid(inverseMass), inverseMass, 1.0); }
  std::size_t addOther(Index size) { return add(complement.add(size), MatrixXd::Identity(size, size), 0.0); }
  void couple(const Couplings& pairs) {
    for (const auto& [a, b] : pairs) complement.couple(firsts[a], firsts[b]);
    couplings = pairs;
    complement.order();
  }
  /// Fills K: positive, with blocks of all groups with themselves and of those that are coupled.
  void fill(double seed) {
    stiffness = MatrixXd::Zero(complement.size(), complement.size());
    for (std::size_t g = 0; g < firsts.size(); ++g) {
      const VectorXd eigenvalues = VectorXd::LinSpaced(sizes[g], 0.5, 20.0);
      addTo(g, g, symmetric(eigenvalues, seed + static_cast<double>(g)));
    }
    for (const auto& [a, b] : couplings) {
      // As a row does: J^T H J with the Jacobians of both.
      const MatrixXd ja = numbers(3, sizes[a], seed + 0.1 * static_cast<double>(b)),
                     jb = numbers(3, sizes[b], seed + 0.3 * static_cast<double>(a));
      addTo(a, a, ja.transpose() * ja);
      addTo(b, b, jb.transpose() * jb);
      addTo(std::max(a, b), std::min(a, b), a > b ? -ja.transpose() * jb : -jb.transpose() * ja);
    }
    write();
  }
  /// Writes K into the blocks.
  void write() {
    complement.setZero();
    for (std::size_t g = 0; g < firsts.size(); ++g) writeBlock(g, g);
    for (const auto& [a, b] : couplings) writeBlock(std::max(a, b), std::min(a, b));
  }
  void expectDenseSolution() {
    complement.factor();
    for (const double seed : {1.0, 2.0}) {
      const VectorXd right = numbers(complement.size(), 1, seed);
      const VectorXd wanted = denseSolution(inverseMasses, rigid, stiffness, right);
      EXPECT_LT((complement.solve(right) - wanted).norm(), 1e-9 * (1.0 + wanted.norm()));
    }
  }

  SchurComplement complement;
  MatrixXd inverseMasses, stiffness;
  VectorXd rigid;
  std::vector<Index> firsts, sizes;
  Couplings couplings;

 private:
  std::size_t add(Index first, const MatrixXd& inverseMass, double isRigid) {
    const Index size = inverseMass.rows();
    EXPECT_EQ(first, rigid.size());
    EXPECT_EQ(complement.size(), first + size);
    firsts.push_back(first);
    sizes.push_back(size);
    inverseMasses.conservativeResizeLike(MatrixXd::Zero(first + size, first + size));
    inverseMasses.bottomRightCorner(size, size) = inverseMass;
    rigid.conservativeResize(first + size);
    rigid.tail(size).setConstant(isRigid);
    return firsts.size() - 1;
  }
  void addTo(std::size_t row, std::size_t column, const MatrixXd& block) {
    stiffness.block(firsts[row], firsts[column], sizes[row], sizes[column]) += block;
    if (row != column) stiffness.block(firsts[column], firsts[row], sizes[column], sizes[row]) += block.transpose();
  }
  void writeBlock(std::size_t row, std::size_t column) {
    SchurComplement::Block block = complement.block(firsts[row], firsts[column]);
    ASSERT_EQ(block.rows(), sizes[row]);
    ASSERT_EQ(block.cols(), sizes[column]);
    block += stiffness.block(firsts[row], firsts[column], sizes[row], sizes[column]);  // as rows add theirs
  }
};

/// All groups are coupled with all others.
Groups::Couplings allOf(std::size_t count) {
  Groups::Couplings all;
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < a; ++b) all.emplace_back(a, b);
  }
  return all;
}

TEST(SchurComplement, AddsProductsWithTheBitsOfEigens) {
  for (const Index rows : {6, 7, 12}) {
    for (const Index columns : {6, 11}) {
      SchurComplement complement;
      const Index second = complement.add(columns), first = complement.add(rows);
      complement.couple(first, second);
      complement.order();
      const Eigen::Matrix<double, 3, Eigen::Dynamic> a = numbers(3, rows, 1.0), b = numbers(3, columns, 2.0);
      const Eigen::Matrix3d h = numbers(3, 3, 3.0);
      MatrixXd wanted = MatrixXd::Zero(rows, columns);
      for (const double sign : {1.0, -1.0, 1.0}) {
        wanted += sign * (a.transpose() * h * b);
        complement.addProduct(first, second, sign, a, smallFrom<3, 3>(h.data()), b);
      }
      EXPECT_EQ(MatrixXd(complement.block(first, second)), wanted) << rows << " " << columns;
    }
  }
}

TEST(SchurComplement, SolvesForRigidBodiesAndOtherUnknowns) {
  for (const int rigid : {0, 1, 3}) {
    for (const int others : {0, 2}) {
      if (rigid + others == 0) continue;
      SCOPED_TRACE(std::to_string(rigid) + " and " + std::to_string(others));
      Groups groups;
      for (int k = 0; k < rigid; ++k) groups.addRigid(someInverseMass(6, 4.0 + k));
      for (int k = 0; k < others; ++k) groups.addOther(6);
      groups.couple(allOf(static_cast<std::size_t>(rigid + others)));
      groups.fill(3.0);
      groups.expectDenseSolution();
    }
  }
}

/// A multibody has six unknowns and one for each joint, or no six if its base is fixed.
TEST(SchurComplement, SolvesForGroupsOfAnySize) {
  Groups groups;
  double seed = 4.0;
  for (const Index size : {6, 14, 1, 9, 2}) groups.addRigid(someInverseMass(size, seed++));
  groups.addOther(6);
  groups.couple({{1, 0}, {1, 2}, {1, 5}, {3, 4}, {5, 4}, {2, 4}});
  groups.fill(1.0);
  groups.expectDenseSolution();
}

TEST(SchurComplement, SolvesForAChain) {
  Groups groups;
  Groups::Couplings links;
  for (std::size_t k = 0; k < 40; ++k) {
    groups.addRigid(someInverseMass(6, 1.0 + static_cast<double>(k)));
    if (k > 0) links.emplace_back(k - 1, k);
  }
  groups.couple(links);
  groups.fill(2.0);
  groups.expectDenseSolution();
}

/// One body that all others touch: the first, the last or one between them.
TEST(SchurComplement, SolvesForManyThatAreCoupledWithOne) {
  for (const std::size_t hub : {0U, 7U, 19U}) {
    SCOPED_TRACE(hub);
    Groups groups;
    Groups::Couplings spokes;
    for (std::size_t k = 0; k < 20; ++k) {
      if (k % 3 == 2) {
        groups.addOther(6);
      } else {
        groups.addRigid(someInverseMass(6, 1.0 + static_cast<double>(k)));
      }
      if (k != hub) spokes.emplace_back(hub, k);
    }
    groups.couple(spokes);
    groups.fill(2.0);
    groups.expectDenseSolution();
  }
}

TEST(SchurComplement, GroupsThatAreNotCoupledAreSolvedAsIfAlone) {
  Groups all;
  for (int k = 0; k < 3; ++k) all.addRigid(someInverseMass(6, 4.0 + k));
  all.addOther(6);
  all.couple({});
  all.fill(3.0);
  all.expectDenseSolution();
  VectorXd right = numbers(all.complement.size(), 1, 1.0);
  const VectorXd before = all.complement.solve(right);
  right.segment(6, 6) *= -3.0;
  const VectorXd change = all.complement.solve(right) - before;
  EXPECT_GT(change.segment(6, 6).norm(), 0.1);
  EXPECT_EQ(change.head(6).norm() + change.tail(12).norm(), 0.0);
}

/// As contacts come: the same pair several times, in either order, and a group with itself.
TEST(SchurComplement, GroupsMayBeCoupledInAnyOrderAndTwice) {
  Groups groups;
  for (int k = 0; k < 4; ++k) groups.addRigid(someInverseMass(6, 4.0 + k));
  for (const auto& [a, b] : Groups::Couplings{{3, 1}, {1, 3}, {0, 0}, {3, 1}}) {
    groups.complement.couple(groups.firsts[a], groups.firsts[b]);
  }
  groups.couple({{2, 0}, {3, 0}, {1, 3}});
  groups.fill(3.0);
  groups.expectDenseSolution();
}

TEST(SchurComplement, BlocksAreThoseOfTheirGroupsAndNoOthers) {
  Groups groups;
  for (const Index size : {6, 8, 3}) groups.addRigid(MatrixXd::Identity(size, size));
  groups.couple(allOf(3));
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column <= row; ++column) {
      SchurComplement::Block block = groups.complement.block(groups.firsts[row], groups.firsts[column]);
      EXPECT_TRUE(block.isZero(0.0));
      block.setConstant(static_cast<double>(10 * row + column) + 1.0);
    }
  }
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column <= row; ++column) {
      const SchurComplement::Block block = groups.complement.block(groups.firsts[row], groups.firsts[column]);
      EXPECT_TRUE(block.isConstant(static_cast<double>(10 * row + column) + 1.0, 0.0)) << row << " " << column;
    }
  }
  groups.complement.setZero();
  EXPECT_TRUE(groups.complement.block(groups.firsts[2], groups.firsts[0]).isZero(0.0));
}

/// A step factors the matrix once per pass: rows that are apart in one are not in the next.
TEST(SchurComplement, IsFactoredAgainInTheSameOrder) {
  Groups groups;
  for (int k = 0; k < 5; ++k) groups.addRigid(someInverseMass(6, 4.0 + k));
  groups.addOther(6);
  groups.couple({{0, 1}, {1, 2}, {3, 2}, {5, 4}, {5, 0}});
  for (const double seed : {3.0, 5.0, 8.0}) {
    groups.fill(seed);
    groups.expectDenseSolution();
  }
  // Most of the rows have gone, and come back.
  const MatrixXd full = groups.stiffness;
  groups.stiffness.setZero();
  groups.stiffness.bottomRightCorner(6, 6) = symmetric(VectorXd::LinSpaced(6, 0.5, 20.0), 1.0);
  groups.write();
  groups.expectDenseSolution();
  groups.stiffness = full;
  groups.write();
  groups.expectDenseSolution();
}

TEST(SchurComplement, LockedAxesDoNotMove) {
  MatrixXd inverseMass = someInverseMass(6);
  for (const Index locked : {0, 4}) inverseMass.row(locked).setZero(), inverseMass.col(locked).setZero();
  Groups groups;
  groups.addRigid(someInverseMass(6, 5.0));
  groups.addRigid(inverseMass);
  groups.addOther(6);
  groups.couple(allOf(3));
  groups.fill(3.0);
  groups.expectDenseSolution();
  const VectorXd moved = groups.complement.solve(numbers(18, 1, 1.0));
  for (const Index locked : {0, 4}) EXPECT_NEAR(moved[6 + locked], 0.0, 1e-12);
  EXPECT_GT(moved.segment(6, 6).norm(), 0.01);
}

TEST(SchurComplement, TheInverseMassMayBeSingularInAnyDirection) {
  VectorXd eigenvalues = VectorXd::LinSpaced(7, 0.1, 5.0);
  eigenvalues.head(3).setZero();
  Groups groups;
  groups.addRigid(symmetric(eigenvalues, 4.0));
  groups.addRigid(MatrixXd::Zero(6, 6));
  groups.addRigid(symmetric(eigenvalues, 7.0));
  groups.addOther(6);
  groups.couple(allOf(4));
  groups.fill(3.0);
  groups.expectDenseSolution();
}

TEST(SchurComplement, IsFactoredWithPivotsWhereItIsNotPositive) {
  Groups groups;
  groups.addRigid(1e-6 * MatrixXd::Identity(6, 6));
  groups.addOther(6);
  groups.addOther(12);
  groups.couple({{0, 1}, {2, 1}});
  groups.fill(3.0);
  const MatrixXd positive = groups.stiffness;
  groups.expectDenseSolution();
  VectorXd eigenvalues = VectorXd::LinSpaced(12, 0.5, 20.0);
  eigenvalues[5] = -1e-3;
  for (const MatrixXd& last : {symmetric(eigenvalues, 3.0), MatrixXd(-20.0 * symmetric(eigenvalues, 3.0))}) {
    groups.stiffness = positive;
    groups.stiffness.bottomRightCorner(12, 12) = last;
    groups.write();
    groups.expectDenseSolution();
  }
  groups.stiffness = positive;
  groups.write();
  groups.expectDenseSolution();
}

TEST(SchurComplement, MultipliesByTheInverseMassesOfRigidBodiesOnly) {
  Groups groups;
  groups.addRigid(someInverseMass(6, 4.0));
  groups.addOther(6);
  VectorXd eigenvalues = VectorXd::LinSpaced(8, 0.1, 5.0);
  eigenvalues.head(2).setZero();
  groups.addRigid(symmetric(eigenvalues, 5.0));
  const VectorXd unknowns = numbers(20, 1, 2.0), moved = groups.complement.timesInverseMass(unknowns);
  EXPECT_LT((moved - groups.inverseMasses * unknowns).norm(), 1e-12);
  EXPECT_EQ((moved.segment(6, 6) - unknowns.segment(6, 6)).norm(), 0.0);
}

}  // namespace
}  // namespace tetskin::test
