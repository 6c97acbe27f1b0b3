// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Quadratic tets: ten nodes, whose displacement is a quadratic function between them. They bend as linear tets, which
// are too stiff, cannot. A cage holds each as the eight linear tets of its uniform refinement, so that whatever reads
// tets (embedding, contact, picking, Bullet itself) goes on as it does.
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/types.h>

#include <array>
#include <cstddef>
#include <vector>

namespace tetskin {

/// Number of nodes of a quadratic tet.
constexpr std::size_t kQuadraticNodes = 10;
/// Number of the linear tets that a quadratic one is made of.
constexpr std::size_t kSubTets = 8;

/// A quadratic tet of a cage, with straight edges.
struct QuadraticTet {
  /// Corners 0 to 3, positively oriented, then the midpoints of the edges 01, 02, 03, 12, 13, 23.
  std::array<int, kQuadraticNodes> nodes{};
  std::array<int, kSubTets> tets{};  ///< of the cage, ascending
};

/// The quadratic tets that `Cage::quadraticTet` tells of, by their number; none if it is empty. Cost O(T) for T tets.
/// cage    its indices are in range
/// Errors  SizeMismatch: another number of values than tets; InvalidOption: a number below -1, or that leaves one out;
///         the tets of one number are not eight, or not the uniform refinement of a tet
TETSKIN_CORE_API Result<std::vector<QuadraticTet>> quadraticTets(const Cage& cage);

/// Makes a cage of quadratic tets: each tet of the mesh becomes one, with nodes at the middles of its edges. For meshes
/// that are filled by their body; a mesh of an eighth of the tets then serves as well as a linear one, and better.
/// mesh      valid (see `validate`), without flat tets; rest space, any unit
/// Returns   a cage of 8 T tets for T tets; the mesh's nodes come first, in their order
/// Cost      O(T log T)
/// Errors    those of `validate(const TetMesh&)`; Degenerate: flat tets; TooLarge: 8 T tets are too many
TETSKIN_CORE_API Result<Cage> refineQuadratic(const TetMesh& mesh);

/// Finds the quadratic tets of a mesh that was refined uniformly, wholly or in part, by any program: groups of eight
/// tets that `refineQuadratic` could have made of one, in any order and orientation. For meshes that are filled by
/// their body. Where tets could be grouped in several ways, as in a lattice or in a mesh that was refined twice, those
/// groups come first that hang together, by whole faces, with the most others. Tets of no group stay linear.
/// cage     valid (see `validate`); its `quadraticTet` is replaced, and becomes empty if there are none
/// Returns  the number of quadratic tets
/// Cost     O(T log T), some 2 microseconds per tet
TETSKIN_CORE_API std::size_t findQuadraticTets(Cage& cage);

}  // namespace tetskin
