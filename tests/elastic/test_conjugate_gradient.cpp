// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/elastic/src/dynamics/conjugate_gradient.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <limits>

#include "elastic_fixtures.h"
#include "support/odd_meshes.h"
#include "support/shuffled_threads.h"

namespace tetskin {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using elastic_detail::BlockMatrix;
using elastic_detail::ConjugateGradient;
using elastic_detail::SolveLimits;
using kernels::kGroup;
using test::AssembledBody;
using test::onEachInstructionSet;

using Solver = ConjugateGradient<double>;

TetMesh smallCage() {
  return test::jittered(test::latticeCage(3, 2, 2), 0.15, 3);
}

SolveLimits closely() {
  SolveLimits limits;
  limits.tolerance = 1e-10;
  limits.iterations = 500;
  return limits;
}

template <class S>
VectorXd solutionOf(const AssembledBody<S>& body) {
  return body.fromWide(body.matrix.solution());
}

/// As the protocol wants it: a start, and the residual that it leaves.
template <class S>
void begin(AssembledBody<S>& body, const MatrixXd& a, const VectorXd& b, const VectorXd& start) {
  body.toWide(start, body.matrix.solution());
  body.toWide(b - a * start, body.matrix.residual());
}

VectorXd rightSide(const AssembledBody<double>& body, unsigned seed = 41) {
  return test::Random(seed).vector(3 * body.nodes.size());
}

double apart(const VectorXd& a, const VectorXd& b) {
  return (a - b).norm() / b.norm();
}

/// For a tolerance of 1e-10 in the norm of the preconditioner.
constexpr double kClose = 1e-8;

TEST(ConjugateGradient, SolvesAsADenseSolverDoes) {
  onEachInstructionSet([&] {
    AssembledBody<double> body(smallCage());
    const MatrixXd a = body.dense();
    const VectorXd b = rightSide(body);
    for (const VectorXd& from : {VectorXd(VectorXd::Zero(b.size())), rightSide(body, 42)}) {
      begin(body, a, b, from);
      Solver solver;
      solver.start({&body.matrix}, closely(), {}, nullptr);
      EXPECT_FALSE(solver.converged());
      EXPECT_TRUE(solver.iterate(500, nullptr));
      EXPECT_LT(apart(solutionOf(body), a.ldlt().solve(b)), kClose);
      EXPECT_GT(solver.iterations(), 5);
      EXPECT_LT(solver.iterations(), 60);
    }
  });
}

TEST(ConjugateGradient, SolvesInFloatAsFarAsThatReaches) {
  onEachInstructionSet([&] {
    AssembledBody<float> body(smallCage());
    const MatrixXd a = body.dense();
    const VectorXd b = test::Random(41).vector(3 * body.nodes.size());
    begin(body, a, b, VectorXd::Zero(b.size()));
    ConjugateGradient<float> solver;
    SolveLimits limits = closely();
    limits.tolerance = 1e-5;
    solver.start({&body.matrix}, limits, {}, nullptr);
    EXPECT_TRUE(solver.iterate(500, nullptr));
    EXPECT_LT(apart(solutionOf(body), a.ldlt().solve(b)), 2e-5);
  });
}

/// The solution of a x = b whose `fixed` components (columns of a basis) stay as they are at the start.
VectorXd solveWithin(const MatrixXd& a, const VectorXd& b, const VectorXd& start, const MatrixXd& basisOfTheFree) {
  const MatrixXd& z = basisOfTheFree;
  return start + z * (z.transpose() * a * z).ldlt().solve(z.transpose() * (b - a * start));
}

/// Columns: what is left free, from directions by node that are not.
MatrixXd freeBasis(std::size_t nodes, const std::vector<std::pair<std::size_t, Vector3d>>& fixed) {
  const auto size = static_cast<Eigen::Index>(3 * nodes);
  MatrixXd projection = MatrixXd::Identity(size, size);
  for (const auto& [node, n] : fixed) {
    const auto at = static_cast<Eigen::Index>(3 * node);
    projection.block<3, 3>(at, at) -= n * n.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> split(projection);
  return split.eigenvectors().rightCols(size - static_cast<Eigen::Index>(fixed.size()));
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
    begin(body, a, b, from);
    Solver solver;
    solver.start({&body.matrix}, closely(), {}, nullptr);
    EXPECT_TRUE(solver.iterate(500, nullptr));
    const VectorXd x = solutionOf(body);
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
    body.matrix.fixAlong(3, m.data());  // neighbours, one with the other
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
    begin(body, a, b, from);
    Solver solver;
    solver.start({&body.matrix}, closely(), {}, nullptr);
    EXPECT_TRUE(solver.iterate(500, nullptr));
    const VectorXd x = solutionOf(body);
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
    body.matrix.resistAcross(6, n.data(), 20.0);
    MatrixXd a = body.dense();
    a.block<3, 3>(18, 18) += 20.0 * (Eigen::Matrix3d::Identity() - n * n.transpose());
    const VectorXd b = rightSide(body);
    begin(body, a, b, VectorXd::Zero(b.size()));
    Solver solver;
    solver.start({&body.matrix}, closely(), {}, nullptr);
    EXPECT_TRUE(solver.iterate(500, nullptr));
    EXPECT_LT(apart(solutionOf(body), a.ldlt().solve(b)), kClose);
  });
}

