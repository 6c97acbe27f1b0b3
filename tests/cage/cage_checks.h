// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/cage_builder.h>

#include <string>

namespace tetskin::test {

/// What a cage promises, as the first thing that does not hold; empty if all does: clean (`checkTetMesh`), dihedral
/// angles, every vertex inside (by `embed`, which believes the map), what it knows of the mesh, parts without hinges,
/// and a report that agrees.
std::string faultOfCage(const TriangleMesh& mesh, const Cage& cage, const CageReport& report);

/// Of a cage that is not split: at most two tets at a face, no coincident nodes, tets connected face to face around
/// every node, a manifold boundary.
std::string faultOfTopology(const TetMesh& cage);

/// Builds a cage and says what is wrong with it, the number of tets included; empty if nothing is.
std::string buildFault(const TriangleMesh& mesh, std::size_t targetTets, bool fit = true, CageReport* report = nullptr);

}  // namespace tetskin::test
