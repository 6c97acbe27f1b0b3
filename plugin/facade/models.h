// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Meshes and cages as other languages hold them: immutable, so that bodies, skins and threads share them.
#pragma once

#include "errors.h"

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>
#include <tetskin/core/mesh_skin.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace tetskin::facade {

using Vec3 = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  ///< x, y, z, w

struct MeshModel {
  std::shared_ptr<const TriangleMesh> mesh;
};
struct CageModel {
  std::shared_ptr<const Cage> cage;
  std::string report;  ///< of what made it, in words; may be empty
};

/// Throws unless all numbers are finite, and no larger than what the library supports.
const Vec3& finite(const Vec3& vector, const char* name);

/// Options by their words.
BindingOptions bindingOptions(const std::string& interpolation, const std::string& normals, const std::string& outside,
                              std::optional<double> maxDistance);
Interpolation interpolationOf(const std::string& name);

/// A rest space's place in the world.
Eigen::Affine3d placementOf(const Vec3& position, const Quaternion& rotation);

}  // namespace tetskin::facade
