// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The diagonal blocks of a matrix, and nodes whose blocks are pinned, fixed or resisted.
#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <Eigen/LU>

#include "elastic_fixtures.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

using kernels::kGroup;

TetMesh flatCage() {
  return jittered(latticeCage(3, 2, 1), 0.15, 3);
}

template <class S>
class FixedNodesOf : public WithScalar<S> {};
TYPED_TEST_SUITE(FixedNodesOf, Scalars);

template <class S>
Matrix3d symmetric(const S (&m)[6]) {
  Matrix3d result;
  result << m[0], m[1], m[2], m[1], m[3], m[4], m[2], m[4], m[5];
  return result;
}

template <class S>
Matrix3d diagonalOf(const BlockMatrix<S>& matrix, std::size_t node) {
  S m[6];
  matrix.diagonal(node, m);
  return symmetric(m);
}

template <class S>
Matrix3d freeInverseOf(const BlockMatrix<S>& matrix, std::size_t node) {
  S m[6];
  matrix.freeInverse(node, m);
  return symmetric(m);
}

/// The inverse of a node's block as used by the sweeps: their result for a residual that is 0 at all other nodes.
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

TYPED_TEST(FixedNodesOf, KnowsTheInversesOfItsDiagonal) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(flatCage());
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

TYPED_TEST(FixedNodesOf, AFixedNodeMovesOnlyWhereItMay) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(flatCage());
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

/// factor (1 - n n^T)
template <class S>
std::array<S, 6> across(const Vector3d& n, double factor) {
  const Matrix3d plane = factor * (Matrix3d::Identity() - n * n.transpose());
  std::array<S, 6> block;
  std::size_t k = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) block[k++] = static_cast<S>(plane(i, j));
  }
  return block;
}

TYPED_TEST(FixedNodesOf, ResistsAcrossANormalUntilItIsFree) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(flatCage());
    BlockMatrix<TypeParam>& matrix = body.matrix;
    const Vector3d n = Vector3d(2, 3, -6) / 7.0;
    const TypeParam normal[3] = {static_cast<TypeParam>(n[0]), static_cast<TypeParam>(n[1]),
                                 static_cast<TypeParam>(n[2])};
    const Matrix3d plane = Matrix3d::Identity() - n * n.transpose();
    for (const std::size_t node : {0u, 5u, 9u}) {
      const Matrix3d before = diagonalOf(matrix, node), free = freeInverseOf(matrix, node);
      matrix.resist(node, across<TypeParam>(n, 7.0).data());
      const Matrix3d expected = before + 7.0 * plane;
      EXPECT_LT((diagonalOf(matrix, node) - expected).norm(), 10.0 * this->kEpsilon * expected.norm());
      EXPECT_LT((inverseInUse(matrix, node) * expected - Matrix3d::Identity()).norm(), 30.0 * this->kEpsilon);
      EXPECT_EQ(freeInverseOf(matrix, node), free);
      const VectorXd along =
          VectorXd::Unit(static_cast<Eigen::Index>(3 * body.nodes.size()), static_cast<Eigen::Index>(3 * node));
      const VectorXd column = body.times(along);
      const Vector3d row = column.segment<3>(static_cast<Eigen::Index>(3 * node));
      EXPECT_LT((row - expected.col(0)).norm(), 10.0 * this->kEpsilon * expected.norm());

      matrix.fixAlong(node, normal);  // together with the resistance
      EXPECT_LT((plane * expected * inverseInUse(matrix, node) - plane).norm(), 30.0 * this->kEpsilon);

      matrix.free();
      EXPECT_EQ(diagonalOf(matrix, node), before);
      EXPECT_EQ(inverseInUse(matrix, node), free);
    }
  });
}

TYPED_TEST(FixedNodesOf, AHeldNodeStaysHeld) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(flatCage());
    body.hold(5);
    body.assemble();
    BlockMatrix<TypeParam>& matrix = body.matrix;
    const Matrix3d block = diagonalOf(matrix, 5);
    const TypeParam normal[3] = {0, 1, 0};
    matrix.fixAlong(5, normal);
    EXPECT_EQ(inverseInUse(matrix, 5), Matrix3d::Zero());
    matrix.fixAllBut(5, normal);
    EXPECT_EQ(inverseInUse(matrix, 5), Matrix3d::Zero());
    matrix.resist(5, across<TypeParam>(Vector3d::UnitY(), 3.0).data());
    EXPECT_EQ(inverseInUse(matrix, 5), Matrix3d::Zero());
    EXPECT_EQ(diagonalOf(matrix, 5), block);
    matrix.free();
    EXPECT_EQ(inverseInUse(matrix, 5), Matrix3d::Zero());
    // The node is free again from the next assembly on.
    body.masses[5] = 1.0;
    body.assemble();
    EXPECT_GT(inverseInUse(matrix, 5).determinant(), 0.0);
  });
}

}  // namespace
}  // namespace tetskin::test
