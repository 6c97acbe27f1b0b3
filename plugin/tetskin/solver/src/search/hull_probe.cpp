// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <LinearMath/btConvexHullComputer.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/solver/src/search/hull_probe.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <numeric>

namespace tetskin::bullet_detail {
namespace {

std::vector<btVector3> cornersOfFace(const btConvexHullComputer& hull, int face) {
  std::vector<btVector3> corners;
  const btConvexHullComputer::Edge* first = &hull.edges[hull.faces[face]];
  const btConvexHullComputer::Edge* edge = first;
  do {
    corners.push_back(hull.vertices[edge->getSourceVertex()]);
    edge = edge->getNextEdgeOfFace();
  } while (edge != first);
  return corners;
}

/// Twice the area vector of a polygon.
btVector3 areaOf(const std::vector<btVector3>& corners) {
  btVector3 area(0, 0, 0);
  for (std::size_t k = 2; k < corners.size(); ++k) {
    area += (corners[k - 1] - corners[0]).cross(corners[k] - corners[0]);
  }
  return area;
}

}  // namespace

void FacePlanes::clear() {
  for (std::vector<btScalar>* values : {&x, &y, &z, &offsets}) values->clear();
}

void FacePlanes::add(const btVector3& normal, btScalar offset) {
  x.push_back(normal.x());
  y.push_back(normal.y());
  z.push_back(normal.z());
  offsets.push_back(offset);
}

HullFaces::HullFaces(const btConvexHullShape& shape) : scaling_(shape.getLocalScalingNV()) {
  const int count = shape.getNumPoints();
  points_.assign(shape.getUnscaledPoints(), shape.getUnscaledPoints() + count);
  std::vector<btVector3> scaled;
  for (const btVector3& point : points_) scaled.push_back(point * scaling_);
  firstTriangle_.push_back(0);
  if (count < 4) return;
  btConvexHullComputer hull;
  hull.compute(scaled[0].m_floats, sizeof(btVector3), count, 0, 0);
  const btVector3 inside = std::accumulate(scaled.begin(), scaled.end(), btVector3(0, 0, 0)) / btScalar(count);
  for (int f = 0; f < hull.faces.size(); ++f) addFace(cornersOfFace(hull, f));
  // For points in one plane, Bullet makes two faces, back to back.
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    if (planes_.height(f, inside) < -SIMD_EPSILON) continue;
    planes_.clear();
    return;
  }
}

void HullFaces::addFace(const std::vector<btVector3>& corners) {
  btVector3 normal = areaOf(corners);
  const btScalar length = normal.length();
  if (!(length > 0)) return;
  normal /= length;
  btScalar offset = -BT_LARGE_FLOAT;
  for (const btVector3& corner : corners) offset = std::max(offset, normal.dot(corner));
  planes_.add(normal, offset);
  for (std::size_t k = 2; k < corners.size(); ++k) {
    triangles_.push_back({toEigen(corners[0]), toEigen(corners[k - 1]), toEigen(corners[k])});
  }
  firstTriangle_.push_back(static_cast<std::uint32_t>(triangles_.size()));
  assert(firstTriangle_.size() == planes_.size() + 1);
}

bool HullFaces::fits(const btConvexHullShape& shape) const {
  if (shape.getNumPoints() != static_cast<int>(points_.size()) || !(shape.getLocalScalingNV() == scaling_))
    return false;
  return std::equal(points_.begin(), points_.end(), shape.getUnscaledPoints(),
                    [](const btVector3& a, const btVector3& b) { return a == b; });
}

btVector3 HullFaces::offsetFrom(std::size_t face, const btVector3& point) const {
  assert(face < planes_.size() && firstTriangle_[face] < firstTriangle_[face + 1]);
  const Eigen::Vector3d p = toEigen(point);
  Eigen::Vector3d nearest = Eigen::Vector3d::Constant(static_cast<double>(BT_LARGE_FLOAT));
  for (std::uint32_t t = firstTriangle_[face]; t < firstTriangle_[face + 1]; ++t) {
    const Eigen::Vector3d offset = p - closestPointOnTriangle(p, triangles_[t]).point;
    if (offset.squaredNorm() < nearest.squaredNorm()) nearest = offset;
  }
  return toBullet(nearest);
}

