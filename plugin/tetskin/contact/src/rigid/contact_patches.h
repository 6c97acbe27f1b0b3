// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: the points of the surface that may touch, in groups that are passed over together.
#pragma once

#include <LinearMath/btVector3.h>
#include <tetskin/core/embedding.h>

#include <cstdint>
#include <vector>

namespace tetskin {

/// Points that are carried by the same few nodes: the vertices in a tet, or the samples on a triangle.
struct ContactPatch {
  std::uint32_t firstNode = 0;    ///< in ContactPatches::nodes
  std::uint32_t nodeCount = 0;    ///< 4 for a tet, up to kMostCarriers for a triangle
  std::uint32_t firstPoint = 0;   ///< numbers of its points
  std::uint32_t pointCount = 0;   ///<
  std::uint32_t firstWeight = 0;  ///< in ContactPatches::weights, nodeCount for each point
  btScalar spread = 1;            ///< points are within the ball around the nodes' box, times this
};

/// Neighbouring patches.
struct PatchCluster {
  std::uint32_t firstPatch = 0, patchCount = 0;
  std::uint32_t firstNode = 0, nodeCount = 0;  ///< in ContactPatches::clusterNodes, each node once
  btScalar spread = 1;                         ///< the largest of its patches
};

/// The corners of a triangle may each be in a tet of its own.
constexpr std::size_t kMostCarriers = 12;

struct ContactPatches {
  std::vector<ContactPatch> patches;
  std::vector<PatchCluster> clusters;
  std::vector<int> nodes, clusterNodes;
  std::vector<btScalar> weights;  ///< where a point is: of the nodes of its patch, point by point
  /// The same of the closest point of its tet for a vertex outside: those by which it acts, none of them negative.
  std::vector<btScalar> acting;
  std::size_t pointCount = 0;
};

/// How many samples a spacing above 0 takes on the larger triangles. Cost O(triangles)
double countOfSamples(const TriangleMesh& mesh, double spacing);

/// The vertices of a mesh, each place once, and with a spacing above 0 samples on its larger triangles, no farther than
/// that from each other. Cost O(n log n) for n of them.
/// mesh     of the embedding
/// spacing  rest units
ContactPatches makeContactPatches(const Embedding& embedding, const TriangleMesh& mesh, double spacing);

}  // namespace tetskin
