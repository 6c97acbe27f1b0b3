// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to elasticity: the inner loops, compiled once for each instruction set and chosen at run time. Plain types
// only, for the same reason as in tetskin/core/src/kernels/skinning_kernels.h.
//
// Values of eight tets (a pack), or of eight rows of the matrix (a chunk), are adjacent in memory. `S[kGroup]` of
// consecutive quantities is called wide. Points are four scalars: x, y, z, and a meaningless one.
#pragma once

#include <tetskin/core/src/base/kernels/dispatch.h>

#include <cstddef>
#include <cstdint>

namespace tetskin::kernels {

/// Number of tets or rows stored side by side: as many floats as AVX2 has lanes, twice those of SSE2, half those of
/// AVX-512.
constexpr int kGroup = 8;

/// Scalars of a chunk's vectors, of its symmetric blocks (xx xy xz yy yz zz), and of an entry's blocks (by rows).
constexpr std::size_t kWideVector = 3 * kGroup, kWideSymmetric = 6 * kGroup, kWideBlock = 9 * kGroup;
/// Eight tets at rest.
template <class S>
struct TetPack {
  /// Integration points, nodes, and the unit of `kCorners`.
  static constexpr std::size_t kPoints = 1, kNodes = 4, kCornersPerNode = 1;
  S gradients[9][kGroup];               ///< of the barycentric weights of nodes 1, 2 and 3, rest space
  S shear[kGroup];                      ///< 2 mu x volume; 0 for padding in the last pack
  S bulk[kGroup];                       ///< lambda x volume
  std::uint32_t nodes[kNodes][kGroup];  ///< slots of the nodes
};

/// Eight quadratic tets at rest, integrated at four points.
template <class S>
struct QuadraticPack {
  /// Integration points, nodes, and the unit of `kCorners`.
  static constexpr std::size_t kPoints = 4, kNodes = 10, kCornersPerNode = 3;
  S gradients[9][kGroup];               ///< of the barycentric weights of corners 1, 2 and 3, rest space
  S points[3 * kPoints][kGroup];        ///< the same weights at each point
  S shear[kGroup];                      ///< 2 mu x volume of a point; 0 for padding in the last pack
  S bulk[kGroup];                       ///< lambda x volume of a point
  std::uint32_t nodes[kNodes][kGroup];  ///< slots of the corners, and of the middles of edges 01, 02, 03, 12, 13, 23
};

/// Scalars of a tet's corners, which are points that hold its nodes' vectors. A linear tet has one vector per node. A
/// quadratic one has vectors at four points: their x, y and z fill three corners per node.
template <class Pack>
constexpr std::size_t kCorners = 4 * Pack::kCornersPerNode* Pack::kNodes;

/// Pack  TetPack or QuadraticPack
template <class S, class Pack>
struct TetWork {
  std::size_t firstPack = 0, lastPack = 0;
  const Pack* packs = nullptr;
  S* rotations = nullptr;        ///< quaternions w x y z, wide, by pack and point
  const S* assembled = nullptr;  ///< the rotations with which the matrix was assembled
  const S* points = nullptr;     ///< by slot; null: `alphas` are already known
  /// Rotations of the frames in which bodies are at rest, quaternions w x y z, by part: points are then displacements
  /// from the rest positions in these frames. Null: points are positions.
  const S* frames = nullptr;
  const std::uint32_t* partOf = nullptr;  ///< by slot; null: all tets are of part 0
  S* corners = nullptr;                   ///< by tet and node
  S* sums = nullptr;           ///< by slot: forces are added here; null: written to a tet's first corners, by node
  S alpha = 0, flatAlpha = 0;  ///< the second one applies where a tet is flat or inverted
  S* alphas = nullptr;         ///< by pack and point: which of the two; unused if they are equal
  const S* factors = nullptr;  ///< wide, by pack: of the tets in the matrix alone; null: 1

