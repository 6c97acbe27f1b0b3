// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A matrix to which blocks of two nodes are added, compared with the same matrix assembled densely.
#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <set>
#include <utility>

#include "gradient_fixtures.h"

namespace tetskin::test {
namespace {

/// A point in a tet that resists its motion, as a contact point does: sum w_i w_j H.
struct PointRow {
  std::size_t tet = 0;
  std::array<double, 4> weights{};
  Matrix3d stiffness;
};

/// The first two points are in one tet, the third in another one that may share nodes; one of them is stiff only along
/// its normal.
std::vector<PointRow> rows() {
  const Vector3d n = Vector3d(1, 2, -0.5).normalized();
  const Matrix3d along = n * n.transpose();
  return {{2, {0.1, 0.2, 0.3, 0.4}, 200.0 * along},
          {2, {0.7, 0.1, 0.3, -0.1}, 30.0 * Matrix3d::Identity() + 200.0 * along},
          {7, {0.25, 0.25, 0.25, 0.25}, 50.0 * Matrix3d::Identity()}};
}

template <class S>
std::array<S, 6> blockOf(const Matrix3d& m, double factor) {
  const double entries[6] = {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
  std::array<S, 6> block;
  for (std::size_t k = 0; k < 6; ++k) block[k] = static_cast<S>(factor * entries[k]);
  return block;
}

/// Adds a point's resistance, and returns what was added: nothing for pinned nodes.
template <class S>
MatrixXd add(const PointRow& row, AssembledBody<S>& body) {
  const auto size = static_cast<Eigen::Index>(3 * body.nodes.size());
  MatrixXd added = MatrixXd::Zero(size, size);
  const Tet& tet = body.cage.tets[row.tet];
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j <= i; ++j) {
      const auto a = static_cast<std::size_t>(tet[i]), b = static_cast<std::size_t>(tet[j]);
      const double factor = row.weights[static_cast<std::size_t>(i)] * row.weights[static_cast<std::size_t>(j)];
      const auto block = blockOf<S>(row.stiffness, factor);
      if (i == j) {
        body.matrix.resist(a, block.data());
      } else {
        body.matrix.couple(body.matrix.couplingOf(a, b).value(), block.data());
        body.matrix.applyCouplings();
      }
      if (body.masses[a] == 0.0 || body.masses[b] == 0.0) continue;
      added.block<3, 3>(3 * tet[i], 3 * tet[j]) += factor * row.stiffness;
      if (i != j) added.block<3, 3>(3 * tet[j], 3 * tet[i]) += factor * row.stiffness;
    }
  }
  return added;
}

template <class S>
MatrixXd addAll(AssembledBody<S>& body) {
  const auto size = static_cast<Eigen::Index>(3 * body.nodes.size());
  MatrixXd sum = MatrixXd::Zero(size, size);
  for (const PointRow& row : rows()) sum += add(row, body);
  return sum;
}

template <class S>
class CoupledNodesOf : public WithScalar<S> {};
TYPED_TEST_SUITE(CoupledNodesOf, Scalars);

TYPED_TEST(CoupledNodesOf, HaveTheirBlocksInProductsAndInBothRows) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(smallCage());
    const MatrixXd expected = body.dense() + addAll(body);
    const MatrixXd a = columnsOf(body);
    const double size = expected.cwiseAbs().maxCoeff();
    EXPECT_LT((a - expected).cwiseAbs().maxCoeff(), 15.0 * this->kEpsilon * size);
    EXPECT_LT((a - a.transpose()).cwiseAbs().maxCoeff(), 2.0 * this->kEpsilon * size);
  });
}

TYPED_TEST(CoupledNodesOf, AreAsBeforeToTheBitOnceFree) {
  AssembledBody<TypeParam> body(smallCage());
  const MatrixXd before = columnsOf(body);
  for (int k = 0; k < 2; ++k) {
    const MatrixXd added = addAll(body);
    EXPECT_GT((columnsOf(body) - before).norm(), 0.5 * added.norm());
    body.matrix.free();
    EXPECT_EQ(columnsOf(body), before);
  }
}

TYPED_TEST(CoupledNodesOf, AreForgottenByTheNextAssembly) {
  AssembledBody<TypeParam> body(smallCage()), alike(smallCage());
  addAll(body);
  body.assemble();
  alike.assemble();
  EXPECT_EQ(columnsOf(body), columnsOf(alike));
  body.matrix.free();
  EXPECT_EQ(columnsOf(body), columnsOf(alike));
}

TYPED_TEST(CoupledNodesOf, HaveATetInCommonOrAreRefused) {
  AssembledBody<TypeParam> body(smallCage());
  std::set<std::pair<int, int>> edges;
  for (const Tet& tet : body.cage.tets) {
    for (const int a : tet) {
      for (const int b : tet) {
        if (a != b) edges.emplace(a, b);
      }
    }
  }
  const int count = static_cast<int>(body.nodes.size());
  ASSERT_LT(edges.size(), static_cast<std::size_t>(count * (count - 1)));
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b < count; ++b) {
      const auto pair = body.matrix.couplingOf(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
      EXPECT_EQ(pair.has_value(), edges.count({a, b}) > 0) << a << " " << b;
    }
  }
}

TYPED_TEST(CoupledNodesOf, AreNotCoupledToHeldOnes) {
  AssembledBody<TypeParam> body(smallCage());
  const Tet& tet = body.cage.tets[rows()[0].tet];
  body.hold(static_cast<std::size_t>(tet[1]));
  body.assemble();
  const MatrixXd expected = body.dense() + addAll(body);
  EXPECT_LT((columnsOf(body) - expected).cwiseAbs().maxCoeff(), 15.0 * this->kEpsilon * expected.cwiseAbs().maxCoeff());
}

TEST(CoupledNodes, AreSolvedForByTheConjugateGradient) {
  onEachInstructionSet([&] {
    for (const double stiffer : {1.0, 1e3}) {
      AssembledBody<double> body(smallCage());
      MatrixXd a = body.dense();
      for (PointRow row : rows()) {
        row.stiffness *= stiffer;
        a += add(row, body);
      }
      const VectorXd b = rightSide(body);
      begin(body, a, b, rightSide(body, 42));
      Solver solver;
      solver.start({&body.matrix}, closely(), nullptr, nullptr);
      EXPECT_TRUE(solver.iterate(500, nullptr));
      EXPECT_LT(apart(solutionOf(body), solved(a, b)), kClose * std::sqrt(stiffer));
      // The sweeps include these blocks: stiff rows within a tet cost hardly any iterations.
      EXPECT_LT(solver.iterations(), 80) << stiffer;
    }
  });
}

}  // namespace
}  // namespace tetskin::test
