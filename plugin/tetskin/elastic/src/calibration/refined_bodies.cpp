// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   James Bramble, Joseph Pasciak and Jinchao Xu, "Parallel Multilevel Preconditioners", Math. Comp. 55, 1990
#include <tetskin/elastic/src/calibration/refined_bodies.h>

namespace tetskin::elastic_detail {
namespace {

/// Residual over load at which a displacement counts as found. The response of interest is wrong by its square only.
constexpr double kTolerance = 1e-3;
constexpr int kMostSolveIterations = 500;
}  // namespace

RefinedBodies::Level::Level(Refinement made, double poissonRatio)
    : refinement(std::move(made)), body(refinement.mesh, poissonRatio), diagonal(body.stiffness.diagonal()) {}

RefinedBodies::RefinedBodies(const TetMesh& coarsest, double poissonRatio, int refinements)
    : levels_([&] {
        std::vector<std::unique_ptr<Level>> levels;
        levels.push_back(std::make_unique<Level>(Refinement{coarsest, {}}, poissonRatio));
        for (int k = 0; k < refinements; ++k) {
          levels.push_back(std::make_unique<Level>(refineUniformly(levels.back()->refinement.mesh), poissonRatio));
        }
        return levels;
      }()),
      direct_(levels_.front()->body) {}

Eigen::VectorXd RefinedBodies::refined(std::size_t level, const Eigen::VectorXd& displacement) const {
  const std::vector<std::array<int, 2>>& edges = levels_[level + 1]->refinement.edges;
  Eigen::VectorXd result(displacement.size() + 3 * static_cast<Eigen::Index>(edges.size()));
  result.head(displacement.size()) = displacement;
  Eigen::Index at = displacement.size();
  for (const auto& [a, b] : edges) {
    result.segment<3>(at) = 0.5 * (displacement.segment<3>(3 * a) + displacement.segment<3>(3 * b));
    at += 3;
  }
  return result;
}

Eigen::VectorXd RefinedBodies::coarsened(std::size_t level, const Eigen::VectorXd& load) const {
  const std::vector<std::array<int, 2>>& edges = levels_[level]->refinement.edges;
  const Eigen::Index size = load.size() - 3 * static_cast<Eigen::Index>(edges.size());
  Eigen::VectorXd result = load.head(size);
  Eigen::Index at = size;
  for (const auto& [a, b] : edges) {
    result.segment<3>(3 * a) += 0.5 * load.segment<3>(at);
    result.segment<3>(3 * b) += 0.5 * load.segment<3>(at);
    at += 3;
  }
  return result;
}

Eigen::VectorXd RefinedBodies::precondition(std::size_t level, const Eigen::VectorXd& load) const {
  if (level == 0) return direct_.solve(load);
  return load.cwiseQuotient(levels_[level]->diagonal) +
         refined(level - 1, precondition(level - 1, coarsened(level, load)));
}

Eigen::VectorXd RefinedBodies::solve(std::size_t level, const Eigen::VectorXd& load,
                                     const Eigen::VectorXd& guess) const {
  const auto stiffness = body(level).stiffness.selfadjointView<Eigen::Lower>();
  Eigen::VectorXd displacement = guess;
  Eigen::VectorXd residual = load - stiffness * displacement;
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(load.size());
  double before = 1.0;
  for (int k = 0; k < kMostSolveIterations && residual.norm() > kTolerance * load.norm(); ++k) {
    const Eigen::VectorXd step = precondition(level, residual);
    const double now = residual.dot(step);
    direction = step + (k == 0 ? 0.0 : now / before) * direction;
    before = now;
    const Eigen::VectorXd force = stiffness * direction;
    const double length = now / direction.dot(force);
    displacement += length * direction;
    residual -= length * force;
  }
  return displacement;
}

}  // namespace tetskin::elastic_detail