/// A matrix of springs added to that of some bodies, of which the unknowns stand one after the other.
class Springs {
 public:
  Springs(std::vector<AssembledBody<double>*> bodies, MatrixXd springs)
      : bodies_(std::move(bodies)), springs_(std::move(springs)) {
    for (const AssembledBody<double>* body : bodies_) added_.emplace_back(body->matrix.wideSize(), 0.0);
  }

  Solver::Extra extra() {
    return [this](std::vector<const double*>& out) {
      ++calls;
      VectorXd step(springs_.cols());
      Eigen::Index at = 0;
      for (const AssembledBody<double>* body : bodies_) {
        for (std::size_t n = 0; n < body->nodes.size(); ++n, at += 3) {
          const double* p = body->matrix.stepPoints() + 4 * body->matrix.slotOf(n);
          step.segment<3>(at) = Vector3d(p[0], p[1], p[2]);
        }
      }
      const VectorXd image = springs_ * step;
      at = 0;
      for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const auto size = static_cast<Eigen::Index>(3 * bodies_[k]->nodes.size());
        bodies_[k]->toWide(image.segment(at, size), added_[k].data());
        out[k] = added_[k].data();
        at += size;
      }
    };
  }

  int calls = 0;

 private:
  std::vector<AssembledBody<double>*> bodies_;
  MatrixXd springs_;
  std::vector<std::vector<double>> added_;
};

TEST(ConjugateGradient, SolvesWithAnotherOperatorAdded) {
  onEachInstructionSet([&] {
    AssembledBody<double> body(smallCage());
    const VectorXd stiffness = (rightSide(body, 43).array() + 1.0) * 10.0;
    const MatrixXd a = body.dense() + MatrixXd(stiffness.asDiagonal());
    const VectorXd b = rightSide(body), from = rightSide(body, 42);
    Springs springs({&body}, stiffness.asDiagonal());
    begin(body, a, b, from);
    Solver solver;
    solver.start({&body.matrix}, closely(), springs.extra(), nullptr);
    EXPECT_TRUE(solver.iterate(500, nullptr));
    EXPECT_EQ(springs.calls, solver.iterations());
    EXPECT_LT(apart(solutionOf(body), a.ldlt().solve(b)), kClose);
  });
}

