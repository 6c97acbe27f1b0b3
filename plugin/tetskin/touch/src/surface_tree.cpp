// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/mesh_skin.h>
#include <tetskin/touch/src/points/body_kind.h>
#include <tetskin/touch/src/tree/blast.h>
#include <tetskin/touch/src/tree/nearest_triangle.h>
#include <tetskin/touch/src/tree/surface_ray_caster.h>

#include <cmath>

namespace tetskin {
namespace {

using touch_detail::PointData;

/// What may be missing of 1 in the weights of a hit.
constexpr btScalar kWeightsRounding = btScalar(1e-3);

Status checkMesh(const SoftBodyBinding* binding, const TriangleMesh& mesh) {
  if (!binding) return {StatusCode::Empty, "a surface tree needs a binding: that of a bound skin"};
  if (Status status = checkTriangleMesh(mesh); !status.ok()) return status;
  if (mesh.triangles.empty()) return {StatusCode::Empty, "the mesh has no triangles that a ray could meet"};
  if (binding->embedding().vertexCount() == mesh.vertexCount()) return {};
  return {StatusCode::SizeMismatch, "the binding is of another mesh: it has " +
                                        std::to_string(binding->embedding().vertexCount()) + " vertices, this one " +
                                        std::to_string(mesh.vertexCount())};
}

}  // namespace

struct SurfaceTree::Parts {
  Status status;
  std::shared_ptr<const SoftBodyBinding> binding;
  TriangleMesh mesh;                     ///< positions and triangles
  std::vector<Eigen::Vector3d> normals;  ///< by vertex, at rest
  std::vector<double> areas;             ///< by vertex: its share of the surface at rest
  touch_detail::SurfaceRayCaster rays;

  Status checkBody(const btSoftBody& body) const {
    if (!status.ok()) return status;
    if (binding->embedding().nodeCount() == static_cast<std::size_t>(body.m_nodes.size())) return {};
    return {StatusCode::SizeMismatch, "the body has " + std::to_string(body.m_nodes.size()) +
                                          " nodes, but the tree's cage " +
                                          std::to_string(binding->embedding().nodeCount())};
  }
  SurfacePoint pointOf(btSoftBody& body, std::size_t triangle, const std::array<btScalar, 3>& shares,
                       int firstCorner) const;
};

/// firstCorner  of the triangle, which its shares begin with
SurfacePoint SurfaceTree::Parts::pointOf(btSoftBody& body, std::size_t triangle, const std::array<btScalar, 3>& shares,
                                         int firstCorner) const {
  PointData data;
  data.shares = shares;
  Eigen::Vector3d corners[3], normal = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const auto vertex = static_cast<std::size_t>(mesh.triangles[triangle][(firstCorner + k) % 3]);
    data.corners[k] = binding->embedding().at<btScalar>(vertex);
    corners[k] = mesh.positions[vertex];
    normal += static_cast<double>(shares[k]) * normals[vertex];
  }
  const Eigen::Vector3d side = corners[1] - corners[0], area = side.cross(corners[2] - corners[0]);
  if (area.norm() > 0.0 && side.norm() > 0.0 && normal.norm() > 0.0) {
    const Eigen::Vector3d tangent = side.normalized(), out = area.normalized(), across = out.cross(tangent);
    normal.normalize();
    data.restNormal = toBullet({normal.dot(tangent), normal.dot(across), normal.dot(out)});
  }
  return {body, data};
}

SurfaceTree::SurfaceTree(std::shared_ptr<const SoftBodyBinding> binding, const TriangleMesh& mesh)
    : parts_(std::make_unique<Parts>()) {
  Parts& parts = *parts_;
  parts.status = checkMesh(binding.get(), mesh);
  if (!parts.status.ok()) return;
  parts.binding = std::move(binding);
  parts.mesh.positions = mesh.positions;
  parts.mesh.triangles = mesh.triangles;
  parts.normals = restNormals(mesh);
  parts.areas = touch_detail::vertexAreas(mesh);
  parts.rays = touch_detail::SurfaceRayCaster(parts.binding, mesh);
}

SurfaceTree::~SurfaceTree() = default;
SurfaceTree::SurfaceTree(SurfaceTree&&) noexcept = default;
SurfaceTree& SurfaceTree::operator=(SurfaceTree&&) noexcept = default;

