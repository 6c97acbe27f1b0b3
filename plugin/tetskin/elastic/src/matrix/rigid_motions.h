// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/elastic/src/matrix/linear_elasticity.h>

#include <Eigen/Cholesky>
#include <vector>

namespace tetskin::elastic_detail {

/// The rigid motions of each part of a body at rest that nothing holds: elasticity does not resist them. What is said
/// of one displacement or load goes for each column.
///
/// A body in a step is another matter: its parts turn by angles that are not small, and some of their nodes are held
/// (see PartMotion::excess).
class RigidMotions {
 public:
  /// mesh    rest space; every part has a volume. Not referred to later
  /// masses  3 nodeCount, above 0, see `lumpedVolumes`
  /// Cost    O(nodes + tets)
  RigidMotions(const TetMesh& mesh, const Eigen::VectorXd& masses);

  /// How many there are: six a part.
  Eigen::Index count() const { return 6 * static_cast<Eigen::Index>(parts_.size()); }
  /// Takes the rigid motions out of displacements, so that they neither move nor turn any part's masses: the projection
  /// that is orthogonal by mass. Cost O(nodes x columns)
  void removeFrom(Fields& displacements) const;
  /// Takes the resultants and moments out of loads: `removeFrom` of the accelerations that they cause.
  void balance(Fields& loads) const;

 private:
  struct Part {
    double mass = 0.0;
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    Eigen::LDLT<Eigen::Matrix3d> inertiaFactors;
  };

  std::vector<int> partOf_;            ///< by node
  std::vector<double> masses_;         ///< by node
  std::vector<Eigen::Vector3d> arms_;  ///< by node: from its part's centroid
  std::vector<Part> parts_;
};

}  // namespace tetskin::elastic_detail
