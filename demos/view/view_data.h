// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How a page stores what it draws: as JSON, with long arrays as {"u16": "..."}, {"u32": "..."} or {"f32": "..."},
// base64 of little-endian numbers, which browsers turn into typed arrays.
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/mesh.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tetskin::view {

using Json = nlohmann::ordered_json;

/// No page can be made: a mesh does not fit its cage, or a file that pages are made from cannot be read.
struct ViewError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::string base64(std::string_view bytes);
/// Uses 16 bits if they suffice for the largest index.
Json packed(const std::vector<std::uint32_t>& indices);
Json packed(const std::vector<std::uint16_t>& words);
Json packed(const std::vector<float>& numbers);

/// A mesh's triangles, and the materials of its groups by name.
Json trianglesOf(const TriangleMesh& mesh);
/// A mesh that does not deform: triangles, materials, and positions relative to an origin.
Json rigidMeshOf(const TriangleMesh& mesh, const Eigen::Vector3d& origin);

/// Everything that linear and quadratic skinning need of a mesh in its cage, and the cage's edges. Throws ViewError if
/// they do not fit.
/// embedding  of the mesh in the cage
Json skinOf(const Cage& cage, const TriangleMesh& mesh, const Embedding& embedding);

}  // namespace tetskin::view
