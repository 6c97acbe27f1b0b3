// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/embedding.h>
#include <tetskin/core/src/base/mesh/face_neighbours.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/reduced/src/modes/cage_modes.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tetskin::reduced_detail {
namespace {

/// Weight of the cage's own bending relative to the fine nodes' distances: small enough not to affect these; it
/// determines nodes that carry almost nothing.
constexpr double kBendingWeight = 1e-6;
/// Smallest mass of a node relative to the mean: nodes that carry nothing, or only nodes outside, would have none.
constexpr double kMinMass = 1e-3;
/// Fraction of the diagonal of the cage's box: if fine nodes are farther outside, they are not at the cage's position.
constexpr double kFarOutside = 0.2;

using Sparse = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

struct Weights {
  Sparse matrix;  ///< fine nodes x nodes of the cage
  std::size_t outside = 0;
};

Status checkNodeTets(const std::vector<int>& nodeTets, std::size_t nodes, const TetMesh& cage) {
  if (nodeTets.size() != nodes) {
    return {StatusCode::SizeMismatch, "nodeTets has " + std::to_string(nodeTets.size()) + " values for " +
                                          std::to_string(nodes) + " nodes of the tets of the modes"};
  }
  for (const int tet : nodeTets) {
    if (tet < 0 || static_cast<std::size_t>(tet) >= cage.tetCount()) {
      return {StatusCode::IndexOutOfRange,
              "nodeTets refers to tet " + std::to_string(tet) + ", which the cage does not have"};
    }
  }
  return {};
}

Status checkPosition(const std::vector<Eigen::Vector3d>& nodes, const TetMesh& cage) {
  Box3 around = boundingBox(cage.nodes);
  const double far = kFarOutside * around.diagonal().norm();
  around.extend((around.min().array() - far).matrix()).extend((around.max().array() + far).matrix());
  if (around.contains(boundingBox(nodes))) return {};
  return {StatusCode::OutsideCage, "the tets of the modes do not overlap with the cage"};
}

Result<Weights> weightsOf(const std::vector<Eigen::Vector3d>& nodes, const TetMesh& cage,
                          const std::vector<int>& nodeTets) {
  Weights weights;
  Triplets entries;
  if (nodeTets.empty()) {
    const Result<Embedding> embedding = embed(cage, viewOf(nodes));
    if (!embedding.ok()) return embedding.status();
    const std::vector<VertexBinding> bindings = embedding.value().bindings();
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (!bindings[n].inside) ++weights.outside;
      for (std::size_t k = 0; k < 4; ++k) {
        entries.emplace_back(static_cast<int>(n), cage.tets[bindings[n].tet][k], bindings[n].weights[k]);
      }
    }
  } else {
    if (Status status = checkNodeTets(nodeTets, nodes.size(), cage); !status.ok()) return status;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const Tet& tet = cage.tets[nodeTets[n]];
      const Eigen::Vector4d value = BarycentricMap(cornersOf(cage, tet))(nodes[n]);
      if (barycentricDistance(value) > 1e-6) ++weights.outside;
      for (int k = 0; k < 4; ++k) entries.emplace_back(static_cast<int>(n), tet[k], value[k]);
    }
  }
  weights.matrix.resize(static_cast<Eigen::Index>(nodes.size()), static_cast<Eigen::Index>(cage.nodeCount()));
  weights.matrix.setFromTriplets(entries.begin(), entries.end());
  return weights;
}

/// The squared change of gradients from tet to tet, which is 0 for affine displacements. Weighted by volume and by
/// squared length, to have the unit of squared displacements.
Sparse bendingOf(const TetMesh& cage) {
  const Lists<> neighbours = faceNeighbours(cage);
  Triplets entries;
  for (std::size_t face = 0; face + 1 < neighbours.starts.size(); ++face) {
    const auto a = static_cast<std::uint32_t>(face / 4);
    for (std::uint32_t k = neighbours.starts[face]; k < neighbours.starts[face + 1]; ++k) {
      const std::uint32_t b = neighbours.values[k];
      if (b < a) continue;
      std::vector<std::pair<int, Eigen::Vector3d>> change;
      double volume = 0.0;
      for (const auto& [tet, sign] : {std::pair{a, 1.0}, std::pair{b, -1.0}}) {
        const TetCorners corners = cornersOf(cage, cage.tets[tet]);
        const std::array<Eigen::Vector3d, 4> gradients = BarycentricMap(corners).gradients();
        for (int c = 0; c < 4; ++c) change.emplace_back(cage.tets[tet][c], sign * gradients[c]);
        volume += 0.5 * std::abs(signedVolume(corners));
      }
      const double weight = volume * std::pow(volume, 2.0 / 3.0);
      for (const auto& [i, u] : change) {
        for (const auto& [j, v] : change) entries.emplace_back(i, j, weight * u.dot(v));
      }
    }
  }
  const auto count = static_cast<Eigen::Index>(cage.nodeCount());
  Sparse bending(count, count);
  bending.setFromTriplets(entries.begin(), entries.end());
  return bending;
}

