// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <set>

#include "elastic_fixtures.h"
#include "support/odd_meshes.h"
#include "support/shuffled_threads.h"

namespace tetskin {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using elastic_detail::BlockMatrix;
using elastic_detail::BlockPattern;
using kernels::kGroup;
using test::AssembledBody;
using test::onEachInstructionSet;

TetMesh smallCage() {
  return test::jittered(test::latticeCage(3, 2, 1), 0.15, 3);
}

/// Large enough for several tasks of one colour.
TetMesh largeCage() {
  return test::latticeCage(12, 12, 12);
}

/// The cages of the tests of the pattern: one of them with nodes that no tet names.
std::vector<TetMesh> patternCages() {
  std::vector<TetMesh> cages{test::singleTet(), smallCage(), test::bodyCentredCage(3, 3, 2), largeCage()};
  cages[1].nodes.insert(cages[1].nodes.end(), 3, Vector3d(5, 5, 5));
  return cages;
}

BlockPattern patternOf(const TetMesh& cage) {
  return BlockMatrix<double>(cage.nodeCount(), cage.tets, test::CorotatedTets<double>::noTet(cage.tetCount()))
      .pattern();
}

/// By slot, -1 where there is none.
std::vector<int> nodesOf(const BlockPattern& pattern) {
  std::vector<int> nodes(pattern.slotCount(), -1);
  for (std::size_t n = 0; n < pattern.slotOf.size(); ++n) nodes[pattern.slotOf[n]] = static_cast<int>(n);
  return nodes;
}

std::vector<std::size_t> coloursOfChunks(const BlockPattern& pattern) {
  std::vector<std::size_t> colours(pattern.chunkCount(), 999);
  for (std::size_t c = 0; c + 1 < pattern.colours.size(); ++c) {
    for (std::size_t chunk = pattern.taskChunks[pattern.colours[c]]; chunk < pattern.taskChunks[pattern.colours[c + 1]];
         ++chunk) {
      colours[chunk] = c;
    }
  }
  return colours;
}

TEST(BlockPattern, EveryNodeHasASlotOfItsOwnAndEveryChunkATaskAndAColour) {
  for (const TetMesh& cage : patternCages()) {
    const BlockPattern pattern = patternOf(cage);
    ASSERT_EQ(pattern.slotOf.size(), cage.nodeCount());
    std::set<std::uint32_t> slots;
    for (const std::uint32_t slot : pattern.slotOf) {
      EXPECT_LT(slot, pattern.slotCount());
      EXPECT_TRUE(slots.insert(slot).second) << slot;
    }
    EXPECT_EQ(pattern.taskChunks.front(), 0u);
    EXPECT_EQ(pattern.taskChunks.back(), pattern.chunkCount());
    EXPECT_TRUE(std::is_sorted(pattern.taskChunks.begin(), pattern.taskChunks.end()));
    EXPECT_EQ(pattern.colours.front(), 0u);
    EXPECT_EQ(pattern.colours.back(), pattern.taskCount());
    EXPECT_TRUE(std::is_sorted(pattern.colours.begin(), pattern.colours.end()));
    const std::vector<std::size_t> colours = coloursOfChunks(pattern);
    EXPECT_EQ(std::count(colours.begin(), colours.end(), 999u), 0);
  }
}

TEST(BlockPattern, NeighboursAreThereOnceFromEachSideAndNeverOfOneColour) {
  for (const TetMesh& cage : patternCages()) {
    const BlockPattern pattern = patternOf(cage);
    const std::vector<int> nodes = nodesOf(pattern);
    const std::vector<std::size_t> colours = coloursOfChunks(pattern);
    std::map<std::pair<int, int>, int> lower, upper;
    for (std::size_t chunk = 0; chunk < pattern.chunkCount(); ++chunk) {
      for (std::size_t e = pattern.starts[2 * chunk]; e < pattern.starts[2 * chunk + 2]; ++e) {
        const bool isLower = e < pattern.starts[2 * chunk + 1];
        for (std::size_t lane = 0; lane < kGroup; ++lane) {
          const std::size_t own = kGroup * chunk + lane, other = pattern.neighbours[kGroup * e + lane];
          if (other == own) continue;  // filled up
          ASSERT_GE(nodes[own], 0);
          ASSERT_GE(nodes[other], 0);
          const std::size_t otherColour = colours[other / kGroup];
          EXPECT_TRUE(isLower ? otherColour < colours[chunk] : otherColour > colours[chunk]) << own << " " << other;
          ++(isLower ? lower : upper)[{nodes[own], nodes[other]}];
        }
      }
    }
    std::map<std::pair<int, int>, int> both = lower;
    both.insert(upper.begin(), upper.end());
    EXPECT_EQ(both.size(), lower.size() + upper.size());
    for (const auto& [pair, times] : both) EXPECT_EQ(times, 1) << pair.first << " " << pair.second;
    for (const auto& [pair, times] : lower) EXPECT_EQ(upper.count({pair.second, pair.first}), 1u);
    const auto edges = uniqueEdges(cage);
    EXPECT_EQ(both.size(), 2 * edges.size());
    for (const auto& [a, b] : edges) EXPECT_EQ(both.count({a, b}) + both.count({b, a}), 2u) << a << " " << b;
  }
}

TEST(BlockPattern, EveryTetHasATermInEachOfItsBlocks) {
  for (const TetMesh& cage : patternCages()) {
    const BlockPattern pattern = patternOf(cage);
    const std::vector<int> nodes = nodesOf(pattern);
    const std::size_t none = 4 * test::CorotatedTets<double>::noTet(cage.tetCount());
    const auto nodeAt = [&](std::uint32_t corner) { return cage.tets[corner / 4][corner % 4]; };
    std::size_t terms = 0;
    for (std::size_t chunk = 0; chunk < pattern.chunkCount(); ++chunk) {
      for (std::size_t e = pattern.starts[2 * chunk]; e < pattern.starts[2 * chunk + 2]; ++e) {
        for (std::size_t term = pattern.sums[e]; term < pattern.sums[e + 1]; ++term) {
          for (std::size_t lane = 0; lane < kGroup; ++lane) {
            const std::uint32_t own = pattern.terms[2 * kGroup * term + lane];
            const std::uint32_t other = pattern.terms[2 * kGroup * term + kGroup + lane];
            EXPECT_EQ(own == none, other == none);
            if (own == none || other == none) continue;
            ++terms;
            ASSERT_LT(std::max(own, other), none);
            EXPECT_EQ(own / 4, other / 4) << "of one tet";
            EXPECT_EQ(nodeAt(own), nodes[kGroup * chunk + lane]);
            EXPECT_EQ(nodeAt(other), nodes[pattern.neighbours[kGroup * e + lane]]);
          }
        }
      }
    }
    EXPECT_EQ(terms, 12 * cage.tetCount());  // ordered pairs of corners
  }
}

template <class S>
class BlockMatrixOf : public testing::Test {
 protected:
  static constexpr double kEpsilon = std::numeric_limits<S>::epsilon();
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BlockMatrixOf, Scalars);

/// One column after the other.
template <class S>
Eigen::MatrixXd columnsOf(const AssembledBody<S>& body) {
  const auto size = static_cast<Eigen::Index>(3 * body.nodes.size());
  Eigen::MatrixXd columns(size, size);
  for (Eigen::Index k = 0; k < size; ++k) columns.col(k) = body.times(VectorXd::Unit(size, k));
  return columns;
}

TYPED_TEST(BlockMatrixOf, IsThatOfThePaperAndSymmetric) {
  for (const TetMesh& cage : {smallCage(), test::singleTet(), test::bodyCentredCage(2, 1, 2)}) {
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
    AssembledBody<TypeParam> body(smallCage(), 0.1, 1e3);  // stiff: stiffness would be seen
    body.hold(4);
    body.assemble();
    const Vector3d shift(1, -2, 0.5);
    const VectorXd image = body.times(shift.replicate(static_cast<Eigen::Index>(body.nodes.size()), 1));
    double most = 0.0;
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      most = std::max(most, (image.segment<3>(static_cast<Eigen::Index>(3 * n)) - body.masses[n] * shift).norm());
    }
    const double stiffness = body.dense().cwiseAbs().maxCoeff();
    ASSERT_GT(stiffness, 1e3);
    EXPECT_LT(most, 20.0 * this->kEpsilon * stiffness);
  });
}

