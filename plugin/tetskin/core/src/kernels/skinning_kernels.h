// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to skinning: the inner loops, compiled once for each instruction set and chosen at run time.
//
// This header and what it includes are compiled with flags that not every processor supports, so they use only plain
// types: if an inline function of Eigen or of the standard library were compiled here, the linker might keep this copy
// for everyone.
#pragma once

#include <tetskin/core/src/base/kernels/dispatch.h>
#include <tetskin/core/src/base/kernels/run.h>

#include <cstddef>
#include <cstdint>

namespace tetskin::kernels {

/// How points follow their tet.
enum class Surface {
  Linear,
  Quadratic,         ///< for vertices inside
  QuadraticOutside,  ///< continued to first order from the closest point
};

/// Some consecutive runs, all inside or all outside, with all data that their vertices depend on.
template <class Scalar>
struct Work {
  Surface surface = Surface::Linear;
  const Run* runs = nullptr;
  std::size_t firstRun = 0;
  std::size_t lastRun = 0;                  ///< one past
  const float* weights[3] = {};             ///< one array per weight, by slot
  const float* closest[3] = {};             ///< one past the end
  std::uint32_t closestBase = 0;            ///< the first slot outside
  const Scalar* nodes = nullptr;            ///< current positions, 4 scalars per node, relative to some point nearby
  const Scalar* edges = nullptr;            ///< 4 scalars per cage edge: its vector, and its rest length
  const std::uint32_t* runEdges = nullptr;  ///< by run: its 6 edges (0,1) (0,2) (0,3) (1,2) (1,3) (2,3)
};

/// Extremes of the points written, merged with the previous values.
template <class Scalar>
struct Extent {
  Scalar low[3];
  Scalar high[3];
};

/// Scalars of a gradient: three columns of 4, and 4 meaningless ones.
constexpr std::size_t kGradientStride = 16;

/// One node's gradient is the sum of neighbour positions times `factors`: see quadratic_skinning.h.
template <class Scalar>
struct GradientWork {
  std::size_t firstNode = 0, lastNode = 0;  ///< among the nodes with a gradient
  const std::uint32_t* starts = nullptr;    ///< by node with a gradient, and the end: its first entry
  const std::uint32_t* neighbours = nullptr;
  const Scalar* factors = nullptr;  ///< 3 per entry, and memory for one scalar more
  const Scalar* nodes = nullptr;    ///< current positions, as in Work
  Scalar* gradients = nullptr;      ///< kGradientStride scalars per node with a gradient
};

template <class Scalar>
struct EdgeWork {
  std::size_t firstEdge = 0, lastEdge = 0;
  const std::uint32_t* gradientOf = nullptr;  ///< 2 per edge: indices of their gradients
  const Scalar* halfRest = nullptr;  ///< 4 per edge: half the rest vector, first end to second; its squared length
  const Scalar* gradients = nullptr;
  Scalar* edges = nullptr;  ///< 4 per edge; the fourth is not changed
};

/// The vector of an edge of a quadratic tet is the sum of positions of the tet's nodes times `factors`.
template <class Scalar>
struct BendWork {
  std::size_t firstEdge = 0, lastEdge = 0;  ///< among these edges
  const std::uint32_t* starts = nullptr;    ///< by edge, and the end: its first entry
  const std::uint32_t* entryNodes = nullptr;
  const Scalar* factors = nullptr;   ///< 1 per entry
  const Scalar* nodes = nullptr;     ///< current positions, as in Work
  const Scalar* halfRest = nullptr;  ///< as in EdgeWork, from the first of these edges on
  Scalar* edges = nullptr;
};

/// What a bone's matrix [ A | t ] contains: half the node's gradient, or the whole gradient beside the displacement.
enum class BoneContent { HalfGradient, Gradient };

template <class Scalar>
struct BoneWork {
  std::size_t firstNode = 0, lastNode = 0;
  BoneContent content = BoneContent::HalfGradient;
  bool columns = false;                       ///< four columns of four floats each, otherwise three rows
  const std::uint32_t* gradientOf = nullptr;  ///< by node: index of its gradient
  const Scalar* gradients = nullptr;
  const Scalar* restNodes = nullptr;  ///< 4 scalars per node
  const Scalar* nodes = nullptr;      ///< current positions, as in Work
  Scalar shift[4] = {};               ///< added to them
  float* bones = nullptr;             ///< that of node 0; never read
  std::size_t strideBytes = 0;
};

/// Directions transformed by the map's gradient. A normal is the sum of factor k times the cross product of the other
/// two columns; a tangent is the sum of factor k times column k.
enum class Direction { Normal, Tangent };
struct DirectionPlanes {
  Direction kind = Direction::Normal;
  const float* factors[3] = {};  ///< one array per factor, by slot, of the padded length of weights
};

/// Groups of vertex positions in the output that share a normal: see recomputed_normals.h.
template <class Scalar>
struct PathWork {
  std::size_t firstGroup = 0, lastGroup = 0;
  const std::uint32_t* groupPaths = nullptr;      ///< by group, and the end: index of the first entry of its path
  const std::uint32_t* paths = nullptr;           ///< indices of points
  const std::uint32_t* groupPositions = nullptr;  ///< by group, and the end
  const std::uint32_t* indices = nullptr;         ///< indices of points of the group; the first is the path's centre
  const Scalar* points = nullptr;                 ///< 4 scalars per point
  float* out = nullptr;                           ///< by index of the point
  std::size_t outStride = 0;                      ///< in bytes
};

/// The loops of one instruction set. Points are written contiguously in slot order: slot s at out + 3 s. If there is an
/// extent, `positions` extends it. `directions` and `pathNormals` write unit vectors, and leave the previous value
/// where there is no direction.
template <class Scalar>
struct Table {
  void (*positions)(const Work<Scalar>&, const Scalar shift[3], Scalar* out, Extent<Scalar>*);
  void (*directions)(const Work<Scalar>&, const DirectionPlanes&, float* out);
  void (*gradients)(const GradientWork<Scalar>&);
  void (*edges)(const EdgeWork<Scalar>&);
  void (*bends)(const BendWork<Scalar>&);
  void (*bones)(const BoneWork<Scalar>&);
  void (*pathNormals)(const PathWork<Scalar>&);
};

TETSKIN_FOR_EACH_INSTRUCTION_SET(extern const Table<float> tableFloat; extern const Table<double> tableDouble;)

}  // namespace tetskin::kernels
