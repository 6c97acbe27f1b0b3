// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Quadratic skinning of single points: the formulas of core's skinning (quadratic_skinning.h has their source), for a
// few points without the rest of the surface.
#include <tetskin/core/src/embedding/embedding_data.h>
#include <tetskin/core/src/skin_binding.h>
#include <tetskin/touch/src/points/corners.h>

#include <algorithm>
#include <cassert>

namespace tetskin::touch_detail {
namespace {

using Eigen::Vector3d;

/// Those of planes of three; the fourth is what is left of 1.
std::array<btScalar, 4> weightsOf(const std::array<std::vector<float>, 3>& planes, std::size_t slot) {
  std::array<btScalar, 4> weights{};
  weights[3] = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    weights[k] = planes[k][slot];
    weights[3] -= weights[k];
  }
  return weights;
}

/// The place of a tet's run, or their number: tets without vertices have none.
std::size_t runOf(const EmbeddingData& of, int tet) {
  const auto isBefore = [](const EmbeddingData::Run& run, std::uint32_t t) { return run.tet < t; };
  const auto inside = of.runs.begin() + static_cast<std::ptrdiff_t>(of.insideRunCount), end = of.runs.end() - 1;
  const auto wanted = static_cast<std::uint32_t>(tet);
  for (const auto& [first, last] : {std::pair(of.runs.begin(), inside), std::pair(inside, end)}) {
    const auto found = std::lower_bound(first, last, wanted, isBefore);
    if (found != last && found->tet == wanted) return static_cast<std::size_t>(found - of.runs.begin());
  }
  return of.runs.size();
}

/// The tet's edge vectors (0,1) (0,2) (0,3) (1,2) (1,3) (2,3), and the shortest edge at rest.
struct Edges {
  Vector3d of[6];
  double shortest = 0;
};

Eigen::Matrix3d gradientAt(const QuadraticStencils<btScalar>& stencils, std::size_t gradient, const Vector3d& origin,
                           const NodeAt& nodeAt) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t e = stencils.starts()[gradient]; e < stencils.starts()[gradient + 1]; ++e) {
    const Vector3d at = toEigen(nodeAt(static_cast<int>(stencils.entryNodes()[e]))) - origin;
    for (int k = 0; k < 3; ++k) sum.col(k) += at * static_cast<double>(stencils.entryFactors()[3 * e + k]);
  }
  return sum;
}

Edges edgesOf(const QuadraticStencils<btScalar>& stencils, std::size_t run, const Vector3d& origin,
              const NodeAt& nodeAt) {
  Edges edges;
  for (std::size_t k = 0; k < 6; ++k) {
    const std::size_t e = stencils.runEdges()[6 * run + k];
    const Eigen::Matrix3d first = gradientAt(stencils, stencils.edgeGradients()[2 * e], origin, nodeAt);
    const Eigen::Matrix3d second = gradientAt(stencils, stencils.edgeGradients()[2 * e + 1], origin, nodeAt);
    const btScalar* half = &stencils.halfRest()[4 * e];
    edges.of[k] = (first - second) * Vector3d(half[0], half[1], half[2]);
    const double squared = edges.of[k].squaredNorm(), limit = half[3];
    if (squared > limit) edges.of[k] *= std::sqrt(limit / squared);
    const auto rest = static_cast<double>(stencils.restLengths()[e]);
    edges.shortest = k == 0 ? rest : std::min(edges.shortest, rest);
  }
  return edges;
}

/// What is added at the weights b, and its derivative along d.
Vector3d bendAt(const Edges& edges, const std::array<btScalar, 4>& b) {
  Vector3d sum = Vector3d::Zero();
  int k = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j)
      sum += static_cast<double>(b[i]) * static_cast<double>(b[j]) * edges.of[k++];
  }
  return sum;
}
Vector3d bendAlong(const Edges& edges, const std::array<btScalar, 4>& b, const std::array<btScalar, 4>& d) {
  Vector3d sum = Vector3d::Zero();
  int k = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) sum += static_cast<double>(b[i] * d[j] + d[i] * b[j]) * edges.of[k++];
  }
  return sum;
}

}  // namespace

Corner cornerOf(const Embedding& embedding, std::size_t vertex) {
  const EmbeddingData& of = embedding.data();
  assert(vertex < of.vertexCount());
  const std::uint32_t slot = of.vertexSlots[vertex];
  const auto after = std::upper_bound(of.runs.begin(), of.runs.end(), slot,
                                      [](std::uint32_t s, const EmbeddingData::Run& run) { return s < run.firstSlot; });
  const EmbeddingData::Run& run = *std::prev(after);
  Corner corner;
  corner.tet = static_cast<int>(run.tet);
  std::copy_n(run.nodes, 4, corner.nodes.begin());
  corner.weights = corner.closest = weightsOf(of.weights, slot);
  corner.outside = slot >= of.insideCount;
  if (corner.outside) corner.closest = weightsOf(of.closestWeights, slot - of.insideCount);
  return corner;
}

btVector3 linearPosition(const Corner& corner, const NodeAt& nodeAt) {
  const btVector3 last = nodeAt(corner.nodes[3]);
  btVector3 sum(0, 0, 0);
  for (std::size_t k = 0; k < 3; ++k) sum += corner.weights[k] * (nodeAt(corner.nodes[k]) - last);
  return last + sum;
}

btVector3 linearPosition(const PointData& point, const btSoftBody& body) {
  const NodeAt nodeAt = [&](int node) { return body.m_nodes[node].m_x; };
  const btVector3 first = linearPosition(point.corners[0], nodeAt);
  btVector3 sum(0, 0, 0);
  for (std::size_t c = 1; c < 3; ++c) sum += point.shares[c] * (linearPosition(point.corners[c], nodeAt) - first);
  return first + sum;
}

btVector3 quadraticPosition(const Corner& corner, const SoftBodyBinding& binding, const NodeAt& nodeAt) {
  const btVector3 linear = linearPosition(corner, nodeAt);
  const auto& stencils = binding.parts().quadratic;
  if (!stencils) return linear;
  const std::size_t run = runOf(binding.embedding().data(), corner.tet);
  if (run == binding.embedding().data().runs.size()) return linear;
  const Edges edges = edgesOf(*stencils, run, toEigen(nodeAt(corner.nodes[3])), nodeAt);
  Vector3d bend = bendAt(edges, corner.closest);
  if (corner.outside) {
    std::array<btScalar, 4> beyond{};
    for (std::size_t k = 0; k < 4; ++k) beyond[k] = corner.weights[k] - corner.closest[k];
    bend += bendAlong(edges, corner.closest, beyond);
    if (bend.norm() > edges.shortest) bend *= edges.shortest / bend.norm();
  }
  return linear + toBullet(bend);
}

}  // namespace tetskin::touch_detail
