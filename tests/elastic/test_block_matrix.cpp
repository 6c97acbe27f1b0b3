// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The matrix of a body, in products with vectors and in sweeps, compared with the same matrix assembled densely.
#include <tetskin/elastic/src/matrix/block_matrix.h>

#include "elastic_fixtures.h"
#include "support/odd_meshes.h"
#include "support/shuffled_threads.h"

namespace tetskin::test {
namespace {

TetMesh cageForMatrix() {
  return jittered(latticeCage(3, 2, 1), 0.15, 3);
}

template <class S>
class BlockMatrixOf : public WithScalar<S> {};
TYPED_TEST_SUITE(BlockMatrixOf, Scalars);

TYPED_TEST(BlockMatrixOf, IsThatOfThePaperAndSymmetric) {
  for (const Cage& cage :
       {Cage(cageForMatrix()), Cage(singleTet()), Cage(bodyCentredCage(2, 1, 2)), oddQuadraticCage(), oddMixedCage()}) {
    onEachInstructionSet([&] {
      AssembledBody<TypeParam> body(cage);
      body.hold(1);
      body.assemble();
      const Eigen::MatrixXd a = columnsOf(body), expected = body.dense();
      const double size = expected.cwiseAbs().maxCoeff();
      EXPECT_LT((a - expected).cwiseAbs().maxCoeff(), 15.0 * this->kEpsilon * size);
      EXPECT_LT((a - a.transpose()).cwiseAbs().maxCoeff(), 2.0 * this->kEpsilon * size);
    });
  }
}

TYPED_TEST(BlockMatrixOf, MeetsATranslationWithTheMassesAlone) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(cageForMatrix(), 0.1,
                                  1e3);  // so stiff that an effect of the stiffness would be noticed
    body.hold(4);
    body.assemble();
    const Vector3d shift(1, -2, 0.5);
    const VectorXd image = body.times(shift.replicate(static_cast<Eigen::Index>(body.nodes.size()), 1));
    double maximum = 0.0;
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      maximum = std::max(maximum, (image.segment<3>(static_cast<Eigen::Index>(3 * n)) - body.masses[n] * shift).norm());
    }
    const double stiffness = body.dense().cwiseAbs().maxCoeff();
    ASSERT_GT(stiffness, 1e3);
    EXPECT_LT(maximum, 20.0 * this->kEpsilon * stiffness);
  });
}

TYPED_TEST(BlockMatrixOf, WithoutTetsIsTheMasses) {
  onEachInstructionSet([&] {
    BlockMatrix<TypeParam> matrix(11, {});
    for (std::size_t n = 0; n < 11; ++n) matrix.setMass(n, static_cast<TypeParam>(n));
    matrix.assemble(nullptr, 0, nullptr);
    EXPECT_EQ(matrix.totalMass(), 55.0);
    std::vector<TypeParam> points(4 * matrix.slotCount(), 2), image(matrix.wideSize());
    matrix.multiply(points.data(), image.data(), nullptr);
    for (std::size_t n = 0; n < 11; ++n) {
      EXPECT_EQ(matrix.mass(n), matrix.massAt(matrix.slotOf(n)));
      EXPECT_EQ(image[matrix.wideOf(n)], static_cast<TypeParam>(2 * n));
    }
  });
}

TYPED_TEST(BlockMatrixOf, LowerSolvesWithTheRowsBeforeAndReturnsItsNorm) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(cageForMatrix());
    BlockMatrix<TypeParam>& matrix = body.matrix;
    // The lower triangle of blocks in the order of slots, in which they are swept.
    const auto size = static_cast<Eigen::Index>(3 * body.nodes.size());
    Eigen::MatrixXd dense = body.dense(), lower = Eigen::MatrixXd::Zero(size, size), diagonal = lower;
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      for (std::size_t m = 0; m < body.nodes.size(); ++m) {
        const auto i = static_cast<Eigen::Index>(3 * n), j = static_cast<Eigen::Index>(3 * m);
        if (matrix.slotOf(m) <= matrix.slotOf(n)) lower.block<3, 3>(i, j) = dense.block<3, 3>(i, j);
        if (m == n) diagonal.block<3, 3>(i, j) = dense.block<3, 3>(i, j);
      }
    }
    const VectorXd r = Random(35).vector(3 * body.nodes.size());
    body.toWide(r, matrix.residual());
    const double norm = matrix.lower(nullptr);
    const VectorXd expected = solved(lower, r);
    EXPECT_LT((body.fromWide(matrix.residual()) - expected).norm(), 15.0 * this->kEpsilon * expected.norm());
    EXPECT_NEAR(norm / expected.dot(diagonal * expected), 1.0, 10.0 * this->kEpsilon);
  });
}

