// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/rigid/contact_patches.h>
#include <tetskin/core/src/shared/bvh/bvh.h>
#include <tetskin/core/src/shared/mesh/triangle_samples.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

using Point = EmbeddedPoint<btScalar>;

/// Patches per cluster: enough that skipping a cluster pays, few enough that it is small.
constexpr int kPatchesPerCluster = 12;

/// The points carried by the same nodes, while patches are collected.
struct LoosePatch {
  std::vector<int> nodes;
  std::vector<btScalar> weights;                       ///< of the nodes, point by point
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< rest space

  std::size_t pointCount() const { return weights.size() / nodes.size(); }
};

void dropRepeated(std::vector<Point>& points) {
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.weights < b.weights; });
  const auto same = [](const Point& a, const Point& b) { return a.weights == b.weights; };
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
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
  return patch;
}

/// One patch for each tet with vertices inside, and one for each tet with vertices outside.
std::vector<LoosePatch> vertexPatches(const Embedding& embedding, const TriangleMesh& mesh) {
  std::vector<LoosePatch> patches;
  const std::vector<std::uint32_t>& vertices = embedding.slotVertices();
  for (std::size_t slot = 0; slot < vertices.size();) {
    const Point first = embedding.at<btScalar>(vertices[slot]);
    std::vector<Point> points;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (; slot < vertices.size(); ++slot) {
      const Point point = embedding.at<btScalar>(vertices[slot]);
      if (point.tet != first.tet || point.inside != first.inside) break;
      points.push_back(point);
      sum += mesh.positions[vertices[slot]];
    }
    const auto count = static_cast<double>(points.size());
    patches.push_back(patchOf(std::move(points)));
    patches.back().centroid = sum / count;
  }
  return patches;
}

/// A triangle's corners, and the nodes of all their tets.
struct EmbeddedTriangle {
  std::array<Point, 3> corners;
  std::vector<int> nodes;
  std::array<std::array<std::size_t, 4>, 3> indices{};  ///< by corner and node of its tet: index in `nodes`
};

EmbeddedTriangle embeddedTriangle(const Embedding& embedding, const std::array<int, 3>& vertices) {
  EmbeddedTriangle triangle;
  for (std::size_t c = 0; c < 3; ++c) {
    triangle.corners[c] = embedding.at<btScalar>(static_cast<std::size_t>(vertices[c]));
    for (std::size_t k = 0; k < 4; ++k) {
      const int node = triangle.corners[c].nodes[k];
      const auto found = std::find(triangle.nodes.begin(), triangle.nodes.end(), node);
      triangle.indices[c][k] = static_cast<std::size_t>(found - triangle.nodes.begin());
      if (found == triangle.nodes.end()) triangle.nodes.push_back(node);
    }
  }
  return triangle;
}

/// shares  weights of the corners
void appendSample(const EmbeddedTriangle& triangle, const std::array<btScalar, 3>& weights, LoosePatch& patch) {
  assert(btFabs(weights[0] + weights[1] + weights[2] - 1) < btScalar(1e-5));
  assert(!triangle.nodes.empty() && triangle.nodes.size() <= kMaxCarriers);
  const std::size_t first = patch.weights.size();
  patch.weights.resize(first + triangle.nodes.size(), 0);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < 4; ++k) {
      patch.weights[first + triangle.indices[c][k]] += weights[c] * triangle.corners[c].weights[k];
    }
  }
}

/// Appends the corners of the small triangles into which `steps` cuts per edge divide the triangle, without its own
/// corners.
void appendSamples(const EmbeddedTriangle& triangle, int steps, LoosePatch& patch) {
  const auto weight = [&](int n) { return static_cast<btScalar>(n) / static_cast<btScalar>(steps); };
  forEachSample(steps, [&](int i, int j, int k) {
    if (std::max({i, j, k}) < steps) appendSample(triangle, {weight(i), weight(j), weight(k)}, patch);
  });
}

void appendTrianglePatches(const Embedding& embedding, const TriangleMesh& mesh, double spacing,
                           std::vector<LoosePatch>& patches) {
  for (const std::array<int, 3>& t : mesh.triangles) {
    const double steps = edgeDivisions(mesh, t, spacing);
    if (!(steps > 1.0)) continue;
    const EmbeddedTriangle triangle = embeddedTriangle(embedding, t);
    LoosePatch patch;
    patch.nodes = triangle.nodes;
    for (const int v : t) patch.centroid += mesh.positions[static_cast<std::size_t>(v)] / 3.0;
    appendSamples(triangle, static_cast<int>(steps), patch);
    patches.push_back(std::move(patch));
  }
}

