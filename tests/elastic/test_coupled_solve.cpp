// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The conjugate gradient method with terms in addition to its matrices, and over several matrices.

#include <limits>
#include <utility>

#include "gradient_fixtures.h"

namespace tetskin::test {
namespace {

using kernels::kGroup;

/// A matrix of springs that is added to those of several bodies, whose unknowns are concatenated.
class Springs : public Solver::CouplingOperator {
 public:
  Springs(std::vector<AssembledBody<double>*> bodies, MatrixXd springs)
      : bodies_(std::move(bodies)), springs_(std::move(springs)) {
    for (const AssembledBody<double>* body : bodies_) {
      starts_.push_back(steps_.size());
      steps_.conservativeResize(steps_.size() + 3 * static_cast<Eigen::Index>(body->nodes.size()));
      added_.emplace_back(body->matrix.wideSize(), 0.0);
    }
  }

  void readPoints(std::size_t k) override {
    Eigen::Index at = starts_[k];
    for (std::size_t n = 0; n < bodies_[k]->nodes.size(); ++n, at += 3) {
      const double* p = bodies_[k]->matrix.stepPoints() + 4 * bodies_[k]->matrix.slotOf(n);
      steps_.segment<3>(at) = Vector3d(p[0], p[1], p[2]);
    }
  }
  void combine() override {
    ++calls;
    image_ = springs_ * steps_;
  }
  const double* apply(std::size_t k) override {
    const auto size = static_cast<Eigen::Index>(3 * bodies_[k]->nodes.size());
    bodies_[k]->toWide(image_.segment(starts_[k], size), added_[k].data());
    return added_[k].data();
  }

  int calls = 0;

 private:
  std::vector<AssembledBody<double>*> bodies_;
  MatrixXd springs_;
  std::vector<Eigen::Index> starts_;  // by body
  VectorXd steps_, image_;
  std::vector<std::vector<double>> added_;
};

/// From the fifth call on, it adds a multiple of the step; nothing before.
class Multiple : public Solver::CouplingOperator {
 public:
  Multiple(const AssembledBody<double>& body, double factor)
      : body_(body), factor_(factor), added_(body.matrix.wideSize()) {}

  void readPoints(std::size_t) override {}
  void combine() override { ++calls; }
  const double* apply(std::size_t) override {
    if (calls <= 4) return nullptr;
    for (std::size_t n = 0; n < body_.nodes.size(); ++n) {
      for (std::size_t k = 0; k < 3; ++k) {
        added_[body_.matrix.wideOf(n) + k * kGroup] =
            factor_ * body_.matrix.stepPoints()[4 * body_.matrix.slotOf(n) + k];
      }
    }
    return added_.data();
  }

  int calls = 0;

 private:
  const AssembledBody<double>& body_;
  double factor_;
  std::vector<double> added_;
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
    solver.start({&body.matrix}, closely(), &springs, nullptr);
    EXPECT_TRUE(solver.iterate(500, nullptr));
    EXPECT_EQ(springs.calls, solver.iterations());
    EXPECT_LT(apart(solutionOf(body), solved(a, b)), kClose);
  });
}

TEST(ConjugateGradient, SolvesBodiesThatAreCoupled) {
  onEachInstructionSet([&] {
    AssembledBody<double> first(smallCage()), second(bodyCentredCage(1, 2, 1), 0.05, 2.0);
    const auto size = static_cast<Eigen::Index>(3 * first.nodes.size());
    const auto total = size + static_cast<Eigen::Index>(3 * second.nodes.size());
    MatrixXd springs = MatrixXd::Zero(total, total);
    for (int k = 0; k < 9; ++k) {  // from the first nodes of one body to those of the other
      const double stiffness = 5.0 + k;
      springs(k, k) += stiffness;
      springs(size + k, size + k) += stiffness;
      springs(k, size + k) -= stiffness;
      springs(size + k, k) -= stiffness;
    }
    MatrixXd a = springs;
    a.topLeftCorner(size, size) += first.dense();
    a.bottomRightCorner(total - size, total - size) += second.dense();
    const VectorXd b = Random(44).vector(static_cast<std::size_t>(total));
    for (AssembledBody<double>* body : {&first, &second}) {
      const VectorXd part = body == &first ? b.head(size) : b.tail(total - size);
      body->toWide(VectorXd::Zero(part.size()), body->matrix.solution());
      body->toWide(part, body->matrix.residual());
    }
    Springs between({&first, &second}, springs);
    Solver solver;
    solver.start({&first.matrix, &second.matrix}, closely(), &between, nullptr);
    EXPECT_TRUE(solver.iterate(500, nullptr));
    VectorXd x(total);
    x << solutionOf(first), solutionOf(second);
    EXPECT_LT(apart(x, solved(a, b)), kClose);
  });
}

TEST(ConjugateGradient, AnAdditionThatIsNotPositiveLeavesWhatHasBeenReached) {
  onEachInstructionSet([&] {
    for (const double value :
         {-1e6, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      AssembledBody<double> body(smallCage());
      const MatrixXd a = body.dense();
      const VectorXd b = rightSide(body);
      begin(body, a, b, VectorXd::Zero(b.size()));
      Multiple multiple(body, value);
      Solver solver;
      solver.start({&body.matrix}, closely(), &multiple, nullptr);
      solver.iterate(4, nullptr);
      const VectorXd reached = solutionOf(body);
      solver.iterate(100, nullptr);
      EXPECT_EQ(multiple.calls, 5) << value;
      EXPECT_EQ(solutionOf(body), reached) << value;
      EXPECT_TRUE(reached.allFinite());
    }
  });
}

}  // namespace
}  // namespace tetskin::test
