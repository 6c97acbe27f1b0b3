// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/rigid/surface_patches.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/triangle_samples.h>
#include <tetskin/core/src/base/mesh/used_vertices.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace tetskin::contact_detail {

using namespace bullet_detail;

namespace {

using Point = EmbeddedPoint<btScalar>;

/// Triangles with edges longer than this, in mean edges of tets, have samples by default. A sphere half an edge wide
/// rests 0.05 edges or less deep between three corners this far apart; with 0.43 it would pass.
constexpr double kLargeInEdges = 0.25;
/// Spacing of these samples, in mean edges. A box edge that lies between two rows of samples is at most half of this
/// deep.
constexpr double kSpacingInEdges = 0.125;
/// Largest number of divisions of an edge. The number of samples reaches its limit long before.
constexpr double kMaxEdgeDivisions = 1 << 14;

void dropRepeated(std::vector<Point>& points) {
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.weights < b.weights; });
  const auto same = [](const Point& a, const Point& b) { return a.weights == b.weights; };
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
}

/// Removes the nodes that carry none of the patch's points: where vertices are nodes, as on a cage's own surface, most
/// corners of their tets do not.
void dropIdleNodes(LoosePatch& patch) {
  const std::size_t count = patch.nodes.size(), points = patch.weights.size() / count;
  std::size_t kept = 0;
  std::vector<char> carries(count, 0);
  for (std::size_t k = 0; k < patch.weights.size(); ++k) carries[k % count] |= patch.weights[k] != 0;
  for (std::size_t k = 0; k < patch.weights.size(); ++k) {
    if (carries[k % count]) patch.weights[kept++] = patch.weights[k];
  }
  patch.weights.resize(kept);
  std::size_t n = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (carries[k]) patch.nodes[n++] = patch.nodes[k];
  }
  patch.nodes.resize(n);
  assert(n > 0 && patch.weights.size() == points * n);
  (void)points;
}

/// points  all in one tet
LoosePatch patchOf(std::vector<Point> points) {
  assert(!points.empty());
  LoosePatch patch;
  patch.nodes.assign(points.front().nodes.begin(), points.front().nodes.end());
  dropRepeated(points);
  for (const Point& point : points) {
    patch.weights.insert(patch.weights.end(), point.weights.begin(), point.weights.end());
  }
  dropIdleNodes(patch);
  return patch;
}

/// One patch for each tet with vertices inside, and one for each tet with vertices outside. Vertices that no triangle
/// uses are skipped.
std::vector<LoosePatch> vertexPatches(const Embedding& embedding, const TriangleMesh& mesh) {
  std::vector<LoosePatch> patches;
  const std::vector<char> used = usedVertices(mesh);
  const std::vector<std::uint32_t>& vertices = embedding.slotVertices();
  for (std::size_t slot = 0; slot < vertices.size();) {
    const Point first = embedding.at<btScalar>(vertices[slot]);
    std::vector<Point> points;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (; slot < vertices.size(); ++slot) {
      const Point point = embedding.at<btScalar>(vertices[slot]);
      if (point.tet != first.tet || point.inside != first.inside) break;
      if (!used[vertices[slot]]) continue;
      points.push_back(point);
      sum += mesh.positions[vertices[slot]];
    }
    if (points.empty()) continue;
    const auto count = static_cast<double>(points.size());
    patches.push_back(patchOf(std::move(points)));
    patches.back().centroid = sum / count;
  }
  return patches;
}

std::uint32_t powerOf2(double atLeast) {
  std::uint32_t power = 1;
  while (power < std::min(atLeast, kMaxEdgeDivisions)) power *= 2;
  return power;
}

/// The samples on a triangle, with all nodes of the tets of its corners.
LoosePatch trianglePatch(const Embedding& embedding, const TriangleMesh& mesh, const std::array<int, 3>& triangle,
                         std::uint32_t divisions) {
  LoosePatch patch;
  patch.divisions = divisions;
  std::array<Point, 3> corners;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto vertex = static_cast<std::size_t>(triangle[c]);
    corners[c] = embedding.at<btScalar>(vertex);
    patch.centroid += mesh.positions[vertex] / 3.0;
    patch.nodes.insert(patch.nodes.end(), corners[c].nodes.begin(), corners[c].nodes.end());
  }
  std::sort(patch.nodes.begin(), patch.nodes.end());
  patch.nodes.erase(std::unique(patch.nodes.begin(), patch.nodes.end()), patch.nodes.end());
  assert(patch.nodes.size() <= kMaxCarriers);
  patch.weights.assign(3 * patch.nodes.size(), 0);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto node = std::lower_bound(patch.nodes.begin(), patch.nodes.end(), corners[c].nodes[k]);
      const auto at = static_cast<std::size_t>(node - patch.nodes.begin());
      patch.weights[c * patch.nodes.size() + at] += corners[c].weights[k];
    }
  }
  dropIdleNodes(patch);
  return patch;
}

/// The mean edge of the tet that carries a vertex.
double edgeAt(const Embedding& embedding, int vertex, const std::vector<btScalar>& restNodes) {
  const Point point = embedding.at<btScalar>(static_cast<std::size_t>(vertex));
  TetCorners corners;
  for (std::size_t k = 0; k < 4; ++k) {
    const btScalar* at = &restNodes[4 * static_cast<std::size_t>(point.nodes[k])];
    corners[k] = Eigen::Vector3d(static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2]));
  }
  return edgeSum(corners) / 6.0;
}

}  // namespace

Divisions divisionsFor(const TriangleMesh& mesh, double spacing) {
  assert(spacing > 0.0);
  Divisions divisions;
  for (const std::array<int, 3>& t : mesh.triangles) divisions.push_back(powerOf2(edgeDivisions(mesh, t, spacing)));
  return divisions;
}

Divisions defaultDivisions(const Embedding& embedding, const TriangleMesh& mesh,
                           const std::vector<btScalar>& restNodes) {
  assert(embedding.vertexCount() == mesh.vertexCount() && restNodes.size() == 4 * embedding.nodeCount());
  Divisions divisions;
  for (const std::array<int, 3>& t : mesh.triangles) {
    double edge = edgeAt(embedding, t[0], restNodes);
    for (const int v : {t[1], t[2]}) edge = std::min(edge, edgeAt(embedding, v, restNodes));
    const bool isLarge = edge > 0.0 && edgeDivisions(mesh, t, kLargeInEdges * edge) > 1.0;
    divisions.push_back(isLarge ? powerOf2(edgeDivisions(mesh, t, kSpacingInEdges * edge)) : 1);
  }
  while (countOfSamples(divisions) > kMaxSamples) {
    for (std::uint32_t& parts : divisions) parts = std::max(parts / 2, 1U);
  }
  return divisions;
}

double countOfSamples(const Divisions& divisions) {
  double count = 0.0;
  for (const std::uint32_t parts : divisions) count += samplesOf(parts);
  return count;
}

ContactPatches makeContactPatches(const Embedding& embedding, const TriangleMesh& mesh, const Divisions& divisions) {
  assert(embedding.vertexCount() == mesh.vertexCount());
  assert(divisions.empty() || divisions.size() == mesh.triangleCount());
  std::vector<LoosePatch> loose = vertexPatches(embedding, mesh);
  for (std::size_t t = 0; t < divisions.size(); ++t) {
    if (divisions[t] > 1) loose.push_back(trianglePatch(embedding, mesh, mesh.triangles[t], divisions[t]));
  }
  return clustered(loose);
}

}  // namespace tetskin::contact_detail
