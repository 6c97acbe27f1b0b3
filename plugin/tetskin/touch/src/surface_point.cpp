// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/core/src/exported/quadratic_point.h>
#include <tetskin/core/src/exported/skin_binding.h>
#include <tetskin/touch/src/points/body_kind.h>
#include <tetskin/touch/src/points/point_data.h>
#include <tetskin/touch/src/points/point_jacobian.h>
#include <tetskin/touch/src/rows/node_pushes.h>

namespace tetskin {

using namespace bullet_detail;

using touch_detail::PointData;
using touch_detail::PointJacobian;

namespace {

/// The frame of a triangle as drawn: one axis along its first side, one along its normal.
SurfaceFrame frameOf(const btVector3 corners[3], const PointData& point) {
  SurfaceFrame frame;
  frame.position = corners[0];
  for (std::size_t k = 1; k < 3; ++k) frame.position += point.weights[k] * (corners[k] - corners[0]);
  const btVector3 side = corners[1] - corners[0];
  const btVector3 area = side.cross(corners[2] - corners[0]);
  if (!(side.length2() > 0) || !(area.length2() > 0)) return frame;
  const btVector3 tangent = side.normalized(), out = area.normalized(), across = out.cross(tangent);
  frame.normal =
      (point.restNormal[0] * tangent + point.restNormal[1] * across + point.restNormal[2] * out).normalized();
  frame.tangent = (tangent - tangent.dot(frame.normal) * frame.normal).normalized();
  frame.bitangent = frame.normal.cross(frame.tangent);
  return frame;
}

using Point = Eigen::Matrix<btScalar, 3, 1>;

Point pointOf(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// Computes the corners of a point's triangle as the skin draws them; false if the skin is of another body.
bool drawCorners(const SoftBodySkin& skin, btScalar alpha, const btSoftBody& body, const PointData& data,
                 btVector3 corners[3]) {
  const auto binding = skin.binding();
  if (skin.body() != &body || binding->embedding().tetCount() <= static_cast<std::size_t>(data.corners[0].tet)) {
    return false;
  }
  const auto& stencils = dataOf(*binding).quadratic;
  const bool bends = stencils && skin.interpolation() == Interpolation::Quadratic;
  const NodePositions<btScalar> positionOf = [&](int node) { return pointOf(skin.nodeAt(node, alpha)); };
  for (std::size_t k = 0; k < 3; ++k) {
    const EmbeddedPoint<btScalar>& corner = data.corners[k];
    const Point drawn =
        bends ? quadraticPosition(corner, binding->embedding(), *stencils, positionOf) : corner.position(positionOf);
    corners[k] = btVector3(drawn.x(), drawn.y(), drawn.z());
  }
  return true;
}

void linearCorners(const btSoftBody& body, const PointData& data, btVector3 corners[3]) {
  for (std::size_t k = 0; k < 3; ++k) corners[k] = data.corners[k].position(positionsIn(body));
}

}  // namespace

btTransform SurfaceFrame::transform() const {
  const btMatrix3x3 basis(tangent.x(), normal.x(), -bitangent.x(), tangent.y(), normal.y(), -bitangent.y(), tangent.z(),
                          normal.z(), -bitangent.z());
  return btTransform(basis, position);
}

SurfacePoint::SurfacePoint(btSoftBody& body, const PointData& data)
    : body_(&body), nodeCount_(body.m_nodes.size()), tetCount_(body.m_tetras.size()), data_(data) {
  if (const BodyWithTrees* made = bodyWithTrees(body)) {
    life_ = made->lifetime();
    watched_ = true;
  }
}

StatusCode SurfacePoint::status() const {
  if (!body_) return StatusCode::Released;
  if (watched_ && life_.expired()) return StatusCode::BodyDeleted;
  if (body_->m_nodes.size() != nodeCount_ || body_->m_tetras.size() != tetCount_) return StatusCode::TopologyChanged;
  for (const EmbeddedPoint<btScalar>& corner : data_.corners) {
    for (const int node : corner.nodes) {
      if (!touch_detail::isFiniteVector(body_->m_nodes[node].m_x)) return StatusCode::NonFinite;
    }
  }
  return StatusCode::Ok;
}

void SurfacePoint::release() {
  *this = {};
}

btSoftBody* SurfacePoint::body() const {
  return watched_ && life_.expired() ? nullptr : body_;
}

std::optional<btVector3> SurfacePoint::position() const {
  const auto at = frame();
  return at ? std::optional(at->position) : std::nullopt;
}

std::optional<btVector3> SurfacePoint::position(const SoftBodySkin& skin, btScalar alpha) const {
  const auto at = frame(skin, alpha);
  return at ? std::optional(at->position) : std::nullopt;
}

std::optional<SurfaceFrame> SurfacePoint::frame() const {
  if (status() != StatusCode::Ok) return {};
  btVector3 corners[3];
  linearCorners(*body_, data_, corners);
  return frameOf(corners, data_);
}

std::optional<SurfaceFrame> SurfacePoint::frame(const SoftBodySkin& skin, btScalar alpha) const {
  btVector3 corners[3];
  if (status() != StatusCode::Ok || !drawCorners(skin, alpha, *body_, data_, corners)) return {};
  return frameOf(corners, data_);
}

std::optional<btVector3> SurfacePoint::velocity() const {
  if (status() != StatusCode::Ok) return {};
  const auto velocityOf = [&](int node) { return body_->m_nodes[node].m_v + body_->m_nodes[node].m_splitv; };
  btVector3 sum(0, 0, 0);
  for (std::size_t c = 0; c < 3; ++c) sum += data_.weights[c] * data_.corners[c].velocity(velocityOf);
  return sum;
}

btScalar SurfacePoint::effectiveMass() const {
  if (status() != StatusCode::Ok) return 0;
  const PointJacobian jacobian = touch_detail::jacobianAt(data_, *body_);
  return static_cast<btScalar>(touch_detail::massOf(touch_detail::linearResponse(jacobian, *body_)));
}

StatusCode SurfacePoint::applyImpulse(const btVector3& impulse) {
  if (const StatusCode now = status(); now != StatusCode::Ok) return now;
  if (!touch_detail::isFiniteVector(impulse)) return StatusCode::NonFinite;
  if (touch_detail::isReduced(*body_)) return StatusCode::InvalidOption;
  touch_detail::NodePushes pushes;
  touch_detail::addPush(touch_detail::jacobianAt(data_, *body_), toEigen(impulse), pushes);
  touch_detail::applyImpulses(pushes, *body_);
  return StatusCode::Ok;
}

StatusCode SurfacePoint::applyForce(const btVector3& force, int steps) {
  if (const StatusCode now = status(); now != StatusCode::Ok) return now;
  if (!touch_detail::isFiniteVector(force)) return StatusCode::NonFinite;
  touch_detail::NodePushes pushes;
  touch_detail::addPush(touch_detail::jacobianAt(data_, *body_), toEigen(force), pushes);
  return touch_detail::applyForces(std::move(pushes), steps, *body_);
}

}  // namespace tetskin
