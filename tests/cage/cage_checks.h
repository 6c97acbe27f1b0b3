// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/cage_builder.h>

#include <string>

namespace tetskin::test {

/// What a cage promises, as the first thing that does not hold; empty if all does: clean (`checkTetMesh`), dihedral
/// angles, every vertex inside (by `embed`), at most two tets at a face, no coincident nodes, tets connected face to
/// face around every node, a manifold boundary, and a report that agrees.
std::string faultOfCage(const TriangleMesh& mesh, const TetMesh& cage, const CageReport& report);

/// The part of it that is topology: from "at most two tets at a face" to the boundary.
std::string faultOfTopology(const TetMesh& cage);

/// Builds a cage and says what is wrong with it, the number of tets included; empty if nothing is.
std::string buildFault(const TriangleMesh& mesh, std::size_t targetTets, bool fit = true, CageReport* report = nullptr);

}  // namespace tetskin::test
