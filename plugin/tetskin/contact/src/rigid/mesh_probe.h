// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: concave shapes by their triangles.
#pragma once

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <tetskin/contact/src/rigid/shape_probe.h>
#include <tetskin/contact/src/rigid/triangle_distance.h>

#include <vector>

namespace tetskin {

/// A triangle, with what tells quickly that it is far.
struct ProbeTriangle {
  TriangleCorners corners;
  btVector3 normal;  ///< of unit length, to where the corners are counter-clockwise
  btVector3 low, high;
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
  btScalar thickness_ = 0, reach_ = 0;
  std::vector<ProbeTriangle> entered_, narrowed_;
};

}  // namespace tetskin
