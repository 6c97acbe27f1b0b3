// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/cross_matrix.h>
#include <tetskin/touch/src/points/point_jacobian.h>

#include <algorithm>
#include <cassert>
#include <limits>

namespace tetskin::touch_detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d positionOf(const btSoftBody& body, int node) {
  return toEigen(body.m_nodes[node].m_x);
}

/// By node: the matrix from its velocity to the angular velocity of all nodes about their centroid; zero if they lie on
/// a line.
struct Turning {
  std::vector<Vector3d> arms;
  Matrix3d inverse = Matrix3d::Zero();  ///< of the inertia of the nodes, each with mass 1
  bool possible = false;

  explicit Turning(std::vector<Vector3d> positions) : arms(std::move(positions)) {
    Vector3d centroid = Vector3d::Zero();
    for (const Vector3d& p : arms) centroid += p / static_cast<double>(arms.size());
    Matrix3d inertia = Matrix3d::Zero();
    for (Vector3d& p : arms) {
      p -= centroid;
      inertia += p.squaredNorm() * Matrix3d::Identity() - p * p.transpose();
    }
    // Relative to the third power of the trace (a cube has 1/27): nodes on a line have no inertia about it, except for
    // rounding.
    constexpr double kLine = 1e-9;
    const double size = inertia.trace();
    possible = inertia.determinant() > kLine * size * size * size;
    if (possible) inverse = inertia.inverse();
  }
  Matrix3d value(std::size_t k) const { return inverse * crossMatrix(arms[k]); }
};

PointJacobianNode& nodeIn(PointJacobian& jacobian, int node) {
  const auto found = std::find_if(jacobian.begin(), jacobian.end(),
                                  [&](const PointJacobianNode& thisNode) { return thisNode.node == node; });
  if (found != jacobian.end()) return *found;
  jacobian.emplace_back().node = node;
  return jacobian.back();
}

void addWeights(const std::array<int, 4>& nodes, const std::array<btScalar, 4>& weights, double fraction,
                PointJacobian& jacobian) {
  double left = 1.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double weight = k < 3 ? static_cast<double>(weights[k]) : left;
    left -= weight;
    nodeIn(jacobian, nodes[k]).linear += fraction * weight * Matrix3d::Identity();
  }
}

void addCorner(const EmbeddedPoint<btScalar>& corner, double fraction, const btSoftBody& body,
               PointJacobian& jacobian) {
  assert(corner.tet >= 0);
  if (corner.inside) return addWeights(corner.nodes, corner.weights, fraction, jacobian);
  std::vector<Vector3d> positions;
  Vector3d beyond = Vector3d::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    positions.push_back(positionOf(body, corner.nodes[k]));
    beyond += static_cast<double>(corner.weights[k] - corner.clampedWeights[k]) * (positions[k] - positions[0]);
  }
  const Turning turning(std::move(positions));
  if (!turning.possible) return addWeights(corner.nodes, corner.weights, fraction, jacobian);
  addWeights(corner.nodes, corner.clampedWeights, fraction, jacobian);
  for (std::size_t k = 0; k < 4; ++k) {
    nodeIn(jacobian, corner.nodes[k]).linear -= fraction * crossMatrix(beyond) * turning.value(k);
  }
}

}  // namespace

PointJacobian jacobianAt(const PointData& point, const btSoftBody& body) {
  PointJacobian jacobian;
  for (std::size_t c = 0; c < 3; ++c) {
    if (point.weights[c] != 0) addCorner(point.corners[c], static_cast<double>(point.weights[c]), body, jacobian);
  }
  return jacobian;
}

Matrix3d linearResponse(const PointJacobian& jacobian, const btSoftBody& body) {
  assert(jacobian.size() <= 12);
  Matrix3d sum = Matrix3d::Zero();
  for (const PointJacobianNode& node : jacobian) {
    sum += static_cast<double>(body.m_nodes[node.node].m_im) * node.linear * node.linear.transpose();
  }
  return sum;
}

double massOf(const Matrix3d& response) {
  const double inverse = response.trace() / 3.0;
  return inverse > 0.0 ? 1.0 / inverse : std::numeric_limits<double>::infinity();
}

}  // namespace tetskin::touch_detail