/// A hierarchy whose leaves are clusters of neighbouring patches.
Bvh clustersOf(const std::vector<LoosePatch>& patches) {
  Bvh::Centroids<double> centroids;
  centroids.reserve(patches.size());
  for (const LoosePatch& patch : patches) centroids.push_back(patch.centroid);
  return {centroids, kPatchesPerCluster};
}

btScalar spreadOf(const LoosePatch& patch) {
  assert(!patch.nodes.empty() && patch.weights.size() % patch.nodes.size() == 0);
  btScalar spread = 1;
  for (std::size_t p = 0; p < patch.weights.size(); p += patch.nodes.size()) {
    btScalar sum = 0;
    for (std::size_t k = 0; k < patch.nodes.size(); ++k) sum += std::abs(patch.weights[p + k]);
    spread = std::max(spread, sum);
  }
  return spread;
}

void append(const LoosePatch& loose, ContactPatches& to) {
  assert(loose.nodes.size() <= kMaxCarriers && loose.pointCount() > 0);
  ContactPatch patch;
  patch.firstNode = static_cast<std::uint32_t>(to.nodes.size());
  patch.nodeCount = static_cast<std::uint32_t>(loose.nodes.size());
  patch.firstPoint = static_cast<std::uint32_t>(to.pointCount);
  patch.pointCount = static_cast<std::uint32_t>(loose.pointCount());
  patch.firstWeight = static_cast<std::uint32_t>(to.weights.size());
  patch.spread = spreadOf(loose);
  to.nodes.insert(to.nodes.end(), loose.nodes.begin(), loose.nodes.end());
  to.weights.insert(to.weights.end(), loose.weights.begin(), loose.weights.end());
  to.pointCount += loose.pointCount();
  to.patches.push_back(patch);
}

void closeCluster(std::size_t firstPatch, ContactPatches& to) {
  assert(firstPatch < to.patches.size());
  PatchCluster cluster;
  cluster.firstPatch = static_cast<std::uint32_t>(firstPatch);
  cluster.patchCount = static_cast<std::uint32_t>(to.patches.size() - firstPatch);
  cluster.firstNode = static_cast<std::uint32_t>(to.clusterNodes.size());
  std::vector<int> nodes(to.nodes.begin() + to.patches[firstPatch].firstNode, to.nodes.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  cluster.nodeCount = static_cast<std::uint32_t>(nodes.size());
  to.clusterNodes.insert(to.clusterNodes.end(), nodes.begin(), nodes.end());
  for (std::size_t p = firstPatch; p < to.patches.size(); ++p) {
    cluster.spread = std::max(cluster.spread, to.patches[p].spread);
  }
  to.clusters.push_back(cluster);
}

}  // namespace

double countOfSamples(const TriangleMesh& mesh, double spacing) {
  double count = 0.0;
  for (const std::array<int, 3>& t : mesh.triangles) {
    const double steps = edgeDivisions(mesh, t, spacing);
    if (steps > 1.0) count += (steps + 1.0) * (steps + 2.0) / 2.0;
  }
  return count;
}

ContactPatches makeContactPatches(const Embedding& embedding, const TriangleMesh& mesh, double spacing) {
  assert(embedding.vertexCount() == mesh.vertexCount() && spacing >= 0.0);
  std::vector<LoosePatch> loose = vertexPatches(embedding, mesh);
  if (spacing > 0.0) appendTrianglePatches(embedding, mesh, spacing, loose);
  const Bvh clusters = clustersOf(loose);
  ContactPatches result;
  for (const Bvh::Node& node : clusters.nodes()) {
    if (!node.isLeaf()) continue;
    assert(result.patches.size() == static_cast<std::size_t>(node.first));
    for (int k = node.first; k < node.last; ++k) append(loose[static_cast<std::size_t>(clusters.item(k))], result);
    closeCluster(static_cast<std::size_t>(node.first), result);
  }
  return result;
}

}  // namespace tetskin
