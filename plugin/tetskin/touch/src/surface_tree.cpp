// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/mesh_skin.h>
#include <tetskin/touch/src/points/body_kind.h>
#include <tetskin/touch/src/points/point_data.h>
#include <tetskin/touch/src/tree/nearest_triangle.h>
#include <tetskin/touch/src/tree/radial_impulse.h>
#include <tetskin/touch/src/tree/surface_ray_caster.h>

#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

using touch_detail::PointData;

/// By how much the sum of a hit's weights may differ from 1.
constexpr btScalar kWeightsRounding = btScalar(1e-3);

Status checkMesh(const SoftBodyBinding* binding, const TriangleMesh& mesh) {
  if (!binding) return {StatusCode::Empty, "the binding is null; pass that of a bound skin"};
  if (Status status = validate(mesh); !status.ok()) return status;
  if (mesh.triangles.empty()) return {StatusCode::Empty, "the mesh has no triangles; ray casts need some"};
  if (binding->embedding().vertexCount() == mesh.vertexCount()) return {};
  return {StatusCode::SizeMismatch, "the binding belongs to another mesh: it has " +
                                        std::to_string(binding->embedding().vertexCount()) +
                                        " vertices, this mesh has " + std::to_string(mesh.vertexCount())};
}

}  // namespace

struct SurfaceTree::Impl {
  Status status;
  std::shared_ptr<const SoftBodyBinding> binding;
  TriangleMesh mesh;                     ///< positions and triangles
  std::vector<Eigen::Vector3d> normals;  ///< by vertex, at rest
  std::vector<double> areas;             ///< by vertex: its share of the surface at rest
  touch_detail::SurfaceRayCaster rays;
  touch_detail::RestTriangles rest;

  Status checkBody(const btSoftBody& body) const {
    if (!status.ok()) return status;
    if (binding->embedding().nodeCount() == static_cast<std::size_t>(body.m_nodes.size())) return {};
    return {StatusCode::SizeMismatch, "the body has " + std::to_string(body.m_nodes.size()) +
                                          " nodes, but the cage of the tree has " +
                                          std::to_string(binding->embedding().nodeCount())};
  }
  SurfacePoint pointOf(btSoftBody& body, std::size_t triangle, const std::array<btScalar, 3>& weights,
                       int firstCorner) const;
};

/// firstCorner  the corner of the triangle that the first weight belongs to
SurfacePoint SurfaceTree::Impl::pointOf(btSoftBody& body, std::size_t triangle, const std::array<btScalar, 3>& weights,
                                        int firstCorner) const {
  assert(triangle < mesh.triangleCount() && firstCorner >= 0 && firstCorner < 3);
  PointData data;
  data.weights = weights;
  Eigen::Vector3d corners[3], normal = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const auto vertex = static_cast<std::size_t>(mesh.triangles[triangle][(firstCorner + k) % 3]);
    data.corners[k] = binding->embedding().at<btScalar>(vertex);
    corners[k] = mesh.positions[vertex];
    normal += static_cast<double>(weights[k]) * normals[vertex];
  }
  const Eigen::Vector3d side = corners[1] - corners[0], area = side.cross(corners[2] - corners[0]);
  if (area.norm() > 0.0 && side.norm() > 0.0 && normal.norm() > 0.0) {
    const Eigen::Vector3d tangent = side.normalized(), out = area.normalized(), across = out.cross(tangent);
    normal.normalize();
    data.restNormal = toBullet({normal.dot(tangent), normal.dot(across), normal.dot(out)});
  }
  return Access<SurfacePoint>::create(body, data);
}

