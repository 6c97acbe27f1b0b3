// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The conjugate gradient method for one free body: its result, and when it stops.

#include <utility>

#include "gradient_fixtures.h"
#include "support/shuffled_threads.h"

namespace tetskin::test {
namespace {

TEST(ConjugateGradient, SolvesAsADenseSolverDoes) {
  onEachInstructionSet([&] {
    AssembledBody<double> body(smallCage());
    const MatrixXd a = body.dense();
    const VectorXd b = rightSide(body);
    for (const VectorXd& from : {VectorXd(VectorXd::Zero(b.size())), rightSide(body, 42)}) {
      begin(body, a, b, from);
      Solver solver;
      solver.start({&body.matrix}, closely(), nullptr, nullptr);
      EXPECT_FALSE(solver.converged());
      EXPECT_TRUE(solver.iterate(500, nullptr));
      EXPECT_LT(apart(solutionOf(body), solved(a, b)), kClose);
      EXPECT_GT(solver.iterations(), 5);
      EXPECT_LT(solver.iterations(), 60);
    }
  });
}

TEST(ConjugateGradient, SolvesInFloatAsFarAsThatReaches) {
  onEachInstructionSet([&] {
    AssembledBody<float> body(smallCage());
    const MatrixXd a = body.dense();
    const VectorXd b = Random(41).vector(3 * body.nodes.size());
    begin(body, a, b, VectorXd::Zero(b.size()));
    ConjugateGradient<float> solver;
    SolveLimits limits = closely();
    limits.tolerance = 1e-5;
    solver.start({&body.matrix}, limits, nullptr, nullptr);
    EXPECT_TRUE(solver.iterate(500, nullptr));
    EXPECT_LT(apart(solutionOf(body), solved(a, b)), 2e-5);
  });
}

TEST(ConjugateGradient, ComesNearerWithEveryIteration) {
  onEachInstructionSet([&] {
    AssembledBody<double> body(smallCage(), 0.1, 100.0);
    const MatrixXd a = body.dense();
    const VectorXd b = rightSide(body), right = solved(a, b);
    begin(body, a, b, VectorXd::Zero(b.size()));
    Solver solver;
    solver.start({&body.matrix}, closely(), nullptr, nullptr);
    // The method minimizes the error in the norm of the matrix.
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
  const auto solved = [&](std::vector<int> components) {
    begin(body, a, b, VectorXd::Zero(b.size()));
    Solver solver;
    solver.start({&body.matrix}, closely(), nullptr, nullptr);
    for (const int component : components) solver.iterate(component, nullptr);
    EXPECT_EQ(solver.iterations(), 9);
    return solutionOf(body);
  };
  const VectorXd once = solved({9});
  EXPECT_EQ(solved({5, 4}), once);
  EXPECT_EQ(solved({1, 0, 1, 7}), once);
}

TEST(ConjugateGradient, StopsAtWhatIsEnough) {
  AssembledBody<double> body(smallCage());
  const MatrixXd a = body.dense();
  const VectorXd b = rightSide(body);
  const auto iterationsWith = [&](const SolveLimits& limits) {
    begin(body, a, b, VectorXd::Zero(b.size()));
    Solver solver;
    solver.start({&body.matrix}, limits, nullptr, nullptr);
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
  limits.enough = 1e6;  // larger than any residual here
  EXPECT_EQ(iterationsWith(limits), std::make_pair(0, true));

  // A start whose residual is a hundredth of the one that the tolerance relates to.
  limits = closely();
  limits.tolerance = 1e-4;
  const int all = iterationsWith(limits).first;
  begin(body, a, b, VectorXd::Zero(b.size()));
  limits.tolerance = 1e-2;
  limits.acting = 1e-4 * body.matrix.squaredNorm(body.matrix.residual(), nullptr);
  EXPECT_EQ(iterationsWith(limits), std::make_pair(all, true));
  limits.reduction = 1e-6;
  EXPECT_GT(iterationsWith(limits).first, all) << "whichever is less";
  limits.enough = 1e6;
  EXPECT_EQ(iterationsWith(limits), std::make_pair(0, true));

  // Here the limit is the square of a residual, as the solver reports it.
  begin(body, a, b, VectorXd::Zero(b.size()));
  Solver solver;
  solver.start({&body.matrix}, closely(), nullptr, nullptr);
  limits = closely();
  limits.tolerance = 0.0;
  limits.enough = solver.enough();
  EXPECT_EQ(iterationsWith(limits), close);
}

TEST(ConjugateGradient, ThereIsNothingToDoWithoutResidual) {
  AssembledBody<double> body(smallCage());
  const VectorXd x = rightSide(body);
  body.toWide(x, body.matrix.solution());
  std::fill_n(body.matrix.residual(), body.matrix.wideSize(), 0.0);
  SolveLimits limits;
  limits.tolerance = 0.0;
  Solver solver;
  solver.start({&body.matrix}, limits, nullptr, nullptr);
  EXPECT_TRUE(solver.iterate(100, nullptr));
  EXPECT_EQ(solver.iterations(), 0);
  EXPECT_EQ(solutionOf(body), x);
}

}  // namespace
}  // namespace tetskin::test
