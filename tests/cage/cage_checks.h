// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/create_cage.h>

#include <string>

namespace tetskin::test {

struct Built {
  Status status;
  Cage cage;
  CageReport report;
};
Built build(const TriangleMesh& mesh, std::size_t target = 3000, bool fit = true, bool split = true);

/// The first promise of a cage that does not hold; empty if all hold: clean (`checkTetMesh`), dihedral angles, every
/// vertex of a triangle inside (by `embed`, which trusts the map), what the cage stores about the mesh, components
/// without hinges, and a report that agrees.
std::string faultOfCage(const TriangleMesh& mesh, const Cage& cage, const CageReport& report);

/// The first fault in the topology of a cage without duplicate elements; empty if there is none: at most two tets at a
/// face, no coincident nodes, tets connected face to face around every node, and a manifold boundary.
std::string faultOfTopology(const TetMesh& cage);

/// Creates a cage and describes its faults, including the number of tets; empty if there are none.
std::string buildFault(const TriangleMesh& mesh, std::size_t targetTets, bool fit = true, CageReport* report = nullptr);

}  // namespace tetskin::test
