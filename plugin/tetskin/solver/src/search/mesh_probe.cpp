// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/core/src/base/mesh/triangle_geometry.h>
#include <tetskin/solver/src/search/mesh_probe.h>

#include <algorithm>
#include <cassert>
#include <mutex>

namespace tetskin::bullet_detail {
namespace {

/// A btGImpactMeshShape reads its triangles through pointers that each query sets, counts and clears again.
std::mutex& impactMutex() {
  static std::mutex mutex;
  return mutex;
}

/// If a ball has more triangles than this, the shape is queried again for those near a smaller ball: its tree is faster
/// than a test of each.
constexpr std::size_t kManyTriangles = 64;
/// Cosine between normals of triangles in one plane, up to rounding.
constexpr btScalar kParallel = btScalar(0.999999);
/// Distance of corners from the plane that triangles share, as a fraction of the reach: far below the margin.
constexpr btScalar kInPlane = btScalar(0.01);

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

/// Negative if the scaling mirrors.
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

/// The offset of a point from the closest point of the triangle. In double, because few digits are left near the
/// triangle.
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
  gather(ball.centre - half, ball.centre + half, entered_);
  narrowed_ = entered_;
  bound_ = {};
  return !entered_.empty();
}

void MeshProbe::gather(const btVector3& low, const btVector3& high, std::vector<ProbeTriangle>& out) const {
  out.clear();
  TriangleGatherer gatherer(low, high, outward_, out);
  std::unique_lock<std::mutex> lock;
  if (shape_->getShapeType() == GIMPACT_SHAPE_PROXYTYPE) lock = std::unique_lock<std::mutex>(impactMutex());
  shape_->processAllTriangles(&gatherer, low, high);
}

/// A point that may be behind a triangle is also tested against triangles beyond the reach that it is in front of: a
/// point outside of a thin wall is not inside of the wall's other side.
bool MeshProbe::narrow(const CarrierPaths& carriers, const Ball& ball, btScalar reach) {
  reach_ = reach;
  const btScalar thick = std::max(reach, thickness_), side = ball.radius + thick;
  const btVector3 low = ball.centre - btVector3(side, side, side), high = ball.centre + btVector3(side, side, side);
  const bool many = entered_.size() > kManyTriangles;
  if (many) gather(low, high, gathered_);
  narrowed_.clear();
  far_.clear();
  bool mayBeBehind = false;
  for (const ProbeTriangle& triangle : many ? gathered_ : entered_) {
    if (!boxesOverlap(triangle, low, high)) continue;
    const btScalar plane = triangle.normal.dot(triangle.corners[0]);
    const btScalar lowest = carriers.lowest(triangle.normal) - plane;
    if (lowest > thick || carriers.highest(triangle.normal) - plane < -thickness_) continue;
    mayBeBehind = mayBeBehind || lowest < 0;
    (lowest > reach ? far_ : narrowed_).push_back(triangle);
  }
  bound_ = {};
  if (narrowed_.empty()) return false;
  if (mayBeBehind) narrowed_.insert(narrowed_.end(), far_.begin(), far_.end());
  bound_ = commonPlane();
  return true;
}

ShapeBound MeshProbe::commonPlane() const {
  if (narrowed_.empty()) return {};
  const btVector3 &normal = narrowed_[0].normal, &corner = narrowed_[0].corners[0];
  btScalar highest = 0;
  for (const ProbeTriangle& triangle : narrowed_) {
    if (triangle.normal.dot(normal) < kParallel) return {};
    for (const btVector3& other : triangle.corners) {
      const btScalar height = normal.dot(other - corner);
      if (btFabs(height) > kInPlane * reach_) return {};
      highest = std::max(highest, height);
    }
  }
  return {normal, -normal.dot(corner) - highest};
}

/// If several triangles are equally near, at an edge or a corner, the one whose normal is most nearly along the offset
/// determines the side. Triangles beyond the reach that the point is in front of only matter if it would otherwise
/// count as inside.
ShapeDistance MeshProbe::at(const btVector3& point) const {
  constexpr btScalar kSame = btScalar(1e-4);  // relative to the distance
  ShapeDistance found{reach_, btVector3(0, 1, 0)};
  btScalar minimum = std::max(reach_, thickness_), facing = 0;
  const auto look = [&](const ProbeTriangle& triangle, btScalar height, btScalar most) {
    if (btFabs(height) > most || !isBeside(triangle, point, most)) return;
    const btVector3 away = offsetFrom(triangle, point);
    const btScalar distance = away.length();
    if (distance > minimum * (1 + kSame) || (distance > minimum * (1 - kSame) && btFabs(height) <= facing)) return;
    minimum = std::min(minimum, distance);
    facing = btFabs(height);
    // For a point on the triangle itself, the offset has no direction, so the normal is used.
    const bool on = !(distance > SIMD_EPSILON);
    found = {height < 0 ? -distance : distance, on ? triangle.normal : (height < 0 ? -away : away) / distance};
  };
  for (const ProbeTriangle& triangle : narrowed_) {
    const btScalar height = triangle.normal.dot(point - triangle.corners[0]);
    look(triangle, height, std::min(minimum, height < 0 ? thickness_ : reach_));
  }
  for (std::size_t k = 0; k < narrowed_.size() && found.distance < 0; ++k) {
    const btScalar height = narrowed_[k].normal.dot(point - narrowed_[k].corners[0]);
    if (!(height < 0)) look(narrowed_[k], height, minimum);
  }
  const bool isNear = found.distance < reach_ && !(found.distance < -thickness_);
  return isNear ? found : ShapeDistance{reach_, btVector3(0, 1, 0)};
}

}  // namespace tetskin::bullet_detail
