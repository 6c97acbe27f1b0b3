// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: how far points are from one rigid shape, asked ball by ball, so that most of the shape,
// and most points, are passed over.
#pragma once

#include <tetskin/contact/src/rigid/exact_distance.h>

#include <cstddef>

namespace tetskin {

struct Ball {
  btVector3 centre;
  btScalar radius = 0;
};

/// Where a node or a point is when the step begins, and where it would go without contact.
struct NodePath {
  btVector3 now, predicted;
};

/// Points are on the ways of these nodes, weighted; if some weights are negative, beyond them by the spread.
struct CarrierPaths {
  const NodePath* paths = nullptr;
  std::size_t count = 0;
  btScalar spread = 1;

  /// Of the points' heights in a direction no less than the least, and no more than the most.
  btScalar lowest(const btVector3& direction) const { return -highest(-direction); }
  btScalar highest(const btVector3& direction) const {
    btScalar low = BT_LARGE_FLOAT, high = -BT_LARGE_FLOAT;
    for (std::size_t k = 0; k < count; ++k) {
      const btScalar now = direction.dot(paths[k].now), predicted = direction.dot(paths[k].predicted);
      low = btMin(low, btMin(now, predicted));
      high = btMax(high, btMax(now, predicted));
    }
    return (low + high + spread * (high - low)) * btScalar(0.5);
  }
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
  /// Shapes of the kind with the same box are the same: none changes in place unseen.
  virtual bool isKnownByItsBox() const { return false; }
  /// Whether anything of the shape may be within `reach` of the ball. Then points in the ball may be asked for.
  virtual bool enter(const Ball& ball, btScalar reach) = 0;
  /// The same for a ball in the last one entered, around these.
  virtual bool narrow(const CarrierPaths& carriers, const Ball& ball, btScalar reach) = 0;
  /// For all points, by the last ball.
  virtual ShapeBound bound() const = 0;
  /// For points within reach, how far they are; for others no more than that, and at least the reach.
  virtual ShapeDistance at(const btVector3& point) const = 0;
};

/// Of shapes with formulas.
class ExactProbe : public ShapeProbe {
 public:
  void take(const ExactShape& shape) { shape_ = shape; }
  bool isKnownByItsBox() const override { return true; }
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

}  // namespace tetskin
