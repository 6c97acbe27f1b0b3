// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

namespace tetskin {

/// Adds each triangle's area vector (twice its area times its normal) to the sums of its corners.
/// sumOf  of a vertex: the Vector3d& to add to
template <class SumOf>
void sumAreaVectors(const TriangleMesh& mesh, std::size_t firstTriangle, SumOf&& sumOf) {
  for (std::size_t t = firstTriangle; t < mesh.triangleCount(); ++t) {
    const auto& corners = mesh.triangles[t];
    const Eigen::Vector3d& a = mesh.positions[static_cast<std::size_t>(corners[0])];
    const Eigen::Vector3d area = (mesh.positions[static_cast<std::size_t>(corners[1])] - a)
                                     .cross(mesh.positions[static_cast<std::size_t>(corners[2])] - a);
    for (const int v : corners) sumOf(static_cast<std::size_t>(v)) += area;
  }
}

}  // namespace tetskin
