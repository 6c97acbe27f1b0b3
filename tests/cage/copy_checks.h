// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/cage_builder.h>

#include <string>

namespace tetskin::test {

/// Number of parts of a mesh of tets that are connected by faces: more than by nodes if some hang together by a node or
/// an edge alone, which is a hinge.
std::size_t countPartsByFaces(const TetMesh& cage);

/// What tets with copies must be in place of what `faultOfTopology` asks of cages that are not split: at most two
/// places of the lattice at a face, parts connected by faces, and numbered so; empty if they are.
std::string faultOfCopies(const Cage& cage, const CageReport& report);

/// What a cage knows of its mesh, as the first thing that does not hold: every vertex in the tet that the map names,
/// those at one position in the same; masses that add up to the mesh's volume, none below 0.09 of the mean; fill.
std::string faultOfKnowledge(const TriangleMesh& mesh, const Cage& cage, const CageReport& report);

/// Sum of the tets' volumes times their fill.
double filledVolume(const Cage& cage);

/// True if both are the same to the bit, whatever is known of the mesh included.
bool sameCage(const Cage& a, const Cage& b);

}  // namespace tetskin::test
