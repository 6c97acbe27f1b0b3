// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

namespace tetskin::scenes {

/// Append an obstacle to a mesh, as a group "box" or "sphere", with the material of a floor or a dome.
/// slope  radians about z
void appendBox(TriangleMesh& mesh, const Eigen::Vector3d& centre, const Eigen::Vector3d& halfExtents, double slope);
void appendSphere(TriangleMesh& mesh, const Eigen::Vector3d& centre, double radius);

}  // namespace tetskin::scenes
