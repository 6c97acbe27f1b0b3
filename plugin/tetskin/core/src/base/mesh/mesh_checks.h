// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The checks of meshes and cages that several stages share.
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>

namespace tetskin {

/// The part of `checkTetMesh` that `validate` needs: all but duplicate tets and unreferenced nodes. Cost O(N + T) for N
/// nodes, allocates nothing.
TETSKIN_CORE_API TetMeshReport inspectForUse(const TetMesh& mesh);

/// `validate`, based on the report of either check.
TETSKIN_CORE_API Status validate(const TetMesh& mesh, const TetMeshReport& report);

/// Ok if a tet mesh may have these numbers of nodes and tets. Error: TooLarge
TETSKIN_CORE_API Status checkTetCounts(std::size_t nodes, std::size_t tets);

/// Ok if a triangle mesh may have these numbers of vertices and triangles. Error: TooLarge
TETSKIN_CORE_API Status checkTriangleCounts(std::size_t vertices, std::size_t triangles);

/// Validates a cage's data beside its tet mesh.
TETSKIN_CORE_API Status validateAttributes(const Cage& cage);

}  // namespace tetskin