  // Of rest shapes that change: see rest_change.h.
  /// (P D)^-1 - 1 by rows, and det D, wide, by pack and point; null: all tets have their first shapes.
  S* changes = nullptr;
  const S* assembledChanges = nullptr;  ///< those with which the matrix was assembled
  const S* given = nullptr;             ///< D by rows, wide, by pack and point; null: 1
  /// The norm of the deviator of E at which tets yield, and by how much it grows with the equivalent plastic strain,
  /// wide, by pack; null: nothing flows.
  const S* yields = nullptr;
  S* flowed = nullptr;  ///< the equivalent plastic strain, wide, by pack and point
  S flowShare = 1;      ///< share of what is beyond the yield surface that flows in this step; 0: none
  S largestStrain = 0;  ///< the largest plastic strain that may remain: see rest_change.h

  // Of tets with another law than the corotated one: see hyperelasticity.h.
  /// 1 for such a tet, 0 for others, c2, c3, `largestDistortion`, wide, by pack; null: all are corotated
  const S* laws = nullptr;
  S* stiffer = nullptr;  ///< wide, by pack: how much stiffer than at rest such tets are, at least 1; null: not asked
};

/// Scalars of a pack's changes at one point, and of its laws.
constexpr std::size_t kChange = 10 * kGroup, kLaw = 4 * kGroup;

/// Ratio of volume to rest volume below which a tet counts as flat. No body is flat under its own weight; one that is
/// squashed by ten times what it can carry is, and the corner on which one falls.
constexpr double kFlatVolume = 0.1;

template <class S>
struct TetFindings {
  S flattest = 1;       ///< the least ratio of volume to rest volume, at most 1
  S maxTurned = 0;      ///< the largest squared difference between a rotation and that of the matrix, as quaternions
  double turned = 0.0;  ///< sum of these differences, each a quarter of the squared angle
  double energy = 0.0;
  bool yields = false;  ///< some tet is beyond its yield surface
};

/// Corners of fibres in tets, see fibre_tets.h: layers, each like the corners of all tets, 0 where there is none. In
/// the matrix, even layers have blocks a b^T, odd ones (a . b) 1.
template <class S>
struct FibreLayers {
  const S* corners = nullptr;
  std::size_t count = 0, size = 0;  ///< number of layers; scalars of one
};

/// Rows of the matrix; no two of them are neighbours.
template <class S>
struct RowWork {
  std::size_t firstChunk = 0, lastChunk = 0;
  const std::uint32_t* starts = nullptr;      ///< by chunk, 2 each, and the end: its lower entries, its upper ones
  const std::uint32_t* neighbours = nullptr;  ///< by entry, 8 slots each
  S* blocks = nullptr;                        ///< by entry
  S* diagonal = nullptr;                      ///< by chunk
  S* inverse = nullptr;                       ///< by chunk: inverse of the diagonal
  const S* masses = nullptr;                  ///< by chunk; 0: pinned, or not a node

  // For the assembly.
  const std::uint32_t* sums = nullptr;           ///< by entry, and the end: index of the first of its terms
  const std::uint32_t* terms = nullptr;          ///< 16 per term: corners of the rows' nodes, corners of the neighbours
  const std::uint32_t* quadraticSums = nullptr;  ///< the same for quadratic tets, with the first corners of nodes
  const std::uint32_t* quadraticTerms = nullptr;
  const S* corners = nullptr;  ///< see `TetLoops::rotatedGradients`
  FibreLayers<S> fibres;
  S ratio = 0;    ///< lambda / mu
  S spread = 1;   ///< see BlockMatrix::assemble
  S minMass = 0;  ///< relative to the trace of the stiffness's diagonal block; see `assemble`

