// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: how far points are from one rigid shape, asked ball by ball, so that most of the shape,
// and most points, are passed over.
#pragma once

#include <tetskin/contact/src/rigid/exact_distance.h>

namespace tetskin {

struct Ball {
  btVector3 centre;
  btScalar radius = 0;
};

/// A lower bound of distances: no point is nearer than it is above the plane.
struct ShapeBound {
  btVector3 normal{0, 0, 0};
  btScalar offset = -BT_LARGE_FLOAT;

  btScalar operator()(const btVector3& point) const { return normal.dot(point) + offset; }
  /// A convex shape is behind the plane through its point that is nearest to another one.
  static ShapeBound behind(const ShapeDistance& at, const btVector3& point) {
    return {at.normal, at.distance - at.normal.dot(point)};
  }
};

/// All in the shape's own space.
class ShapeProbe {
 public:
  virtual ~ShapeProbe() = default;
  /// Whether anything of the shape may be within `reach` of the ball. Then points in the ball may be asked for.
  virtual bool enter(const Ball& ball, btScalar reach) = 0;
  /// The same for a ball in the last one entered.
  virtual bool narrow(const Ball& ball, btScalar reach) = 0;
  /// For all points, by the last ball.
  virtual ShapeBound bound() const = 0;
  /// For points within reach, how far they are; for others no more than that, and at least the reach.
  virtual ShapeDistance at(const btVector3& point) const = 0;
};

/// Of shapes with formulas.
class ExactProbe : public ShapeProbe {
 public:
  void take(const ExactShape& shape) { shape_ = shape; }
  bool enter(const Ball& ball, btScalar reach) override {
    const ShapeDistance centre = shape_.distance(ball.centre);
    bound_ = ShapeBound::behind(centre, ball.centre);
    return centre.distance <= ball.radius + reach;
  }
  bool narrow(const Ball& ball, btScalar reach) override { return enter(ball, reach); }
  ShapeBound bound() const override { return bound_; }
  ShapeDistance at(const btVector3& point) const override { return shape_.distance(point); }

 private:
  ExactShape shape_;
  ShapeBound bound_;
};

}  // namespace tetskin
