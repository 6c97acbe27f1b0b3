// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: convex hulls by their faces.
#pragma once

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <tetskin/contact/src/rigid/shape_probe.h>
#include <tetskin/contact/src/rigid/triangle_distance.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace tetskin {

/// Planes of faces, and which faces these are.
struct FaceRows {
  std::vector<btScalar> x, y, z, offsets;
  std::vector<std::uint32_t> faces;

  std::size_t size() const { return faces.size(); }
  void clear();
  void add(const btVector3& normal, btScalar offset, std::uint32_t face);
  btVector3 normal(std::size_t row) const { return {x[row], y[row], z[row]}; }
  /// Over the plane, above 0 outside.
  btScalar height(std::size_t row, const btVector3& point) const {
    return x[row] * point.x() + y[row] * point.y() + z[row] * point.z() - offsets[row];
  }
};

/// The faces of the hull of some points, none if they are in a plane.
class HullFaces {
 public:
  explicit HullFaces(const btConvexHullShape& shape);
  /// Whether it is that of these points still.
  bool fits(const btConvexHullShape& shape) const;

  bool empty() const { return rows_.faces.empty(); }
  const FaceRows& rows() const { return rows_; }
  btVector3 closest(std::uint32_t face, const btVector3& point) const;

 private:
  void addFace(const std::vector<btVector3>& corners);

  FaceRows rows_;                             ///< by face
  std::vector<std::uint32_t> firstTriangle_;  ///< by face, and one more
  std::vector<TriangleCorners> triangles_;
  btVector3 scaling_;
  std::vector<btVector3> points_;
};

/// Asks only for the faces that can be the nearest of a point in the ball.
class HullProbe : public ShapeProbe {
 public:
  /// False where the hull has no faces.
  bool take(const btConvexHullShape& shape);
  bool enter(const Ball& ball, btScalar reach) override;
  bool narrow(const CarrierPaths& carriers, const Ball& ball, btScalar reach) override;
  /// Inside, to the nearest face; outside, to the nearest point of those faces that look to the point.
  ShapeDistance at(const btVector3& point) const override;
  ShapeBound bound() const override { return bound_; }

 private:
  bool keepNear(const FaceRows& from, const Ball& ball, btScalar reach, FaceRows& kept);

  std::unordered_map<const btCollisionShape*, HullFaces> known_;
  const HullFaces* faces_ = nullptr;
  FaceRows entered_, narrowed_;
  std::vector<btScalar> heights_;
  ShapeBound bound_;
};

}  // namespace tetskin
