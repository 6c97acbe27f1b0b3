// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Petr Vanek, Jan Mandel, Marian Brezina, "Algebraic Multigrid by Smoothed Aggregation for Second and Fourth Order
//     Elliptic Problems", Computing 56, 1996, doi 10.1007/BF02238511 (rigid motions of groups, smoothed)
//   Mark Adams, Marian Brezina, Jonathan Hu, Ray Tuminaro, "Parallel multigrid smoothing: polynomial versus
//     Gauss-Seidel", J. Comput. Phys. 188, 2003 (Chebyshev smoothing)
#include <tetskin/elastic/src/modes/aggregates.h>
#include <tetskin/elastic/src/modes/start_vectors.h>
#include <tetskin/elastic/src/modes/two_level_solver.h>

#include <Eigen/LU>
#include <algorithm>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

/// Most groups: six motions of each give as many unknowns as a dense factorisation can process in a few seconds.
constexpr int kMaxGroups = 400;
/// Smallest number of nodes per group.
constexpr std::size_t kNodesOfGroup = 8;
/// A group's motion that is this small relative to its largest one does not exist: the nodes are on a line, or there is
/// only one node.
constexpr double kNoMotion = 1e-6;
/// Degree of the smoothing polynomial, and the part of the spectrum that it damps: everything above the largest
/// eigenvalue divided by this.
constexpr int kDegree = 3;
constexpr double kDampedRange = 12.0;
constexpr int kPowerIterations = 15;
/// Margin added to an estimate of the largest eigenvalue, which is a lower bound.
constexpr double kMaxMargin = 1.1;
/// Stiffness added to each motion of the groups, relative to the largest: a free body's rigid motions have none of
/// their own.
constexpr double kGroupShift = 1e-10;

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

using Motions = Eigen::Matrix<double, Eigen::Dynamic, 6>;

/// Makes the columns orthonormal, largest first, and returns how many there are: drops those that add hardly anything
/// to the others. By the Gram-Schmidt method, twice, which gives all digits: Eigen's singular values of such a matrix
/// take the compiler five seconds, this takes none.
Eigen::Index makeOrthonormal(Motions& motions) {
  Eigen::Index rank = 0;
  double largest = 0.0;
  for (; rank < motions.cols(); ++rank) {
    Eigen::Index longest = 0;
    const double length = motions.rightCols(motions.cols() - rank).colwise().norm().maxCoeff(&longest);
    if (rank == 0) largest = length;
    if (!(length > kNoMotion * largest)) break;
    motions.col(rank).swap(motions.col(rank + longest));
    for (int pass = 0; pass < 2; ++pass) {
      for (Eigen::Index c = 0; c < rank; ++c) {
        motions.col(rank) -= motions.col(c).dot(motions.col(rank)) * motions.col(c);
      }
      motions.col(rank).normalize();
    }
    for (Eigen::Index c = rank + 1; c < motions.cols(); ++c) {
      motions.col(c) -= motions.col(rank).dot(motions.col(c)) * motions.col(rank);
    }
  }
  return rank;
}

/// Orthonormal bases of the rigid motions of each group's free nodes.
SparseRows motionsOf(const Aggregates& groups, const std::vector<Eigen::Vector3d>& nodes,
                     const std::vector<char>& free) {
  assert(groups.indices.size() == nodes.size() && free.size() == nodes.size());
  assert(std::find(groups.indices.begin(), groups.indices.end(), -1) == groups.indices.end());
  const Lists<> members = packLists(static_cast<std::size_t>(groups.count), [&](auto&& add) {
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (free[n]) add(static_cast<std::size_t>(groups.indices[n]), static_cast<std::uint32_t>(n));
    }
  });
  std::vector<Eigen::Triplet<double>> entries;
  int columns = 0;
  for (std::size_t g = 0; g + 1 < members.starts.size(); ++g) {
    const Eigen::Index count = members.starts[g + 1] - members.starts[g];
    if (count == 0) continue;
    const std::uint32_t* member = &members.values[members.starts[g]];
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 0; k < count; ++k) centre += nodes[member[k]] / static_cast<double>(count);
    double radius = 0.0;
    for (Eigen::Index k = 0; k < count; ++k) radius = std::max(radius, (nodes[member[k]] - centre).norm());
    Motions motions(3 * count, 6);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Vector3d arm = (nodes[member[k]] - centre) / (radius > 0.0 ? radius : 1.0);
      motions.block<3, 3>(3 * k, 0).setIdentity();
      motions.block<3, 3>(3 * k, 3) << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
    }
    const Eigen::Index rank = makeOrthonormal(motions);
    for (Eigen::Index c = 0; c < rank; ++c) {
      for (Eigen::Index k = 0; k < count; ++k) {
        for (int i = 0; i < 3; ++i) {
          entries.emplace_back(3 * static_cast<int>(member[k]) + i, columns, motions(3 * k + i, c));
        }
      }
      ++columns;
    }
  }
  SparseRows motions(static_cast<Eigen::Index>(3 * nodes.size()), columns);
  motions.setFromTriplets(entries.begin(), entries.end());
  return motions;
}

}  // namespace

