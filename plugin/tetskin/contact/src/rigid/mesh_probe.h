// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: concave shapes by their triangles.
#pragma once

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <tetskin/contact/src/rigid/shape_probe.h>

#include <array>
#include <vector>

namespace tetskin {

/// A triangle, with what tells quickly that it is far.
struct ProbeTriangle {
  std::array<btVector3, 3> corners;
  btVector3 normal;  ///< of unit length, outwards
  btVector3 low, high;
};

/// Which side of a shape's triangles is outside: where their corners are counter-clockwise, mirrored with the shape. Of
/// terrain, whose winding is another along each axis, it is the side of its up axis.
class OutwardSide {
 public:
  OutwardSide() = default;
  explicit OutwardSide(const btConcaveShape& shape);
  /// normal  where the corners are counter-clockwise
  bool isBehind(const btVector3& normal) const { return (upAxis_ < 0 ? btScalar(1) : normal[upAxis_]) * sign_ < 0; }

 private:
  btScalar sign_ = 1;
  int upAxis_ = -1;  ///< of terrain
};

/// Points behind a triangle are inside, as far as `thickness`; farther, they belong to something else. Asks the shape
/// once for each ball entered.
class MeshProbe : public ShapeProbe {
 public:
  void take(const btConcaveShape& shape, btScalar thickness);
  bool enter(const Ball& ball, btScalar reach) override;
  bool narrow(const CarrierPaths& carriers, const Ball& ball, btScalar reach) override;
  ShapeBound bound() const override { return {}; }
  ShapeDistance at(const btVector3& point) const override;

 private:
  const btConcaveShape* shape_ = nullptr;
  OutwardSide outward_;
  btScalar thickness_ = 0, reach_ = 0;
  std::vector<ProbeTriangle> entered_, narrowed_;
};

}  // namespace tetskin
