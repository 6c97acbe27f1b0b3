// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/base/arithmetic/small_matrix.h>
#include <tetskin/elastic/src/matrix/linear_elasticity.h>

#include <vector>

namespace tetskin::elastic_detail {

/// The rigid motions of each component of a free body at rest: elasticity does not resist them. Displacements and loads
/// may have several columns; each column is treated separately.
///
/// Not for a moving body: its components rotate by large angles, and some of their nodes are pinned (see
/// ComponentMotion::excess).
class RigidMotions {
 public:
  /// mesh    rest space; every component has volume. Not kept
  /// masses  3 nodeCount, above 0, see `lumpedVolumes`
  /// Cost    O(nodes + tets)
  RigidMotions(const TetMesh& mesh, const Eigen::VectorXd& masses);

  /// The number of rigid motions: six per component.
  Eigen::Index count() const { return 6 * static_cast<Eigen::Index>(components_.size()); }
  /// Removes the rigid motions from displacements, so that they neither translate nor rotate any component: the
  /// projection that is orthogonal with respect to mass. Cost O(nodes x columns)
  void removeFrom(Fields& displacements) const;
  /// Removes the resultants and moments from loads: `removeFrom`, applied to the accelerations that they cause.
  void balance(Fields& loads) const;

 private:
  struct Component {
    double mass = 0.0;
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    SmallLdlt<3> inertiaFactors{{}};
  };

  std::vector<int> partOf_;            ///< by node
  std::vector<double> masses_;         ///< by node
  std::vector<Eigen::Vector3d> arms_;  ///< by node: from its component's centroid
  std::vector<Component> components_;
};

}  // namespace tetskin::elastic_detail
