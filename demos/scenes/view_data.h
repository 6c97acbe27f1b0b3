// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How a page holds what it draws: as JSON, its long arrays as {"u16": "..."}, {"u32": "..."} or {"f32": "..."}, base64
// of little-endian numbers, which browsers turn into typed arrays.
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/triangle_mesh.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace tetskin::scenes {

using Json = nlohmann::ordered_json;

std::string base64(std::string_view bytes);
/// In 16 bits where they suffice for the largest.
Json packed(const std::vector<std::uint32_t>& indices);
Json packed(const std::vector<std::uint16_t>& words);
Json packed(const std::vector<float>& numbers);

/// Triangles, and the materials of their groups by name.
Json trianglesOf(const TriangleMesh& mesh);
/// Those, and positions minus an origin: a mesh that does not deform.
Json rigidMeshOf(const TriangleMesh& mesh, const Eigen::Vector3d& origin);

/// All that linear and quadratic skinning need of a mesh in its cage, and the cage's edges. Throws InputError if they
/// do not fit.
/// embedding  of the mesh in the cage
Json skinOf(const Cage& cage, const TriangleMesh& mesh, const Embedding& embedding);

}  // namespace tetskin::scenes
