// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: the points of a body that may touch rigid objects, in groups that are skipped together.
#pragma once

#include <LinearMath/btVector3.h>
#include <tetskin/core/src/base/bvh/bvh.h>
#include <tetskin/export.h>
#include <tetskin/solver/src/base/point_contacts.h>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace tetskin::bullet_detail {

/// Points carried by the same few nodes: the vertices in a tet, or the samples on a triangle.
///
/// Samples are the corners of the small triangles into which the triangle's edges are cut, except its own corners,
/// which are vertices. They are not stored: the sample at (i, j), with weight i / divisions of the second corner and j
/// / divisions of the third, has the number firstPoint + i * (divisions + 1) + j.
struct ContactPatch {
  std::uint32_t firstNode = 0;    ///< index in ContactPatches::nodes
  std::uint32_t nodeCount = 0;    ///< up to 4 for a tet, up to kMaxCarriers for a triangle
  std::uint32_t firstPoint = 0;   ///< number of its first point
  std::uint32_t pointCount = 0;   ///< number of vertices or samples
  std::uint32_t firstWeight = 0;  ///< index in ContactPatches::weights: nodeCount per vertex, or per corner
  std::uint32_t divisions = 0;    ///< of a triangle's edges, a power of 2; 0: the points are vertices
  btScalar spread = 1;            ///< the points are within the ball around the nodes' box, scaled by this

  bool isTriangle() const { return divisions > 0; }
  /// How many point numbers it occupies.
  std::uint32_t numberCount() const { return isTriangle() ? (divisions + 1) * (divisions + 1) : pointCount; }
};

/// A group of neighbouring patches.
struct PatchCluster {
  std::uint32_t firstPatch = 0, patchCount = 0;
  std::uint32_t firstNode = 0, nodeCount = 0;  ///< index in ContactPatches::clusterNodes, each node once
  btScalar spread = 1;                         ///< the largest spread of its patches
};

constexpr std::size_t kMaxCarriers = kMaxPointNodes;
/// Largest number of samples of a body: their numbers must not reach those of other points. A spacing that needs more
/// is most likely in the wrong unit.
constexpr double kMaxSamples = 10'000'000;

struct ContactPatches {
  std::vector<ContactPatch> patches;
  std::vector<PatchCluster> clusters;
  std::vector<int> nodes, clusterNodes;
  std::vector<btScalar> weights;  ///< of the nodes of each patch; below 0 for points outside of the tet
  std::size_t pointCount = 0;     ///< number of vertices and samples
  Bvh tree;                       ///< of the patches; its leaves, in their order, are the clusters
  std::vector<int> clusterOf;     ///< by node of the tree: its cluster; -1: not a leaf

  /// The weights of a point's nodes: nodeCount values.
  /// point  its number minus the patch's first one
  void weightsOf(const ContactPatch& patch, std::uint32_t point, btScalar* weights) const;
  CarriedPoint carriedPoint(const ContactPatch& patch, std::uint32_t point) const;
};

/// A patch not yet in a cluster.
struct LoosePatch {
  std::vector<int> nodes;
  std::vector<btScalar> weights;                       ///< of the nodes: point by point, or corner by corner
  std::uint32_t divisions = 0;                         ///< as in ContactPatch
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< rest space
};

/// The number of samples on a triangle with these divisions of its edges.
TETSKIN_SOLVER_API double samplesOf(std::uint32_t divisions);

/// Puts patches into clusters of neighbours. Cost O(n log n) for n patches
TETSKIN_SOLVER_API ContactPatches clustered(const std::vector<LoosePatch>& patches);

}  // namespace tetskin::bullet_detail
