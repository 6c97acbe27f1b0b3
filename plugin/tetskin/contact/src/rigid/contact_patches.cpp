// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/rigid/contact_patches.h>
#include <tetskin/core/src/bvh/bvh.h>
#include <tetskin/core/src/embedding/embedding_data.h>
#include <tetskin/core/src/mesh/triangle_samples.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

/// Patches in a cluster: enough that passing over it pays, few enough that it is small.
constexpr int kPatchesPerCluster = 12;

/// A point with its weights, of the nodes of its patch, while patches are collected.
struct CarriedPoint {
  std::array<btScalar, kMostCarriers> weights{}, acting{};
  bool operator==(const CarriedPoint& other) const { return weights == other.weights && acting == other.acting; }
  bool operator<(const CarriedPoint& other) const {
    return weights != other.weights ? weights < other.weights : acting < other.acting;
  }
};

struct LoosePatch {
  std::vector<int> nodes;
  std::vector<CarriedPoint> points;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< rest space
};

std::array<float, 4> withFourth(const std::array<std::vector<float>, 3>& planes, std::size_t at) {
  const float a = planes[0][at], b = planes[1][at], c = planes[2][at];
  return {a, b, c, 1.0F - a - b - c};
}

/// Closest points' weights leave the tet by rounding alone.
std::array<float, 4> actingWeights(const EmbeddingData& data, std::size_t slot) {
  auto weights = slot < data.insideCount ? withFourth(data.weights, slot)
                                         : withFourth(data.closestWeights, slot - data.insideCount);
  for (float& w : weights) w = std::max(w, 0.0F);
  return weights;
}

CarriedPoint carriedVertex(const EmbeddingData& data, std::size_t slot) {
  CarriedPoint point;
  const auto weights = withFourth(data.weights, slot), acting = actingWeights(data, slot);
  for (std::size_t k = 0; k < 4; ++k) {
    point.weights[k] = static_cast<btScalar>(weights[k]);
    point.acting[k] = static_cast<btScalar>(acting[k]);
  }
  return point;
}

void dropRepeated(std::vector<CarriedPoint>& points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
}

std::vector<LoosePatch> vertexPatches(const EmbeddingData& data, const TriangleMesh& mesh) {
  std::vector<LoosePatch> patches;
  for (std::size_t r = 0; r + 1 < data.runs.size(); ++r) {
    const EmbeddingData::Run& run = data.runs[r];
    const std::size_t end = data.runs[r + 1].firstSlot;
    if (run.firstSlot == end) continue;
    LoosePatch patch;
    patch.nodes.assign(run.nodes, run.nodes + 4);
    for (std::size_t slot = run.firstSlot; slot < end; ++slot) {
      patch.points.push_back(carriedVertex(data, slot));
      patch.centroid += mesh.positions[data.slotVertices[slot]];
    }
    patch.centroid /= static_cast<double>(end - run.firstSlot);
    dropRepeated(patch.points);
    patches.push_back(std::move(patch));
  }
  return patches;
}

/// By vertex: the run of its tet.
std::vector<std::uint32_t> runsOfVertices(const EmbeddingData& data) {
  std::vector<std::uint32_t> runs(data.vertexCount());
  for (std::size_t r = 0; r + 1 < data.runs.size(); ++r) {
    for (std::size_t slot = data.runs[r].firstSlot; slot < data.runs[r + 1].firstSlot; ++slot) {
      runs[data.slotVertices[slot]] = static_cast<std::uint32_t>(r);
    }
  }
  return runs;
}

/// A triangle's corners, by the nodes of them all.
struct CarriedTriangle {
  std::vector<int> nodes;
  std::array<CarriedPoint, 3> corners;
};

CarriedTriangle carriedTriangle(const EmbeddingData& data, const std::vector<std::uint32_t>& runs,
                                const std::array<int, 3>& triangle) {
  CarriedTriangle carried;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto vertex = static_cast<std::size_t>(triangle[c]);
    const CarriedPoint own = carriedVertex(data, data.vertexSlots[vertex]);
    for (std::size_t k = 0; k < 4; ++k) {
      const int node = data.runs[runs[vertex]].nodes[k];
      auto at = std::find(carried.nodes.begin(), carried.nodes.end(), node);
      if (at == carried.nodes.end()) at = carried.nodes.insert(at, node);
      const auto place = static_cast<std::size_t>(at - carried.nodes.begin());
      carried.corners[c].weights[place] += own.weights[k];
      carried.corners[c].acting[place] += own.acting[k];
    }
  }
  return carried;
}