/// Several objects may share one shape, and shapes may be changed in place.
std::shared_ptr<const HullFaces> HullProbe::find(const btConvexHullShape& shape) {
  const auto found = known_.find(&shape);
  std::shared_ptr<const HullFaces> faces = found == known_.end() ? nullptr : found->second.lock();
  if (faces && faces->fits(shape)) return faces;
  for (auto hull = known_.begin(); hull != known_.end();) {
    hull = hull->second.expired() ? known_.erase(hull) : std::next(hull);
  }
  faces = std::make_shared<const HullFaces>(shape);
  known_[&shape] = faces;
  return faces;
}

bool HullProbe::take(const btConvexHullShape& shape) {
  faces_ = find(shape);
  all_.resize(faces_->planes().size());
  std::iota(all_.begin(), all_.end(), std::size_t{0});
  return !faces_->empty();
}

bool HullProbe::enter(const Ball& ball, btScalar reach) {
  assert(faces_ && !faces_->empty());
  if (!keepNear(all_, ball, reach, entered_)) return false;
  narrowed_ = entered_;
  return true;
}

bool HullProbe::narrow(const CarrierPaths&, const Ball& ball, btScalar reach) {
  return keepNear(entered_, ball, reach, narrowed_);
}

/// Keeps the faces that can be the nearest to a point in the ball. A face whose plane is lower below the centre than
/// the highest one by more than the ball's diameter is never the highest within the ball. Points beside an edge are
/// nearest to faces that are lower than the highest one, but in front of those faces.
bool HullProbe::keepNear(const std::vector<std::size_t>& from, const Ball& ball, btScalar reach,
                         std::vector<std::size_t>& kept) {
  assert(!from.empty() && &from != &kept);
  const FacePlanes& planes = faces_->planes();
  heights_.resize(from.size());
  for (std::size_t k = 0; k < from.size(); ++k) heights_[k] = planes.height(from[k], ball.centre);
  const auto top = std::max_element(heights_.begin(), heights_.end());
  const btScalar highest = *top;
  bound_ =
      ShapeBound::behind({highest, planes.normal(from[static_cast<std::size_t>(top - heights_.begin())])}, ball.centre);
  if (highest > ball.radius + reach) return false;
  const btScalar low = highest - 2 * (ball.radius + reach);
  kept.clear();
  for (std::size_t k = 0; k < from.size(); ++k) {
    if (heights_[k] >= low) kept.push_back(from[k]);
  }
  return true;
}

ShapeDistance HullProbe::at(const btVector3& point) const {
  assert(!narrowed_.empty());
  const FacePlanes& planes = faces_->planes();
  btScalar height = -BT_LARGE_FLOAT;
  std::size_t top = 0;
  for (const std::size_t face : narrowed_) {
    const btScalar other = planes.height(face, point);
    if (!(other > height)) continue;
    height = other;
    top = face;
  }
  const ShapeDistance highest{height, planes.normal(top)};
  return height > 0 ? outside(point, highest) : highest;
}

ShapeDistance HullProbe::outside(const btVector3& point, const ShapeDistance& highest) const {
  btScalar minimum = BT_LARGE_FLOAT;
  btVector3 away = highest.normal;
  for (const std::size_t face : narrowed_) {
    if (!(faces_->planes().height(face, point) > 0)) continue;
    const btVector3 from = faces_->offsetFrom(face, point);
    if (from.length2() < minimum) {
      minimum = from.length2();
      away = from;
    }
  }
  const btScalar distance = btSqrt(minimum);
  return distance > SIMD_EPSILON ? ShapeDistance{distance, away / distance} : highest;
}

}  // namespace tetskin::bullet_detail
