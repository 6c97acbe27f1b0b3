// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A mesh and its cage, by themselves. Everything here throws InputError.
#pragma once

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/cage/create_cage.h>

#include "scenes/placement.h"

namespace tetskin::scenes {

struct CagedMesh {
  TriangleMesh mesh;
  Cage cage;
};

Cage builtCage(const TriangleMesh& mesh, const CageOptions& options);
/// With default options, but for this number of tets.
Cage builtCage(const TriangleMesh& mesh, std::size_t tets);

SoftBodyBinding::Pointer boundTo(const Cage& cage, const TriangleMesh& mesh);

/// Puts the centre of the cage's box at the origin, and scales it to kSize. Returns how both were moved.
Placement putInWorld(TriangleMesh& mesh, Cage& cage);
/// A mesh in a built cage, put into the world.
CagedMesh inWorld(TriangleMesh mesh, std::size_t tets);

}  // namespace tetskin::scenes
