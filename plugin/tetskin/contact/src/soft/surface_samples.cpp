// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/surface_samples.h>
#include <tetskin/core/src/base/mesh/triangle_samples.h>
#include <tetskin/core/src/base/mesh/weld.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <unordered_set>

namespace tetskin::contact_detail {
namespace {

/// Number of cubes that a flat surface passes through, per face area of a cube: 1 along the axes, 1.73 diagonally.
constexpr double kCubesPerFace = 1.3;
/// Largest number of divisions of a triangle's edges: enough for a triangle as long as the whole model.
constexpr int kMaxDivisions = 256;

/// Keeps the first point in each cube of a lattice.
class CubeSieve {
 public:
  explicit CubeSieve(double side) : inverse_(1.0 / side) { assert(side > 0.0); }
  bool takes(const Eigen::Vector3d& p) {
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) {
      // 21 bits per coordinate: with more cubes than that, some would share a key, and lose a sample.
      const auto cube = static_cast<std::int64_t>(std::floor(p[k] * inverse_));
      key = (key << 21) | (static_cast<std::uint64_t>(cube) & 0x1FFFFF);
    }
    return taken_.insert(key).second;
  }

 private:
  double inverse_;
  std::unordered_set<std::uint64_t> taken_;
};

double areaOf(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const Eigen::Vector3d& a = mesh.positions[t[0]];
  return 0.5 * (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).norm();
}

void sampleTriangle(const TriangleMesh& mesh, const std::array<int, 3>& t, double spacing, CubeSieve& sieve,
                    std::vector<SurfaceSample>& samples) {
  const int divisions = static_cast<int>(std::min<double>(edgeDivisions(mesh, t, spacing), kMaxDivisions));
  if (divisions < 2) return;
  forEachSample(divisions, [&](int i, int j, int) {
    const double u = static_cast<double>(i) / divisions, v = static_cast<double>(j) / divisions;
    const Eigen::Vector3d p =
        (1.0 - u - v) * mesh.positions[t[0]] + u * mesh.positions[t[1]] + v * mesh.positions[t[2]];
    if (sieve.takes(p)) samples.push_back({p, -1, t});
  });
}

/// By vertex: its height above its neighbours in these triangles, relative to their distance.
std::vector<double> prominence(const TriangleMesh& mesh, const std::vector<int>& triangles) {
  // At seams and tips, several vertices share a position.
  const std::vector<std::uint32_t> first = weldCoincident(viewOf(mesh.positions));
  std::vector<Eigen::Vector3d> direction(mesh.vertexCount(), Eigen::Vector3d::Zero());
  std::vector<Eigen::Vector3d> area(mesh.vertexCount(), Eigen::Vector3d::Zero());
  std::vector<double> length(mesh.vertexCount(), 0.0);
  for (const int t : triangles) {
    const auto& corners = mesh.triangles[t];
    const Eigen::Vector3d &a = mesh.positions[corners[0]], &b = mesh.positions[corners[1]];
    const Eigen::Vector3d normal = (b - a).cross(mesh.positions[corners[2]] - a);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = first[corners[k]];
      area[v] += normal;
      for (const int other : {corners[(k + 1) % 3], corners[(k + 2) % 3]}) {
        direction[v] += mesh.positions[v] - mesh.positions[other];
        length[v] += (mesh.positions[v] - mesh.positions[other]).norm();
      }
    }
  }
  std::vector<double> out(mesh.vertexCount(), 0.0);
  for (std::size_t v = 0; v < out.size(); ++v) {
    const double size = area[v].norm() * length[v];
    if (size > 0.0) out[v] = direction[v].dot(area[v]) / size;
  }
  for (std::size_t v = 0; v < out.size(); ++v) out[v] = out[first[v]];
  return out;
}

/// Tips come first: they touch before their surroundings do.
std::vector<SurfaceSample> verticesByProminence(const TriangleMesh& mesh, const std::vector<int>& triangles) {
  const std::vector<double> out = prominence(mesh, triangles);
  std::vector<SurfaceSample> vertices;
  std::vector<char> listed(mesh.vertexCount(), 0);
  for (const int t : triangles) {
    for (const int v : mesh.triangles[t]) {
      if (!listed[v]) vertices.push_back({mesh.positions[v], v, mesh.triangles[t]});
      listed[v] = 1;
    }
  }
  std::stable_sort(vertices.begin(), vertices.end(),
                   [&](const SurfaceSample& a, const SurfaceSample& b) { return out[a.vertex] > out[b.vertex]; });
  return vertices;
}

}  // namespace

std::vector<SurfaceSample> sampleSurface(const TriangleMesh& mesh, const std::vector<int>& triangles,
                                         std::size_t count) {
  assert(count > 0);
  double area = 0.0;
  for (const int t : triangles) area += areaOf(mesh, mesh.triangles[t]);
  std::vector<SurfaceSample> samples;
  if (!(area > 0.0)) return samples;
  const double side = std::sqrt(kCubesPerFace * area / static_cast<double>(count));
  CubeSieve sieve(side);
  for (const SurfaceSample& vertex : verticesByProminence(mesh, triangles)) {
    if (sieve.takes(vertex.point)) samples.push_back(vertex);
  }
  for (const int t : triangles) sampleTriangle(mesh, mesh.triangles[t], side, sieve, samples);
  return samples;
}

}  // namespace tetskin::contact_detail
