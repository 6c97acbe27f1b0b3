// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Linear elasticity of a tet mesh at rest, by linear finite elements: what Bullet's elastic forces are for small
// displacements. Vectors hold three displacements a node: 3 x nodeCount.
#pragma once

#include <tetskin/core/src/mesh/tet_geometry.h>
#include <tetskin/core/tet_mesh.h>

#include <Eigen/SparseCore>
#include <vector>

namespace tetskin::elastic_detail {

/// Forces over displacements for a Young's modulus of 1, 3N x 3N, symmetric, lower triangle only; positive but for
/// rigid motions. The tets must not be flat.
/// scale  by tet: times its stiffness
Eigen::SparseMatrix<double> stiffnessMatrix(const TetMesh& mesh, double poissonRatio, const std::vector<double>& scale);

/// The stiffness of one tet, for a Young's modulus of 1.
Eigen::Matrix<double, 12, 12> tetStiffness(const TetCorners& corners, double poissonRatio);

/// Masses for a density of 1, a quarter of each tet's at its nodes; 3N, each node's mass three times.
/// fill  by tet: share of it that has a mass
Eigen::VectorXd lumpedVolumes(const TetMesh& mesh, const std::vector<double>& fill);

/// The rigid motions of each part of a mesh: elasticity does not resist them.
class RigidMotions {
 public:
  /// masses  as `lumpedVolumes`
  RigidMotions(const TetMesh& mesh, const Eigen::VectorXd& masses);

  /// Takes the rigid motions out of a displacement, so that it neither moves nor turns any part's masses.
  void removeFrom(Eigen::VectorXd& displacement) const;
  /// Takes the resultant and the moment of a load out of it: `removeFrom` of the accelerations that it causes.
  void balance(Eigen::VectorXd& load) const;

 private:
  struct Part {
    double mass = 0.0;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  };

  const TetMesh& mesh_;
  const Eigen::VectorXd& masses_;
  std::vector<int> partOf_;  ///< by node
  std::vector<Part> parts_;
};

}  // namespace tetskin::elastic_detail