TYPED_TEST(BlockMatrixOf, ReturnsTheNormOfTheResidualWhichStays) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(cageForMatrix());
    body.toWide(Random(35).vector(3 * body.nodes.size()), body.matrix.residual());
    const VectorXd r = body.fromWide(body.matrix.residual());
    const double norm = body.matrix.squaredNorm(body.matrix.residual(), nullptr);
    EXPECT_EQ(body.fromWide(body.matrix.residual()), r);
    EXPECT_EQ(norm, body.matrix.lower(nullptr));
  });
}

TYPED_TEST(BlockMatrixOf, MultipliesADifferenceOfWhatIsNotPinned) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(cageForMatrix());
    body.hold(3);
    body.assemble();
    BlockMatrix<TypeParam>& matrix = body.matrix;
    std::vector<TypeParam> first(matrix.wideSize()), second = first, difference = first, image = first;
    const VectorXd x = Random(37).vector(3 * body.nodes.size());
    const VectorXd y = Random(38).vector(3 * body.nodes.size());
    body.toWide(x, first.data());
    body.toWide(y, second.data());
    for (const bool both : {false, true}) {
      matrix.multiplyDifference(first.data(), both ? second.data() : nullptr, difference.data(), image.data(), nullptr);
      VectorXd expected = both ? VectorXd(x - y) : x;
      expected.segment<3>(9).setZero();
      const VectorXd found = body.fromWide(difference.data());
      EXPECT_LT((found - expected).norm(), 2.0 * this->kEpsilon * expected.norm());
      EXPECT_TRUE(found.segment(9, 3).isZero(0.0));
      const VectorXd product = body.dense() * expected;
      EXPECT_LT((body.fromWide(image.data()) - product).norm(), 10.0 * this->kEpsilon * product.norm());
    }
    EXPECT_NEAR(matrix.inner(first.data(), second.data(), nullptr), x.dot(y),
                10.0 * this->kEpsilon * x.norm() * y.norm());
  });
}

TYPED_TEST(BlockMatrixOf, HasTheSameBitsOnAnyThreads) {
  // Several parts, of linear and of quadratic tets.
  Cage cage = refineQuadratic(latticeCage(60, 3, 3, 2.0)).value();
  for (int& number : cage.quadraticTet) number = number < 1500 ? number : -1;
  const AssembledBody<TypeParam> fresh(cage);
  const VectorXd x = Random(36).vector(3 * cage.mesh.nodeCount());
  const auto everything = [&](ParallelFor* threads) {
    AssembledBody<TypeParam> body = fresh;  // its rotations have not been updated
    BlockMatrix<TypeParam>& matrix = body.matrix;
    body.assemble(threads);
    VectorXd results = body.times(x, threads);
    const auto append = [&](const VectorXd& more) {
      results.conservativeResize(results.size() + more.size());
      results.tail(more.size()) = more;
    };
    body.toWide(x, matrix.residual());
    body.toWide(x, matrix.solution());
    std::vector<TypeParam> difference(matrix.wideSize()), image = difference;
    matrix.multiplyDifference(matrix.residual(), nullptr, difference.data(), image.data(), threads);
    append(body.fromWide(image.data()));
    append(Eigen::Vector2d(matrix.squaredNorm(matrix.residual(), threads),
                           matrix.inner(difference.data(), image.data(), threads)));
    const double norm = matrix.lower(threads);
    matrix.backward(0, threads);
    const double bend = matrix.forward(nullptr, threads);
    const double after = matrix.advance(static_cast<TypeParam>(norm / bend), threads);
    append(Vector3d(norm, bend, after));
    append(body.fromWide(matrix.solution()));
    append(body.fromWide(matrix.residual()));
    return results;
  };
  const VectorXd expected = everything(nullptr);
  ASSERT_TRUE(expected.allFinite());
  for (const int count : {1, 2, 3}) {
    ShuffledThreads threads(count);
    EXPECT_EQ(everything(&threads), expected);
    EXPECT_GT(threads.maxTasks, 4u);
    EXPECT_GE(threads.runs, 9) << "the parts of a sweep, and its separators";
  }
}

}  // namespace
}  // namespace tetskin::test
