// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/triangle_mesh.h>

#include <vector>

namespace tetskin::scenes {

/// By node of a cage: the tet of another one, of the same mesh, that it belongs to. Where these are split, by the
/// nearest vertex of the mesh in the node's own tets; by its place otherwise. Throws InputError.
std::vector<int> tetsOfNodes(const TriangleMesh& mesh, const Cage& driver, const Cage& cage);

}  // namespace tetskin::scenes