TYPED_TEST(BlockMatrixOf, WithoutTetsIsTheMasses) {
  onEachInstructionSet([&] {
    BlockMatrix<TypeParam> matrix(11, {}, 0);
    for (std::size_t n = 0; n < 11; ++n) matrix.setMass(n, static_cast<TypeParam>(n));
    matrix.assemble(nullptr, nullptr);
    EXPECT_EQ(matrix.totalMass(), 55.0);
    std::vector<TypeParam> points(4 * matrix.slotCount(), 2), image(matrix.wideSize());
    matrix.multiply(points.data(), image.data(), nullptr);
    for (std::size_t n = 0; n < 11; ++n) {
      EXPECT_EQ(matrix.mass(n), matrix.massAt(matrix.slotOf(n)));
      EXPECT_EQ(image[matrix.wideOf(n)], static_cast<TypeParam>(2 * n));
    }
  });
}

Matrix3d symmetric(const double* m) {
  Matrix3d result;
  result << m[0], m[1], m[2], m[1], m[3], m[4], m[2], m[4], m[5];
  return result;
}

template <class S>
Matrix3d diagonalOf(const BlockMatrix<S>& matrix, std::size_t node) {
  S m[6];
  matrix.diagonal(node, m);
  const double d[6] = {m[0], m[1], m[2], m[3], m[4], m[5]};
  return symmetric(d);
}

