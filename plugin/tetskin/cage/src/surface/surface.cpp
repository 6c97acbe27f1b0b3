// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/surface/orientation.h>
#include <tetskin/cage/src/surface/surface.h>
#include <tetskin/core/src/shared/base/disjoint_sets.h>
#include <tetskin/core/src/shared/base/lists.h>
#include <tetskin/core/src/shared/mesh/weld.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tetskin::cage_detail {
namespace {

/// A triangle whose area is below this fraction of its longest edge squared has no side: its normal is rounding error.
constexpr double kThinTriangle = 1e-12;

/// The point that each vertex became.
std::vector<int> weld(const TriangleMesh& mesh, Surface& surface) {
  const std::vector<std::uint32_t> first = weldCoincident(viewOf(mesh.positions));
  std::vector<int> pointOf(mesh.vertexCount());
  for (std::size_t v = 0; v < pointOf.size(); ++v) {
    if (first[v] == v) {
      pointOf[v] = static_cast<int>(surface.points.size());
      surface.points.push_back(mesh.positions[v]);
    } else {
      pointOf[v] = pointOf[first[v]];
    }
  }
  return pointOf;
}

bool hasArea(const Surface& surface, const std::array<int, 3>& t) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
  double longest = 0.0;
  for (int i = 0; i < 3; ++i) {
    longest = std::max(longest, (surface.points[t[i]] - surface.points[t[(i + 1) % 3]]).squaredNorm());
  }
  return areaVector(surface, t).norm() > kThinTriangle * longest;
}

/// Keeps the first of every set of triangles with the same three points. Bucketed by lowest point: linear.
void addDistinct(const std::vector<std::array<int, 3>>& triangles, Surface& surface) {
  const auto sorted = [](std::array<int, 3> t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  Lists<> byLowest = packLists(surface.points.size(), [&](auto&& add) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) add(static_cast<std::size_t>(sorted(triangles[t])[0]), t);
  });
  std::vector<char> keep(triangles.size(), 1);
  for (std::size_t p = 0; p < surface.points.size(); ++p) {
    const auto begin = byLowest.values.begin() + byLowest.starts[p],
               end = byLowest.values.begin() + byLowest.starts[p + 1];
    std::stable_sort(begin, end, [&](auto a, auto b) { return sorted(triangles[a]) < sorted(triangles[b]); });
    for (auto i = begin; i != end; ++i) {
      if (i != begin && sorted(triangles[*i]) == sorted(triangles[*(i - 1)])) keep[*i] = 0;
    }
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (keep[t]) surface.triangles.push_back(triangles[t]);
  }
}

void findLoosePoints(Surface& surface) {
  std::vector<char> used(surface.points.size(), 0);
  for (const auto& t : surface.triangles) {
    for (const int p : t) used[p] = 1;
  }
  for (std::size_t p = 0; p < used.size(); ++p) {
    if (!used[p]) surface.loosePoints.push_back(static_cast<int>(p));
  }
}

std::size_t countComponents(const Surface& surface) {
  DisjointSets sets(surface.points.size());
  for (const auto& t : surface.triangles) {
    sets.unite(t[0], t[1]);
    sets.unite(t[0], t[2]);
  }
  std::vector<char> seen(surface.points.size(), 0);
  std::size_t count = 0;
  for (const auto& t : surface.triangles) {
    char& root = seen[sets.find(t[0])];
    count += root ? 0 : 1;
    root = 1;
  }
  return count;
}

void measure(Surface& surface) {
  const Eigen::Vector3d centre = surface.box.center();
  double volume = 0.0;
  for (std::size_t t = 0; t < surface.solidCount; ++t) {
    const Eigen::Vector3d normal = areaVector(surface, surface.triangles[t]);
    surface.area += normal.norm();
    volume += normal.dot(surface.points[surface.triangles[t][0]] - centre) / 3.0;
  }
  surface.volume = std::abs(volume) > kSheetVolume * surface.area * std::sqrt(surface.area) ? std::abs(volume) : 0.0;
}

}  // namespace

Surface prepareSurface(const TriangleMesh& mesh) {
  Surface surface;
  surface.pointOf = weld(mesh, surface);
  surface.box = boundingBox(surface.points);
  std::vector<std::array<int, 3>> triangles(mesh.triangleCount());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) triangles[t][i] = surface.pointOf[mesh.triangles[t][i]];
  }
  addDistinct(triangles, surface);
  const auto solidEnd = std::stable_partition(surface.triangles.begin(), surface.triangles.end(),
                                              [&](const auto& t) { return hasArea(surface, t); });
  assert(surface.pointOf.size() == mesh.vertexCount() && surface.triangles.size() <= mesh.triangleCount());
  surface.solidCount = static_cast<std::size_t>(solidEnd - surface.triangles.begin());
  findLoosePoints(surface);
  surface.components = countComponents(surface);
  orient(surface);
  measure(surface);
  return surface;
}

}  // namespace tetskin::cage_detail
