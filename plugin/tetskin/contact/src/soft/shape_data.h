// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The data of a ContactShape, all in rest space.
#pragma once

#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/src/soft/distance_grid.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/src/base/bvh/bvh.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tetskin::contact_detail {

using ContactBox = BvhBox<btScalar>;

/// The samples [first, last), all carried by one tet.
struct SampleRun {
  int tet = 0;
  int first = 0, last = 0;
};

/// Which of a tet's 64 cells, in barycentric weights, belong to the part of the surface that the tet carries; all of
/// them, unless the tet has duplicates.
struct CarriedCells {
  std::uint64_t bits = ~std::uint64_t{0};
  bool holdsAll() const { return bits == ~std::uint64_t{0}; }
  bool holds(const btScalar weights[4]) const { return (bits >> cellOf(weights)) & 1; }
  static int cellOf(const btScalar weights[4]);
};

/// Distance from the surface up to which a sample counts, in cubes of the grid.
constexpr btScalar kReachCubes = btScalar(1.5);
/// Contacts whose gap the step will not close are left out if the gap is larger than this many cubes.
constexpr btScalar kNearCubes = btScalar(0.1);

/// In cubes of the grid: a motion this small within a step is not worth splitting into common and relative motion.
constexpr btScalar kStillCubes = btScalar(0.02);

/// Smallest weight with which a point counts as inside a tet: rounding must not lose a point between two tets, and just
/// outside of the cage the surface is near.
constexpr btScalar kMinWeight = btScalar(-0.02);
/// How much farther than its nodes a point inside a tet can move: the sum of its weights' magnitudes.
constexpr btScalar kInsideSpread = 1 - 6 * kMinWeight;

/// The part of a tet that may contain, or be near to, the inside: where each weight is at least this. It has the shape
/// of the tet, and deforms with it.
struct TetSubregion {
  btScalar minimum[4] = {};
  btScalar left = 1;  ///< 1 minus their sum

  /// How much farther than its nodes a point of the part can move: above 1 if weights are negative.
  btScalar spread() const {
    btScalar sum = left;
    for (const btScalar weight : minimum) sum += std::abs(weight);
    return sum;
  }
};

/// Number of tets that are tested at once: those of a leaf of their tree.
constexpr int kLanes = 4;

/// The tets of a leaf; -1 in unused lanes.
using TetGroup = std::array<int, kLanes>;

/// A group with tets that are neighbours of a run; they do not collide with it.
struct NearGroup {
  int group = 0;
  std::array<bool, kLanes> near{};
};

/// A tree of items, walked without a stack.
struct SearchTree {
  Bvh tree;
  std::vector<int> past;    ///< by node: the next node that is not a descendant
  std::vector<int> leafOf;  ///< by node: the number of the leaf, in the order of the items; -1: not a leaf

  SearchTree() = default;
  explicit SearchTree(Bvh from);
  /// Calls visit(node) for the leaves for which meets(node) is true, and for all nodes that contain them.
  template <class Meets, class Visit>
  void visitLeaves(const Meets& meets, Visit&& visit) const {
    for (std::size_t n = 0; n < past.size();) {
      if (!meets(n)) {
        n = static_cast<std::size_t>(past[n]);
        continue;
      }
      if (leafOf[n] >= 0) visit(n);
      ++n;
    }
  }
};

struct ShapeData {
  std::vector<btVector3> nodes;
  std::vector<Tet> tets;
  std::vector<btVector3> centroids;  ///< centroids of the tets
  btScalar edge = 0;                 ///< mean edge length of the tets
  DistanceGrid grid;
  std::vector<SampleRun> runs;                   ///< ascending by tet
  std::vector<EmbeddedPoint<btScalar>> samples;  ///< of the surface
  // Separate arrays for values that are read for many samples in sequence.
  std::vector<btVector3> sampleRest;
  std::vector<btVector3> sampleNormals;            ///< outwards; see sampleNormals()
  std::vector<int> sampleNodes;                    ///< the node with the largest clamped weight
  std::vector<btScalar> weights[4];                ///< the weights again, by node of the tet; padded at the end
  std::vector<CarriedCells> carried;               ///< by tet; empty unless the cage is split
  std::vector<TetSubregion> filled;                ///< by tet
  std::vector<TetSubregion> runRegions;            ///< by run: the part of the tet that holds its samples
  btScalar largestSpread = 1;                      ///< of the runs' parts
  std::vector<std::vector<int>> otherComponents;   ///< by run: see tetsOfOtherComponents
  SearchTree runTree;                              ///< over all runs
  SearchTree tetTree;                              ///< over the tets that contain, or are near to, the inside
  std::vector<TetGroup> groups;                    ///< by leaf of `tetTree`
  std::vector<std::vector<NearGroup>> nearGroups;  ///< by run, ascending
};

}  // namespace tetskin::contact_detail

namespace tetskin {

template <>
struct Access<ContactShape> {
  static const contact_detail::ShapeData& data(const ContactShape& shape) { return *shape.data_; }
  static std::shared_ptr<const ContactShape> create(std::unique_ptr<const contact_detail::ShapeData> data) {
    return std::shared_ptr<const ContactShape>(new ContactShape(std::move(data)));
  }
};

}  // namespace tetskin

namespace tetskin::contact_detail {

/// The contents of a shape, valid as long as the shape.
inline const ShapeData& dataOf(const ContactShape& shape) {
  return Access<ContactShape>::data(shape);
}

}  // namespace tetskin::contact_detail
