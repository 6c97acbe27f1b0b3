// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: distances to convex hulls, computed from their faces.
#pragma once

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <tetskin/core/src/base/mesh/triangle_geometry.h>
#include <tetskin/solver/src/search/shape_probe.h>

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

namespace tetskin::bullet_detail {

struct FacePlanes {
  std::vector<btScalar> x, y, z, offsets;

  std::size_t size() const { return offsets.size(); }
  void clear();
  void add(const btVector3& normal, btScalar offset);
  btVector3 normal(std::size_t face) const { return {x[face], y[face], z[face]}; }
  /// The height of a point above a face's plane, positive outside.
  btScalar height(std::size_t face, const btVector3& point) const {
    return x[face] * point.x() + y[face] * point.y() + z[face] * point.z() - offsets[face];
  }
};

/// The faces of the convex hull of some points; none if they are in a plane.
class HullFaces {
 public:
  explicit HullFaces(const btConvexHullShape& shape);
  /// True if the shape still has the points from which the faces were made.
  bool fits(const btConvexHullShape& shape) const;

  bool empty() const { return planes_.offsets.empty(); }
  const FacePlanes& planes() const { return planes_; }
  /// The offset of a point from the closest point of a face.
  btVector3 offsetFrom(std::size_t face, const btVector3& point) const;

 private:
  void addFace(const std::vector<btVector3>& corners);

  FacePlanes planes_;                         ///< planes by face
  std::vector<std::uint32_t> firstTriangle_;  ///< first triangle of each face, and the end
  std::vector<TriangleCorners> triangles_;
  btVector3 scaling_;
  std::vector<btVector3> points_;
};

/// Tests only faces that can be the nearest to a point in the ball.
class HullProbe : public ShapeProbe {
 public:
  /// Selects a hull; false if it has no faces.
  bool take(const btConvexHullShape& shape);
  bool enter(const Ball& ball, btScalar reach) override;
  bool narrow(const CarrierPaths& carriers, const Ball& ball, btScalar reach) override;
  /// Inside, the distance to the nearest face; outside, to the nearest point of those faces that the point is in front
  /// of.
  ShapeDistance at(const btVector3& point) const override;
  ShapeBound bound() const override { return bound_; }
  /// The faces of the selected hull. Keeping them saves their computation when the hull is selected again.
  const std::shared_ptr<const HullFaces>& faces() const { return faces_; }

 private:
  std::shared_ptr<const HullFaces> find(const btConvexHullShape& shape);
  ShapeDistance outside(const btVector3& point, const ShapeDistance& highest) const;
  bool keepNear(const std::vector<std::size_t>& from, const Ball& ball, btScalar reach, std::vector<std::size_t>& kept);

  std::unordered_map<const btCollisionShape*, std::weak_ptr<const HullFaces>> known_;
  std::shared_ptr<const HullFaces> faces_;
  std::vector<std::size_t> all_, entered_, narrowed_;  ///< numbers of faces
  std::vector<btScalar> heights_;
  ShapeBound bound_;
};

}  // namespace tetskin::bullet_detail
