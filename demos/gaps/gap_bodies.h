// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What comes to rest in the table of gaps: a serpent, a ball and an animal of four legs.
#pragma once

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/triangle_mesh.h>

#include <memory>
#include <string>
#include <vector>

namespace tetskin::gaps {

/// In the world's size, the largest side of the cage's box kSize, about the origin.
struct GapBody {
  TriangleMesh mesh;
  Cage cage;
  std::shared_ptr<const SoftBodyBinding> binding;
};

/// "serpent", "round", "legs".
const std::vector<std::string>& bodyNames();

/// Throws InputError for another name.
GapBody makeGapBody(const std::string& name, std::size_t tets, std::size_t triangles);

}  // namespace tetskin::gaps
