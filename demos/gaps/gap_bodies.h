// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The bodies in the table of gaps: a serpent, a ball and an animal with four legs.
#pragma once

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

#include <memory>
#include <string>
#include <vector>

namespace tetskin::gaps {

/// In world space, centred at the origin; the largest side of the cage's box is kSize.
struct GapBody {
  TriangleMesh mesh;
  Cage cage;
  std::shared_ptr<const SoftBodyBinding> binding;
};

/// The names of the bodies: "serpent", "round", "legs".
const std::vector<std::string>& bodyNames();

/// Throws InputError for any other name.
GapBody makeGapBody(const std::string& name, std::size_t tets, std::size_t triangles);

}  // namespace tetskin::gaps