template <class S>
Matrix3d freeInverseOf(const BlockMatrix<S>& matrix, std::size_t node) {
  S m[6];
  matrix.freeInverse(node, m);
  const double d[6] = {m[0], m[1], m[2], m[3], m[4], m[5]};
  return symmetric(d);
}

/// What the sweeps take for the inverse of a node's block: what they make of a residual that is 0 everywhere else.
template <class S>
Matrix3d inverseInUse(BlockMatrix<S>& matrix, std::size_t node) {
  Matrix3d inverse;
  for (int j = 0; j < 3; ++j) {
    std::fill_n(matrix.residual(), matrix.wideSize(), S(0));
    matrix.residual()[matrix.wideOf(node) + static_cast<std::size_t>(j) * kGroup] = S(1);
    matrix.lower(nullptr);
    for (int i = 0; i < 3; ++i) {
      inverse(i, j) = matrix.residual()[matrix.wideOf(node) + static_cast<std::size_t>(i) * kGroup];
    }
  }
  return inverse;
}

TYPED_TEST(BlockMatrixOf, KnowsTheInversesOfItsDiagonal) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(smallCage());
    body.hold(2);
    body.assemble();
    const Eigen::MatrixXd dense = body.dense();
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      const auto at = static_cast<Eigen::Index>(3 * n);
      const Matrix3d block = dense.block<3, 3>(at, at);
      EXPECT_LT((diagonalOf(body.matrix, n) - block).norm(), 15.0 * this->kEpsilon * block.norm());
      if (n == 2) {
        EXPECT_EQ(freeInverseOf(body.matrix, n), Matrix3d::Zero());
      } else {
        EXPECT_LT((freeInverseOf(body.matrix, n) * block - Matrix3d::Identity()).norm(), 40.0 * this->kEpsilon);
      }
      EXPECT_EQ(inverseInUse(body.matrix, n), freeInverseOf(body.matrix, n));
    }
  });
}

