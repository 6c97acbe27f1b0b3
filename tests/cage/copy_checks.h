// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/create_cage.h>

#include <string>

namespace tetskin::test {

/// Number of components of a tet mesh that are connected by faces. There are more of these than of components connected
/// by nodes if some tets share only a node or an edge, which is a hinge.
std::size_t countComponentsByFaces(const TetMesh& cage);

/// The first fault of a cage with duplicate elements, which need not satisfy `faultOfTopology`; empty if there is none:
/// at most two tets of the lattice at a face, and components that are connected by faces and numbered accordingly.
std::string faultOfCopies(const Cage& cage, const CageReport& report);

/// The first fault in what a cage stores about its mesh; empty if there is none: every vertex is in the tet that the
/// map names, vertices at one position are in the same tet, the masses add up to the mesh's volume and none is below
/// 0.09 of the mean, and the volume fractions agree.
std::string faultOfKnowledge(const TriangleMesh& mesh, const Cage& cage, const CageReport& report);

/// Sum of the tets' volumes times their volume fractions.
double filledVolume(const Cage& cage);

/// Whether both cages are equal to the bit, including what they store about the mesh.
bool sameCage(const Cage& a, const Cage& b);

}  // namespace tetskin::test