/// Three columns per mode.
Eigen::MatrixXd columnsOf(const VibrationModes& modes, std::size_t count) {
  assert(count <= modes.shapes.size());
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(modes.nodeCount()), static_cast<Eigen::Index>(3 * count));
  for (std::size_t r = 0; r < count; ++r) {
    for (std::size_t n = 0; n < modes.nodeCount(); ++n) {
      for (std::size_t k = 0; k < 3; ++k) {
        columns(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(3 * r + k)) = modes.shapes[r][3 * n + k];
      }
    }
  }
  return columns;
}

void measureFineBody(const VibrationModes& modes, CageModes& result) {
  for (std::size_t n = 0; n < modes.nodeCount(); ++n) {
    result.mass += modes.masses[n];
    result.centre += modes.masses[n] * modes.nodes[n];
  }
  result.centre /= result.mass;
  for (std::size_t n = 0; n < modes.nodeCount(); ++n) {
    const Eigen::Vector3d arm = modes.nodes[n] - result.centre;
    result.inertia += modes.masses[n] * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
}

std::vector<double> massesOf(const Eigen::VectorXd& carried, double total) {
  assert(total > 0.0 && carried.size() > 0);
  const double minimum = kMinMass * total / static_cast<double>(carried.size());
  std::vector<double> masses;
  for (const double mass : carried) masses.push_back(std::max(mass, minimum));
  const double scale = total / std::accumulate(masses.begin(), masses.end(), 0.0);
  for (double& mass : masses) mass *= scale;
  return masses;
}

/// True for nodes of the cage that carry more pinned than free fine nodes.
std::vector<char> pinnedNodes(const VibrationModes& modes, const Sparse& carried) {
  assert(carried.rows() == static_cast<Eigen::Index>(modes.nodeCount()));
  Eigen::VectorXd pinned = Eigen::VectorXd::Zero(carried.rows());
  for (const int n : modes.pinned) pinned[n] = modes.masses[static_cast<std::size_t>(n)];
  const Eigen::Map<const Eigen::VectorXd> masses(modes.masses.data(), carried.rows());
  const Eigen::VectorXd ofPinned = carried.transpose() * pinned, all = carried.transpose() * masses;
  std::vector<char> pinnedMass;
  for (Eigen::Index n = 0; n < all.size(); ++n) pinnedMass.push_back(ofPinned[n] > 0.5 * all[n]);
  return pinnedMass;
}

}  // namespace

Result<CageModes> modesOfCage(const VibrationModes& modes, std::size_t count, const TetMesh& cage,
                              const std::vector<int>& nodeTets) {
  assert(count > 0 && count <= modes.modeCount());
  if (Status status = checkPosition(modes.nodes, cage); !status.ok()) return status;
  const Result<Weights> weights = weightsOf(modes.nodes, cage, nodeTets);
  if (!weights.ok()) return weights.status();
  const Sparse& carried = weights.value().matrix;
  CageModes result;
  result.outside = weights.value().outside;
  measureFineBody(modes, result);

  const Eigen::Map<const Eigen::VectorXd> masses(modes.masses.data(), static_cast<Eigen::Index>(modes.nodeCount()));
  const Sparse byMass = masses.asDiagonal() * carried;
  const Sparse products = Sparse(carried.transpose()) * byMass;
  const Sparse bending = bendingOf(cage);
  // A fixed fraction even if masses are not volumes.
  const double scale = kBendingWeight * products.diagonal().sum() / bending.diagonal().sum();
  const Eigen::SimplicialLDLT<Sparse> factors(products + scale * bending);
  if (factors.info() != Eigen::Success) {
    return Status{StatusCode::Degenerate,
                  "the modes do not determine the motion of the cage's nodes: the cage is at another position"};
  }
  const Eigen::MatrixXd fine = columnsOf(modes, count);
  const Eigen::MatrixXd coarse = factors.solve(byMass.transpose() * fine);
  const Eigen::MatrixXd errors = carried * coarse - fine;

  result.pinned = pinnedNodes(modes, carried);
  result.masses = massesOf(byMass.transpose() * Eigen::VectorXd::Ones(carried.rows()), result.mass);
  for (std::size_t r = 0; r < count; ++r) {
    const auto first = static_cast<Eigen::Index>(3 * r);
    const auto norm = [&](const Eigen::MatrixXd& value) {
      return std::sqrt((masses.asDiagonal() * value.middleCols(first, 3).cwiseAbs2()).sum());
    };
    result.projectionErrors.push_back(norm(errors) / norm(fine));
    result.momenta.push_back(fine.middleCols(first, 3).transpose() * masses);
    result.shapes.emplace_back(3 * cage.nodeCount());
    for (std::size_t k = 0; k < 3 * cage.nodeCount(); ++k) {
      result.shapes.back()[k] = coarse(static_cast<Eigen::Index>(k / 3), first + static_cast<Eigen::Index>(k % 3));
    }
  }
  return result;
}

}  // namespace tetskin::reduced_detail
