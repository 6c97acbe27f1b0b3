// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/touch/src/tree/surface_ray_caster.h>

#include <cassert>
#include <numeric>

namespace tetskin::touch_detail {
namespace {

/// Triangles per leaf: few enough that few are tested in vain, many enough that fitting is cheap.
constexpr int kLeafSize = 4;

/// By vertex: the index at which a skin of this order writes it.
std::vector<std::uint32_t> indicesOf(const SoftBodyBinding& binding) {
  if (binding.options().order == VertexOrder::Sorted) return binding.embedding().vertexSlots();
  std::vector<std::uint32_t> indices(binding.embedding().vertexCount());
  std::iota(indices.begin(), indices.end(), 0u);
  return indices;
}

Eigen::Vector3d pointAt(PointView<const btScalar> points, int index) {
  const btScalar* p = points[static_cast<std::size_t>(index)];
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

}  // namespace

SurfaceRayCaster::SurfaceRayCaster(std::shared_ptr<const SoftBodyBinding> binding, const TriangleMesh& mesh)
    : binding_(std::move(binding)) {
  assert(!mesh.triangles.empty());
  Bvh::Centroids<double> centroids;
  centroids.reserve(mesh.triangleCount());
  for (const auto& triangle : mesh.triangles) {
    const TriangleCorners t = cornersOf(mesh, triangle);
    centroids.emplace_back(t[0] + t[1] + t[2]);
  }
  bvh_ = Bvh(centroids, kLeafSize);
  const std::vector<std::uint32_t> indices = indicesOf(*binding_);
  triangles_.reserve(mesh.triangleCount());
  for (const int t : bvh_.items()) {
    triangles_.push_back(mesh.triangles[static_cast<std::size_t>(t)]);
    for (int& corner : triangles_.back()) corner = static_cast<int>(indices[static_cast<std::size_t>(corner)]);
  }
}

TriangleCorners SurfaceRayCaster::cornersAt(int index) const {
  assert(index >= 0 && static_cast<std::size_t>(index) < triangles_.size());
  const auto& corners = triangles_[static_cast<std::size_t>(index)];
  const PointView<const btScalar> points = skin_.positions();
  return {pointAt(points, corners[0]), pointAt(points, corners[1]), pointAt(points, corners[2])};
}

StatusCode SurfaceRayCaster::fit(const SoftBodySkin& skin) {
  if (!skin.body()) return StatusCode::Unbound;
  if (skin.binding() != binding_) return StatusCode::OtherBody;
  const btSoftBody& body = *skin.body();
  if (static_cast<std::size_t>(body.m_nodes.size()) != binding_->embedding().nodeCount()) {
    return StatusCode::TopologyChanged;
  }
  const bool sameSurface = skin_.bound() && skin_.interpolation() == skin.interpolation();
  if (sameSurface && isFitted(body)) return StatusCode::Ok;
  nodes_.clear();
  if (sameSurface) {
    if (skin_.update(nodePositions(body)) != StatusCode::Ok) return StatusCode::NonFinite;
  } else {
    InstanceOptions options;
    options.disableQuadratic = skin.interpolation() == Interpolation::Linear;
    options.disableNormals = true;
    options.bounds = false;
    if (!skin_.bind(binding_, nodePositions(body), options).ok()) return StatusCode::NonFinite;
  }
  fitBoxes();
  keepNodes(body);
  return StatusCode::Ok;
}

void SurfaceRayCaster::fitBoxes() {
  assert(skin_.bound() && skin_.positions().size() == binding_->embedding().vertexCount());
  const PointView<const btScalar> points = skin_.positions();
  bvh_.fit(boxes_, [&](int index) {
    BvhBox<btScalar> box;
    for (const int p : triangles_[static_cast<std::size_t>(index)]) box.extend(points[static_cast<std::size_t>(p)]);
    return box;
  });
}

bool SurfaceRayCaster::isFitted(const btSoftBody& body) const {
  if (nodes_.size() != 3 * static_cast<std::size_t>(body.m_nodes.size())) return false;
  const btScalar* kept = nodes_.data();
  bool same = true;
  for (int n = 0; n < body.m_nodes.size() && same; ++n, kept += 3) {
    const btScalar* x = body.m_nodes[n].m_x.m_floats;
    same = (x[0] == kept[0]) & (x[1] == kept[1]) & (x[2] == kept[2]);
  }
  return same;
}

void SurfaceRayCaster::keepNodes(const btSoftBody& body) {
  assert(nodes_.empty());
  nodes_.reserve(3 * static_cast<std::size_t>(body.m_nodes.size()));
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    nodes_.insert(nodes_.end(), body.m_nodes[n].m_x.m_floats, body.m_nodes[n].m_x.m_floats + 3);
  }
}

RayHit SurfaceRayCaster::nearestHit(Ray ray, const TriangleFilter& filter) const {
  RayHit best;
  bvh_.visitAlong(boxes_, ray.start, ray.direction, ray.end, [&](int index, double& end) {
    ray.end = end;
    RayHit hit;
    if (!collides(ray, cornersAt(index), hit)) return;
    hit.triangle = bvh_.item(index);
    hit.index = index;
    if (best.triangle >= 0 && hit.at == best.at && hit.triangle > best.triangle) return;
    if (filter && !filter(hit.triangle)) return;
    best = hit;
    end = hit.at;
  });
  return best;
}

SurfaceHit SurfaceRayCaster::cast(const btVector3& from, const btVector3& to, const TriangleFilter& filter) const {
  assert(!nodes_.empty());
  const Ray ray{toEigen(from), toEigen(to) - toEigen(from)};
  SurfaceHit hit;
  const RayHit found = nearestHit(ray, filter);
  if (found.triangle < 0) return hit;
  hit.status = StatusCode::Ok;
  hit.triangle = found.triangle;
  hit.weights[1] = static_cast<btScalar>(found.second);
  hit.weights[2] = static_cast<btScalar>(found.third);
  hit.weights[0] = 1 - hit.weights[1] - hit.weights[2];
  hit.distance = static_cast<btScalar>(found.at * ray.direction.norm());
  hit.point = toBullet(ray.start + found.at * ray.direction);
  const auto& [a, b, c] = cornersAt(found.index);
  hit.normal = toBullet((b - a).cross(c - a).normalized());
  return hit;
}

}  // namespace tetskin::touch_detail
