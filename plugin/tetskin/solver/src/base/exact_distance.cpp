// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <tetskin/solver/src/base/exact_distance.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

btVector3 alongAxis(int k, btScalar length) {
  btVector3 along(0, 0, 0);
  along[k] = length;
  return along;
}

bool isRound(const btCylinderShape& cylinder) {
  const btVector3 half = cylinder.getHalfExtentsWithMargin();
  const int along = cylinder.getUpAxis();
  const btScalar a = half[(along + 1) % 3], b = half[(along + 2) % 3];
  return btFabs(a - b) <= SIMD_EPSILON * (a + b);
}

}  // namespace

std::optional<ExactShape> ExactShape::exactShape(const btCollisionShape& shape) {
  ExactShape exact;
  switch (shape.getShapeType()) {
    case STATIC_PLANE_PROXYTYPE: {
      const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
      exact.kind_ = Kind::Plane;
      exact.extents_ = plane.getPlaneNormal();
      exact.half_ = plane.getPlaneConstant();
      return exact;
    }
    case BOX_SHAPE_PROXYTYPE:
      exact.kind_ = Kind::Box;
      exact.extents_ = static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin();
      return exact;
    case SPHERE_SHAPE_PROXYTYPE:
      exact.radius_ = static_cast<const btSphereShape&>(shape).getRadius();
      return exact;
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      exact.kind_ = Kind::Capsule;
      exact.axis_ = capsule.getUpAxis();
      exact.radius_ = capsule.getRadius();
      exact.half_ = capsule.getHalfHeight();
      return exact;
    }
    case CYLINDER_SHAPE_PROXYTYPE: {
      const auto& cylinder = static_cast<const btCylinderShape&>(shape);
      if (!isRound(cylinder)) return {};
      exact.kind_ = Kind::Cylinder;
      exact.axis_ = cylinder.getUpAxis();
      exact.radius_ = cylinder.getRadius();
      exact.half_ = cylinder.getHalfExtentsWithMargin()[exact.axis_];
      return exact;
    }
    default:
      return {};
  }
}

ShapeDistance ExactShape::distance(const btVector3& point) const {
  switch (kind_) {
    case Kind::Plane:
      return {point.dot(extents_) - half_, extents_};
    case Kind::Box:
      return fromBox(point);
    case Kind::Ball:
      return fromBall(point);
    case Kind::Capsule:
      return fromCapsule(point);
    default:
      return fromCylinder(point);
  }
}

/// Over a box's face, and within it where no other face is nearer, on the face's side of the middle.
bool ExactShape::isHalfSpace(const btVector3& centre, btScalar radius) const {
  if (kind_ != Kind::Box) return kind_ == Kind::Plane;
  btVector3 beyond = centre.absolute() - extents_;
  const int side = beyond.maxAxis();
  if (btFabs(centre[side]) < radius) return false;
  const btScalar lowest = beyond[side] - radius;
  beyond[side] = -BT_LARGE_FLOAT;
  const btScalar beside = beyond[beyond.maxAxis()] + radius;
  return beside <= 0 && lowest >= beside;
}

/// At the centre no direction is special: any one is valid.
ShapeDistance ExactShape::fromBall(const btVector3& point) const {
  const btScalar length = point.length();
  return {length - radius_, length > SIMD_EPSILON * radius_ ? point / length : alongAxis((axis_ + 1) % 3, 1)};
}

ShapeDistance ExactShape::fromBox(const btVector3& point) const {
  const btVector3 beyond = point.absolute() - extents_;
  const int side = beyond.maxAxis();
  btVector3 outside = beyond;
  outside.setMax(btVector3(0, 0, 0));
  const btScalar length = outside.length();
  // The point is on a face or inside, up to rounding; then the nearest face determines the result.
  if (!(length > SIMD_EPSILON * extents_[side])) return {beyond[side], alongAxis(side, point[side] < 0 ? -1 : 1)};
  for (int k = 0; k < 3; ++k) outside[k] = std::copysign(outside[k], point[k]);
  return {length, outside / length};
}

ShapeDistance ExactShape::fromCapsule(const btVector3& point) const {
  assert(axis_ >= 0 && axis_ < 3 && half_ >= 0);
  btVector3 fromAxis = point;
  fromAxis[axis_] -= std::clamp(point[axis_], -half_, half_);
  return fromBall(fromAxis);
}

/// Computed in the half-plane of the axis and the point, in which the cylinder is a rectangle.
ShapeDistance ExactShape::fromCylinder(const btVector3& point) const {
  assert(axis_ >= 0 && axis_ < 3 && half_ >= 0);
  btVector3 outwards = point;
  outwards[axis_] = 0;
  const btScalar fromAxis = outwards.length();
  outwards = fromAxis > SIMD_EPSILON * radius_ ? outwards / fromAxis : alongAxis((axis_ + 1) % 3, 1);
  const btVector3 upwards = alongAxis(axis_, point[axis_] < 0 ? -1 : 1);
  const btScalar beside = fromAxis - radius_, above = btFabs(point[axis_]) - half_;
  if (beside > 0 && above > 0) {
    const btScalar distance = btSqrt(beside * beside + above * above);
    return {distance, (beside * outwards + above * upwards) / distance};
  }
  return beside > above ? ShapeDistance{beside, outwards} : ShapeDistance{above, upwards};
}

}  // namespace tetskin::bullet_detail
