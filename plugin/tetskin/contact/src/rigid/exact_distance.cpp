// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <tetskin/contact/src/rigid/exact_distance.h>
#include <tetskin/contact/src/rigid/shape_probe.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

/// From a ball around the origin. Its centre has no direction: any serves, such as `atCentre`.
ShapeDistance fromBall(const btVector3& point, btScalar radius, const btVector3& atCentre) {
  const btScalar length = point.length();
  return {length - radius, length > SIMD_EPSILON * radius ? point / length : atCentre};
}

ShapeDistance fromPlane(const btStaticPlaneShape& plane, const btVector3& point) {
  return {point.dot(plane.getPlaneNormal()) - plane.getPlaneConstant(), plane.getPlaneNormal()};
}

btVector3 axis(int k, btScalar length) {
  btVector3 along(0, 0, 0);
  along[k] = length;
  return along;
}

ShapeDistance fromBox(const btVector3& halfSides, const btVector3& point) {
  const btVector3 beyond = point.absolute() - halfSides;
  const int side = beyond.maxAxis();
  btVector3 outside = beyond;
  outside.setMax(btVector3(0, 0, 0));
  const btScalar length = outside.length();
  // Up to rounding on a face or inside; there it is the nearest face's.
  if (!(length > SIMD_EPSILON * halfSides[side])) return {beyond[side], axis(side, point[side] < 0 ? -1 : 1)};
  for (int k = 0; k < 3; ++k) outside[k] = std::copysign(outside[k], point[k]);
  return {length, outside / length};
}

ShapeDistance fromCapsule(const btCapsuleShape& capsule, const btVector3& point) {
  const int along = capsule.getUpAxis();
  const btScalar half = capsule.getHalfHeight();
  btVector3 fromAxis = point;
  fromAxis[along] -= std::clamp(point[along], -half, half);
  return fromBall(fromAxis, capsule.getRadius(), axis((along + 1) % 3, 1));
}

/// In the half-plane of the axis and the point, where the cylinder is a rectangle.
ShapeDistance fromCylinder(const btCylinderShape& cylinder, const btVector3& point) {
  const int along = cylinder.getUpAxis();
  const btScalar radius = cylinder.getRadius(), half = cylinder.getHalfExtentsWithMargin()[along];
  btVector3 outwards = point;
  outwards[along] = 0;
  const btScalar fromAxis = outwards.length();
  outwards = fromAxis > SIMD_EPSILON * radius ? outwards / fromAxis : axis((along + 1) % 3, 1);
  const btVector3 upwards = axis(along, point[along] < 0 ? -1 : 1);
  const btScalar beside = fromAxis - radius, above = btFabs(point[along]) - half;
  if (beside > 0 && above > 0) {
    const btScalar distance = btSqrt(beside * beside + above * above);
    return {distance, (beside * outwards + above * upwards) / distance};
  }
  return beside > above ? ShapeDistance{beside, outwards} : ShapeDistance{above, upwards};
}

bool isRound(const btCylinderShape& cylinder) {
  const btVector3 half = cylinder.getHalfExtentsWithMargin();
  const int along = cylinder.getUpAxis();
  const btScalar a = half[(along + 1) % 3], b = half[(along + 2) % 3];
  return btFabs(a - b) <= SIMD_EPSILON * (a + b);
}

}  // namespace

bool hasExactDistance(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case STATIC_PLANE_PROXYTYPE:
    case BOX_SHAPE_PROXYTYPE:
    case SPHERE_SHAPE_PROXYTYPE:
    case CAPSULE_SHAPE_PROXYTYPE:
      return true;
    case CYLINDER_SHAPE_PROXYTYPE:
      return isRound(static_cast<const btCylinderShape&>(shape));
    default:
      return false;
  }
}

ShapeDistance exactDistance(const btCollisionShape& shape, const btVector3& point) {
  assert(hasExactDistance(shape));
  switch (shape.getShapeType()) {
    case STATIC_PLANE_PROXYTYPE:
      return fromPlane(static_cast<const btStaticPlaneShape&>(shape), point);
    case BOX_SHAPE_PROXYTYPE:
      return fromBox(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin(), point);
    case SPHERE_SHAPE_PROXYTYPE:
      return fromBall(point, static_cast<const btSphereShape&>(shape).getRadius(), btVector3(0, 1, 0));
    case CYLINDER_SHAPE_PROXYTYPE:
      return fromCylinder(static_cast<const btCylinderShape&>(shape), point);
    default:
      return fromCapsule(static_cast<const btCapsuleShape&>(shape), point);
  }
}

bool ExactProbe::enter(const Ball& ball, btScalar reach) {
  return exactDistance(*shape_, ball.centre).distance <= ball.radius + reach;
}

}  // namespace tetskin