TYPED_TEST(BlockMatrixOf, AFixedNodeMovesOnlyWhereItMay) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(smallCage());
    BlockMatrix<TypeParam>& matrix = body.matrix;
    const Vector3d n = Vector3d(1, -2, 2) / 3.0;
    const TypeParam normal[3] = {static_cast<TypeParam>(n[0]), static_cast<TypeParam>(n[1]),
                                 static_cast<TypeParam>(n[2])};
    const Matrix3d plane = Matrix3d::Identity() - n * n.transpose();
    for (const std::size_t node : {0u, 5u, 9u}) {
      const Matrix3d block = diagonalOf(matrix, node), free = inverseInUse(matrix, node);
      const double small = 10.0 * this->kEpsilon;

      matrix.fixAlong(node, normal);
      Matrix3d inverse = inverseInUse(matrix, node);
      EXPECT_LT((inverse * n).norm(), small * free.norm());
      EXPECT_LT((n.transpose() * inverse).norm(), small * free.norm());
      EXPECT_LT((plane * block * inverse - plane).norm(), small) << "the inverse in the plane";

      matrix.fixAllBut(node, normal);
      inverse = inverseInUse(matrix, node);
      const Matrix3d expected = n * n.transpose() / n.dot(block * n);
      EXPECT_LT((inverse - expected).norm(), small * free.norm());

      matrix.fix(node);
      EXPECT_EQ(inverseInUse(matrix, node), Matrix3d::Zero());
      EXPECT_EQ(diagonalOf(matrix, node), block);

      matrix.free();
      EXPECT_EQ(inverseInUse(matrix, node), free);
    }
  });
}

TYPED_TEST(BlockMatrixOf, ResistsAcrossANormalUntilItIsFree) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(smallCage());
    BlockMatrix<TypeParam>& matrix = body.matrix;
    const Vector3d n = Vector3d(2, 3, -6) / 7.0;
    const TypeParam normal[3] = {static_cast<TypeParam>(n[0]), static_cast<TypeParam>(n[1]),
                                 static_cast<TypeParam>(n[2])};
    const Matrix3d plane = Matrix3d::Identity() - n * n.transpose();
    for (const std::size_t node : {0u, 5u, 9u}) {
      const Matrix3d before = diagonalOf(matrix, node), free = freeInverseOf(matrix, node);
      matrix.resistAcross(node, normal, 7);
      const Matrix3d expected = before + 7.0 * plane;
      EXPECT_LT((diagonalOf(matrix, node) - expected).norm(), 10.0 * this->kEpsilon * expected.norm());
      EXPECT_LT((inverseInUse(matrix, node) * expected - Matrix3d::Identity()).norm(), 30.0 * this->kEpsilon);
      EXPECT_EQ(freeInverseOf(matrix, node), free);
      const VectorXd along =
          VectorXd::Unit(static_cast<Eigen::Index>(3 * body.nodes.size()), static_cast<Eigen::Index>(3 * node));
      const VectorXd column = body.times(along);
      const Vector3d row = column.segment<3>(static_cast<Eigen::Index>(3 * node));
      EXPECT_LT((row - expected.col(0)).norm(), 10.0 * this->kEpsilon * expected.norm());

      matrix.fixAlong(node, normal);  // within the resistance
      EXPECT_LT((plane * expected * inverseInUse(matrix, node) - plane).norm(), 30.0 * this->kEpsilon);

      matrix.free();
      EXPECT_EQ(diagonalOf(matrix, node), before);
      EXPECT_EQ(inverseInUse(matrix, node), free);
    }
  });
}