CarriedPoint pointWithin(const CarriedTriangle& triangle, const std::array<btScalar, 3>& at) {
  CarriedPoint point;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < triangle.nodes.size(); ++k) {
      point.weights[k] += at[c] * triangle.corners[c].weights[k];
      point.acting[k] += at[c] * triangle.corners[c].acting[k];
    }
  }
  return point;
}

/// At the corners of the small triangles into which each edge's `steps` cut it, but not at its own.
void appendSamples(const CarriedTriangle& triangle, int steps, std::vector<CarriedPoint>& points) {
  const auto weight = [&](int n) { return static_cast<btScalar>(n) / static_cast<btScalar>(steps); };
  forEachSample(steps, [&](int i, int j, int k) {
    if (std::max({i, j, k}) < steps) points.push_back(pointWithin(triangle, {weight(i), weight(j), weight(k)}));
  });
}

void appendTrianglePatches(const EmbeddingData& data, const TriangleMesh& mesh, double spacing,
                           std::vector<LoosePatch>& patches) {
  const std::vector<std::uint32_t> runs = runsOfVertices(data);
  for (const std::array<int, 3>& t : mesh.triangles) {
    const double steps = edgeDivisions(mesh, t, spacing);
    if (!(steps > 1.0)) continue;
    const CarriedTriangle triangle = carriedTriangle(data, runs, t);
    LoosePatch patch;
    patch.nodes = triangle.nodes;
    for (const int v : t) patch.centroid += mesh.positions[static_cast<std::size_t>(v)] / 3.0;
    appendSamples(triangle, static_cast<int>(steps), patch.points);
    patches.push_back(std::move(patch));
  }
}

/// Neighbouring patches are in one leaf.
Bvh clustersOf(const std::vector<LoosePatch>& patches) {
  Bvh::Centroids<double> centroids;
  centroids.reserve(patches.size());
  for (const LoosePatch& patch : patches) centroids.push_back(patch.centroid);
  return {centroids, kPatchesPerCluster};
}

btScalar spreadOf(const LoosePatch& patch) {
  btScalar spread = 1;
  for (const CarriedPoint& point : patch.points) {
    btScalar sum = 0;
    for (const btScalar w : point.weights) sum += std::abs(w);
    spread = std::max(spread, sum);
  }
  return spread;
}

void append(const LoosePatch& loose, ContactPatches& to) {
  ContactPatch patch;
  patch.firstNode = static_cast<std::uint32_t>(to.nodes.size());
  patch.nodeCount = static_cast<std::uint32_t>(loose.nodes.size());
  patch.firstPoint = static_cast<std::uint32_t>(to.pointCount);
  patch.pointCount = static_cast<std::uint32_t>(loose.points.size());
  patch.firstWeight = static_cast<std::uint32_t>(to.weights.size());
  patch.spread = spreadOf(loose);
  to.nodes.insert(to.nodes.end(), loose.nodes.begin(), loose.nodes.end());
  for (const CarriedPoint& point : loose.points) {
    to.weights.insert(to.weights.end(), point.weights.begin(), point.weights.begin() + patch.nodeCount);
    to.acting.insert(to.acting.end(), point.acting.begin(), point.acting.begin() + patch.nodeCount);
  }
  to.pointCount += loose.points.size();
  to.patches.push_back(patch);
}

void closeCluster(std::size_t firstPatch, ContactPatches& to) {
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
  std::vector<LoosePatch> loose = vertexPatches(embedding.data(), mesh);
  if (spacing > 0.0) appendTrianglePatches(embedding.data(), mesh, spacing, loose);
  const Bvh clusters = clustersOf(loose);
  ContactPatches result;
  for (const Bvh::Node& node : clusters.nodes()) {
    if (!node.isLeaf()) continue;
    for (int k = node.first; k < node.last; ++k) append(loose[static_cast<std::size_t>(clusters.item(k))], result);
    closeCluster(static_cast<std::size_t>(node.first), result);
  }
  return result;
}

}  // namespace tetskin