TwoLevelSolver::TwoLevelSolver(const BlockRows& stiffness, const std::vector<Eigen::Vector3d>& nodes,
                               const std::vector<double>& masses, const std::vector<char>& free)
    : stiffness_(stiffness), inverseDiagonal_(nodes.size(), Block::Zero()) {
  assert(nodes.size() == masses.size() && nodes.size() == free.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (free[n]) inverseDiagonal_[n] = stiffness.diagonalBlock(n).inverse();
  }
  estimateLargest(masses);
  const int desired = static_cast<int>(std::min<std::size_t>(kMaxGroups, 1 + nodes.size() / kNodesOfGroup));
  const SparseRows motions = motionsOf(aggregate(stiffness.neighbours(), desired), nodes, free);
  const SparseRows sparse = stiffness.sparse();

  // One Jacobi step: the motions of neighbouring groups blend into each other, which makes them soft.
  // P = (1 - 4/3 D^-1 K / largest) P0
  SparseRows inverse(sparse.rows(), sparse.rows());
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const int at = 3 * static_cast<int>(n);
        entries.emplace_back(at + i, at + j, 4.0 / 3.0 / largest_ * inverseDiagonal_[n](i, j));
      }
    }
  }
  inverse.setFromTriplets(entries.begin(), entries.end());
  const SparseRows forces = sparse * motions;
  interpolation_ = motions - SparseRows(inverse * forces);
  const SparseRows ofGroups = sparse * interpolation_;
  Eigen::MatrixXd coarse = Eigen::MatrixXd(SparseRows(interpolation_.transpose() * ofGroups));
  coarse.diagonal().array() += kGroupShift * coarse.diagonal().maxCoeff();
  factorise(coarse, coarse_);
}

void TwoLevelSolver::estimateLargest(const std::vector<double>& masses) {
  const auto rows = static_cast<Eigen::Index>(3 * inverseDiagonal_.size());
  Fields field = startVectors(rows, 1), forces(rows, 1);
  for (int k = 0; k < kPowerIterations; ++k) {
    stiffness_.multiply(field, forces);
    field = timesInverseDiagonal(forces);
    largest_ = kMaxMargin * field.norm();
    field /= field.norm();
  }
  // A node's stiffness over its mass, times `largest`, bounds all squared frequencies.
  for (std::size_t n = 0; n < masses.size(); ++n) {
    if (inverseDiagonal_[n].isZero(0.0)) continue;
    const double stiffest = stiffness_.diagonalBlock(n).trace();
    largestFrequency_ = std::max(largestFrequency_, largest_ * stiffest / masses[n]);
  }
}

Fields TwoLevelSolver::timesInverseDiagonal(const Fields& loads) const {
  assert(loads.rows() == static_cast<Eigen::Index>(3 * inverseDiagonal_.size()));
  Fields result(loads.rows(), loads.cols());
  for (std::size_t n = 0; n < inverseDiagonal_.size(); ++n) {
    const auto at = static_cast<Eigen::Index>(3 * n);
    for (int i = 0; i < 3; ++i) {
      result.row(at + i) = inverseDiagonal_[n](i, 0) * loads.row(at) + inverseDiagonal_[n](i, 1) * loads.row(at + 1) +
                           inverseDiagonal_[n](i, 2) * loads.row(at + 2);
    }
  }
  return result;
}

/// Chebyshev iteration for the upper part of the spectrum.
void TwoLevelSolver::smooth(const Fields& loads, Fields& displacements, bool fromZero) const {
  assert(largest_ > 0.0 && loads.rows() == displacements.rows() && loads.cols() == displacements.cols());
  const double high = largest_, low = largest_ / kDampedRange;
  const double centre = 0.5 * (high + low), radius = 0.5 * (high - low);
  Fields residual = loads, forces(loads.rows(), loads.cols());
  if (!fromZero) {
    stiffness_.multiply(displacements, forces);
    residual -= forces;
  }
  double rho = radius / centre;
  Fields step = timesInverseDiagonal(residual) / centre;
  for (int k = 1;; ++k) {
    displacements += step;
    if (k == kDegree) return;
    stiffness_.multiply(step, forces);
    residual -= forces;
    const double next = 1.0 / (2.0 * centre / radius - rho);
    step = next * rho * step + (2.0 * next / radius) * timesInverseDiagonal(residual);
    rho = next;
  }
}

Fields TwoLevelSolver::solve(const Fields& loads) const {
  assert(ok() && loads.rows() == interpolation_.rows());
  Fields displacements = Fields::Zero(loads.rows(), loads.cols()), forces(loads.rows(), loads.cols());
  smooth(loads, displacements, true);
  stiffness_.multiply(displacements, forces);
  const Eigen::MatrixXd ofGroups = interpolation_.transpose() * (loads - forces);
  displacements += interpolation_ * solved(coarse_, ofGroups);
  smooth(loads, displacements, false);
  return displacements;
}

}  // namespace tetskin::elastic_detail