TYPED_TEST(BlockMatrixOf, AHeldNodeStaysHeld) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(smallCage());
    body.hold(5);
    body.assemble();
    BlockMatrix<TypeParam>& matrix = body.matrix;
    const Matrix3d block = diagonalOf(matrix, 5);
    const TypeParam normal[3] = {0, 1, 0};
    matrix.fixAlong(5, normal);
    EXPECT_EQ(inverseInUse(matrix, 5), Matrix3d::Zero());
    matrix.fixAllBut(5, normal);
    EXPECT_EQ(inverseInUse(matrix, 5), Matrix3d::Zero());
    matrix.resistAcross(5, normal, 3);
    EXPECT_EQ(inverseInUse(matrix, 5), Matrix3d::Zero());
    EXPECT_EQ(diagonalOf(matrix, 5), block);
    matrix.free();
    EXPECT_EQ(inverseInUse(matrix, 5), Matrix3d::Zero());
    // Let go again, from the next assembly on.
    body.masses[5] = 1.0;
    body.assemble();
    EXPECT_GT(inverseInUse(matrix, 5).determinant(), 0.0);
  });
}

TYPED_TEST(BlockMatrixOf, OneRowIsThatOfTheProduct) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(smallCage());
    const TypeParam normal[3] = {0, 1, 0};
    body.matrix.resistAcross(3, normal, 4);
    const VectorXd x = test::Random(34).vector(3 * body.nodes.size());
    const VectorXd image = body.times(x);
    body.toWide(x, body.matrix.solution());
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      TypeParam row[3];
      body.matrix.rowTimesSolution(n, row);
      const Vector3d difference = image.segment<3>(static_cast<Eigen::Index>(3 * n)) - Vector3d(row[0], row[1], row[2]);
      EXPECT_LT(difference.norm(), 5.0 * this->kEpsilon * image.norm());
    }
  });
}

TYPED_TEST(BlockMatrixOf, LowerSolvesWithTheRowsBeforeAndReturnsItsNorm) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(smallCage());
    BlockMatrix<TypeParam>& matrix = body.matrix;
    // The lower triangle of blocks by the order of slots, which is that of colours.
    const auto size = static_cast<Eigen::Index>(3 * body.nodes.size());
    Eigen::MatrixXd dense = body.dense(), lower = Eigen::MatrixXd::Zero(size, size), diagonal = lower;
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      for (std::size_t m = 0; m < body.nodes.size(); ++m) {
        const auto i = static_cast<Eigen::Index>(3 * n), j = static_cast<Eigen::Index>(3 * m);
        if (matrix.slotOf(m) <= matrix.slotOf(n)) lower.block<3, 3>(i, j) = dense.block<3, 3>(i, j);
        if (m == n) diagonal.block<3, 3>(i, j) = dense.block<3, 3>(i, j);
      }
    }
    const VectorXd r = test::Random(35).vector(3 * body.nodes.size());
    body.toWide(r, matrix.residual());
    const double norm = matrix.lower(nullptr);
    const VectorXd expected = lower.partialPivLu().solve(r);
    EXPECT_LT((body.fromWide(matrix.residual()) - expected).norm(), 15.0 * this->kEpsilon * expected.norm());
    EXPECT_NEAR(norm / expected.dot(diagonal * expected), 1.0, 10.0 * this->kEpsilon);
  });
}

TYPED_TEST(BlockMatrixOf, HasTheSameBitsOnAnyThreads) {
  const TetMesh cage = largeCage();
  const AssembledBody<TypeParam> fresh(cage);
  const VectorXd x = test::Random(36).vector(3 * cage.nodeCount());
  const auto everything = [&](ParallelFor* threads) {
    AssembledBody<TypeParam> body = fresh;  // with rotations that have not been turned along
    BlockMatrix<TypeParam>& matrix = body.matrix;
    body.assemble(threads);
    VectorXd results = body.times(x, threads);
    const auto append = [&](const VectorXd& more) {
      results.conservativeResize(results.size() + more.size());
      results.tail(more.size()) = more;
    };
    body.toWide(x, matrix.residual());
    body.toWide(x, matrix.solution());
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
    test::ShuffledThreads threads(count);
    EXPECT_EQ(everything(&threads), expected);
    EXPECT_GT(threads.mostTasks, 8u);
    EXPECT_GT(threads.runs, 20) << "colours have tasks to share out";
  }
}

}  // namespace
}  // namespace tetskin
