// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/material/tet_material.h>
#include <tetskin/cage/src/split/lattice_links.h>
#include <tetskin/cage/src/surface/triangle_crossing.h>
#include <tetskin/core/src/base/bvh/bvh.h>

#include <deque>
#include <tuple>
#include <vector>

namespace tetskin::cage_detail {

/// A cell, with the number of its tet.
struct TetCell {
  int tet = -1;
  int cell = 0;
};

/// Straight segments into and out of a body, each within one or two tets: only triangles that touch these tets can
/// cross them. The part of a triangle in a tet is an element, numbered as in `TetMaterial::triangles`.
/// Cost: for a segment about O(log n) in its tet's n elements, and O(n log n) once per tet that is queried. A tet may
/// contain the whole surface, and segments may start at each of its triangles: testing all against all would be too
/// slow.
class SegmentQueries {
 public:
  /// The arguments must outlive this object.
  SegmentQueries(const Surface& surface, const TetMaterial& material, const LatticeFrame& frame,
                 const LatticeLinks& links)
      : surface_(surface),
        material_(material),
        frame_(frame),
        links_(links),
        treeOf_(material.triangles.starts.size() - 1, -1) {}

  std::size_t firstElement(std::size_t tet) const { return material_.triangles.starts[tet]; }
  std::size_t lastElement(std::size_t tet) const { return material_.triangles.starts[tet + 1]; }
  int triangleOf(std::size_t element) const { return static_cast<int>(material_.triangles.values[element]); }
  Eigen::Vector3d centroidOf(const TetCell& cell) const;

  /// The element through which a segment first leaves the body, or first enters it, after its start; or -1.
  int firstExit(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const {
    return firstCrossing(tet, from, direction, true);
  }
  int firstEntry(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const {
    return firstCrossing(tet, from, direction, false);
  }
  /// True if the segment between the centroids of two material cells, of one tet or of two that share a face, leaves
  /// the body. Where parts of the body overlap, not every triangle on the segment is a boundary.
  bool isBlocked(const TetCell& from, const TetCell& to) const;

 private:
  Crossing crossingOf(std::size_t element, const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const;
  int firstCrossing(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& direction, bool leaving) const;

  struct ElementTree {
    Bvh bvh;
    std::vector<BvhBox<double>> boxes;
  };
  ElementTree makeTree(int tet) const;
  const ElementTree& treeOf(int tet) const;
  /// Calls visit(element, most) for all elements of a tet that the segment crosses, and possibly more, see
  /// Bvh::visitAlong.
  template <class Visit>
  void forElementsAlong(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& direction, Visit&& visit) const;

  const Surface& surface_;
  const TetMaterial& material_;
  const LatticeFrame& frame_;
  const LatticeLinks& links_;
  mutable std::vector<int> treeOf_;                            ///< by tet: index in `trees_`, or -1 until it is needed
  mutable std::deque<ElementTree> trees_;                      ///< of tets with many elements
  mutable std::vector<std::tuple<double, int, int>> crossed_;  ///< scratch memory: fraction, triangle, change
};

}  // namespace tetskin::cage_detail
