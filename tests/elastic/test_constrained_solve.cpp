// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The conjugate gradient method with nodes that are pinned, fixed or resisted.

#include <utility>

#include "gradient_fixtures.h"

namespace tetskin::test {
namespace {

/// The solution of a x = b in the span of `basisOfTheFree`; all other components keep their values from the start.
VectorXd solveWithin(const MatrixXd& a, const VectorXd& b, const VectorXd& start, const MatrixXd& basisOfTheFree) {
  const MatrixXd& z = basisOfTheFree;
  return start + z * solved(z.transpose() * a * z, z.transpose() * (b - a * start));
}

/// A basis of the free directions, in columns, from the fixed directions by node.
MatrixXd freeBasis(std::size_t nodes, const std::vector<std::pair<std::size_t, Vector3d>>& fixed) {
  const auto size = static_cast<Eigen::Index>(3 * nodes);
  MatrixXd projection = MatrixXd::Identity(size, size);
  for (const auto& [node, n] : fixed) {
    const auto at = static_cast<Eigen::Index>(3 * node);
    projection.block<3, 3>(at, at) -= n * n.transpose();
  }
  return spectrumOf(projection, VectorXd::Ones(size)).vectors.rightCols(size - static_cast<Eigen::Index>(fixed.size()));
}

TEST(ConjugateGradient, HeldNodesStayAsTheyWereAtTheStart) {
  onEachInstructionSet([&] {
    AssembledBody<double> body(smallCage());
    std::vector<std::pair<std::size_t, Vector3d>> fixed;
    for (const std::size_t node : {0u, 4u, 7u}) {
      body.hold(node);
      for (int k = 0; k < 3; ++k) fixed.emplace_back(node, Vector3d::Unit(k));
    }
    body.assemble();
    const MatrixXd a = body.dense();
    const VectorXd b = rightSide(body), from = rightSide(body, 42);
    const VectorXd x = solvedFrom(from, body, a, b);
    for (const std::size_t node : {0u, 4u, 7u}) {
      EXPECT_EQ(x.segment<3>(static_cast<Eigen::Index>(3 * node)),
                from.segment<3>(static_cast<Eigen::Index>(3 * node)));
    }
    EXPECT_LT(apart(x, solveWithin(a, b, from, freeBasis(body.nodes.size(), fixed))), kClose);
  });
}

TEST(ConjugateGradient, FixedDirectionsStayAsTheyWereAtTheStart) {
  onEachInstructionSet([&] {
    AssembledBody<double> body(smallCage());
    const Vector3d n = Vector3d(1, -2, 2) / 3.0, m = Vector3d(2, 3, -6) / 7.0;
    const Vector3d across = n.unitOrthogonal(), rest = n.cross(across);
    body.matrix.fixAlong(2, n.data());
    body.matrix.fixAlong(3, m.data());  // a neighbour of the other fixed node
    body.matrix.fixAllBut(9, n.data());
    body.matrix.fix(12);
    const std::vector<std::pair<std::size_t, Vector3d>> fixed{{2, n},
                                                              {3, m},
                                                              {9, across},
                                                              {9, rest},
                                                              {12, Vector3d::UnitX()},
                                                              {12, Vector3d::UnitY()},
                                                              {12, Vector3d::UnitZ()}};
    const MatrixXd a = body.dense();
    const VectorXd b = rightSide(body), from = rightSide(body, 42);
    const VectorXd x = solvedFrom(from, body, a, b);
    for (const auto& [node, direction] : fixed) {
      const auto at = static_cast<Eigen::Index>(3 * node);
      EXPECT_NEAR(direction.dot(x.segment<3>(at)), direction.dot(from.segment<3>(at)), 1e-13);
    }
    EXPECT_LT(apart(x, solveWithin(a, b, from, freeBasis(body.nodes.size(), fixed))), kClose);
  });
}

TEST(ConjugateGradient, ResistanceIsPartOfTheMatrix) {
  onEachInstructionSet([&] {
    AssembledBody<double> body(smallCage());
    const Vector3d n = Vector3d(1, -2, 2) / 3.0;
    const Eigen::Matrix3d plane = 20.0 * (Eigen::Matrix3d::Identity() - n * n.transpose());
    const double block[6] = {plane(0, 0), plane(0, 1), plane(0, 2), plane(1, 1), plane(1, 2), plane(2, 2)};
    body.matrix.resist(6, block);
    MatrixXd a = body.dense();
    a.block<3, 3>(18, 18) += plane;
    const VectorXd b = rightSide(body);
    EXPECT_LT(apart(solvedFrom(VectorXd::Zero(b.size()), body, a, b), solved(a, b)), kClose);
  });
}

}  // namespace
}  // namespace tetskin::test