TEST(ConjugateGradient, SolvesBodiesThatAreCoupled) {
  onEachInstructionSet([&] {
    AssembledBody<double> first(smallCage()), second(test::bodyCentredCage(1, 2, 1), 0.05, 2.0);
    const auto size = static_cast<Eigen::Index>(3 * first.nodes.size());
    const auto total = size + static_cast<Eigen::Index>(3 * second.nodes.size());
    MatrixXd springs = MatrixXd::Zero(total, total);
    for (int k = 0; k < 9; ++k) {  // from the first nodes of one to those of the other
      const double stiffness = 5.0 + k;
      springs(k, k) += stiffness;
      springs(size + k, size + k) += stiffness;
      springs(k, size + k) -= stiffness;
      springs(size + k, k) -= stiffness;
    }
    MatrixXd a = springs;
    a.topLeftCorner(size, size) += first.dense();
    a.bottomRightCorner(total - size, total - size) += second.dense();
    const VectorXd b = test::Random(44).vector(static_cast<std::size_t>(total));
    for (AssembledBody<double>* body : {&first, &second}) {
      const VectorXd part = body == &first ? b.head(size) : b.tail(total - size);
      body->toWide(VectorXd::Zero(part.size()), body->matrix.solution());
      body->toWide(part, body->matrix.residual());
    }
    Springs between({&first, &second}, springs);
    Solver solver;
    solver.start({&first.matrix, &second.matrix}, closely(), between.extra(), nullptr);
    EXPECT_TRUE(solver.iterate(500, nullptr));
    VectorXd x(total);
    x << solutionOf(first), solutionOf(second);
    EXPECT_LT(apart(x, a.ldlt().solve(b)), kClose);
  });
}

TEST(ConjugateGradient, ComesNearerWithEveryIteration) {
  onEachInstructionSet([&] {
    AssembledBody<double> body(smallCage(), 0.1, 100.0);
    const MatrixXd a = body.dense();
    const VectorXd b = rightSide(body), right = a.ldlt().solve(b);
    begin(body, a, b, VectorXd::Zero(b.size()));
    Solver solver;
    solver.start({&body.matrix}, closely(), {}, nullptr);
    // The error in the norm of the matrix is what conjugate gradients make as small as they can.
    double before = right.dot(a * right);
    for (int k = 1; k <= 20; ++k) {
      solver.iterate(1, nullptr);
      EXPECT_EQ(solver.iterations(), k);
      const VectorXd error = solutionOf(body) - right;
      const double now = error.dot(a * error);
      EXPECT_LT(now, before) << k;
      before = now;
    }
    EXPECT_LT(before, 1e-5 * right.dot(a * right));
  });
}

TEST(ConjugateGradient, GoesOnWhereItStopped) {
  AssembledBody<double> body(smallCage());
  const MatrixXd a = body.dense();
  const VectorXd b = rightSide(body);
  const auto solved = [&](std::vector<int> parts) {
    begin(body, a, b, VectorXd::Zero(b.size()));
    Solver solver;
    solver.start({&body.matrix}, closely(), {}, nullptr);
    for (const int part : parts) solver.iterate(part, nullptr);
    EXPECT_EQ(solver.iterations(), 9);
    return solutionOf(body);
  };
  const VectorXd once = solved({9});
  EXPECT_EQ(solved({5, 4}), once);
  EXPECT_EQ(solved({1, 0, 1, 7}), once);
}

TEST(ConjugateGradient, HasTheSameBitsOnAnyThreads) {
  AssembledBody<float> body(test::latticeCage(12, 12, 12));
  const VectorXd b = test::Random(45).vector(3 * body.nodes.size());
  const auto solved = [&](ParallelFor* threads) {
    body.toWide(VectorXd::Zero(b.size()), body.matrix.solution());
    body.toWide(b, body.matrix.residual());
    ConjugateGradient<float> solver;
    solver.start({&body.matrix}, SolveLimits(), {}, threads);
    EXPECT_TRUE(solver.iterate(200, threads));
    return solutionOf(body);
  };
  const VectorXd alone = solved(nullptr);
  for (const int count : {1, 2}) {
    test::ShuffledThreads threads(count);
    EXPECT_EQ(solved(&threads), alone);
    EXPECT_GT(threads.runs, 20);
  }
}

