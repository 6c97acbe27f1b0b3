// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/surface/surface_samples.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::cage_detail {
namespace {

class TriangleRows {
 public:
  TriangleRows(const Surface& surface, double step, SurfaceSamples& samples)
      : surface_(surface), step_(step), samples_(samples) {}

  /// Adds rows of points parallel to the longest edge, with rows and points at most a step apart; none if that edge is
  /// shorter.
  void add(int triangle) {
    const std::array<int, 3>& t = surface_.triangles[triangle];
    int longest = 0;
    double length = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double edge = (at(t[(i + 1) % 3]) - at(t[i])).norm();
      if (edge <= length) continue;
      length = edge;
      longest = i;
    }
    if (length <= step_) return;
    const int corners[3] = {t[longest], t[(longest + 1) % 3], t[(longest + 2) % 3]};
    const Eigen::Vector3d &a = at(corners[0]), &b = at(corners[1]), &c = at(corners[2]);
    const double height = (b - a).cross(c - a).norm() / length;
    const int rows = static_cast<int>(std::ceil(height / step_));
    std::vector<int> before;
    for (int r = 0; r <= rows; ++r) {
      const double s = rows > 0 ? static_cast<double>(r) / rows : 0.0;
      std::vector<int> row = addRow(triangle, a + s * (c - a), b + s * (c - b));
      joinRows(before, row);
      if (r == 0) {
        join(corners[0], row.front());
        join(corners[1], row.back());
      }
      before = std::move(row);
    }
    if (rows > 0) join(corners[2], before.front());
  }

 private:
  const Eigen::Vector3d& at(int point) const { return surface_.points[point]; }
  void join(int a, int b) { samples_.steps.push_back({a, b}); }

  std::vector<int> addRow(int triangle, const Eigen::Vector3d& left, const Eigen::Vector3d& right) {
    const int columns = static_cast<int>(std::ceil((right - left).norm() / step_));
    std::vector<int> row;
    for (int k = 0; k <= columns; ++k) {
      row.push_back(static_cast<int>(samples_.points.size()));
      samples_.points.push_back(left + (columns > 0 ? static_cast<double>(k) / columns : 0.0) * (right - left));
      samples_.triangleOf.push_back(triangle);
      if (k > 0) join(row[row.size() - 2], row.back());
    }
    return row;
  }

  /// Joins each point of the longer row with its neighbour in the other row.
  void joinRows(const std::vector<int>& before, const std::vector<int>& row) {
    if (before.empty()) return;
    for (std::size_t k = 0; k < before.size(); ++k) {
      const std::size_t beside =
          before.size() > 1 ? (k * (row.size() - 1) + (before.size() - 1) / 2) / (before.size() - 1) : 0;
      join(before[k], row[beside]);
    }
  }

  const Surface& surface_;
  double step_;
  SurfaceSamples& samples_;
};

}  // namespace

SurfaceSamples sampleSurface(const Surface& surface, double step) {
  assert(step > 0.0);
  SurfaceSamples samples;
  samples.points = surface.points;
  TriangleRows rows(surface, step, samples);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) samples.steps.push_back({surface.triangles[t][k], surface.triangles[t][(k + 1) % 3]});
    rows.add(static_cast<int>(t));
  }
  assert(samples.points.size() == surface.points.size() + samples.triangleOf.size());
  return samples;
}

}  // namespace tetskin::cage_detail
