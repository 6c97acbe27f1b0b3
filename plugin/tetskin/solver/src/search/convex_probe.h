// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: distances to convex shapes by Bullet's GJK.
#pragma once

#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <tetskin/solver/src/search/shape_probe.h>

namespace tetskin::bullet_detail {

/// Distances to shapes as drawn, without a margin around them. A point costs a microsecond or two, but GJK only runs if
/// the plane that separates the ball's centre from the shape does not already show that the point is far.
class ConvexProbe : public ShapeProbe {
 public:
  void take(const btConvexShape& shape) { shape_ = &shape; }
  bool enter(const Ball& ball, btScalar reach) override;
  bool narrow(const CarrierPaths&, const Ball& ball, btScalar reach) override { return enter(ball, reach); }
  ShapeBound bound() const override { return bound_; }
  ShapeDistance at(const btVector3& point) const override;

 private:
  const btConvexShape* shape_ = nullptr;
  ShapeBound bound_;
  btScalar reach_ = 0;
};

}  // namespace tetskin::bullet_detail