  // For products and solves. Wide vectors are by chunk, points by slot.
  S* residual = nullptr;   ///< transformed: (D + L)^-1 r
  S* direction = nullptr;  ///< transformed
  S* rest = nullptr;       ///< `backward`: U t; `forward`: t + y
  S* step = nullptr;       ///< the vector t
  S* solution = nullptr;
  const S* extra = nullptr;  ///< the product of other operators with t; null: none
  S* stepPoints = nullptr;   ///< t as points
  S* lowerPoints = nullptr;  ///< y as points
  S factor = 0;              ///< factor of the previous direction, or of the step

  // For the start of solves.
  const S* first = nullptr;   ///< wide
  const S* second = nullptr;  ///< wide; null: 0
};

/// Sums of points by lists of corners.
template <class S>
struct SumWork {
  std::size_t firstSlot = 0, lastSlot = 0;
  const std::uint32_t* starts = nullptr;  ///< by slot, and the end
  const std::uint32_t* corners = nullptr;
  const S* from = nullptr;
  S* points = nullptr;
};

/// The loops over tets of one kind.
template <class S, class Pack>
struct TetLoops {
  /// Elastic forces at the points' positions, by node or, with the same bits, summed; updates `rotations`.
  TetFindings<S> (*forces)(const TetWork<S, Pack>&, bool energy);
  /// R g sqrt(alpha mu V) of all corners, with g the gradient of the node's shape function; the fourth scalar of each
  /// is lambda / mu. Uses `flatAlpha` where a tet is flat at the points' positions.
  void (*rotatedGradients)(const TetWork<S, Pack>&);
};

/// The loops of one instruction set.
///
/// For the conjugate gradient, with A = L + D + U and the preconditioner (D + L) D^-1 (D + U), by Eisenstat's trick:
///   backward  p <- D r + factor p;  t = (D + U)^-1 p;  rest = U t
///   forward   y = (D + L)^-1 (rest + extra);  rest <- t + y, which is (D + L)^-1 A t;  returns p . (t + y)
///   advance   solution += factor t;  r -= factor rest;  returns r . D r
///   lower     rest <- (D + L)^-1 residual, which may be the same vector;  returns rest . D rest
/// Call `backward` for the last rows first, `forward` and `lower` for the first rows first.
template <class S>
struct ElasticTable {
  TetLoops<S, TetPack<S>> linear;
  TetLoops<S, QuadraticPack<S>> quadratic;
  void (*sum)(const SumWork<S>&);
  /// Computes the blocks, the diagonal, and its inverse, which is 0 where the mass is 0.
  void (*assemble)(const RowWork<S>&);
  /// Computes rest = A stepPoints.
  void (*multiply)(const RowWork<S>&);
  /// The same by differences between neighbours, for rows as they were assembled.
  void (*multiplyByDifferences)(const RowWork<S>&);
  void (*backward)(const RowWork<S>&);
  S (*forward)(const RowWork<S>&);
  S (*advance)(const RowWork<S>&);
  S (*lower)(const RowWork<S>&);
  /// Computes step = first - second, 0 where the mass is 0, and the same as points.
  void (*difference)(const RowWork<S>&);
  /// Returns first . second.
  S (*inner)(const RowWork<S>&);
};

TETSKIN_FOR_EACH_INSTRUCTION_SET(extern const ElasticTable<float> elasticFloat;
                                 extern const ElasticTable<double> elasticDouble;)

// The same bits on every processor: as wide as AVX2's, but without fused multiply-adds.
namespace unfused {
extern const ElasticTable<float> elasticFloat;
extern const ElasticTable<double> elasticDouble;
}  // namespace unfused
namespace unfused_avx2 {
extern const ElasticTable<float> elasticFloat;
extern const ElasticTable<double> elasticDouble;
}  // namespace unfused_avx2

/// The table for the processor's `instructionSet()`.
/// deterministic  one with the same bits on every processor, unless the compiler has no vector types
template <class S>
const ElasticTable<S>& elasticInUse(bool deterministic);
template <>
const ElasticTable<float>& elasticInUse(bool deterministic);
template <>
const ElasticTable<double>& elasticInUse(bool deterministic);

}  // namespace tetskin::kernels
