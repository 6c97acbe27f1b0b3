// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/exported/quadratic_point.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

using Eigen::Vector3d;

template <class Scalar>
using Weights = std::array<Scalar, 4>;

/// Index of a tet's run, or the number of runs if it has none: tets without vertices have no run.
std::size_t runOf(const EmbeddingData& data, int tet) {
  const auto isBefore = [](const EmbeddingData::Run& run, std::uint32_t t) { return run.tet < t; };
  const auto inside = data.runs.begin() + static_cast<std::ptrdiff_t>(data.insideRunCount), end = data.runs.end() - 1;
  const auto wanted = static_cast<std::uint32_t>(tet);
  for (const auto& [first, last] : {std::pair(data.runs.begin(), inside), std::pair(inside, end)}) {
    const auto found = std::lower_bound(first, last, wanted, isBefore);
    if (found != last && found->tet == wanted) return static_cast<std::size_t>(found - data.runs.begin());
  }
  return data.runs.size();
}

/// A tet's edge vectors (0,1) (0,2) (0,3) (1,2) (1,3) (2,3), and its shortest edge at rest.
struct TetEdges {
  Vector3d vectors[6];
  double shortest = 0.0;
};

/// origin  near the nodes, so that differences from it are exact
template <class Scalar>
Eigen::Matrix3d gradientAt(const QuadraticStencils<Scalar>& stencils, std::size_t gradient, const Vector3d& origin,
                           const NodePositions<Scalar>& positionOf) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t e = stencils.starts()[gradient]; e < stencils.starts()[gradient + 1]; ++e) {
    const Vector3d offset = positionOf(static_cast<int>(stencils.entryNodes()[e])).template cast<double>() - origin;
    for (int k = 0; k < 3; ++k) sum.col(k) += offset * static_cast<double>(stencils.entryFactors()[3 * e + k]);
  }
  return sum;
}

template <class Scalar>
Vector3d edgeVector(const QuadraticStencils<Scalar>& stencils, std::size_t edge, const Vector3d& origin,
                    const NodePositions<Scalar>& positionOf) {
  if (edge < stencils.plainEdgeCount()) {
    const Eigen::Matrix3d first = gradientAt(stencils, stencils.edgeGradients()[2 * edge], origin, positionOf);
    const Eigen::Matrix3d second = gradientAt(stencils, stencils.edgeGradients()[2 * edge + 1], origin, positionOf);
    const Scalar* half = &stencils.halfRest()[4 * edge];
    return (first - second) * Vector3d(half[0], half[1], half[2]);
  }
  const std::size_t bent = edge - stencils.plainEdgeCount();
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = stencils.bendStarts()[bent]; k < stencils.bendStarts()[bent + 1]; ++k) {
    const Vector3d offset = positionOf(static_cast<int>(stencils.bendNodes()[k])).template cast<double>() - origin;
    sum += static_cast<double>(stencils.bendFactors()[k]) * offset;
  }
  return sum;
}

template <class Scalar>
TetEdges edgesOf(const QuadraticStencils<Scalar>& stencils, std::size_t run, const Vector3d& origin,
                 const NodePositions<Scalar>& positionOf) {
  assert(6 * run + 6 <= stencils.runEdges().size());
  TetEdges edges;
  for (std::size_t k = 0; k < 6; ++k) {
    const std::size_t e = stencils.runEdges()[6 * run + k];
    edges.vectors[k] = edgeVector(stencils, e, origin, positionOf);
    const double squared = edges.vectors[k].squaredNorm(), limit = stencils.halfRest()[4 * e + 3];
    if (squared > limit) edges.vectors[k] *= std::sqrt(limit / squared);
    const auto rest = static_cast<double>(stencils.restLengths()[e]);
    edges.shortest = k == 0 ? rest : std::min(edges.shortest, rest);
  }
  return edges;
}

/// The correction that the edges' vectors add to the linear position at the weights b, and its derivative along d.
template <class Scalar>
Vector3d bendAt(const TetEdges& edges, const Weights<Scalar>& b) {
  Vector3d sum = Vector3d::Zero();
  int k = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      sum += static_cast<double>(b[i]) * static_cast<double>(b[j]) * edges.vectors[k++];
    }
  }
  return sum;
}
template <class Scalar>
Vector3d bendAlong(const TetEdges& edges, const Weights<Scalar>& b, const Weights<Scalar>& d) {
  Vector3d sum = Vector3d::Zero();
  int k = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) sum += static_cast<double>(b[i] * d[j] + d[i] * b[j]) * edges.vectors[k++];
  }
  return sum;
}

/// Outside, it is continued to first order from the closest point, and limited to the length of an edge.
template <class Scalar>
Vector3d bendOf(const EmbeddedPoint<Scalar>& point, const TetEdges& edges) {
  if (point.inside) return bendAt(edges, point.weights);
  Weights<Scalar> closest = point.clampedWeights, beyond{};
  closest[3] = 1 - closest[0] - closest[1] - closest[2];  // below 0 because of rounding, as in skinning
  for (std::size_t k = 0; k < 4; ++k) beyond[k] = point.weights[k] - closest[k];
  Vector3d bend = bendAt(edges, closest);
  bend += bendAlong(edges, closest, beyond);
  if (bend.norm() > edges.shortest) bend *= edges.shortest / bend.norm();
  return bend;
}

}  // namespace

template <class Scalar>
Eigen::Matrix<Scalar, 3, 1> quadraticPosition(const EmbeddedPoint<Scalar>& point, const Embedding& embedding,
                                              const QuadraticStencils<Scalar>& stencils,
                                              const NodePositions<Scalar>& positionOf) {
  assert(point.tet >= 0 && stencils.runEdges().size() + 6 == 6 * dataOf(embedding).runs.size());
  const std::size_t run = runOf(dataOf(embedding), point.tet);
  if (run == dataOf(embedding).runs.size()) return point.position(positionOf);
  const Vector3d origin = positionOf(point.nodes[3]).template cast<double>();
  return point.position(positionOf) + bendOf(point, edgesOf(stencils, run, origin, positionOf)).template cast<Scalar>();
}

#define TETSKIN_INSTANTIATE(Scalar)                                        \
  template TETSKIN_CORE_API Eigen::Matrix<Scalar, 3, 1> quadraticPosition( \
      const EmbeddedPoint<Scalar>&, const Embedding&, const QuadraticStencils<Scalar>&, const NodePositions<Scalar>&);
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin
