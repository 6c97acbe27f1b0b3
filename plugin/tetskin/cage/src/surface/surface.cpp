// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/surface/orientation.h>
#include <tetskin/cage/src/surface/surface.h>
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/lists.h>
#include <tetskin/core/src/base/mesh/weld.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tetskin::cage_detail {
namespace {

/// A triangle whose area is below this fraction of its longest edge squared has no sides: its normal is rounding error.
constexpr double kThinTriangle = 1e-12;

using Triangles = std::vector<std::array<int, 3>>;

/// The triangles by the first vertex at each corner's position, without those that are points: these connect nothing,
/// and have no extent that a tet could cover.
Triangles weldedTriangles(const TriangleMesh& mesh, const std::vector<std::uint32_t>& first) {
  Triangles welded;
  welded.reserve(mesh.triangleCount());
  for (const std::array<int, 3>& t : mesh.triangles) {
    const auto corner = [&](int i) { return static_cast<int>(first[static_cast<std::size_t>(t[i])]); };
    const std::array<int, 3> corners = {corner(0), corner(1), corner(2)};
    if (corners[0] != corners[1] || corners[0] != corners[2]) welded.push_back(corners);
  }
  return welded;
}

/// Makes a point of each position that triangles use, in the order of the vertices. Vertices of cut-off parts often
/// stay in the file: tets around them would belong to nothing, and fall apart.
void makePoints(const TriangleMesh& mesh, const std::vector<std::uint32_t>& first, Triangles& triangles,
                Surface& surface) {
  std::vector<char> used(mesh.vertexCount(), 0);
  for (const std::array<int, 3>& t : triangles) {
    for (const int v : t) used[v] = 1;
  }
  surface.pointOf.assign(mesh.vertexCount(), -1);
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) {
      surface.pointOf[v] = static_cast<int>(surface.points.size());
      surface.points.push_back(mesh.positions[v]);
    } else if (first[v] != v) {
      surface.pointOf[v] = surface.pointOf[first[v]];
    }
    surface.looseVertices += surface.pointOf[v] < 0 ? 1 : 0;
  }
  for (std::array<int, 3>& t : triangles) {
    for (int& v : t) v = surface.pointOf[v];
  }
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
void addDistinct(const Triangles& triangles, Surface& surface) {
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
  const std::vector<std::uint32_t> first = weldCoincident(viewOf(mesh.positions));
  Triangles triangles = weldedTriangles(mesh, first);
  makePoints(mesh, first, triangles, surface);
  surface.box = boundingBox(surface.points);
  addDistinct(triangles, surface);
  const auto solidEnd = std::stable_partition(surface.triangles.begin(), surface.triangles.end(),
                                              [&](const auto& t) { return hasArea(surface, t); });
  assert(surface.pointOf.size() == mesh.vertexCount() && surface.triangles.size() <= mesh.triangleCount());
  surface.solidCount = static_cast<std::size_t>(solidEnd - surface.triangles.begin());
  surface.components = countComponents(surface);
  orient(surface);
  measure(surface);
  return surface;
}

}  // namespace tetskin::cage_detail
