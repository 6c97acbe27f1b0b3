// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <LinearMath/btConvexHullComputer.h>
#include <tetskin/contact/src/rigid/hull_probe.h>

#include <algorithm>
#include <numeric>

namespace tetskin {
namespace {

/// Hulls that are kept, of shapes that may be long gone.
constexpr std::size_t kMostHulls = 64;

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

/// Twice the area, as a vector.
btVector3 areaOf(const std::vector<btVector3>& corners) {
  btVector3 area(0, 0, 0);
  for (std::size_t k = 2; k < corners.size(); ++k) {
    area += (corners[k - 1] - corners[0]).cross(corners[k] - corners[0]);
  }
  return area;
}

}  // namespace

void FaceRows::clear() {
  for (std::vector<btScalar>* values : {&x, &y, &z, &offsets}) values->clear();
  faces.clear();
}

void FaceRows::add(const btVector3& normal, btScalar offset, std::uint32_t face) {
  x.push_back(normal.x());
  y.push_back(normal.y());
  z.push_back(normal.z());
  offsets.push_back(offset);
  faces.push_back(face);
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
  // Of points in a plane Bullet makes two faces, back to back.
  for (std::size_t f = 0; f < rows_.size(); ++f) {
    if (rows_.height(f, inside) < -SIMD_EPSILON) continue;
    rows_.clear();
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
  rows_.add(normal, offset, static_cast<std::uint32_t>(rows_.size()));
  for (std::size_t k = 2; k < corners.size(); ++k) triangles_.push_back({corners[0], corners[k - 1], corners[k]});
  firstTriangle_.push_back(static_cast<std::uint32_t>(triangles_.size()));
}

bool HullFaces::fits(const btConvexHullShape& shape) const {
  if (shape.getNumPoints() != static_cast<int>(points_.size()) || !(shape.getLocalScalingNV() == scaling_))
    return false;
  return std::equal(points_.begin(), points_.end(), shape.getUnscaledPoints(),
                    [](const btVector3& a, const btVector3& b) { return a == b; });
}

btVector3 HullFaces::closest(std::uint32_t face, const btVector3& point) const {
  btVector3 best(0, 0, 0);
  btScalar least = BT_LARGE_FLOAT;
  for (std::uint32_t t = firstTriangle_[face]; t < firstTriangle_[face + 1]; ++t) {
    const btVector3 on = closestOnTriangle(triangles_[t], point);
    const btScalar squared = (on - point).length2();
    if (squared < least) {
      least = squared;
      best = on;
    }
  }
  return best;
}

bool HullProbe::take(const btConvexHullShape& shape) {
  auto found = known_.find(&shape);
  if (found == known_.end() || !found->second.fits(shape)) {
    if (known_.size() >= kMostHulls) known_.clear();
    found = known_.insert_or_assign(&shape, HullFaces(shape)).first;
  }
  faces_ = &found->second;
  return !faces_->empty();
}

bool HullProbe::enter(const Ball& ball, btScalar reach) {
  if (!keepNear(faces_->rows(), ball, reach, entered_)) return false;
  narrowed_ = entered_;
  return true;
}

bool HullProbe::narrow(const CarrierPaths&, const Ball& ball, btScalar reach) {
  return keepNear(entered_, ball, reach, narrowed_);
}

/// A face whose plane is lower under the centre than the highest by more than the ball's diameter is never the highest
/// within the ball. Points beside an edge are nearest to faces that are lower than the highest, but look to them.
bool HullProbe::keepNear(const FaceRows& from, const Ball& ball, btScalar reach, FaceRows& kept) {
  heights_.resize(from.size());
  for (std::size_t k = 0; k < from.size(); ++k) heights_[k] = from.height(k, ball.centre);
  const auto top = std::max_element(heights_.begin(), heights_.end());
  const btScalar highest = *top;
  bound_ = ShapeBound::behind({highest, from.normal(static_cast<std::size_t>(top - heights_.begin()))}, ball.centre);
  if (highest > ball.radius + reach) return false;
  const btScalar low = highest - 2 * (ball.radius + reach);
  kept.clear();
  for (std::size_t k = 0; k < from.size(); ++k) {
    if (heights_[k] >= low) kept.add(from.normal(k), from.offsets[k], from.faces[k]);
  }
  return true;
}

ShapeDistance HullProbe::at(const btVector3& point) const {
  ShapeDistance highest{-BT_LARGE_FLOAT, btVector3(0, 1, 0)};
  for (std::size_t k = 0; k < narrowed_.size(); ++k) {
    const btScalar height = narrowed_.height(k, point);
    if (height > highest.distance) highest = {height, narrowed_.normal(k)};
  }
  if (highest.distance <= 0) return highest;
  btScalar least = BT_LARGE_FLOAT;
  btVector3 away = highest.normal;
  for (std::size_t k = 0; k < narrowed_.size(); ++k) {
    if (!(narrowed_.height(k, point) > 0)) continue;
    const btVector3 from = point - faces_->closest(narrowed_.faces[k], point);
    if (from.length2() < least) {
      least = from.length2();
      away = from;
    }
  }
  const btScalar distance = btSqrt(least);
  return distance > SIMD_EPSILON ? ShapeDistance{distance, away / distance} : highest;
}

}  // namespace tetskin
