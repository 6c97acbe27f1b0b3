// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Linear elasticity of tets at rest, by linear and quadratic finite elements: the limit of elastic forces for small
// displacements. The matrix of a whole mesh is BlockRows; moving bodies, whose tets rotate, use BlockMatrix.
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/elastic/src/tets/rest_quadratic_tets.h>

#include <vector>

namespace tetskin::elastic_detail {

/// Several displacements, loads or accelerations: 3 nodeCount x count. A product then reads the matrix, which takes
/// most of its time, only once for all of them.
using Fields = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The stiffness matrix of one tet that is not flat, for a Young's modulus of 1: it maps displacements of its corners
/// to forces, 12 x 12, symmetric.
Eigen::Matrix<double, 12, 12> tetStiffness(const TetCorners& corners, double poissonRatio);

/// The same for a quadratic tet: for its ten nodes, 30 x 30, with its stiffness factor.
Eigen::Matrix<double, 30, 30> tetStiffness(const RestQuadraticTet& tet, double poissonRatio);

/// Masses for a density of 1, a quarter of each tet's mass at each of its nodes; 3 nodeCount, each node's mass three
/// times.
/// fill  by tet: volume fraction that has mass
/// Cost  O(T) for T tets
Eigen::VectorXd lumpedVolumes(const TetMesh& mesh, const std::vector<double>& fill);

}  // namespace tetskin::elastic_detail
