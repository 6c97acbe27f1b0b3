// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A closed surface that moves with a body's nodes: its volume, and the derivative of that by the nodes' positions.
// Pressure times this derivative are its forces. Their sum and their torque are 0, as neither a translation nor a
// rotation changes the volume. The sum over linear triangles is exact; over faces of quadratic tets, the rule of
// integration is.
#pragma once

#include <tetskin/core/types.h>
#include <tetskin/elastic/src/tets/rest_tets.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tetskin::elastic_detail {

/// Nodes and their weights, whose sum is 1, of a vertex of a surface.
using SurfaceVertex = std::array<std::pair<int, double>, 4>;

class TETSKIN_ELASTIC_API PressureSurface {
 public:
  /// Of the boundary of the tets. If parts of it enclose hollows, the pressure is in these, and acts on their walls;
  /// otherwise it is in the body, and acts on its whole surface.
  /// Cost   O(T log T), and the hollows times the faces
  /// Error  InvalidOption: it encloses nothing, or the nodes at rest are unknown
  static Result<PressureSurface> ofTets(const RestTets& rest);
  /// Of a mesh in the body, by the same rule. Vertices that coincide at rest count as one.
  /// positions  at rest, by vertex;  vertices  likewise
  /// Errors     InvalidOption: it is not closed, or encloses nothing
  static Result<PressureSurface> ofMesh(const std::vector<std::array<double, 3>>& positions,
                                        const std::vector<std::array<int, 3>>& triangles,
                                        const std::vector<SurfaceVertex>& vertices);

  /// The nodes of the surface, ascending.
  const std::vector<std::uint32_t>& nodes() const { return nodes_; }
  std::size_t faceCount() const { return triangles_.size() + quadratic_.size(); }
  double restVolume() const { return restVolume_; }
  /// Whether it is that of hollows.
  bool isHollow() const { return hollow_; }

  /// Three numbers for each of `nodes`, for the caller to fill.
  double* positions() { return positions_.data(); }
  /// The volume at rest becomes that at these positions, if it is above 0: the body may have been scaled.
  void takeAsRest();
  /// Computes the volume at these positions, and its derivative if asked. The same bits with any number of threads.
  double evaluate(bool derivative, ParallelFor* threads);
  /// Three numbers for each of `nodes`.
  const double* derivative() const { return derivative_.data(); }

 private:
  using Triangle = std::array<std::uint32_t, 3>;
  using QuadraticFace = std::array<std::uint32_t, 6>;  ///< corners 0, 1, 2, and the middles of 01, 12, 20
  /// Numbers by owner: those of the k-th are `items` from `starts[k]` on.
  struct Lists {
    std::vector<std::uint32_t> starts, items;
    std::vector<double> factors;
  };
  struct Entry {
    std::uint32_t owner = 0, item = 0;
    double factor = 1.0;
  };

  PressureSurface() = default;
  static Lists listsOf(std::vector<Entry> entries, std::size_t owners);
  static void gather(const Lists& lists, const std::vector<double>& from, std::vector<double>& to,
                     ParallelFor* threads);
  /// Keeps the faces that the pressure acts on, so oriented that they enclose a volume above 0.
  Status choose(const std::string& name);
  /// vertices  by vertex; null: vertices are nodes
  void index(const std::vector<SurfaceVertex>* vertices);
  double sumOfFaces(ParallelFor* threads);
  double volumeOf(const Triangle& face, double* corner) const;
  double volumeOf(const QuadraticFace& face, double* corners) const;

  std::vector<Triangle> triangles_;
  std::vector<QuadraticFace> quadratic_;
  std::vector<std::uint32_t> nodes_;
  Lists nodesOf_;     ///< by vertex: places in `nodes_`, with weights
  Lists cornersOf_;   ///< by vertex: places in `corners_`
  Lists verticesOf_;  ///< by place in `nodes_`, with weights
  double restVolume_ = 0.0;
  bool hollow_ = false;
  std::vector<double> positions_, derivative_;  ///< by node
  std::vector<double> points_, vectors_;        ///< by vertex
  std::vector<double> corners_;                 ///< derivatives: one of each triangle, six of each quadratic face
  std::vector<double> partial_;                 ///< volumes, by task
};

}  // namespace tetskin::elastic_detail
