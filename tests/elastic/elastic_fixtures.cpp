// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "elastic_fixtures.h"

#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

using Weights = Eigen::Vector4d;  // barycentric

/// The gradients of the barycentric weights of four corners.
Eigen::Matrix<double, 3, 4> weightGradients(const Points& nodes, const int* corners) {
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = nodes[corners[k + 1]] - nodes[corners[0]];
  Eigen::Matrix<double, 3, 4> gradients;
  gradients.rightCols<3>() = edges.inverse().transpose();
  gradients.col(0) = -gradients.rightCols<3>().rowwise().sum();
  return gradients;
}

double volumeOf(const Eigen::Matrix<double, 3, 4>& weightGradients) {
  return 1.0 / (6.0 * std::abs(weightGradients.rightCols<3>().determinant()));
}

/// The gradients of the ten shape functions L_i (2 L_i - 1) and 4 L_i L_j.
Eigen::Matrix3Xd shapeGradients(const Eigen::Matrix<double, 3, 4>& g, const Weights& weights) {
  constexpr int kEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  Eigen::Matrix3Xd gradients(3, 10);
  for (int i = 0; i < 4; ++i) gradients.col(i) = (4.0 * weights[i] - 1.0) * g.col(i);
  for (int e = 0; e < 6; ++e) {
    const int i = kEdges[e][0], j = kEdges[e][1];
    gradients.col(4 + e) = 4.0 * (weights[i] * g.col(j) + weights[j] * g.col(i));
  }
  return gradients;
}

}  // namespace

Cage oddCage() {
  return jittered(latticeCage(3, 2, 1), 0.15, 3);
}

Cage oddQuadraticCage() {
  TetMesh mesh = jittered(latticeCage(2, 1, 1), 0.15, 3);
  mesh.tets.pop_back();
  return refineQuadratic(mesh).value();
}

Cage oddMixedCage() {
  Cage cage = oddQuadraticCage();
  for (int& number : cage.quadraticTet) number = number % 3 == 1 ? -1 : number / 3 * 2 + number % 3 / 2;
  cage.mesh.tets.pop_back();
  cage.quadraticTet.pop_back();
  return cage;
}

std::vector<double> variedScale(const Cage& cage) {
  Random random(31);
  std::vector<double> scale(cage.mesh.tetCount());
  for (double& s : scale) s = 2.0 + random();
  const std::vector<QuadraticTet> quadratic = quadraticTets(cage).value();
  for (const QuadraticTet& tet : quadratic) {
    for (const int t : tet.tets) scale[t] = scale[tet.tets[0]];
  }
  return scale;
}

Eigen::Matrix3d PlainPoint::gradientAt(const Points& positions) const {
  Eigen::Matrix3d f = Eigen::Matrix3d::Zero();
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    f += positions[nodes[a]] * gradients.col(static_cast<Eigen::Index>(a)).transpose();
  }
  return f;
}

std::vector<PlainPoint> plainPoints(const Cage& cage, const std::vector<double>& scale) {
  std::vector<PlainPoint> points;
  const std::vector<QuadraticTet> quadratic = quadraticTets(cage).value();
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    if (!cage.quadraticTet.empty() && cage.quadraticTet[t] >= 0) continue;
    const Tet& tet = cage.mesh.tets[t];
    const Eigen::Matrix<double, 3, 4> gradients = weightGradients(cage.mesh.nodes, tet.data());
    points.push_back({{tet.begin(), tet.end()}, gradients, scale[t] * volumeOf(gradients)});
  }
  for (const QuadraticTet& tet : quadratic) {
    const Eigen::Matrix<double, 3, 4> gradients = weightGradients(cage.mesh.nodes, tet.nodes.data());
    for (int q = 0; q < 4; ++q) {
      // The rule of four points that is exact for quadratics: (5 - sqrt 5) / 20, and for one weight the rest to 1.
      Weights weights = Weights::Constant((5.0 - std::sqrt(5.0)) / 20.0);
      weights[q] = 1.0 - 3.0 * weights[q];
      points.push_back({{tet.nodes.begin(), tet.nodes.end()},
                        shapeGradients(gradients, weights),
                        scale[tet.tets[0]] * volumeOf(gradients) / 4.0});
    }
  }
  return points;
}

DeformedBody::DeformedBody(const Cage& rest, double amount, double alphaOfMatrix)
    : whole(rest),
      cage(rest.mesh),
      nodes(scattered(mapped(cage.nodes, turnBy(75.0, {1, -2, 0.5}), {0.3, 0.2, -0.7}), amount, 32)),
      scale(variedScale(rest)),
      alpha(alphaOfMatrix) {
  Random random(33);
  for (std::size_t n = 0; n < cage.nodeCount(); ++n) masses.push_back(1.5 + random());
}

Eigen::MatrixXd DeformedBody::dense() const {
  const auto size = static_cast<Eigen::Index>(3 * nodes.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    a.diagonal().segment<3>(static_cast<Eigen::Index>(3 * n)).setConstant(masses[n]);
  }
  for (const PlainPoint& point : plainPoints(whole, scale)) {
    const Eigen::Matrix3d turn = rotationOf(point.gradientAt(nodes));
    EXPECT_GT(turn.determinant(), 0.0) << "the reference is for tets that are not inside out";
    const Eigen::Matrix3Xd h = turn * point.gradients;
    for (std::size_t i = 0; i < point.nodes.size(); ++i) {
      for (std::size_t j = 0; j < point.nodes.size(); ++j) {
        const Eigen::Vector3d own = h.col(static_cast<Eigen::Index>(i)), other = h.col(static_cast<Eigen::Index>(j));
        a.block<3, 3>(3 * point.nodes[i], 3 * point.nodes[j]) +=
            alpha * point.volume *
            (lame.lambda * own * other.transpose() + lame.mu * other * own.transpose() +
             lame.mu * own.dot(other) * Eigen::Matrix3d::Identity());
      }
    }
  }
  return a;
}

}  // namespace tetskin::test