SurfaceTree::SurfaceTree(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Result<SurfaceTree> SurfaceTree::create(std::shared_ptr<const SoftBodyBinding> binding, const TriangleMesh& mesh) {
  if (Status status = checkMesh(binding.get(), mesh); !status.ok()) return status;
  auto impl = std::make_unique<Impl>();
  impl->binding = std::move(binding);
  impl->mesh.positions = mesh.positions;
  impl->mesh.triangles = mesh.triangles;
  impl->normals = restNormals(mesh);
  impl->areas = touch_detail::vertexAreas(mesh);
  assert(impl->normals.size() == mesh.vertexCount() && impl->areas.size() == mesh.vertexCount());
  impl->rays = touch_detail::SurfaceRayCaster(impl->binding, mesh);
  impl->rest = touch_detail::RestTriangles(mesh);
  return SurfaceTree(std::move(impl));
}

SurfaceTree::~SurfaceTree() = default;
SurfaceTree::SurfaceTree(SurfaceTree&&) noexcept = default;
SurfaceTree& SurfaceTree::operator=(SurfaceTree&&) noexcept = default;

/// The parts of this tree; if it was moved from, those of an empty tree.
SurfaceTree::Impl& SurfaceTree::impl() const {
  static Impl movedFrom{{StatusCode::Empty, "the surface tree has been moved from"}, {}, {}, {}, {}, {}, {}};
  return impl_ ? *impl_ : movedFrom;
}

SurfaceHit SurfaceTree::raycast(const SoftBodySkin& skin, const btVector3& from, const btVector3& to,
                                const TriangleFilter& filter) const {
  SurfaceHit hit;
  if (!impl().status.ok()) return hit;
  if (!touch_detail::isFiniteVector(from) || !touch_detail::isFiniteVector(to)) {
    hit.status = StatusCode::NonFinite;
    return hit;
  }
  hit.status = impl().rays.fit(skin);
  if (hit.status == StatusCode::Ok) hit = impl().rays.cast(from, to, filter);
  if (hit) hit.body = skin.body();
  return hit;
}

Result<SurfacePoint> SurfaceTree::pointAt(btSoftBody& body, const SurfaceHit& hit) const {
  if (Status status = impl().checkBody(body); !status.ok()) return status;
  if (!hit || hit.triangle < 0 || static_cast<std::size_t>(hit.triangle) >= impl().mesh.triangleCount()) {
    return Status{StatusCode::InvalidOption, "the ray has hit nothing; check the hit before using it"};
  }
  btScalar sum = 0;
  for (const btScalar w : hit.weights) sum += w;
  if (!(btFabs(sum - 1) < kWeightsRounding)) {
    return Status{StatusCode::InvalidOption, "the weights of the hit do not add up to 1"};
  }
  if (hit.body != &body) return Status{StatusCode::InvalidOption, "the ray has hit another body"};
  return impl().pointOf(body, static_cast<std::size_t>(hit.triangle), {hit.weights[0], hit.weights[1], hit.weights[2]},
                        0);
}

Result<SurfacePoint> SurfaceTree::pointAtVertex(btSoftBody& body, int vertex) const {
  if (Status status = impl().checkBody(body); !status.ok()) return status;
  const touch_detail::NearestTriangle found = impl().rest.largestAround(vertex);
  if (found.triangle < 0) {
    return Status{StatusCode::IndexOutOfRange, "no triangle of the mesh uses vertex " + std::to_string(vertex)};
  }
  return impl().pointOf(body, static_cast<std::size_t>(found.triangle), {1, 0, 0}, found.firstCorner);
}

Result<SurfacePoint> SurfaceTree::pointAtRest(btSoftBody& body, const Eigen::Vector3d& rest) const {
  if (Status status = impl().checkBody(body); !status.ok()) return status;
  if (!std::isfinite(rest.squaredNorm()))
    return Status{StatusCode::NonFinite, "the rest position is not finite, or too far away"};
  const touch_detail::NearestTriangle found = impl().rest.nearest(impl().mesh, impl().rays.tree(), rest);
  const auto& w = found.weights;
  return impl().pointOf(body, static_cast<std::size_t>(found.triangle),
                        {static_cast<btScalar>(w[0]), static_cast<btScalar>(w[1]), static_cast<btScalar>(w[2])}, 0);
}

ImpulseResult SurfaceTree::applyImpulse(btSoftBody& body, const RadialImpulse& impulse) const {
  touch_detail::NodePushes pushes;
  ImpulseResult push = {StatusCode::OtherBody};
  if (!impl().checkBody(body).ok()) return push;
  push = touch_detail::pushesOf(impulse, impl().binding->embedding(), impl().areas, body, pushes);
  if (push.status != StatusCode::Ok) return push;
  if (touch_detail::isReduced(body)) return {StatusCode::InvalidOption};
  touch_detail::applyImpulses(pushes, body);
  return push;
}

ImpulseResult SurfaceTree::applyForce(btSoftBody& body, const RadialImpulse& force, int steps) const {
  touch_detail::NodePushes pushes;
  ImpulseResult push = {StatusCode::OtherBody};
  if (!impl().checkBody(body).ok()) return push;
  push = touch_detail::pushesOf(force, impl().binding->embedding(), impl().areas, body, pushes);
  if (push.status != StatusCode::Ok) return push;
  const StatusCode done = touch_detail::applyForces(std::move(pushes), steps, body);
  if (done != StatusCode::Ok) return {done};
  return push;
}

}  // namespace tetskin
