// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: the points of the surface that may touch, in groups that are passed over together.
#pragma once

#include <LinearMath/btVector3.h>
#include <tetskin/bullet/src/shared/bodies/point_contacts.h>
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

constexpr std::size_t kMostCarriers = kMaxPointNodes;

struct ContactPatches {
  std::vector<ContactPatch> patches;
  std::vector<PatchCluster> clusters;
  std::vector<int> nodes, clusterNodes;
  std::vector<btScalar> weights;  ///< of the nodes of its patch, point by point; below 0 for what lies beyond them
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
