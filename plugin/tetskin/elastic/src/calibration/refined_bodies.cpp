// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   James Bramble, Joseph Pasciak and Jinchao Xu, "Parallel Multilevel Preconditioners", Math. Comp. 55, 1990
#include <tetskin/core/src/base/progress.h>
#include <tetskin/elastic/src/calibration/refined_bodies.h>
#include <tetskin/elastic/src/calibration/strain_energies.h>

#include <algorithm>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

/// Energy of a displacement's error, relative to that of the displacement, at which the solve ends: the relative error
/// of the response. The preconditioner estimates it.
constexpr double kTolerance = 3e-4;
constexpr int kMaxSolveIterations = 200;
/// Factors of stiffness and mass of empty tets: they must move with the rest without resisting it.
constexpr double kMinScale = 1e-3, kMinMass = 1e-4;

/// The values times those painted on the tets of the cage, of which theirs are equal parts.
std::vector<double> painted(std::vector<double> values, const std::vector<double>& map) {
  if (map.empty()) return values;
  const std::size_t pieces = values.size() / map.size();
  assert(pieces * map.size() == values.size());
  for (std::size_t k = 0; k < values.size(); ++k) values[k] *= map[k / pieces];
  return values;
}

Eigen::VectorXd massesOf(const Cage& cage) {
  if (cage.masses.empty()) {
    return lumpedVolumes(cage.mesh, painted(std::vector<double>(cage.mesh.tetCount(), 1.0), cage.paintedDensity));
  }
  Eigen::VectorXd masses(static_cast<Eigen::Index>(3 * cage.mesh.nodeCount()));
  for (std::size_t n = 0; n < cage.mesh.nodeCount(); ++n) {
    masses.segment<3>(static_cast<Eigen::Index>(3 * n)).setConstant(cage.masses[n]);
  }
  return masses;
}

/// By tet of a refinement: its volume fraction within the mesh.
std::vector<double> fillAt(const Cage& cage, int refinement) {
  assert(refinement == 1 || refinement == 2);
  assert(cage.fineVolumeFraction.empty() || cage.fineVolumeFraction.size() == kFineTets * cage.mesh.tetCount());
  const std::size_t pieces = refinement == 1 ? 8 : kFineTets, finest = kFineTets / pieces;
  std::vector<double> fill(pieces * cage.mesh.tetCount(), 1.0);
  for (std::size_t k = 0; k < fill.size(); ++k) {
    if (cage.fineVolumeFraction.empty()) {
      if (!cage.volumeFraction.empty()) fill[k] = cage.volumeFraction[k / pieces];
      continue;
    }
    double sum = 0.0;
    for (std::size_t j = 0; j < finest; ++j) sum += cage.fineVolumeFraction[finest * k + j];
    fill[k] = sum / (255.0 * static_cast<double>(finest));
  }
  return fill;
}

/// The refinement as a cage of quadratic tets, one per original tet, with the material of the refinement's own tets.
Cage quadraticCage(const Cage& cage, const TetMesh& refined, const std::vector<double>& fill) {
  assert(refined.tetCount() == kSubTets * cage.mesh.tetCount());
  Cage result(refined);
  for (std::size_t t = 0; t < refined.tetCount(); ++t) result.quadraticTet.push_back(static_cast<int>(t / kSubTets));
  if (!cage.paintedStiffness.empty())
    result.paintedStiffness = painted(std::vector<double>(refined.tetCount(), 1.0), cage.paintedStiffness);
  if (cage.volumeFraction.empty()) return result;
  result.volumeFraction = fill;
  // A tet of the refinement has eight of the 64 fractions, each of which applies to eight of its own 64 tets.
  for (const std::uint8_t fraction : cage.fineVolumeFraction) {
    result.fineVolumeFraction.insert(result.fineVolumeFraction.end(), kFineTets / 8, fraction);
  }
  return result;
}

std::vector<double> atLeast(std::vector<double> values, double minimum) {
  for (double& value : values) value = std::max(value, minimum);
  return values;
}

Eigen::VectorXd massesOf(const TetMesh& mesh, const std::vector<double>& fill) {
  Eigen::VectorXd masses = lumpedVolumes(mesh, fill);
  masses.array() += kMinMass * masses.mean();
  return masses;
}

/// The quotients by component; 0 where the divisor is 0.
Eigen::RowVectorXd quotients(const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b) {
  Eigen::RowVectorXd result = Eigen::RowVectorXd::Zero(a.size());
  for (Eigen::Index k = 0; k < a.size(); ++k) {
    if (b[k] > 0.0) result[k] = a[k] / b[k];
  }
  return result;
}

}  // namespace

RefinedBodies::Level::Level(Refinement made, double poissonRatio, const std::vector<double>& fill, const Cage& cage,
                            const Cage& quadratic)
    : refinement(std::move(made)),
      scale(painted(atLeast(fill, kMinScale), cage.paintedStiffness)),
      stiffness(quadratic.mesh.nodes.empty() ? BlockRows(refinement.mesh, poissonRatio, scale)
                                             : BlockRows(quadratic, poissonRatio, {})),
      masses(massesOf(refinement.mesh, painted(fill, cage.paintedDensity))),
      diagonal(stiffness.diagonal()),
      rigid(refinement.mesh, masses) {}

RefinedBodies::RefinedBodies(Cage cage, double poissonRatio, int refinements)
    : cage_(std::move(cage)),
      poissonRatio_(poissonRatio),
      coarsest_(cage_, poissonRatio, {}, massesOf(cage_)),
      direct_(coarsest_) {
  assert(refinements >= 0 && refinements <= 2);
  for (int k = 1; k <= refinements; ++k) {
    Progress::goOnWithRound();
    Refinement made = refineUniformly(k == 1 ? cage_.mesh : at(1).refinement.mesh);
    const std::vector<double> fill = fillAt(cage_, k);
    const Cage quadratic = refinements == 1 ? quadraticCage(cage_, made.mesh, fill) : Cage();
    levels_.push_back(std::make_unique<Level>(std::move(made), poissonRatio, fill, cage_, quadratic));
  }
}

Eigen::MatrixXd RefinedBodies::energies(std::size_t level, const Fields& displacements) const {
  if (level == 0) return strainEnergies(cage_, poissonRatio_, {}, displacements);
  assert(levelCount() == 3);
  const Level& fine = at(level);
  const Eigen::MatrixXd all = strainEnergies(fine.refinement.mesh, poissonRatio_, fine.scale, displacements);
  const auto tets = static_cast<Eigen::Index>(cage_.mesh.tetCount()), pieces = all.rows() / tets;
  Eigen::MatrixXd sums(tets, all.cols());
  for (Eigen::Index t = 0; t < tets; ++t) sums.row(t) = all.middleRows(pieces * t, pieces).colwise().sum();
  return sums;
}

Fields RefinedBodies::refined(std::size_t level, const Fields& displacements) const {
  assert(displacements.rows() == masses(level).size());
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
  assert(level > 0 && loads.rows() == masses(level).size());
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
  for (int k = 0; k < kMaxSolveIterations; ++k) {
    Progress::goOnWithRound();
    const Fields steps = precondition(level, residuals);
    const Eigen::RowVectorXd now = products(residuals, steps);
    if ((now.array() <= kTolerance * products(loads, displacements).array()).all()) break;
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
