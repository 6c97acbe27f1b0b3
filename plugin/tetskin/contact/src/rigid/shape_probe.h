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

/// All in the shape's own space. A distance of BT_LARGE_FLOAT means that nothing is near.
class ShapeProbe {
 public:
  virtual ~ShapeProbe() = default;
  /// Whether anything of the shape may be within `reach` of the ball. Then points in the ball may be asked for.
  virtual bool enter(const Ball& ball, btScalar reach) = 0;
  /// The same for a ball in the last one entered.
  virtual bool narrow(const Ball& ball, btScalar reach) = 0;
  /// For points within reach, how far they are; for others at least as much as the reach.
  virtual ShapeDistance at(const btVector3& point) const = 0;
};

/// Of shapes with formulas.
class ExactProbe : public ShapeProbe {
 public:
  void take(const btCollisionShape& shape) { shape_ = &shape; }
  bool enter(const Ball& ball, btScalar reach) override;
  bool narrow(const Ball& ball, btScalar reach) override { return enter(ball, reach); }
  ShapeDistance at(const btVector3& point) const override { return exactDistance(*shape_, point); }

 private:
  const btCollisionShape* shape_ = nullptr;
};

}  // namespace tetskin
