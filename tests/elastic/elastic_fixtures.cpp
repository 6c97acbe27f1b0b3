// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "elastic_fixtures.h"

#include <cmath>

namespace tetskin::test {

DeformedBody::DeformedBody(const TetMesh& rest, double amount, double alphaOfMatrix)
    : cage(rest),
      nodes(scattered(mapped(rest.nodes, turnBy(75.0, {1, -2, 0.5}), {0.3, 0.2, -0.7}), amount, 32)),
      material(variedMaterial(rest.tetCount())),
      alpha(alphaOfMatrix) {
  Random random(33);
  for (std::size_t n = 0; n < rest.nodeCount(); ++n) masses.push_back(1.5 + random());
}

Eigen::MatrixXd DeformedBody::dense() const {
  const auto size = static_cast<Eigen::Index>(3 * nodes.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    a.diagonal().segment<3>(static_cast<Eigen::Index>(3 * n)).setConstant(masses[n]);
  }
  for (std::size_t t = 0; t < cage.tetCount(); ++t) addTet(t, a);
  return a;
}

void DeformedBody::addTet(std::size_t t, Eigen::MatrixXd& a) const {
  Eigen::Matrix3d rest, now;
  for (int k = 0; k < 3; ++k) {
    rest.col(k) = cage.nodes[cage.tets[t][k + 1]] - cage.nodes[cage.tets[t][0]];
    now.col(k) = nodes[cage.tets[t][k + 1]] - nodes[cage.tets[t][0]];
  }
  const Eigen::Matrix3d gradients = rest.inverse();  // rows: gradients of the weights of nodes 1, 2 and 3
  const Eigen::Matrix3d turn = rotationOf(now * gradients);
  ASSERT_GT(turn.determinant(), 0.0) << "the reference is for tets that are not inside out";
  Eigen::Matrix<double, 3, 4> h;
  h.rightCols<3>() = turn * gradients.transpose();
  h.col(0) = -h.rightCols<3>().rowwise().sum();
  const double volume = std::abs(rest.determinant()) / 6.0, mu = material[t].mu, lambda = material[t].lambda;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      a.block<3, 3>(3 * cage.tets[t][i], 3 * cage.tets[t][j]) +=
          alpha * volume *
          (lambda * h.col(i) * h.col(j).transpose() + mu * h.col(j) * h.col(i).transpose() +
           mu * h.col(i).dot(h.col(j)) * Eigen::Matrix3d::Identity());
    }
  }
}

}  // namespace tetskin::test
