// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Klaus-Jürgen Bathe, "Finite Element Procedures", 2014, chapter 4 (the constant-strain tet)
#include <tetskin/elastic/src/matrix/linear_elasticity.h>
#include <tetskin/elastic/src/tets/material.h>

#include <array>
#include <cassert>

namespace tetskin::elastic_detail {

Eigen::Matrix<double, 12, 12> tetStiffness(const TetCorners& corners, double poissonRatio) {
  const Lame material = lameOf(1.0, poissonRatio);
  const double volume = std::abs(signedVolume(corners));
  const std::array<Eigen::Vector3d, 4> g = BarycentricMap(corners).gradients();
  Eigen::Matrix<double, 12, 12> stiffness;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      stiffness.block<3, 3>(3 * a, 3 * b) =
          volume * (material.lambda * g[a] * g[b].transpose() + material.mu * g[b] * g[a].transpose() +
                    material.mu * g[a].dot(g[b]) * Eigen::Matrix3d::Identity());
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
