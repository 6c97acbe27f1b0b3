// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "measure/obstacles.h"

#include <tetskin/bullet/soft_body.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "measure/extremes.h"

namespace tetskin::measure {
namespace {

using Eigen::Vector3d;

/// The distance from a segment along z.
double toSegment(const Vector3d& p, double halfLength) {
  return (p - Vector3d(0, 0, std::clamp(p.z(), -halfLength, halfLength))).norm();
}

}  // namespace

Solid ball(double radius) {
  return {[=] { return std::make_unique<btSphereShape>(static_cast<btScalar>(radius)); },
          [=](const Vector3d& p) { return p.norm() - radius; }};
}

Solid capsule(double radius, double halfLength) {
  return {[=] {
            return std::make_unique<btCapsuleShapeZ>(static_cast<btScalar>(radius),
                                                     static_cast<btScalar>(2.0 * halfLength));
          },
          [=](const Vector3d& p) { return toSegment(p, halfLength) - radius; }};
}

Solid cylinder(double radius, double halfLength) {
  return {[=] { return std::make_unique<btCylinderShapeZ>(toBullet(Vector3d(radius, radius, halfLength))); },
          [=](const Vector3d& p) {
            const Vector3d q(std::hypot(p.x(), p.y()) - radius, std::abs(p.z()) - halfLength, 0);
            return q.cwiseMax(0.0).norm() + std::min(std::max(q.x(), q.y()), 0.0);
          }};
}

Solid box(const Vector3d& halfExtents, double turn) {
  return {[=] { return std::make_unique<btBoxShape>(toBullet(halfExtents)); },
          [=, toBox = Eigen::AngleAxisd(-turn, Vector3d::UnitZ()).toRotationMatrix()](const Vector3d& p) {
            const Vector3d q = (toBox * p).cwiseAbs() - halfExtents;
            return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
          },
          btQuaternion(btVector3(0, 0, 1), static_cast<btScalar>(turn))};
}

Obstacle obstacleOf(const Solid& solid, const std::vector<Vector3d>& centres) {
  return {[=](MeasuringWorld& world) {
            for (const Vector3d& c : centres) world.addRigid(solid.make(), btTransform(solid.turn, toBullet(c)));
          },
          [=](const Vector3d& p) {
            double nearest = HUGE_VAL;
            for (const Vector3d& c : centres) lower(nearest, solid.distance(p - c));
            return nearest;
          }};
}

TriangleShape::TriangleShape(const std::function<void(btTriangleMesh&)>& fill)
    : OwnTriangles(fill), btBvhTriangleMeshShape(&triangles, true) {}

}  // namespace tetskin::measure
