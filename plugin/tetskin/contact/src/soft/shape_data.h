// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What a ContactShape holds, all in rest space.
#pragma once

#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/src/soft/distance_grid.h>
#include <tetskin/core/embedded_point.h>
#include <tetskin/core/src/shared/bvh/bvh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace tetskin::contact_detail {

using ContactBox = BvhBox<btScalar>;

/// The samples [first, last) are carried by one tet.
struct SampleRun {
  int tet = 0;
  int first = 0, last = 0;
};

/// Which sixty-fourths of a tet, by its barycentric weights, belong to the part of the surface that the tet carries;
/// all of them, unless it has copies.
struct CarriedCells {
  std::uint64_t bits = ~std::uint64_t{0};
  bool holds(const btScalar weights[4]) const { return (bits >> cellOf(weights)) & 1; }
  static int cellOf(const btScalar weights[4]);
};

/// How near to the surface a sample must be to count, in cubes of the grid.
constexpr btScalar kReachCubes = btScalar(1.5);

/// The part of a tet that may hold something inside, or near it: where each weight is at least this. It has the form of
/// the tet, so that it follows it.
struct FilledPart {
  btScalar least[4] = {};
  btScalar left = 1;  ///< 1 minus their sum
};

struct ShapeData {
  std::vector<btVector3> nodes;
  std::vector<Tet> tets;
  std::vector<btVector3> middles;  ///< of the tets
  btScalar edge = 0;               ///< mean length, of the tets'
  DistanceGrid grid;
  std::vector<SampleRun> runs;                   ///< ascending by tet
  std::vector<EmbeddedPoint<btScalar>> samples;  ///< of the surface
  // Of the samples, what is read of many of them, one after the other.
  std::vector<btVector3> sampleRest;
  std::vector<btVector3> sampleNormals;      ///< outwards, by the grid; shorter than 1 on edges, 0 where it tells none
  std::vector<int> sampleNodes;              ///< of the largest clamped weight
  std::vector<btScalar> weights[4];          ///< once more
  std::vector<CarriedCells> carried;         ///< by tet; empty unless the cage is split
  std::vector<FilledPart> filled;            ///< by tet
  std::vector<std::vector<int>> otherParts;  ///< by run: see tetsOfOtherParts
  Bvh runTree;                               ///< of all runs
  Bvh tetTree;                               ///< of the tets that hold, or are near, something inside
};

}  // namespace tetskin::contact_detail
