// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Klaus-Jürgen Bathe, "Finite Element Procedures", 2014, chapter 4 (the constant-strain tet), chapter 5 (the
//     ten-node tet)
#include <tetskin/elastic/src/matrix/linear_elasticity.h>
#include <tetskin/elastic/src/tets/material.h>

#include <array>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

/// Stiffness of `volume` of a material, if the weights of two nodes have the gradients g and h: maps a displacement of
/// the second node to the force on the first.
Eigen::Matrix3d blockOf(const Lame& material, double volume, const Eigen::Vector3d& g, const Eigen::Vector3d& h) {
  return volume * (material.lambda * g * h.transpose() + material.mu * h * g.transpose() +
                   material.mu * g.dot(h) * Eigen::Matrix3d::Identity());
}

/// By node of a quadratic tet: the gradient of its weight at a point.
/// at  the barycentric weights of corners 1, 2 and 3
std::array<Eigen::Vector3d, kQuadraticNodes> quadraticGradients(const RestQuadraticTet& tet, const double* at) {
  std::array<Eigen::Vector3d, 4> gradients;
  std::array<double, 4> weights = {1.0, 0.0, 0.0, 0.0};
  gradients[0].setZero();
  for (std::size_t k = 0; k < 3; ++k) {
    gradients[k + 1] = Eigen::Vector3d::Map(&tet.gradients[3 * k]);
    gradients[0] -= gradients[k + 1];
    weights[k + 1] = at[k];
    weights[0] -= at[k];
  }
  std::array<Eigen::Vector3d, kQuadraticNodes> result;
  std::size_t edge = 4;
  for (std::size_t a = 0; a < 4; ++a) {
    result[a] = (4.0 * weights[a] - 1.0) * gradients[a];
    for (std::size_t b = a + 1; b < 4; ++b)
      result[edge++] = 4.0 * (weights[a] * gradients[b] + weights[b] * gradients[a]);
  }
  return result;
}

}  // namespace

Eigen::Matrix<double, 12, 12> tetStiffness(const TetCorners& corners, double poissonRatio) {
  const Lame material = lameOf(1.0, poissonRatio);
  const double volume = std::abs(signedVolume(corners));
  const std::array<Eigen::Vector3d, 4> g = BarycentricMap(corners).gradients();
  Eigen::Matrix<double, 12, 12> stiffness;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) stiffness.block<3, 3>(3 * a, 3 * b) = blockOf(material, volume, g[a], g[b]);
  }
  return stiffness;
}

Eigen::Matrix<double, 30, 30> tetStiffness(const RestQuadraticTet& tet, double poissonRatio) {
  const Lame material = lameOf(1.0, poissonRatio);
  constexpr auto kNodes = static_cast<int>(kQuadraticNodes);
  Eigen::Matrix<double, 30, 30> stiffness = Eigen::Matrix<double, 30, 30>::Zero();
  for (std::size_t q = 0; q < kQuadraticPoints; ++q) {
    const auto g = quadraticGradients(tet, &tet.points[3 * q]);
    const double part = tet.volume / static_cast<double>(kQuadraticPoints);
    for (int a = 0; a < kNodes; ++a) {
      for (int b = 0; b < kNodes; ++b) stiffness.block<3, 3>(3 * a, 3 * b) += blockOf(material, part, g[a], g[b]);
    }
  }
  return stiffness;
}

Eigen::VectorXd lumpedVolumes(const TetMesh& mesh, const std::vector<double>& fill) {
  assert(fill.size() == mesh.tetCount());
  Eigen::VectorXd masses = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * mesh.nodeCount()));
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
    const double quarter = fill[t] * std::abs(signedVolume(cornersOf(mesh, mesh.tets[t]))) / 4.0;
    for (const int n : mesh.tets[t]) masses.segment<3>(3 * n).array() += quarter;
  }
  return masses;
}

}  // namespace tetskin::elastic_detail
