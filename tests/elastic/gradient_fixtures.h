// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Systems of equations for the tests of the conjugate gradient method.
#pragma once

#include <tetskin/elastic/src/dynamics/conjugate_gradient.h>

#include "elastic_fixtures.h"
#include "support/odd_meshes.h"

namespace tetskin::test {

using Solver = ConjugateGradient<double>;

inline TetMesh smallCage() {
  return jittered(latticeCage(3, 2, 2), 0.15, 3);
}

inline SolveLimits closely() {
  SolveLimits limits;
  limits.tolerance = 1e-10;
  limits.iterations = 500;
  return limits;
}

template <class S>
Eigen::VectorXd solutionOf(const AssembledBody<S>& body) {
  return body.fromWide(body.matrix.solution());
}

/// Sets the solver's input: a start, and its residual.
template <class S>
void begin(AssembledBody<S>& body, const Eigen::MatrixXd& a, const Eigen::VectorXd& b, const Eigen::VectorXd& start) {
  body.toWide(start, body.matrix.solution());
  body.toWide(b - a * start, body.matrix.residual());
}

inline Eigen::VectorXd rightSide(const AssembledBody<double>& body, unsigned seed = 41) {
  return Random(seed).vector(3 * body.nodes.size());
}

/// The solver's result from this start.
inline VectorXd solvedFrom(const VectorXd& start, AssembledBody<double>& body, const MatrixXd& a, const VectorXd& b) {
  begin(body, a, b, start);
  Solver solver;
  solver.start({&body.matrix}, closely(), nullptr, nullptr);
  EXPECT_TRUE(solver.iterate(500, nullptr));
  return solutionOf(body);
}

inline double apart(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).norm() / b.norm();
}

/// Allowed error for a tolerance of 1e-10 in the norm of the preconditioner.
constexpr double kClose = 1e-8;

}  // namespace tetskin::test
