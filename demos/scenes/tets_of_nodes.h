// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

#include <vector>

namespace tetskin::scenes {

/// For each node of a cage, the tet of another cage of the same mesh that it belongs to. If cages have duplicate
/// elements, it is found by the nearest vertex of the mesh in the node's own tets; otherwise by position. Throws
/// InputError.
std::vector<int> tetsOfNodes(const TriangleMesh& mesh, const Cage& driver, const Cage& cage);

}  // namespace tetskin::scenes
