// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to embedding: keeps vertices outside the cage on the component that carries their neighbours.
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/point_reader.h>
#include <tetskin/core/types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace tetskin {

/// The nearest tet may belong to another part of the cage: a vertex that pokes out of one leg may be nearer to the
/// other leg, and would be torn along with it. So a vertex outside stays with its neighbours: if its tet is not
/// connected to any of theirs through tets around the vertex, it takes the nearest tet that is, unless that is farther
/// away by more than an edge of the tet. If that one would extrapolate the vertex too far, it takes the connected tet
/// with the smallest weights; if they all would, it stays where it is. Vertices are visited from the inside outwards,
/// each once; in a piece of the mesh without a vertex inside, the reassigned ones are visited, from the others
/// outwards.
///
/// first      by vertex: the first one at its position, see `weldCoincident`; they share edges and tets
/// triangles  of the mesh; a vertex without triangles is left alone
/// reassigned by vertex, or empty: see `TetSearch`
/// tetOf      by vertex: its tet, or ~tet if it lies outside of it; changed
/// Returns    the number of vertices that changed their tet
/// Cost       O(vertexCount + triangleCount + tetCount) if any vertex is outside. In addition, for each of these whose
///            tet shares no node with any of its neighbours', all connected tets that are as near to it as its
///            neighbours, or as its own tet plus an edge of it: for a mesh far outside, that may be the whole cage for
///            every vertex
std::size_t reassignByConnectivity(const TetMesh& cage, PointReader vertices, const std::vector<std::uint32_t>& first,
                                   const std::vector<std::array<int, 3>>& triangles,
                                   const std::vector<bool>& reassigned, std::vector<std::int32_t>& tetOf);

}  // namespace tetskin
