// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/triangle_mesh.h>

#include <string>

namespace tetskin::scenes {

/// Adds a mesh to another: positions, triangles, groups with their materials, and texture coordinates if all have them.
/// Returns its first vertex there.
/// name  of all of its groups instead of their own
std::size_t append(const TriangleMesh& part, TriangleMesh& whole, const std::string& name = "");

}  // namespace tetskin::scenes
