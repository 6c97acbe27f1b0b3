// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to elasticity: the inner loops, compiled once for each instruction set and chosen at run time. Plain types
// only, as in tetskin/core/src/kernels/skinning_kernels.h, and for the same reason.
//
// Numbers of eight tets, or of eight rows of the matrix, lie side by side: a pack, a chunk. `S[kGroup]` of consecutive
// quantities is called wide. Points are four scalars, x y z and one that means nothing.
#pragma once

#include <tetskin/core/src/shared/kernels/dispatch.h>

#include <cstddef>
#include <cstdint>

namespace tetskin::kernels {

constexpr int kGroup = 8;

/// Scalars of a chunk's vectors, of its symmetric blocks (xx xy xz yy yz zz), and of an entry's blocks (rows).
constexpr std::size_t kWideVector = 3 * kGroup, kWideSymmetric = 6 * kGroup, kWideBlock = 9 * kGroup;
/// Scalars of a tet's corners: four points.
constexpr std::size_t kCorners = 16;

/// Eight tets at rest.
template <class S>
struct TetPack {
  S gradients[9][kGroup];          ///< of the barycentric weights of nodes 1, 2 and 3, rest space
  S shear[kGroup];                 ///< 2 mu x volume; 0 for what fills the last pack
  S bulk[kGroup];                  ///< lambda x volume
  std::uint32_t nodes[4][kGroup];  ///< slots
};

template <class S>
struct TetWork {
  std::size_t firstPack = 0, lastPack = 0;
  const TetPack<S>* packs = nullptr;
  S* rotations = nullptr;        ///< quaternions w x y z, wide, by pack
  const S* assembled = nullptr;  ///< the same, of the matrix
  const S* points = nullptr;     ///< by slot
  S* corners = nullptr;          ///< by tet
  S alpha = 0;
};

template <class S>
struct TetFindings {
  S mostTurned = 0;     ///< of the squared differences of a tet's rotation and that of the matrix, as quaternions
  double turned = 0.0;  ///< sum of such differences, each a quarter of the angle's square
  double energy = 0.0;
};

/// Rows of the matrix, sorted into colours: no two rows of one colour are neighbours.
template <class S>
struct RowWork {
  std::size_t firstChunk = 0, lastChunk = 0;
  const std::uint32_t* starts = nullptr;      ///< by chunk, 2, and one more: its lower entries, its upper ones
  const std::uint32_t* neighbours = nullptr;  ///< by entry, 8 slots
  S* blocks = nullptr;                        ///< by entry
  S* diagonal = nullptr;                      ///< by chunk
  S* inverse = nullptr;                       ///< by chunk: of the diagonal
  const S* masses = nullptr;                  ///< by chunk; 0: held, or no node

  // To assemble.
  const std::uint32_t* sums = nullptr;   ///< by entry, and one more: first of its terms
  const std::uint32_t* terms = nullptr;  ///< 16 a term: corners of the rows' nodes, corners of the neighbours
  const S* corners = nullptr;            ///< rotated gradients, see `rotatedGradients`
  S leastMass = 0;                       ///< over the trace of the stiffness's diagonal block; see `assemble`

  // To multiply and to solve. Wide vectors by chunk, points by slot.
  S* residual = nullptr;   ///< transformed: (D + L)^-1 r
  S* direction = nullptr;  ///< transformed
  S* rest = nullptr;       ///< `backward`: U t; `forward`: t + y
  S* step = nullptr;       ///< t
  S* solution = nullptr;
  const S* extra = nullptr;  ///< what other operators make of t; null: none
  S* stepPoints = nullptr;   ///< t, as points
  S* lowerPoints = nullptr;  ///< y, as points
  S factor = 0;              ///< of the direction before, or of the step
};

/// Points summed by lists of corners.
template <class S>
struct SumWork {
  std::size_t firstSlot = 0, lastSlot = 0;
  const std::uint32_t* starts = nullptr;  ///< by slot, and one more
  const std::uint32_t* corners = nullptr;
  const S* from = nullptr;
  S* points = nullptr;
};

/// The loops of one instruction set.
///
/// Of the conjugate gradient, with A = L + D + U and the preconditioner (D + L) D^-1 (D + U), by Eisenstat's trick:
///   backward  p <- D r + factor p;  t = (D + U)^-1 p;  rest = U t
///   forward   y = (D + L)^-1 (rest + extra);  rest <- t + y, which is (D + L)^-1 A t;  returns p . (t + y)
///   advance   solution += factor t;  r -= factor rest;  returns r . D r
///   lower     residual <- (D + L)^-1 residual;  returns r . D r
/// `backward` goes through the colours from the last to the first, `forward` and `lower` from the first to the last.
template <class S>
struct ElasticTable {
  /// Elastic forces on corners, at the points' positions; turns `rotations` along.
  TetFindings<S> (*forces)(const TetWork<S>&, bool energy);
  /// R g sqrt(alpha mu V) of all four corners; in the fourth scalar of each, lambda / mu.
  void (*rotatedGradients)(const TetWork<S>&);
  void (*sum)(const SumWork<S>&);
  /// Blocks, diagonal, and its inverse, which is 0 where the mass is.
  void (*assemble)(const RowWork<S>&);
  /// rest = A stepPoints
  void (*multiply)(const RowWork<S>&);
  void (*backward)(const RowWork<S>&);
  S (*forward)(const RowWork<S>&);
  S (*advance)(const RowWork<S>&);
  S (*lower)(const RowWork<S>&);
};

TETSKIN_FOR_EACH_INSTRUCTION_SET(extern const ElasticTable<float> elasticFloat;
                                 extern const ElasticTable<double> elasticDouble;)

/// Those for this processor, of `instructionSet()`.
template <class S>
const ElasticTable<S>& elasticInUse();

}  // namespace tetskin::kernels
