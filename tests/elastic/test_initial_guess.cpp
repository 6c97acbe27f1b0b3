// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The initial guess of a solve, from previous solves.
#include <tetskin/elastic/src/dynamics/initial_guess.h>

#include <limits>

#include "gradient_fixtures.h"

namespace tetskin::test {
namespace {

constexpr int kManyIterations = 100;

/// A body with two pinned nodes, a linear system, and solutions of previous steps.
struct HeldBody {
  HeldBody() : body(smallCage()) {
    for (const std::size_t n : {std::size_t{2}, std::size_t{9}}) body.hold(n);
    body.assemble();
    a = body.dense();
    const auto size = static_cast<std::size_t>(a.rows());
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      if (body.masses[n] == 0.0) continue;
      for (std::size_t k = 0; k < 3; ++k) unknowns.push_back(static_cast<int>(3 * n + k));
    }
    b = Random(41).vector(size);
    start = Random(42).vector(size);
  }

  MatrixXd freeMatrix() const { return a(unknowns, unknowns); }
  /// A vector without the components of pinned nodes.
  VectorXd freePart(const VectorXd& v) const { return v(unknowns); }
  /// The solution with pinned nodes as at the start.
  VectorXd exact() const {
    const VectorXd correction = solved(freeMatrix(), freePart(b - a * start));
    VectorXd x = start;
    x(unknowns) += correction;
    return x;
  }
  void remember(InitialGuess<double>& guess, const VectorXd& solution) {
    body.toWide(solution, body.matrix.solution());
    guess.remember(body.matrix);
  }
  SolveLimits improve(InitialGuess<double>& guess) {
    begin(body, a, b, start);
    SolveLimits limits = closely();
    guess.improve(body.matrix, limits, nullptr);
    return limits;
  }
  double squaredResidualAtStart() {
    begin(body, a, b, start);
    return body.matrix.squaredNorm(body.matrix.residual(), nullptr);
  }
  double errorOf(const VectorXd& x) const {
    const VectorXd e = freePart(x - exact());
    return e.dot(freeMatrix() * e);
  }

