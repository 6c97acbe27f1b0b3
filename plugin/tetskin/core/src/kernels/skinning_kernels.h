// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to skinning: the inner loops, compiled once for each instruction set and chosen at run time.
//
// This header and what it includes are compiled with flags that not every processor can run, so they use nothing but
// plain types: an inline function of Eigen or of the standard library, compiled here, might be the copy that the
// linker keeps for everyone.
#pragma once

#include <tetskin/core/src/shared/kernels/dispatch.h>

#include <cstddef>
#include <cstdint>

namespace tetskin::kernels {

/// The slots [firstSlot, the next run's firstSlot) belong to the tet of these nodes.
struct Run {
  int nodes[4] = {};
  std::uint32_t firstSlot = 0;
  std::uint32_t tet = 0;
};

/// How points follow their tet.
enum class Surface {
  Linear,
  Quadratic,         ///< for vertices inside
  QuadraticOutside,  ///< to first order from the closest point
};

/// Some consecutive runs, all inside or all outside, and all that their vertices depend on.
template <class Scalar>
struct Work {
  Surface surface = Surface::Linear;
  const Run* runs = nullptr;
  std::size_t firstRun = 0;
  std::size_t lastRun = 0;                  ///< one past
  const float* weights[3] = {};             ///< planes, by slot
  const float* closest[3] = {};             ///< planes, by slot - closestBase; QuadraticOutside only
  std::uint32_t closestBase = 0;            ///< the first slot outside
  const Scalar* nodes = nullptr;            ///< current positions, 4 scalars a node, relative to some point nearby
  const Scalar* edges = nullptr;            ///< 4 scalars a cage edge: its vector, and its rest length
  const std::uint32_t* runEdges = nullptr;  ///< by run: its 6 edges (0,1) (0,2) (0,3) (1,2) (1,3) (2,3)
};

/// Extremes of the points written, merged into what is there.
template <class Scalar>
struct Extent {
  Scalar low[3];
  Scalar high[3];
};

/// Scalars of a gradient: three columns of 4, and 4 that mean nothing.
constexpr std::size_t kGradientStride = 16;

/// One node's gradient is the sum of neighbour positions times `factors`: see quadratic_skinning.h.
template <class Scalar>
struct GradientWork {
  std::size_t firstNode = 0, lastNode = 0;  ///< of those with a gradient
  const std::uint32_t* starts = nullptr;    ///< by node with a gradient, and one more: its first entry
  const std::uint32_t* neighbours = nullptr;
  const Scalar* factors = nullptr;  ///< 3 an entry, and memory for one scalar more
  const Scalar* nodes = nullptr;    ///< as above
  Scalar* gradients = nullptr;      ///< kGradientStride scalars a node with a gradient
};

template <class Scalar>
struct EdgeWork {
  std::size_t firstEdge = 0, lastEdge = 0;
  const std::uint32_t* gradientOf = nullptr;  ///< 2 an edge: places of their gradients
  const Scalar* halfRest = nullptr;           ///< 4 an edge: half the rest vector from its first end to its second,
                                              ///< and the square of its length
  const Scalar* gradients = nullptr;
  Scalar* edges = nullptr;  ///< 4 an edge; the fourth is not touched
};

/// Directions carried by the map's gradient. Normals: the sum of factor k times the cross product of the other two
/// columns; tangents: the sum of factor k times column k.
enum class Direction { Normal, Tangent };
struct DirectionPlanes {
  Direction kind = Direction::Normal;
  const float* factors[3] = {};  ///< planes, by slot, of the padded length of weights
};

/// Groups of places that share a normal: see recomputed_normals.h.
template <class Scalar>
struct PathWork {
  std::size_t firstGroup = 0, lastGroup = 0;
  const std::uint32_t* groupPaths = nullptr;   ///< by group, and one more: where its path begins
  const std::uint32_t* paths = nullptr;        ///< places
  const std::uint32_t* groupPlaces = nullptr;  ///< by group, and one more
  const std::uint32_t* places = nullptr;       ///< of the group; the first is the path's centre
  const Scalar* points = nullptr;              ///< 4 scalars a place
  float* out = nullptr;                        ///< by place
  std::size_t outStride = 0;                   ///< bytes
};

/// The loops of one instruction set. Points are written side by side in the order of the slots: slot s at out + 3 s.
/// Given an extent, `positions` widens it. `directions` writes unit vectors, and leaves a point as it is where there is
/// no direction any more; so does `pathNormals`.
template <class Scalar>
struct Table {
  void (*positions)(const Work<Scalar>&, const Scalar shift[3], Scalar* out, Extent<Scalar>*);
  void (*directions)(const Work<Scalar>&, const DirectionPlanes&, float* out);
  void (*gradients)(const GradientWork<Scalar>&);
  void (*edges)(const EdgeWork<Scalar>&);
  void (*pathNormals)(const PathWork<Scalar>&);
};

TETSKIN_FOR_EACH_INSTRUCTION_SET(extern const Table<float> tableFloat; extern const Table<double> tableDouble;)

}  // namespace tetskin::kernels
