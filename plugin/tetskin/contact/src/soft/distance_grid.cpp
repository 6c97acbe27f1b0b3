// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>
#include <tetskin/contact/src/soft/distance_grid.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::contact_detail {
namespace {

/// Number of cubes added around the box.
constexpr int kGridBorder = 2;

btScalar between(btScalar a, btScalar b, btScalar t) {
  return a + (b - a) * t;
}

int cornersAlong(double side, double spacing) {
  return static_cast<int>(std::ceil(side / spacing)) + 2 * kGridBorder + 1;
}

}  // namespace

double cornersOfGrid(const Box3& box, int cells) {
  assert(!box.isEmpty() && cells > 0);
  const double spacing = box.sizes().maxCoeff() / cells;
  double corners = 1.0;
  for (int k = 0; k < 3; ++k) corners *= cornersAlong(box.sizes()[k], spacing);
  return corners;
}

DistanceGrid::DistanceGrid(const TriangleBvh& outside, const WindingTree& solid, const Box3& box, int cells) {
  assert(!box.isEmpty() && cells > 0);
  const double spacing = box.sizes().maxCoeff() / cells;
  const Eigen::Vector3d low = box.min() - Eigen::Vector3d::Constant(kGridBorder * spacing);
  for (int k = 0; k < 3; ++k) counts_[k] = cornersAlong(box.sizes()[k], spacing);
  stride_ = {1, static_cast<std::size_t>(counts_[0]),
             static_cast<std::size_t>(counts_[0]) * static_cast<std::size_t>(counts_[1])};
  low_ = toBullet(low);
  spacing_ = static_cast<btScalar>(spacing);
  inverseSpacing_ = 1 / spacing_;
  distances_.resize(stride_[2] * static_cast<std::size_t>(counts_[2]));
  for (int z = 0; z < counts_[2]; ++z) {
    for (int y = 0; y < counts_[1]; ++y) {
      fillRow(outside, solid, low + spacing * Eigen::Vector3d(0, y, z), spacing, &distances_[indexOf(0, y, z)]);
    }
  }
  findSteepness();
}

/// Between corners, each slope is a mean of those along the surrounding edges.
void DistanceGrid::findSteepness() {
  float squares = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float most = 0;
    for (int z = 0; z + (axis == 2) < counts_[2]; ++z) {
      for (int y = 0; y + (axis == 1) < counts_[1]; ++y) {
        for (int x = 0; x + (axis == 0) < counts_[0]; ++x) {
          const float* d = &distances_[indexOf(x, y, z)];
          most = std::max(most, std::abs(d[stride_[axis]] - d[0]));
        }
      }
    }
    squares += most * most;
  }
  steepness_ = static_cast<btScalar>(std::sqrt(squares)) * inverseSpacing_;
}

/// From one corner to the next, the nearest triangle is the same one or near it. The distance changes by at most the
/// spacing, so the sign can only change near the surface.
void DistanceGrid::fillRow(const TriangleBvh& outside, const WindingTree& solid, const Eigen::Vector3d& first,
                           double spacing, float* row) const {
  NearestPoint nearest;
  bool inside = false, known = false;
  for (int x = 0; x < counts_[0]; ++x) {
    const Eigen::Vector3d p = first + Eigen::Vector3d(x * spacing, 0, 0);
    nearest = outside.nearest(p, nearest);
    const double distance = std::sqrt(nearest.squaredDistance);
    if (!known || distance <= 2.0 * spacing) inside = solid.windingNumber(p) > kInside;
    known = true;
    row[x] = static_cast<float>(inside ? -distance : distance);
  }
}

bool DistanceGrid::at(const btVector3& point, GridDistance& result) const {
  int cell[3];
  btScalar t[3];
  for (int k = 0; k < 3; ++k) {
    const btScalar position = (point[k] - low_[k]) * inverseSpacing_;
    if (!(position >= 0 && position < static_cast<btScalar>(counts_[k] - 1))) return false;
    cell[k] = static_cast<int>(position);
    t[k] = position - static_cast<btScalar>(cell[k]);
  }
  const float* d = &distances_[indexOf(cell[0], cell[1], cell[2])];
  assert(indexOf(cell[0] + 1, cell[1] + 1, cell[2] + 1) < distances_.size());
  const std::size_t y = stride_[1], z = stride_[2];
  const btScalar x00 = between(d[0], d[1], t[0]), x10 = between(d[y], d[y + 1], t[0]);
  const btScalar x01 = between(d[z], d[z + 1], t[0]), x11 = between(d[y + z], d[y + z + 1], t[0]);
  const btScalar low = between(x00, x10, t[1]), high = between(x01, x11, t[1]);
  result.distance = between(low, high, t[2]);
  const btScalar slopeLow = between(d[1] - d[0], d[y + 1] - d[y], t[1]);
  const btScalar slopeHigh = between(d[z + 1] - d[z], d[y + z + 1] - d[y + z], t[1]);
  result.gradient.setValue(between(slopeLow, slopeHigh, t[2]), between(x10 - x00, x11 - x01, t[2]), high - low);
  result.gradient *= inverseSpacing_;
  return true;
}

bool DistanceGrid::hasInside() const {
  return std::any_of(distances_.begin(), distances_.end(), [](float d) { return d < 0; });
}

}  // namespace tetskin::contact_detail