  AssembledBody<double> body;
  std::vector<int> unknowns;
  MatrixXd a;
  VectorXd b, start;
};

/// One that is used.
InitialGuess<double> usedGuess() {
  InitialGuess<double> guess;
  guess.learn(1.0, 1.0, kManyIterations);
  EXPECT_TRUE(guess.isUsed());
  return guess;
}

TEST(InitialGuess, HasTheLeastErrorOfTheCombinationsOfEarlierSolutions) {
  onEachInstructionSet([&] {
    HeldBody held;
    const VectorXd older = Random(43).vector(held.b.size()), last = Random(44).vector(held.b.size());
    for (const bool both : {false, true}) {
      InitialGuess<double> guess = usedGuess();
      if (both) held.remember(guess, older);
      held.remember(guess, last);
      (void)held.improve(guess);
      const VectorXd found = solutionOf(held.body);
      MatrixXd directions(held.unknowns.size(), both ? 3 : 2);
      directions.col(0) = held.freePart(held.start - last);
      directions.col(1) = held.freePart(last);
      if (both) directions.col(2) = held.freePart(older);
      const MatrixXd products = directions.transpose() * held.freeMatrix() * directions;
      const VectorXd rest = held.freePart(held.b - held.a * held.start);
      VectorXd expected = held.start;
      expected(held.unknowns) += directions * solved(products, directions.transpose() * rest);
      EXPECT_LT(apart(found, expected), 1e-10);
      EXPECT_LT(held.errorOf(found), 0.99 * held.errorOf(held.start));
      const VectorXd residual = held.freePart(held.b - held.a * found);
      EXPECT_LT(apart(held.freePart(held.body.fromWide(held.body.matrix.residual())), residual), 1e-10);
      for (const int pinned : {2, 9}) {
        EXPECT_EQ(found.segment<3>(3 * pinned), held.start.segment<3>(3 * pinned));
      }
    }
  });
}

TEST(InitialGuess, IsTheSolutionWhereItIsThatOfTheStepBefore) {
  HeldBody held;
  InitialGuess<double> guess = usedGuess();
  for (int k = 0; k < 2; ++k) held.remember(guess, held.exact());
  const SolveLimits limits = held.improve(guess);
  EXPECT_LT(apart(solutionOf(held.body), held.exact()), 1e-12);
  Solver solver;
  solver.start({&held.body.matrix}, limits, nullptr, nullptr);
  EXPECT_LT(solver.squaredResidual(), 1e-20 * held.squaredResidualAtStart());
}

/// Three solutions on a line, as of a body that accelerates steadily.
TEST(InitialGuess, ExtrapolatesSteadyMotion) {
  HeldBody held;
  InitialGuess<double> guess = usedGuess();
  VectorXd change = Random(45).vector(held.b.size());
  for (const int pinned : {2, 9}) change.segment<3>(3 * pinned).setZero();
  held.remember(guess, held.exact() - 2.0 * change);
  held.remember(guess, held.exact() - change);
  (void)held.improve(guess);
  EXPECT_LT(apart(solutionOf(held.body), held.exact()), 1e-10);
}

TEST(InitialGuess, WhatItLeavesIsReducedBesideTheTolerance) {
  HeldBody held;
  InitialGuess<double> guess = usedGuess();
  held.remember(guess, held.exact() + 1e-3 * held.start);
  const SolveLimits limits = held.improve(guess);
  EXPECT_LT(limits.reduction, 1.0);
  Solver with;
  with.start({&held.body.matrix}, limits, nullptr, nullptr);
  EXPECT_LT(with.squaredResidual(), 1e-2 * held.squaredResidualAtStart());
}

TEST(InitialGuess, ChangesNothingBeforeItKnowsASolution) {
  HeldBody held;
  InitialGuess<double> used = usedGuess(), unused;
  held.remember(unused, held.exact());
  for (InitialGuess<double>* guess : {&used, &unused}) {
    const SolveLimits limits = held.improve(*guess);
    EXPECT_EQ(limits.reduction, 1.0);
    EXPECT_EQ(solutionOf(held.body), held.start);
  }
}

TEST(InitialGuess, KeepsTheStartWhereSolutionsAreNotFinite) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    HeldBody held;
    InitialGuess<double> guess = usedGuess();
    VectorXd solution = held.exact();
    solution[3] = bad;
    for (int k = 0; k < 2; ++k) held.remember(guess, solution);
    (void)held.improve(guess);
    EXPECT_EQ(solutionOf(held.body), held.start) << bad;
    EXPECT_EQ(held.freePart(held.body.fromWide(held.body.matrix.residual())),
              held.freePart(held.b - held.a * held.start));
  }
}

TEST(InitialGuess, IsUsedWhereSolvesTakeManyIterationsAndItSavesSome) {
  HeldBody held;
  InitialGuess<double> guess;
  guess.learn(1.0, 1.0, 7);
  EXPECT_FALSE(guess.isUsed());
  guess.learn(1.0, 1.0, 8);
  EXPECT_TRUE(guess.isUsed());
  const auto solves = [&](double share) {
    held.remember(guess, held.start);
    (void)held.improve(guess);
    guess.learn(share * share, 1.0, kManyIterations);
  };
  for (int k = 0; k < 100; ++k) solves(k % 8 == 0 ? 0.2 : 0.9);
  EXPECT_TRUE(guess.isUsed()) << "one in eight has saved something";
  for (int k = 0; k < 8; ++k) solves(0.9);
  EXPECT_FALSE(guess.isUsed());
  int solvesWithout = 0;
  for (; !guess.isUsed(); ++solvesWithout) {
    ASSERT_LT(solvesWithout, 1000);
    guess.learn(1.0, 1.0, kManyIterations);
  }
  EXPECT_GT(solvesWithout, 50) << "it is tried again, but not at once";
  for (int k = 0; k < 7; ++k) solves(0.9);
  EXPECT_TRUE(guess.isUsed()) << "as often as before";
}

}  // namespace
}  // namespace tetskin::test
