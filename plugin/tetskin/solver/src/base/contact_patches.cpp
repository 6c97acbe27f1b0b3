// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/base/contact_patches.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// Patches per cluster: enough that skipping a cluster pays, few enough that it is small.
constexpr int kPatchesPerCluster = 12;

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
  assert(!loose.nodes.empty() && loose.nodes.size() <= kMaxCarriers && !loose.weights.empty());
  ContactPatch patch;
  patch.firstNode = static_cast<std::uint32_t>(to.nodes.size());
  patch.nodeCount = static_cast<std::uint32_t>(loose.nodes.size());
  patch.divisions = loose.divisions;
  patch.firstPoint = to.patches.empty() ? 0 : to.patches.back().firstPoint + to.patches.back().numberCount();
  const std::size_t weighted = loose.weights.size() / loose.nodes.size();
  patch.pointCount = patch.isTriangle() ? static_cast<std::uint32_t>(samplesOf(patch.divisions))
                                        : static_cast<std::uint32_t>(weighted);
  patch.firstWeight = static_cast<std::uint32_t>(to.weights.size());
  patch.spread = spreadOf(loose);
  to.nodes.insert(to.nodes.end(), loose.nodes.begin(), loose.nodes.end());
  to.weights.insert(to.weights.end(), loose.weights.begin(), loose.weights.end());
  to.pointCount += patch.pointCount;
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

void ContactPatches::weightsOf(const ContactPatch& patch, std::uint32_t point, btScalar* values) const {
  assert(point < patch.numberCount());
  const btScalar* from = &weights[patch.firstWeight];
  if (!patch.isTriangle()) {
    std::copy_n(from + point * patch.nodeCount, patch.nodeCount, values);
    return;
  }
  const std::uint32_t i = point / (patch.divisions + 1), j = point % (patch.divisions + 1);
  assert(i + j <= patch.divisions);
  const btScalar scale = 1 / static_cast<btScalar>(patch.divisions);
  const btScalar second = scale * static_cast<btScalar>(i), third = scale * static_cast<btScalar>(j);
  for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
    values[n] =
        (1 - second - third) * from[n] + second * from[patch.nodeCount + n] + third * from[2 * patch.nodeCount + n];
  }
}

CarriedPoint ContactPatches::carriedPoint(const ContactPatch& patch, std::uint32_t point) const {
  CarriedPoint carried;
  carried.count = patch.nodeCount;
  std::copy_n(&nodes[patch.firstNode], patch.nodeCount, carried.nodes.begin());
  weightsOf(patch, point, carried.weights.data());
  return carried;
}

double samplesOf(std::uint32_t divisions) {
  const double n = divisions;
  return divisions > 1 ? (n + 1.0) * (n + 2.0) / 2.0 - 3.0 : 0.0;
}

ContactPatches clustered(const std::vector<LoosePatch>& patches) {
  ContactPatches result;
  result.tree = clustersOf(patches);
  for (const Bvh::Node& node : result.tree.nodes()) {
    result.clusterOf.push_back(node.isLeaf() ? static_cast<int>(result.clusters.size()) : -1);
    if (!node.isLeaf()) continue;
    assert(result.patches.size() == static_cast<std::size_t>(node.first));
    for (int k = node.first; k < node.last; ++k) append(patches[static_cast<std::size_t>(result.tree.item(k))], result);
    closeCluster(static_cast<std::size_t>(node.first), result);
  }
  return result;
}

}  // namespace tetskin::bullet_detail
