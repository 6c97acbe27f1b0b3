// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/touch/src/points/lever.h>

#include <algorithm>
#include <limits>

namespace tetskin::touch_detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d placeOf(const btSoftBody& body, int node) {
  return toEigen(body.m_nodes[node].m_x);
}

Matrix3d crossMatrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// By node: from its velocity to how fast all turn, for nodes about their centroid; nothing where they stand in a line.
struct Turning {
  std::vector<Vector3d> arms;
  Matrix3d inverse = Matrix3d::Zero();  ///< of their inertia, each of mass 1
  bool possible = false;

  explicit Turning(std::vector<Vector3d> places) : arms(std::move(places)) {
    Vector3d centroid = Vector3d::Zero();
    for (const Vector3d& p : arms) centroid += p / static_cast<double>(arms.size());
    Matrix3d inertia = Matrix3d::Zero();
    for (Vector3d& p : arms) {
      p -= centroid;
      inertia += p.squaredNorm() * Matrix3d::Identity() - p * p.transpose();
    }
    constexpr double kLine = 1e-9;
    const double size = inertia.trace();
    possible = inertia.determinant() > kLine * size * size * size;
    if (possible) inverse = inertia.inverse();
  }
  Matrix3d of(std::size_t k) const { return inverse * crossMatrix(arms[k]); }
};

LeverNode& nodeIn(Lever& lever, int node) {
  const auto found = std::find_if(lever.begin(), lever.end(), [&](const LeverNode& of) { return of.node == node; });
  if (found != lever.end()) return *found;
  lever.emplace_back().node = node;
  return lever.back();
}

void addWeights(const std::array<int, 4>& nodes, const std::array<btScalar, 4>& weights, double share, Lever& lever) {
  double left = 1.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double weight = k < 3 ? static_cast<double>(weights[k]) : left;
    left -= weight;
    nodeIn(lever, nodes[k]).linear += share * weight * Matrix3d::Identity();
  }
}

void addCorner(const EmbeddedPoint<btScalar>& corner, double share, const btSoftBody& body, Lever& lever) {
  if (corner.inside) return addWeights(corner.nodes, corner.weights, share, lever);
  std::vector<Vector3d> places;
  Vector3d beyond = Vector3d::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    places.push_back(placeOf(body, corner.nodes[k]));
    beyond += static_cast<double>(corner.weights[k] - corner.clamped[k]) * (places[k] - places[0]);
  }
  const Turning turning(std::move(places));
  if (!turning.possible) return addWeights(corner.nodes, corner.weights, share, lever);
  addWeights(corner.nodes, corner.clamped, share, lever);
  for (std::size_t k = 0; k < 4; ++k) {
    nodeIn(lever, corner.nodes[k]).linear -= share * crossMatrix(beyond) * turning.of(k);
  }
}

}  // namespace

Lever leverOf(const PointData& point, const btSoftBody& body) {
  Lever lever;
  for (std::size_t c = 0; c < 3; ++c) {
    if (point.shares[c] != 0) addCorner(point.corners[c], static_cast<double>(point.shares[c]), body, lever);
  }
  return lever;
}

Matrix3d linearResponse(const Lever& lever, const btSoftBody& body) {
  Matrix3d sum = Matrix3d::Zero();
  for (const LeverNode& of : lever) {
    sum += static_cast<double>(body.m_nodes[of.node].m_im) * of.linear * of.linear.transpose();
  }
  return sum;
}

double massOf(const Matrix3d& response) {
  const double inverse = response.trace() / 3.0;
  return inverse > 0.0 ? 1.0 / inverse : std::numeric_limits<double>::infinity();
}

}  // namespace tetskin::touch_detail
