// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

#include <string>

namespace tetskin::scenes {

/// Appends a mesh to another: positions, triangles, groups with their materials, and texture coordinates if both have
/// them. Returns the index of its first vertex in the result.
/// name  of all of its groups, instead of their own names
std::size_t append(const TriangleMesh& part, TriangleMesh& whole, const std::string& name = "");

}  // namespace tetskin::scenes
