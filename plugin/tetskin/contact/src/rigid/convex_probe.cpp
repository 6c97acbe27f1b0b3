// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <tetskin/contact/src/rigid/convex_probe.h>

namespace tetskin {
namespace {

/// What Bullet's shape without its margin lacks of the shape as drawn: spheres are all margin.
btScalar drawnMargin(const btConvexShape& shape) {
  return shape.getShapeType() == MULTI_SPHERE_SHAPE_PROXYTYPE ? shape.getMargin() : btScalar(0);
}

/// Where Bullet finds none, nothing is near.
ShapeDistance gjkDistance(const btConvexShape& shape, const btVector3& point) {
  btGjkEpaSolver2::sResults results;
  const btScalar distance = btGjkEpaSolver2::SignedDistance(point, 0, &shape, btTransform::getIdentity(), results);
  const btScalar length = results.normal.length();
  if (!(btFabs(distance) < BT_LARGE_FLOAT) || !(length > btScalar(0.5))) return {};
  return {distance - drawnMargin(shape), results.normal / length};
}

}  // namespace

bool ConvexProbe::enter(const Ball& ball, btScalar reach) {
  const ShapeDistance centre = gjkDistance(*shape_, ball.centre);
  reach_ = reach;
  bound_ = ShapeBound::behind(centre, ball.centre);
  return centre.distance <= ball.radius + reach;
}

ShapeDistance ConvexProbe::at(const btVector3& point) const {
  const btScalar atLeast = bound_(point);
  if (atLeast > reach_) return {atLeast, bound_.normal};
  return gjkDistance(*shape_, point);
}

}  // namespace tetskin
