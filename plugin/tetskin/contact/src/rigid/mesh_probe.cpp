// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/contact/src/rigid/mesh_probe.h>
#include <tetskin/core/src/shared/mesh/triangle_geometry.h>

#include <algorithm>
#include <cassert>

namespace tetskin {
namespace {

/// Collects the triangles that meet a box; Bullet's own test uses coarse boxes.
class TriangleGatherer : public btTriangleCallback {
 public:
  TriangleGatherer(const btVector3& low, const btVector3& high, const OutwardSide& outward,
                   std::vector<ProbeTriangle>& out)
      : low_(low), high_(high), outward_(outward), out_(out) {}
  void processTriangle(btVector3* corners, int, int) override;

 private:
  btVector3 low_, high_;
  OutwardSide outward_;
  std::vector<ProbeTriangle>& out_;
};

/// Below 0: the scaling mirrors.
btScalar handedness(const btVector3& scaling) {
  return scaling.x() * scaling.y() * scaling.z();
}

bool boxesOverlap(const ProbeTriangle& triangle, const btVector3& low, const btVector3& high) {
  for (int k = 0; k < 3; ++k) {
    if (triangle.low[k] > high[k] || triangle.high[k] < low[k]) return false;
  }
  return true;
}

/// True if the point is in the triangle's box, or within a distance of it.
bool isBeside(const ProbeTriangle& triangle, const btVector3& point, btScalar distance) {
  for (int k = 0; k < 3; ++k) {
    if (triangle.low[k] - point[k] > distance || point[k] - triangle.high[k] > distance) return false;
  }
  return true;
}

/// The offset of a point from the closest point of the triangle. Computed in double, as near the triangle few digits
/// are left.
btVector3 offsetFrom(const ProbeTriangle& triangle, const btVector3& point) {
  const Eigen::Vector3d p = toEigen(point);
  const auto& [a, b, c] = triangle.corners;
  return toBullet(p - closestPointOnTriangle(p, toEigen(a), toEigen(b), toEigen(c)).point);
}

void TriangleGatherer::processTriangle(btVector3* corners, int, int) {
  ProbeTriangle triangle;
  triangle.corners = {corners[0], corners[1], corners[2]};
  triangle.normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const btScalar area = triangle.normal.length();
  if (!(area > 0)) return;
  triangle.normal /= outward_.isBehind(triangle.normal) ? -area : area;
  triangle.low = triangle.high = corners[0];
  for (int k = 1; k < 3; ++k) {
    triangle.low.setMin(corners[k]);
    triangle.high.setMax(corners[k]);
  }
  if (boxesOverlap(triangle, low_, high_)) out_.push_back(triangle);
}

}  // namespace

OutwardSide::OutwardSide(const btConcaveShape& shape) : sign_(handedness(shape.getLocalScaling())) {
  const int type = shape.getShapeType();
  if (type == TERRAIN_SHAPE_PROXYTYPE) {
    upAxis_ = static_cast<const btHeightfieldTerrainShape&>(shape).getUpAxis();
    sign_ = shape.getLocalScaling()[upAxis_];
  } else if (type == SCALED_TRIANGLE_MESH_SHAPE_PROXYTYPE) {
    const auto& scaled = static_cast<const btScaledBvhTriangleMeshShape&>(shape);
    sign_ *= handedness(scaled.getChildShape()->getLocalScaling());
  }
}

void MeshProbe::take(const btConcaveShape& shape, btScalar thickness) {
  assert(!(thickness < 0));
  shape_ = &shape;
  outward_ = OutwardSide(shape);
  thickness_ = thickness;
}

bool MeshProbe::enter(const Ball& ball, btScalar reach) {
  assert(shape_);
  reach_ = reach;
  const btScalar side = ball.radius + std::max(reach, thickness_);
  const btVector3 half(side, side, side);
  entered_.clear();
  TriangleGatherer gatherer(ball.centre - half, ball.centre + half, outward_, entered_);
  shape_->processAllTriangles(&gatherer, ball.centre - half, ball.centre + half);
  narrowed_ = entered_;
  return !entered_.empty();
}

bool MeshProbe::narrow(const CarrierPaths& carriers, const Ball& ball, btScalar reach) {
  reach_ = reach;
  const btScalar side = ball.radius + std::max(reach, thickness_);
  const btVector3 low = ball.centre - btVector3(side, side, side), high = ball.centre + btVector3(side, side, side);
  narrowed_.clear();
  for (const ProbeTriangle& triangle : entered_) {
    if (!boxesOverlap(triangle, low, high)) continue;
    const btScalar plane = triangle.normal.dot(triangle.corners[0]);
    if (carriers.lowest(triangle.normal) - plane > reach || carriers.highest(triangle.normal) - plane < -thickness_) {
      continue;
    }
    narrowed_.push_back(triangle);
  }
  return !narrowed_.empty();
}

/// If several triangles are equally near, at an edge or a corner, the one whose normal is most nearly along the offset
/// determines the side.
ShapeDistance MeshProbe::at(const btVector3& point) const {
  constexpr btScalar kSame = btScalar(1e-4);  // relative to the distance
  ShapeDistance found{reach_, btVector3(0, 1, 0)};
  btScalar minimum = std::max(reach_, thickness_), facing = 0;
  for (const ProbeTriangle& triangle : narrowed_) {
    const btScalar height = triangle.normal.dot(point - triangle.corners[0]);
    if (height > std::min(minimum, reach_) || -height > std::min(minimum, thickness_)) continue;
    if (!isBeside(triangle, point, height < 0 ? std::min(minimum, thickness_) : std::min(minimum, reach_))) continue;
    const btVector3 away = offsetFrom(triangle, point);
    const btScalar distance = away.length();
    if (distance > minimum * (1 + kSame) || (distance > minimum * (1 - kSame) && btFabs(height) <= facing)) continue;
    minimum = std::min(minimum, distance);
    facing = btFabs(height);
    // For a point on the triangle itself, the offset has no direction, and the normal is used.
    const bool on = !(distance > SIMD_EPSILON);
    found = {height < 0 ? -distance : distance, on ? triangle.normal : (height < 0 ? -away : away) / distance};
  }
  return found.distance < -thickness_ ? ShapeDistance{reach_, btVector3(0, 1, 0)} : found;
}

}  // namespace tetskin