/// Of one that was moved from: those of an empty tree.
SurfaceTree::Parts& SurfaceTree::parts() const {
  static Parts movedFrom{{StatusCode::Empty, "the surface tree was moved elsewhere"}, {}, {}, {}, {}, {}};
  return parts_ ? *parts_ : movedFrom;
}

const Status& SurfaceTree::check() const {
  return parts().status;
}

SurfaceHit SurfaceTree::raycast(const SoftBodySkin& skin, const btVector3& from, const btVector3& to,
                                const TriangleFilter& filter) const {
  SurfaceHit hit;
  if (!parts().status.ok()) return hit;
  if (!touch_detail::isFiniteVector(from) || !touch_detail::isFiniteVector(to)) {
    hit.status = TouchStatus::NonFinite;
    return hit;
  }
  hit.status = parts().rays.fit(skin);
  if (hit.status == TouchStatus::Ok) hit = parts().rays.cast(from, to, filter);
  if (hit) hit.body = skin.body();
  return hit;
}

Result<SurfacePoint> SurfaceTree::pointAt(btSoftBody& body, const SurfaceHit& hit) const {
  if (Status status = parts().checkBody(body); !status.ok()) return status;
  if (!hit || hit.triangle < 0 || static_cast<std::size_t>(hit.triangle) >= parts().mesh.triangleCount()) {
    return Status{StatusCode::InvalidOption, "the ray has met nothing: ask the hit first"};
  }
  btScalar sum = 0;
  for (const btScalar w : hit.weights) sum += w;
  if (!(btFabs(sum - 1) < kWeightsRounding)) {
    return Status{StatusCode::InvalidOption, "the weights of the hit do not add up to 1"};
  }
  if (hit.body != &body) return Status{StatusCode::InvalidOption, "the ray has hit another body"};
  return parts().pointOf(body, static_cast<std::size_t>(hit.triangle), {hit.weights[0], hit.weights[1], hit.weights[2]},
                         0);
}

Result<SurfacePoint> SurfaceTree::pointOfVertex(btSoftBody& body, int vertex) const {
  if (Status status = parts().checkBody(body); !status.ok()) return status;
  const touch_detail::NearestTriangle found = touch_detail::largestAround(parts().mesh, vertex);
  if (found.triangle < 0) {
    return Status{StatusCode::IndexOutOfRange, "no triangle of the mesh has a vertex " + std::to_string(vertex)};
  }
  return parts().pointOf(body, static_cast<std::size_t>(found.triangle), {1, 0, 0}, found.firstCorner);
}

Result<SurfacePoint> SurfaceTree::pointAtRest(btSoftBody& body, const Eigen::Vector3d& rest) const {
  if (Status status = parts().checkBody(body); !status.ok()) return status;
  if (!std::isfinite(rest.squaredNorm()))
    return Status{StatusCode::NonFinite, "the rest position is not finite, or too far for a distance from it to be"};
  const touch_detail::NearestTriangle found = touch_detail::nearestTriangle(parts().mesh, rest);
  const auto& w = found.weights;
  return parts().pointOf(body, static_cast<std::size_t>(found.triangle),
                         {static_cast<btScalar>(w[0]), static_cast<btScalar>(w[1]), static_cast<btScalar>(w[2])}, 0);
}

SurfacePush SurfaceTree::applyImpulse(btSoftBody& body, const SurfaceBlast& blast) const {
  touch_detail::NodePushes pushes;
  SurfacePush push = {TouchStatus::OtherBody};
  if (!parts().checkBody(body).ok()) return push;
  push = touch_detail::pushesOf(blast, parts().binding->embedding(), parts().areas, body, pushes);
  if (push.status != TouchStatus::Ok) return push;
  if (touch_detail::isReduced(body)) return {TouchStatus::InvalidOption};
  touch_detail::applyImpulses(pushes, body);
  return push;
}

SurfacePush SurfaceTree::applyForce(btSoftBody& body, const SurfaceBlast& blast, int steps) const {
  touch_detail::NodePushes pushes;
  SurfacePush push = {TouchStatus::OtherBody};
  if (!parts().checkBody(body).ok()) return push;
  push = touch_detail::pushesOf(blast, parts().binding->embedding(), parts().areas, body, pushes);
  if (push.status != TouchStatus::Ok) return push;
  const TouchStatus done = touch_detail::applyForces(std::move(pushes), steps, body, nullptr);
  if (done != TouchStatus::Ok) return {done};
  return push;
}

}  // namespace tetskin
