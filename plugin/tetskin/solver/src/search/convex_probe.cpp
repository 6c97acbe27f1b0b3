// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <tetskin/solver/src/search/convex_probe.h>

#include <cassert>

namespace tetskin::bullet_detail {
namespace {

/// The margin that Bullet adds around the drawn shape; 0 for shapes that it shrinks to make room for the margin.
btScalar addedMargin(const btConvexShape& shape) {
  const int type = shape.getShapeType();
  const bool within = type == MULTI_SPHERE_SHAPE_PROXYTYPE || type == CYLINDER_SHAPE_PROXYTYPE;
  return within ? btScalar(0) : shape.getMargin();
}

/// If Bullet finds no distance, nothing is near.
ShapeDistance gjkDistance(const btConvexShape& shape, const btVector3& point) {
  btGjkEpaSolver2::sResults results;
  const btScalar distance = btGjkEpaSolver2::SignedDistance(point, 0, &shape, btTransform::getIdentity(), results);
  const btScalar length = results.normal.length();
  if (!(btFabs(distance) < BT_LARGE_FLOAT) || !(length > btScalar(0.5))) return {};
  return {distance + addedMargin(shape), results.normal / length};
}

}  // namespace

bool ConvexProbe::enter(const Ball& ball, btScalar reach) {
  assert(shape_);
  const ShapeDistance centre = gjkDistance(*shape_, ball.centre);
  reach_ = reach;
  bound_ = ShapeBound::behind(centre, ball.centre);
  return centre.distance <= ball.radius + reach;
}

ShapeDistance ConvexProbe::at(const btVector3& point) const {
  assert(shape_);
  const btScalar atLeast = bound_(point);
  if (atLeast > reach_) return {atLeast, bound_.normal};
  return gjkDistance(*shape_, point);
}

}  // namespace tetskin::bullet_detail
