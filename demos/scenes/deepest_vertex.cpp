// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/deepest_vertex.h"

#include <tetskin/core/src/base/mesh/triangle_bvh.h>
#include <tetskin/core/src/base/mesh/winding_tree.h>

#include <cmath>

namespace tetskin::scenes {
namespace {

/// Tests all vertices of one body against the triangles of another.
void compare(const std::vector<TriangleMesh>& surfaces, const std::vector<Box3>& boxes, std::size_t body,
             std::size_t other, const WindingTree& solid, const TriangleBvh& triangles, DeepestVertex& deepest) {
  const TriangleMesh& mesh = surfaces[body];
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const Eigen::Vector3d& p = mesh.positions[v];
    if (!boxes[other].contains(p) || solid.windingNumber(p) <= kInside) continue;
    ++deepest.count;
    const double depth = std::sqrt(triangles.nearest(p).squaredDistance);
    if (depth <= deepest.depth) continue;
    deepest.depth = depth;
    deepest.body = body;
    deepest.vertex = static_cast<int>(v);
    deepest.other = other;
  }
}

}  // namespace

DeepestVertex deepestVertex(const std::vector<TriangleMesh>& surfaces) {
  std::vector<Box3> boxes;
  for (const TriangleMesh& surface : surfaces) boxes.push_back(boundingBox(surface.positions));
  DeepestVertex deepest;
  for (std::size_t other = 0; other < surfaces.size(); ++other) {
    const WindingTree solid(surfaces[other]);
    const TriangleBvh triangles(surfaces[other]);
    for (std::size_t body = 0; body < surfaces.size(); ++body) {
      if (body != other && boxes[body].intersects(boxes[other])) {
        compare(surfaces, boxes, body, other, solid, triangles, deepest);
      }
    }
  }
  return deepest;
}

}  // namespace tetskin::scenes
