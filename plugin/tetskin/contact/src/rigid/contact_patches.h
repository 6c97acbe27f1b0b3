// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: the points of the surface that may touch, in groups that are skipped together.
#pragma once

#include <LinearMath/btVector3.h>
#include <tetskin/bullet/src/shared/bodies/point_contacts.h>
#include <tetskin/core/embedding.h>

#include <cstdint>
#include <vector>

namespace tetskin {

/// Points that are carried by the same few nodes: the vertices in a tet, or the samples on a triangle.
struct ContactPatch {
  std::uint32_t firstNode = 0;    ///< index in ContactPatches::nodes
  std::uint32_t nodeCount = 0;    ///< 4 for a tet, up to kMaxCarriers for a triangle
  std::uint32_t firstPoint = 0;   ///< number of its first point
  std::uint32_t pointCount = 0;   ///<
  std::uint32_t firstWeight = 0;  ///< index in ContactPatches::weights, which has nodeCount per point
  btScalar spread = 1;            ///< the points are within the ball around the nodes' box, scaled by this
};

/// A group of neighbouring patches.
struct PatchCluster {
  std::uint32_t firstPatch = 0, patchCount = 0;
  std::uint32_t firstNode = 0, nodeCount = 0;  ///< index in ContactPatches::clusterNodes, each node once
  btScalar spread = 1;                         ///< the largest spread of its patches
};

constexpr std::size_t kMaxCarriers = kMaxPointNodes;

struct ContactPatches {
  std::vector<ContactPatch> patches;
  std::vector<PatchCluster> clusters;
  std::vector<int> nodes, clusterNodes;
  std::vector<btScalar> weights;  ///< of the nodes of each patch, point by point; below 0 for points outside of the tet
  std::size_t pointCount = 0;
};

/// The number of samples on the larger triangles for a spacing above 0. Cost O(triangles)
double countOfSamples(const TriangleMesh& mesh, double spacing);

/// The patches of a mesh: its vertices, each position once, and, with a spacing above 0, samples on its larger
/// triangles, no farther than the spacing from each other. Cost O(n log n) for n points.
/// mesh     of the embedding
/// spacing  rest units
ContactPatches makeContactPatches(const Embedding& embedding, const TriangleMesh& mesh, double spacing);

}  // namespace tetskin
