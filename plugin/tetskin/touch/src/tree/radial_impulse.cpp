// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/touch/src/points/body_kind.h>
#include <tetskin/touch/src/points/point_data.h>
#include <tetskin/touch/src/tree/radial_impulse.h>

#include <cassert>

namespace tetskin::touch_detail {
namespace {

using Eigen::Vector3d;

/// A vertex within reach, and its share of the push.
struct Reached {
  EmbeddedPoint<btScalar> vertex;
  Vector3d position, push;
};

std::vector<Reached> reachedBy(const RadialImpulse& impulse, const Embedding& embedding,
                               const std::vector<double>& areas, const btSoftBody& body) {
  std::vector<Reached> reached;
  const Vector3d centre = toEigen(impulse.centre);
  const auto radius = static_cast<double>(impulse.radius);
  assert(radius > 0.0);
  double sum = 0.0;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    const auto vertex = embedding.at<btScalar>(v);
    const Vector3d position = toEigen(vertex.position(positionsIn(body)));
    const Vector3d away = position - centre;
    const double distance = away.norm(), part = areas[v] * (1.0 - distance / radius);
    if (!(part > 0.0) || !(distance > 0.0)) continue;
    reached.push_back({vertex, position, part / distance * away});
    sum += part;
  }
  for (Reached& near : reached) near.push *= static_cast<double>(impulse.strength) / sum;
  return reached;
}

}  // namespace

std::vector<double> vertexAreas(const TriangleMesh& mesh) {
  std::vector<double> areas(mesh.vertexCount(), 0.0);
  for (const auto& triangle : mesh.triangles) {
    const Vector3d& a = mesh.positions[static_cast<std::size_t>(triangle[0])];
    const Vector3d& b = mesh.positions[static_cast<std::size_t>(triangle[1])];
    const Vector3d& c = mesh.positions[static_cast<std::size_t>(triangle[2])];
    for (const int v : triangle) areas[static_cast<std::size_t>(v)] += (b - a).cross(c - a).norm() / 6.0;
  }
  return areas;
}

ImpulseResult pushesOf(const RadialImpulse& impulse, const Embedding& embedding, const std::vector<double>& areas,
                       const btSoftBody& body, NodePushes& pushes) {
  assert(areas.size() == embedding.vertexCount());
  ImpulseResult done;
  const btVector3 sizes(impulse.radius, impulse.strength, 0);
  if (!isFiniteVector(impulse.centre) || !isFiniteVector(sizes)) return {StatusCode::NonFinite};
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    if (!isFiniteVector(body.m_nodes[n].m_x)) return {StatusCode::NonFinite};
  }
  if (!(impulse.radius > 0)) return {StatusCode::InvalidOption};
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
  std::vector<Vector3d> ofNodes(static_cast<std::size_t>(body.m_nodes.size()), Vector3d::Zero());
  for (const Reached& reached : reachedBy(impulse, embedding, areas, body)) {
    PointData point;
    point.corners[0] = reached.vertex;
    for (const PointJacobianNode& node : jacobianAt(point, body)) {
      ofNodes[static_cast<std::size_t>(node.node)] += node.linear.transpose() * reached.push;
    }
    linear += reached.push;
    angular += reached.position.cross(reached.push);
    ++done.vertices;
  }
  if (done.vertices == 0) done.status = StatusCode::NoHit;
  for (std::size_t n = 0; n < ofNodes.size(); ++n) {
    if (!ofNodes[n].isZero(0.0)) pushes.push_back({static_cast<int>(n), ofNodes[n]});
  }
  done.linear = toBullet(linear);
  done.angular = toBullet(angular);
  return done;
}

}  // namespace tetskin::touch_detail
