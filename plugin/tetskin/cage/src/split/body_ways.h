// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/material/tet_material.h>
#include <tetskin/cage/src/split/lattice_links.h>
#include <tetskin/cage/src/surface/triangle_crossing.h>
#include <tetskin/core/src/shared/bvh/bvh.h>

#include <deque>
#include <tuple>
#include <vector>

namespace tetskin::cage_detail {

/// A cell by the number of its tet.
struct TetCell {
  int tet = -1;
  int cell = 0;
};

/// Straight ways in and out of a body, each within a tet or two: only triangles that touch these can be on them. What
/// is of a triangle in a tet is an element, numbered as in `TetMaterial::triangles`.
/// Cost: a way about O(log n) of its tet's n elements, and O(n log n) once for a tet that is asked about. A tet may
/// hold the whole surface, and each of its triangles may send out ways: testing all of them against all would not do.
class BodyWays {
 public:
  /// All outlive this object.
  BodyWays(const Surface& surface, const TetMaterial& material, const LatticeFrame& frame, const LatticeLinks& links)
      : surface_(surface),
        material_(material),
        frame_(frame),
        links_(links),
        treeOf_(material.triangles.starts.size() - 1, -1) {}

  std::size_t firstElement(std::size_t tet) const { return material_.triangles.starts[tet]; }
  std::size_t lastElement(std::size_t tet) const { return material_.triangles.starts[tet + 1]; }
  int triangleOf(std::size_t element) const { return static_cast<int>(material_.triangles.values[element]); }
  Eigen::Vector3d middleOf(const TetCell& cell) const;

  /// The element through which a way first leaves the body, or first comes into it, after its beginning; or -1.
  int firstExit(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& way) const {
    return firstCrossing(tet, from, way, true);
  }
  int firstEntry(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& way) const {
    return firstCrossing(tet, from, way, false);
  }
  /// True if the way between the middles of two cells of material, of one tet or of two that share a face, leaves the
  /// body. Where parts of it overlap, not every triangle on the way is its end.
  bool isBlocked(const TetCell& from, const TetCell& to) const;

 private:
  Crossing crossingOf(std::size_t element, const Eigen::Vector3d& from, const Eigen::Vector3d& way) const;
  int firstCrossing(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& way, bool leaving) const;

  /// Of a tet's elements.
  struct ElementTree {
    Bvh bvh;
    std::vector<BvhBox<double>> boxes;
  };
  ElementTree makeTree(int tet) const;
  const ElementTree& treeOf(int tet) const;
  /// Calls visit(element, most) for all that the way crosses in a tet, and more, see Bvh::visitAlong.
  template <class Visit>
  void forElementsAlong(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& way, Visit&& visit) const;

  const Surface& surface_;
  const TetMaterial& material_;
  const LatticeFrame& frame_;
  const LatticeLinks& links_;
  mutable std::vector<int> treeOf_;                            ///< by tet: where in `trees_`, or -1 until it is needed
  mutable std::deque<ElementTree> trees_;                      ///< of tets with many elements
  mutable std::vector<std::tuple<double, int, int>> crossed_;  ///< scratch memory: share, triangle, change
};

}  // namespace tetskin::cage_detail
