// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   James Bramble, Joseph Pasciak and Jinchao Xu, "Parallel Multilevel Preconditioners", Math. Comp. 55, 1990
#include <tetskin/elastic/src/calibration/refined_bodies.h>

#include <algorithm>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

/// Residual over load at which a displacement counts as found. The response of interest is wrong by its square only.
constexpr double kTolerance = 2e-3;
constexpr int kMostSolveIterations = 200;
/// Of what is empty: it has to go along with the rest, without holding it.
constexpr double kLeastScale = 1e-3, kLeastMass = 1e-4;

/// As the body will have it.
std::vector<double> scaleOf(const Cage& cage) {
  std::vector<double> scale = cage.stiffnessScale();
  return scale.empty() ? std::vector<double>(cage.tetCount(), 1.0) : scale;
}

Eigen::VectorXd massesOf(const Cage& cage) {
  if (cage.masses.empty()) return lumpedVolumes(cage, std::vector<double>(cage.tetCount(), 1.0));
  Eigen::VectorXd masses(static_cast<Eigen::Index>(3 * cage.nodeCount()));
  for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
    masses.segment<3>(static_cast<Eigen::Index>(3 * n)).setConstant(cage.masses[n]);
  }
  return masses;
}

/// By tet of a refinement: share of it within the mesh.
std::vector<double> fillAt(const Cage& cage, int refinement) {
  const std::size_t pieces = refinement == 1 ? 8 : kFineTets, finest = kFineTets / pieces;
  std::vector<double> fill(pieces * cage.tetCount(), 1.0);
  for (std::size_t k = 0; k < fill.size(); ++k) {
    if (cage.fineFill.empty()) {
      if (!cage.fill.empty()) fill[k] = cage.fill[k / pieces];
      continue;
    }
    double sum = 0.0;
    for (std::size_t j = 0; j < finest; ++j) sum += cage.fineFill[finest * k + j];
    fill[k] = sum / (255.0 * static_cast<double>(finest));
  }
  return fill;
}

std::vector<double> atLeast(std::vector<double> values, double least) {
  for (double& value : values) value = std::max(value, least);
  return values;
}

Eigen::VectorXd massesOf(const TetMesh& mesh, const std::vector<double>& fill) {
  Eigen::VectorXd masses = lumpedVolumes(mesh, fill);
  masses.array() += kLeastMass * masses.mean();
  return masses;
}

/// Of each field by itself.
Eigen::RowVectorXd products(const Fields& a, const Fields& b) {
  Eigen::RowVectorXd sums = Eigen::RowVectorXd::Zero(a.cols());
  for (Eigen::Index row = 0; row < a.rows(); ++row) sums += a.row(row).cwiseProduct(b.row(row));
  return sums;
}

/// 0 where there is nothing to divide.
Eigen::RowVectorXd quotients(const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b) {
  Eigen::RowVectorXd result = Eigen::RowVectorXd::Zero(a.size());
  for (Eigen::Index k = 0; k < a.size(); ++k) {
    if (b[k] > 0.0) result[k] = a[k] / b[k];
  }
  return result;
}

}  // namespace

RefinedBodies::Level::Level(Refinement made, double poissonRatio, const std::vector<double>& fill)
    : refinement(std::move(made)),
      stiffness(refinement.mesh, poissonRatio, atLeast(fill, kLeastScale)),
      masses(massesOf(refinement.mesh, fill)),
      diagonal(stiffness.diagonal()),
      rigid(refinement.mesh, masses) {}

RefinedBodies::RefinedBodies(Cage cage, double poissonRatio, int refinements)
    : cage_(std::move(cage)), coarsest_(cage_, poissonRatio, scaleOf(cage_), massesOf(cage_)), direct_(coarsest_) {
  assert(refinements >= 0 && refinements <= 2);
  for (int k = 1; k <= refinements; ++k) {
    const TetMesh& before = k == 1 ? cage_ : at(static_cast<std::size_t>(k - 1)).refinement.mesh;
    levels_.push_back(std::make_unique<Level>(refineUniformly(before), poissonRatio, fillAt(cage_, k)));
  }
}

Fields RefinedBodies::refined(std::size_t level, const Fields& displacements) const {
  const std::vector<std::array<int, 2>>& edges = at(level + 1).refinement.edges;
  Fields result(displacements.rows() + 3 * static_cast<Eigen::Index>(edges.size()), displacements.cols());
  result.topRows(displacements.rows()) = displacements;
  Eigen::Index row = displacements.rows();
  for (const auto& [a, b] : edges) {
    result.middleRows<3>(row) = 0.5 * (displacements.middleRows<3>(3 * a) + displacements.middleRows<3>(3 * b));
    row += 3;
  }
  return result;
}

Fields RefinedBodies::coarsened(std::size_t level, const Fields& loads) const {
  const std::vector<std::array<int, 2>>& edges = at(level).refinement.edges;
  const Eigen::Index size = loads.rows() - 3 * static_cast<Eigen::Index>(edges.size());
  Fields result = loads.topRows(size);
  Eigen::Index row = size;
  for (const auto& [a, b] : edges) {
    result.middleRows<3>(3 * a) += 0.5 * loads.middleRows<3>(row);
    result.middleRows<3>(3 * b) += 0.5 * loads.middleRows<3>(row);
    row += 3;
  }
  return result;
}

Fields RefinedBodies::precondition(std::size_t level, const Fields& loads) const {
  if (level == 0) return direct_.solve(loads);
  Fields result = refined(level - 1, precondition(level - 1, coarsened(level, loads)));
  result.array() += loads.array().colwise() / at(level).diagonal.array();
  return result;
}

Fields RefinedBodies::solve(std::size_t level, const Fields& loads, const Fields& guess) const {
  assert(level > 0 && loads.rows() == guess.rows() && loads.cols() == guess.cols());
  const BlockRows& stiffness = at(level).stiffness;
  Fields displacements = guess, forces(loads.rows(), loads.cols());
  stiffness.multiply(displacements, forces);
  Fields residuals = loads - forces;
  Fields directions = Fields::Zero(loads.rows(), loads.cols());
  Eigen::RowVectorXd before = Eigen::RowVectorXd::Zero(loads.cols());
  const Eigen::RowVectorXd enough = kTolerance * kTolerance * products(loads, loads);
  for (int k = 0; k < kMostSolveIterations; ++k) {
    if ((products(residuals, residuals).array() <= enough.array()).all()) break;
    const Fields steps = precondition(level, residuals);
    const Eigen::RowVectorXd now = products(residuals, steps);
    directions.array().rowwise() *= quotients(now, before).array();
    directions += steps;
    before = now;
    stiffness.multiply(directions, forces);
    const Eigen::RowVectorXd lengths = quotients(now, products(directions, forces));
    displacements.array() += directions.array().rowwise() * lengths.array();
    residuals.array() -= forces.array().rowwise() * lengths.array();
  }
  return displacements;
}

}  // namespace tetskin::elastic_detail
