// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: the distances of points from one rigid shape. Callers ask for one ball after another, so
// that most of the shape, and most points, are skipped.
#pragma once

#include <tetskin/solver/src/base/exact_distance.h>

#include <cassert>
#include <cstddef>

namespace tetskin::bullet_detail {

struct Ball {
  btVector3 centre;
  btScalar radius = 0;
};

/// The position of a node or a point at the beginning of the step, and the one that it would reach without contact.
struct NodePath {
  btVector3 now, predicted;
};

/// The paths of the nodes that carry some points. The points are on weighted means of these paths; if some weights are
/// negative, outside of them by up to the spread.
struct CarrierPaths {
  const NodePath* paths = nullptr;
  std::size_t count = 0;
  btScalar spread = 1;

  /// Bounds of the points' heights along a direction.
  btScalar lowest(const btVector3& direction) const { return -highest(-direction); }
  btScalar highest(const btVector3& direction) const {
    assert(paths && count > 0);
    btScalar low = BT_LARGE_FLOAT, high = -BT_LARGE_FLOAT;
    for (std::size_t k = 0; k < count; ++k) {
      const btScalar now = direction.dot(paths[k].now), predicted = direction.dot(paths[k].predicted);
      low = btMin(low, btMin(now, predicted));
      high = btMax(high, btMax(now, predicted));
    }
    return (low + high + spread * (high - low)) * btScalar(0.5);
  }
};

/// A lower bound of distances: no point is nearer than its height above the plane.
struct ShapeBound {
  btVector3 normal{0, 0, 0};
  btScalar offset = -BT_LARGE_FLOAT;

  btScalar operator()(const btVector3& point) const { return normal.dot(point) + offset; }
  /// The bound of a convex shape: the shape is behind the plane through its point that is nearest to another point.
  static ShapeBound behind(const ShapeDistance& at, const btVector3& point) {
    return {at.normal, at.distance - at.normal.dot(point)};
  }
};

/// Distances to one shape; all positions are in the shape's own space.
class ShapeProbe {
 public:
  virtual ~ShapeProbe() = default;
  /// True if shapes of this type with the same box are equal, so that the box always reveals a change in place.
  virtual bool isKnownByItsBox() const { return false; }
  /// True if the shape is known to be as good as a half-space for all points in the ball: the deepest point of a
  /// triangle is then a corner.
  virtual bool isHalfSpace(const Ball&) const { return false; }
  /// True if any part of the shape may be within `reach` of the ball. If so, distances of points in the ball may be
  /// asked for.
  virtual bool enter(const Ball& ball, btScalar reach) = 0;
  /// Like `enter`, for a ball within the last one entered that contains these carriers' points.
  virtual bool narrow(const CarrierPaths& carriers, const Ball& ball, btScalar reach) = 0;
  /// A bound for all points in the last ball.
  virtual ShapeBound bound() const = 0;
  /// The distance of a point within reach; for other points a value between the reach and their distance.
  virtual ShapeDistance at(const btVector3& point) const = 0;
};

/// Probe of shapes with exact formulas.
class ExactProbe : public ShapeProbe {
 public:
  void take(const ExactShape& shape) { shape_ = shape; }
  bool isKnownByItsBox() const override { return true; }
  bool isHalfSpace(const Ball& ball) const override { return shape_.isHalfSpace(ball.centre, ball.radius); }
  bool enter(const Ball& ball, btScalar reach) override {
    const ShapeDistance centre = shape_.distance(ball.centre);
    bound_ = ShapeBound::behind(centre, ball.centre);
    return centre.distance <= ball.radius + reach;
  }
  bool narrow(const CarrierPaths&, const Ball& ball, btScalar reach) override { return enter(ball, reach); }
  ShapeBound bound() const override { return bound_; }
  ShapeDistance at(const btVector3& point) const override { return shape_.distance(point); }

 private:
  ExactShape shape_;
  ShapeBound bound_;
};

}  // namespace tetskin::bullet_detail
