// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: distances to concave shapes, computed from their triangles.
#pragma once

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <tetskin/solver/src/search/shape_probe.h>

#include <array>
#include <vector>

namespace tetskin::bullet_detail {

/// A triangle, with a box that quickly shows whether it is far.
struct ProbeTriangle {
  std::array<btVector3, 3> corners;
  btVector3 normal;  ///< of unit length, outwards
  btVector3 low, high;
};

/// Which side of a shape's triangles is outside: the one from which their corners are counter-clockwise, with mirroring
/// taken into account. Terrain has its triangles wound differently for each up axis; there, outside is the side of the
/// up axis.
class OutwardSide {
 public:
  OutwardSide() = default;
  explicit OutwardSide(const btConcaveShape& shape);
  /// normal  on the side from which the corners are counter-clockwise
  bool isBehind(const btVector3& normal) const { return (upAxis_ < 0 ? btScalar(1) : normal[upAxis_]) * sign_ < 0; }

 private:
  btScalar sign_ = 1;
  int upAxis_ = -1;  ///< up axis of terrain; otherwise -1
};

/// Points behind a triangle count as inside up to the depth `thickness`; deeper points belong to something else.
/// Queries the shape once for each ball entered, and again for narrowed ones if there are very many triangles.
class MeshProbe : public ShapeProbe {
 public:
  void take(const btConcaveShape& shape, btScalar thickness);
  bool enter(const Ball& ball, btScalar reach) override;
  bool narrow(const CarrierPaths& carriers, const Ball& ball, btScalar reach) override;
  /// If all triangles of the last ball are in one plane, that plane; otherwise nothing is known.
  ShapeBound bound() const override { return bound_; }
  ShapeDistance at(const btVector3& point) const override;

 private:
  void gather(const btVector3& low, const btVector3& high, std::vector<ProbeTriangle>& out) const;
  ShapeBound commonPlane() const;

  const btConcaveShape* shape_ = nullptr;
  OutwardSide outward_;
  btScalar thickness_ = 0, reach_ = 0;
  std::vector<ProbeTriangle> entered_, gathered_, narrowed_;
  std::vector<ProbeTriangle> far_;  ///< beyond the reach; all points of the last ball are in front of them
  ShapeBound bound_;
};

}  // namespace tetskin::bullet_detail
