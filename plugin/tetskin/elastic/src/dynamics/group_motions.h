// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The rigid motions of groups of neighbouring nodes: the coarse space of a two-level solve. A slender or thin body
// bends as its groups move, and the conjugate gradient alone propagates such motion by only one node per iteration.
//
// This work is based on:
//   Petr Vanek, Jan Mandel, Marian Brezina, "Algebraic Multigrid by Smoothed Aggregation for Second and Fourth Order
//     Elliptic Problems", Computing 56, 1996, doi 10.1007/BF02238511
#pragma once

#include <tetskin/elastic/src/matrix/tet_stiffness.h>

#include <Eigen/SparseCholesky>
#include <vector>

namespace tetskin::elastic_detail {

class GroupMotions {
 public:
  /// Finds the groups. Cost O(groups x nodes)
  GroupMotions(const RestTets& rest, const std::vector<std::uint32_t>& slotOf, std::size_t slots);

  /// Computes E = Z^T (M + alpha K) Z, with Z the groups' motions, and its factors. Returns false if E is not positive.
  /// masses  by slot; 0: pinned
  /// points  positions, 3 scalars per slot
  /// Cost    O(T), and the factors
  bool assemble(const TetStiffness& stiffness, const std::vector<double>& masses, const std::vector<double>& points);
  /// After `assemble`: adds Z E^-1 Z^T impulses to velocities, both 3 scalars per slot.
  void addResponse(const std::vector<double>& impulses, std::vector<double>& velocities) const;

 private:
  /// Three translations, and three rotations about the group's centre.
  static constexpr Eigen::Index kMotions = 6;
  using Motions = Eigen::Matrix<double, 3, kMotions>;

  void findArms(const std::vector<double>& masses, const std::vector<double>& points);
  void addStiffness(const TetStiffness& stiffness, const StiffnessPoint& at, Eigen::MatrixXd& sums) const;
  Motions motionsAt(std::size_t slot) const;

  std::vector<int> groupOf_;  ///< by slot; -1: no group
  int count_ = 0;
  std::vector<char> moves_;             ///< by slot: it has a group, and is not pinned
  std::vector<Eigen::Vector3d> arms_;   ///< by slot: from the centre of its group, divided by the group's radius
  Eigen::SparseMatrix<double> matrix_;  ///< E, lower triangle
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

}  // namespace tetskin::elastic_detail