TEST(ConjugateGradient, StopsAtWhatIsEnough) {
  AssembledBody<double> body(smallCage());
  const MatrixXd a = body.dense();
  const VectorXd b = rightSide(body);
  const auto iterationsWith = [&](const SolveLimits& limits) {
    begin(body, a, b, VectorXd::Zero(b.size()));
    Solver solver;
    solver.start({&body.matrix}, limits, {}, nullptr);
    const bool converged = solver.iterate(1000, nullptr);
    EXPECT_EQ(converged, solver.converged());
    return std::make_pair(solver.iterations(), solver.converged());
  };
  const auto close = iterationsWith(closely());
  EXPECT_TRUE(close.second);
  SolveLimits limits = closely();
  limits.tolerance = 1e-2;
  EXPECT_TRUE(iterationsWith(limits).second);
  EXPECT_LT(iterationsWith(limits).first, close.first);
  limits = closely();
  limits.iterations = 3;
  EXPECT_EQ(iterationsWith(limits), std::make_pair(3, false));
  limits = closely();
  limits.floor = 1e3;  // more than all there is
  EXPECT_EQ(iterationsWith(limits), std::make_pair(0, true));
  limits = closely();
  limits.enough = 1e6;
  EXPECT_EQ(iterationsWith(limits), std::make_pair(0, true));

  // As the square of a residual, of which it is told.
  begin(body, a, b, VectorXd::Zero(b.size()));
  Solver solver;
  solver.start({&body.matrix}, closely(), {}, nullptr);
  limits = closely();
  limits.tolerance = 0.0;
  limits.enough = solver.enough();
  EXPECT_EQ(iterationsWith(limits), close);
}

TEST(ConjugateGradient, AnAdditionThatIsNotPositiveLeavesWhatHasBeenReached) {
  onEachInstructionSet([&] {
    for (const double value :
         {-1e6, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      AssembledBody<double> body(smallCage());
      const MatrixXd a = body.dense();
      const VectorXd b = rightSide(body);
      begin(body, a, b, VectorXd::Zero(b.size()));
      std::vector<double> added(body.matrix.wideSize());
      int calls = 0;
      const auto extra = [&](std::vector<const double*>& out) {
        if (++calls <= 4) return;
        for (std::size_t n = 0; n < body.nodes.size(); ++n) {
          for (std::size_t k = 0; k < 3; ++k) {
            added[body.matrix.wideOf(n) + k * kGroup] = value * body.matrix.stepPoints()[4 * body.matrix.slotOf(n) + k];
          }
        }
        out[0] = added.data();
      };
      Solver solver;
      solver.start({&body.matrix}, closely(), extra, nullptr);
      solver.iterate(4, nullptr);
      const VectorXd reached = solutionOf(body);
      solver.iterate(100, nullptr);
      EXPECT_EQ(calls, 5) << value;
      EXPECT_EQ(solutionOf(body), reached) << value;
      EXPECT_TRUE(reached.allFinite());
    }
  });
}

TEST(ConjugateGradient, ThereIsNothingToDoWithoutResidual) {
  AssembledBody<double> body(smallCage());
  const VectorXd x = rightSide(body);
  body.toWide(x, body.matrix.solution());
  std::fill_n(body.matrix.residual(), body.matrix.wideSize(), 0.0);
  SolveLimits limits;
  limits.tolerance = 0.0;
  Solver solver;
  solver.start({&body.matrix}, limits, {}, nullptr);
  EXPECT_TRUE(solver.iterate(100, nullptr));
  EXPECT_EQ(solver.iterations(), 0);
  EXPECT_EQ(solutionOf(body), x);
}

}  // namespace
}  // namespace tetskin
