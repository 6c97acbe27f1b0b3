// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A cage with duplicate elements: copies of one lattice overlap, each for one component of the mesh.
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/mesh.h>

#include <array>
#include <cstdint>
#include <limits>

#include "support/odd_meshes.h"

namespace tetskin::test {

/// Two plates, 0.2 apart, in one layer of lattice cubes of edge 1; each plate has its own copies of the tets.
struct TwoPlates {
  Cage cage;  ///< tet t and tet t + latticeTets are copies, unless both plates share t
  TriangleMesh mesh;
  std::size_t plateVertices = 0;  ///< vertices of the first, lower plate; the others belong to the second
  std::size_t latticeTets = 0;    ///< number of tets before the copies: the first plate's come first

  bool upper(std::size_t vertex) const { return vertex >= plateVertices; }
};

/// Appends a sheet of 13 x 7 vertices in the plane of this y, within 4 x 1 x 2 cubes.
inline void addSheet(TriangleMesh& mesh, double y) {
  constexpr int kRows = 13, kColumns = 7;
  const int first = static_cast<int>(mesh.vertexCount());
  for (int i = 0; i < kRows; ++i) {
    for (int k = 0; k < kColumns; ++k) mesh.positions.emplace_back(0.17 + 0.3 * i, y, 0.13 + 0.29 * k);
  }
  for (int i = 0; i + 1 < kRows; ++i) {
    for (int k = 0; k + 1 < kColumns; ++k) {
      const int a = first + kColumns * i + k, b = a + kColumns;
      mesh.triangles.push_back({a, a + 1, b});
      mesh.triangles.push_back({b, a + 1, b + 1});
    }
  }
}

/// By tet of a lattice: the index of its copy for the second plate; the copies are appended with their nodes. Both
/// plates share the tets that reach no farther than x = joinedUntil.
inline std::vector<int> appendCopies(Cage& cage, double joinedUntil) {
  const TetMesh lattice = cage.mesh;
  std::vector<int> nodes(lattice.nodeCount()), tets(lattice.tetCount());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const bool shared = lattice.nodes[n].x() <= joinedUntil;
    nodes[n] = static_cast<int>(shared ? n : cage.mesh.nodeCount());
    if (!shared) cage.mesh.nodes.push_back(lattice.nodes[n]);
  }
  for (std::size_t t = 0; t < tets.size(); ++t) {
    Tet copy = lattice.tets[t];
    for (int& n : copy) n = nodes[static_cast<std::size_t>(n)];
    tets[t] = static_cast<int>(copy == lattice.tets[t] ? t : cage.mesh.tetCount());
    if (copy != lattice.tets[t]) cage.mesh.tets.push_back(copy);
  }
  return tets;
}

/// A cage with every field filled in; values that have no meaning here have many digits.
/// joinedUntil  below 0: the copies have no node in common; otherwise they branch off at this x, which is one of the
/// cubes'
inline TwoPlates platesOfCopies(double joinedUntil = -1.0) {
  TwoPlates made;
  for (const double y : {0.3, 0.35, 0.55, 0.6}) addSheet(made.mesh, y);
  made.plateVertices = made.mesh.vertexCount() / 2;
  Cage& cage = made.cage;
  cage = latticeCage(4, 1, 2);
  made.latticeTets = cage.mesh.tetCount();
  const auto bindings = embed(cage.mesh, viewOf(made.mesh.positions)).value().bindings();
  const std::vector<int> copyOf = appendCopies(cage, joinedUntil);
  for (std::size_t v = 0; v < bindings.size(); ++v) {
    cage.vertexTets.push_back(made.upper(v) ? copyOf[static_cast<std::size_t>(bindings[v].tet)] : bindings[v].tet);
  }
  cage.sourceTet.resize(cage.mesh.tetCount());
  for (std::size_t t = 0; t < made.latticeTets; ++t) {
    cage.sourceTet[t] = cage.sourceTet[static_cast<std::size_t>(copyOf[t])] = static_cast<int>(t);
  }
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    cage.component.push_back(joinedUntil < 0.0 && t >= made.latticeTets);
    cage.volumeFraction.push_back(1.0 / static_cast<double>(t + 1));
    cage.stiffnessFactor.push_back(static_cast<double>(t + 1) / 3.0);
    for (std::size_t k = 0; k < kFineTets; ++k) {
      cage.fineVolumeFraction.push_back(static_cast<std::uint8_t>(7 * t + 37 * k));
    }
  }
  for (std::size_t n = 0; n < cage.mesh.nodeCount(); ++n) cage.masses.push_back(0.1 + 0.7 / static_cast<double>(n + 1));
  cage.meshHash = positionsHash(made.mesh.positions);
  return made;
}

}  // namespace tetskin::test
