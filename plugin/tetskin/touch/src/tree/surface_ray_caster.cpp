// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/touch/src/tree/surface_ray_caster.h>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace tetskin::touch_detail {
namespace {

/// By vertex: where a skin of this order writes it.
std::vector<std::uint32_t> placesOf(const SoftBodyBinding& binding) {
  if (binding.options().order == VertexOrder::Sorted) return binding.embedding().vertexSlots();
  std::vector<std::uint32_t> places(binding.embedding().vertexCount());
  std::iota(places.begin(), places.end(), 0u);
  return places;
}

Eigen::Vector3d pointAt(PointView<const btScalar> points, int place) {
  const btScalar* p = points[static_cast<std::size_t>(place)];
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

}  // namespace

SurfaceRayCaster::SurfaceRayCaster(std::shared_ptr<const SoftBodyBinding> binding, const TriangleMesh& mesh)
    : binding_(std::move(binding)), triangles_(mesh.triangles) {
  const std::vector<std::uint32_t> places = placesOf(*binding_);
  tree_ = RayTree(mesh, places);
  for (auto& triangle : triangles_) {
    for (int& corner : triangle) corner = static_cast<int>(places[static_cast<std::size_t>(corner)]);
  }
}

TouchStatus SurfaceRayCaster::fit(const SoftBodySkin& skin) {
  if (!skin.body()) return TouchStatus::Unbound;
  if (skin.binding() != binding_) return TouchStatus::OtherBody;
  const btSoftBody& body = *skin.body();
  if (static_cast<std::size_t>(body.m_nodes.size()) != binding_->embedding().nodeCount()) {
    return TouchStatus::TopologyChanged;
  }
  const bool sameSurface = skin_.bound() && skin_.interpolation() == skin.interpolation();
  if (sameSurface && isFitted(body)) return TouchStatus::Ok;
  nodes_.clear();
  if (sameSurface) {
    if (skin_.update(nodePositions(body)) != UpdateStatus::Updated) return TouchStatus::NonFinite;
  } else {
    InstanceOptions options;
    options.leaveOutQuadratic = skin.interpolation() == Interpolation::Linear;
    options.leaveOutNormals = true;
    options.bounds = false;
    if (!skin_.bind(binding_, nodePositions(body), options).ok()) return TouchStatus::NonFinite;
  }
  tree_.fit(skin_.positions());
  keepNodes(body);
  return TouchStatus::Ok;
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
  nodes_.reserve(3 * static_cast<std::size_t>(body.m_nodes.size()));
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    nodes_.insert(nodes_.end(), body.m_nodes[n].m_x.m_floats, body.m_nodes[n].m_x.m_floats + 3);
  }
}

SurfaceHit SurfaceRayCaster::cast(const btVector3& from, const btVector3& to, const TriangleFilter& filter) const {
  assert(!nodes_.empty());
  const Ray ray{toEigen(from), toEigen(to) - toEigen(from)};
  SurfaceHit hit;
  const RayHit found = tree_.cast(ray, filter);
  if (found.triangle < 0) return hit;
  hit.status = TouchStatus::Ok;
  hit.triangle = found.triangle;
  hit.weights[1] = static_cast<btScalar>(found.second);
  hit.weights[2] = static_cast<btScalar>(found.third);
  hit.weights[0] = 1 - hit.weights[1] - hit.weights[2];
  hit.distance = static_cast<btScalar>(found.at * ray.along.norm());
  hit.point = toBullet(ray.start + found.at * ray.along);
  const auto& corners = triangles_[static_cast<std::size_t>(found.triangle)];
  const Eigen::Vector3d a = pointAt(skin_.positions(), corners[0]);
  const Eigen::Vector3d area =
      (pointAt(skin_.positions(), corners[1]) - a).cross(pointAt(skin_.positions(), corners[2]) - a);
  hit.normal = toBullet(area.normalized());
  return hit;
}

}  // namespace tetskin::touch_detail
