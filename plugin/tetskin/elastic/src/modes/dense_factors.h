// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Dense eigenvectors and factors: compiles Eigen's templates for them only once, in one source.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace tetskin::elastic_detail {

/// Eigenvalues, ascending, and eigenvectors, one per column.
struct Eigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// A x = value x, with vectors of length 1. Cost O(n^3)
/// a  symmetric; its lower triangle is read
Eigenpairs eigenpairsOf(const Eigen::MatrixXd& a);
/// A x = value B x, with vectors of length 1 in the norm of B. Cost O(n^3)
/// a, b  symmetric; their lower triangles are read; b is positive
Eigenpairs eigenpairsOf(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Orthonormal columns of the same span, by reflections: as many columns, even if they are nearly linearly dependent.
Eigen::MatrixXd orthonormalColumns(const Eigen::MatrixXd& columns);

using DenseCholesky = Eigen::LLT<Eigen::MatrixXd>;
/// Stores the factors of a symmetric matrix, whose lower triangle is read; its `info` tells whether it was positive.
void factorise(const Eigen::MatrixXd& a, DenseCholesky& factors);
Eigen::MatrixXd solved(const DenseCholesky& factors, const Eigen::MatrixXd& b);

}  // namespace tetskin::elastic_detail
