// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Klaus-Jürgen Bathe, "Finite Element Procedures", 2014, chapter 4 (the constant-strain tet)
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/lame.h>
#include <tetskin/core/src/mesh/tet_geometry.h>
#include <tetskin/elastic/src/calibration/linear_elasticity.h>

#include <Eigen/LU>
#include <array>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

/// Gradients of the four barycentric weights.
std::array<Eigen::Vector3d, 4> gradientsOf(const TetCorners& corners) {
  const BarycentricMap map(corners);
  return {map.rows[0], map.rows[1], map.rows[2], -(map.rows[0] + map.rows[1] + map.rows[2])};
}

}  // namespace

Eigen::Matrix<double, 12, 12> tetStiffness(const TetCorners& corners, double poissonRatio) {
  const Lame material(1.0, poissonRatio);
  const double volume = std::abs(signedVolume(corners));
  const std::array<Eigen::Vector3d, 4> g = gradientsOf(corners);
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

Eigen::SparseMatrix<double> stiffnessMatrix(const TetMesh& mesh, double poissonRatio,
                                            const std::vector<double>& scale) {
  assert(scale.size() == mesh.tetCount());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(mesh.tetCount() * 78);
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
    const Tet& tet = mesh.tets[t];
    const Eigen::Matrix<double, 12, 12> stiffness = scale[t] * tetStiffness(cornersOf(mesh, tet), poissonRatio);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        if (tet[a] < tet[b]) continue;
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < (a == b ? i + 1 : 3); ++j) {
            entries.emplace_back(3 * tet[a] + i, 3 * tet[b] + j, stiffness(3 * a + i, 3 * b + j));
          }
        }
      }
    }
  }
  const auto size = static_cast<Eigen::Index>(3 * mesh.nodeCount());
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
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

RigidMotions::RigidMotions(const TetMesh& mesh, const Eigen::VectorXd& masses)
    : mesh_(mesh), masses_(masses), partOf_(mesh.nodeCount()) {
  DisjointSets sets(mesh.nodeCount());
  for (const Tet& tet : mesh.tets) {
    for (int k = 1; k < 4; ++k) sets.unite(tet[0], tet[k]);
  }
  std::vector<int> number(mesh.nodeCount(), -1);
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) {
    int& part = number[static_cast<std::size_t>(sets.find(static_cast<int>(n)))];
    if (part < 0) {
      part = static_cast<int>(parts_.size());
      parts_.emplace_back();
    }
    partOf_[n] = part;
    const double mass = masses[3 * static_cast<Eigen::Index>(n)];
    parts_[part].mass += mass;
    parts_[part].centre += mass * mesh.nodes[n];
  }
  for (Part& part : parts_) part.centre /= part.mass;
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) {
    Part& part = parts_[partOf_[n]];
    const Eigen::Vector3d arm = mesh.nodes[n] - part.centre;
    part.inertia += masses[3 * static_cast<Eigen::Index>(n)] *
                    (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
}

void RigidMotions::removeFrom(Eigen::VectorXd& displacement) const {
  std::vector<Eigen::Vector3d> push(parts_.size(), Eigen::Vector3d::Zero()), spin = push;
  for (std::size_t n = 0; n < partOf_.size(); ++n) {
    const auto at = static_cast<Eigen::Index>(3 * n);
    const Eigen::Vector3d momentum = masses_[at] * displacement.segment<3>(at);
    push[partOf_[n]] += momentum;
    spin[partOf_[n]] += (mesh_.nodes[n] - parts_[partOf_[n]].centre).cross(momentum);
  }
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    push[p] /= parts_[p].mass;
    spin[p] = parts_[p].inertia.ldlt().solve(spin[p]).eval();
  }
  for (std::size_t n = 0; n < partOf_.size(); ++n) {
    const int p = partOf_[n];
    displacement.segment<3>(static_cast<Eigen::Index>(3 * n)) -=
        push[p] + spin[p].cross(mesh_.nodes[n] - parts_[p].centre);
  }
}

void RigidMotions::balance(Eigen::VectorXd& load) const {
  Eigen::VectorXd acceleration = load.cwiseQuotient(masses_);
  removeFrom(acceleration);
  load = acceleration.cwiseProduct(masses_);
}

}  // namespace tetskin::elastic_detail
