// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Eigen's dense decompositions, compiled once: in each source that used them, their templates would take the compiler
// seconds. Only plain numbers cross into that source, column by column, because some tests give Eigen's namespace
// another name.
#pragma once

#include <Eigen/Core>

namespace tetskin::test {

namespace dense {

void solve(const double* a, Eigen::Index size, const double* b, Eigen::Index columns, double* x);
void eigenvalues(const double* a, const double* masses, Eigen::Index size, double* values, double* vectors);
void singularValues(const double* a, double* values, double* rotation);

}  // namespace dense

/// x for which a x = b, by LU decomposition.
///   b  one or more columns
template <class B>
Eigen::Matrix<double, Eigen::Dynamic, B::ColsAtCompileTime> solved(const Eigen::MatrixXd& a,
                                                                   const Eigen::MatrixBase<B>& b) {
  const Eigen::Matrix<double, Eigen::Dynamic, B::ColsAtCompileTime> right = b;
  Eigen::Matrix<double, Eigen::Dynamic, B::ColsAtCompileTime> x(a.cols(), right.cols());
  dense::solve(a.data(), a.rows(), right.data(), right.cols(), x.data());
  return x;
}

/// a x = value masses x for a symmetric a, with values ascending.
struct Spectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  ///< one per column, of length 1 with these masses
};

inline Spectrum spectrumOf(const Eigen::MatrixXd& a, const Eigen::VectorXd& masses) {
  Spectrum found{Eigen::VectorXd(a.rows()), Eigen::MatrixXd(a.rows(), a.cols())};
  dense::eigenvalues(a.data(), masses.data(), a.rows(), found.values.data(), found.vectors.data());
  return found;
}

/// Without the vectors, which take most of the time.
inline Eigen::VectorXd eigenvaluesOf(const Eigen::MatrixXd& a, const Eigen::VectorXd& masses) {
  Eigen::VectorXd values(a.rows());
  dense::eigenvalues(a.data(), masses.data(), a.rows(), values.data(), nullptr);
  return values;
}

/// Descending.
inline Eigen::Vector3d singularValuesOf(const Eigen::Matrix3d& a) {
  Eigen::Vector3d values;
  Eigen::Matrix3d rotation;
  dense::singularValues(a.data(), values.data(), rotation.data());
  return values;
}

/// The orthogonal factor of the polar decomposition: a rotation if the determinant is above 0.
inline Eigen::Matrix3d rotationOf(const Eigen::Matrix3d& a) {
  Eigen::Vector3d values;
  Eigen::Matrix3d rotation;
  dense::singularValues(a.data(), values.data(), rotation.data());
  return rotation;
}

}  // namespace tetskin::test
