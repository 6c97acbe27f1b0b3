// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to quadratic skinning: the edges of quadratic tets, along which the map is a known quadratic function.
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace tetskin {

/// A cage edge by its lower and its higher node.
using CageEdge = std::array<std::uint32_t, 2>;

/// How an edge bends, as a sum over nodes of a quadratic tet: e = sum of factor x_node; the factors' sum is 0.
struct EdgeBend {
  std::vector<std::uint32_t> nodes;
  std::vector<double> factors;
};

/// The edges of the eight tets of each quadratic tet. The vector of an edge on a face depends only on the nodes of that
/// face, so neighbours agree.
class QuadraticEdges {
 public:
  /// Cost  O(T log T) for T tets
  QuadraticEdges(const TetMesh& mesh, const std::vector<QuadraticTet>& tets);

  bool contains(const CageEdge& edge) const;
  /// The vector of an edge that is contained.
  EdgeBend bendOf(const CageEdge& edge) const;

 private:
  struct Entry {
    CageEdge edge;
    std::uint32_t tet;
  };
  std::vector<Entry>::const_iterator find(const CageEdge& edge) const;

  const std::vector<QuadraticTet>& tets_;
  std::vector<Entry> entries_;  ///< ascending, each edge once
};

}  // namespace tetskin
