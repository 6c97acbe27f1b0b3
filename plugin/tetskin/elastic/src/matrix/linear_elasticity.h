// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Linear elasticity of a tet mesh at rest, by linear finite elements: what elastic forces are for small displacements.
// The matrix of a whole mesh is that of BlockRows; bodies in motion, of which each tet is turned, have BlockMatrix.
#pragma once

#include <tetskin/core/src/shared/mesh/tet_geometry.h>
#include <tetskin/core/tet_mesh.h>

#include <vector>

namespace tetskin::elastic_detail {

/// Several displacements, loads or accelerations at once: 3 nodeCount x count. A matrix is then read once for all of
/// them, which is what a product takes its time for.
using Fields = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The stiffness of one tet that is not flat, for a Young's modulus of 1: forces of its corners over displacements,
/// 12 x 12, symmetric.
Eigen::Matrix<double, 12, 12> tetStiffness(const TetCorners& corners, double poissonRatio);

/// Masses for a density of 1, a quarter of each tet's at its nodes; 3 nodeCount, each node's mass three times.
/// fill  by tet: share of it that has a mass
/// Cost  O(T) for T tets
Eigen::VectorXd lumpedVolumes(const TetMesh& mesh, const std::vector<double>& fill);

}  // namespace tetskin::elastic_detail
