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

/// The faces of the hull of some points, none if they are in a plane.
class HullFaces {
 public:
  explicit HullFaces(const btConvexHullShape& shape);
  /// Whether it is that of these points still.
  bool fits(const btConvexHullShape& shape) const;

  std::size_t size() const { return offsets_.size(); }
  bool empty() const { return offsets_.empty(); }
  btVector3 normal(std::size_t face) const { return {normals_[0][face], normals_[1][face], normals_[2][face]}; }
  /// From the face's plane, above 0 outside.
  btScalar height(std::size_t face, const btVector3& point) const {
    return normals_[0][face] * point.x() + normals_[1][face] * point.y() + normals_[2][face] * point.z() -
           offsets_[face];
  }
  btVector3 closest(std::size_t face, const btVector3& point) const;

 private:
  void addFace(const std::vector<btVector3>& corners);

  std::vector<btScalar> normals_[3], offsets_;  ///< by face
  std::vector<std::uint32_t> firstTriangle_;    ///< by face, and one more
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
  bool narrow(const Ball& ball, btScalar reach) override;
  /// Inside, to the nearest face; outside, to the nearest point of those faces that look to the point.
  ShapeDistance at(const btVector3& point) const override;
  ShapeBound bound() const override { return bound_; }

 private:
  bool keepNear(const std::vector<std::uint32_t>& from, const Ball& ball, btScalar reach,
                std::vector<std::uint32_t>& kept);

  std::unordered_map<const btCollisionShape*, HullFaces> known_;
  const HullFaces* faces_ = nullptr;
  std::vector<std::uint32_t> all_, entered_, narrowed_;
  std::vector<btScalar> heights_;
  ShapeBound bound_;
};

}  // namespace tetskin
