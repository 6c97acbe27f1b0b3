// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Fixed obstacles, and the distance of a point from each: by formulas that are independent of how contacts are found.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "measure/measuring_world.h"

namespace tetskin::measure {

/// A rigid body about the origin.
struct Solid {
  std::function<std::unique_ptr<btCollisionShape>()> make;
  Distance distance;  ///< negative inside
  btQuaternion turn = btQuaternion::getIdentity();
};

Solid ball(double radius);
/// Along z.
/// halfLength  of the capsule without its round ends
Solid capsule(double radius, double halfLength);
Solid cylinder(double radius, double halfLength);
/// turn  radians about z
Solid box(const Eigen::Vector3d& halfExtents, double turn = 0.0);

struct Obstacle {
  std::function<void(MeasuringWorld&)> addTo;
  Distance distance;  ///< world lengths; negative inside
};

/// Equal solids at several places.
Obstacle obstacleOf(const Solid& solid, const std::vector<Eigen::Vector3d>& centres);

/// Bullet's shape keeps a pointer to its triangles, which are here.
struct OwnTriangles {
  explicit OwnTriangles(const std::function<void(btTriangleMesh&)>& fill) { fill(triangles); }
  btTriangleMesh triangles;
};
class TriangleShape : private OwnTriangles, public btBvhTriangleMeshShape {
 public:
  /// fill  adds all triangles
  explicit TriangleShape(const std::function<void(btTriangleMesh&)>& fill);
};

}  // namespace tetskin::measure
