// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Doug L. James, "Phong Deformation: A Better C0 Interpolant for Embedded Deformation", ACM TOG 39(4), 2020,
//   doi 10.1145/3386569.3392371
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/skinning/edge_bends.h>
#include <tetskin/core/src/skinning/gradient_fit.h>
#include <tetskin/core/src/skinning/quadratic_skinning.h>
#include <tetskin/core/src/skinning/skin_tasks.h>

#include <algorithm>
#include <cassert>

namespace tetskin {
namespace {

/// A node or an edge that no vertex needs.
constexpr std::uint32_t kNone = 0xFFFFFFFFu;
/// A node's gradient costs about 30 times as much as a vertex.
constexpr std::size_t kGradientsPerTask = 512;
constexpr std::size_t kEdgesPerTask = 4096;

/// The edges of a tet as (lower, higher) node, in the order of `runEdges`.
std::array<CageEdge, 6> edgesOf(const kernels::Run& run) {
  std::array<CageEdge, 6> edges;
  std::size_t k = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      const auto a = static_cast<std::uint32_t>(run.nodes[i]), b = static_cast<std::uint32_t>(run.nodes[j]);
      edges[k++] = {std::min(a, b), std::max(a, b)};
    }
  }
  return edges;
}

/// The distinct edges of the tets that carry vertices, sorted.
std::vector<CageEdge> occupiedEdges(const EmbeddingData& embedding) {
  std::vector<CageEdge> edges;
  for (std::size_t r = 0; r + 1 < embedding.runs.size(); ++r) {
    for (const CageEdge& edge : edgesOf(embedding.runs[r])) edges.push_back(edge);
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

template <class Scalar>
QuadraticStencils<Scalar>::QuadraticStencils(const TetMesh& cage, const Embedding& embedding,
                                             const std::vector<int>& latticeTets,
                                             const std::vector<QuadraticTet>& quadraticTets) {
  assert(cage.nodeCount() == embedding.nodeCount() && cage.tetCount() == embedding.tetCount());
  std::vector<CageEdge> edges = occupiedEdges(dataOf(embedding));
  std::vector<std::uint32_t> gradientOf(cage.nodeCount(), kNone);
  for (const CageEdge& edge : edges) gradientOf[edge[0]] = gradientOf[edge[1]] = 0;
  addGradients(cage, latticeTets, gradientOf);

  const QuadraticEdges quadratic(cage, quadraticTets);
  const auto bent = std::stable_partition(edges.begin(), edges.end(),
                                          [&](const CageEdge& edge) { return !quadratic.contains(edge); });
  for (auto edge = edges.begin(); edge != edges.end(); ++edge) {
    const Eigen::Vector3d half = 0.5 * (cage.nodes[(*edge)[1]] - cage.nodes[(*edge)[0]]);
    for (int k = 0; k < 3; ++k) halfRest_.push_back(static_cast<Scalar>(half[k]));
    halfRest_.push_back(static_cast<Scalar>(half.squaredNorm()));
    restLengths_.push_back(static_cast<Scalar>(2.0 * half.norm()));
    if (edge < bent) {
      for (const std::uint32_t node : *edge) edgeGradients_.push_back(gradientOf[node]);
      continue;
    }
    const EdgeBend bend = quadratic.bendOf(*edge);
    bendNodes_.insert(bendNodes_.end(), bend.nodes.begin(), bend.nodes.end());
    for (const double factor : bend.factors) bendFactors_.push_back(static_cast<Scalar>(factor));
    bendStarts_.push_back(static_cast<std::uint32_t>(bendNodes_.size()));
  }
  for (std::size_t r = 0; r + 1 < dataOf(embedding).runs.size(); ++r) {
    for (const CageEdge& edge : edgesOf(dataOf(embedding).runs[r])) {
      auto found = std::lower_bound(edges.begin(), bent, edge);
      if (found == bent || *found != edge) found = std::lower_bound(bent, edges.end(), edge);
      assert(found != edges.end() && *found == edge);
      runEdges_.push_back(static_cast<std::uint32_t>(found - edges.begin()));
    }
  }
}

/// gradientOf  by node: kNone if no gradient is needed; otherwise becomes the index of its gradient
template <class Scalar>
void QuadraticStencils<Scalar>::addGradients(const TetMesh& cage, const std::vector<int>& latticeTets,
                                             std::vector<std::uint32_t>& gradientOf) {
  CageNeighbours neighbours(cage, latticeTets);
  for (std::uint32_t node = 0; node < cage.nodeCount(); ++node) {
    if (gradientOf[node] == kNone) continue;
    const GradientStencil stencil = neighbours.stencilOf(node);
    gradientOf[node] = static_cast<std::uint32_t>(gradientCount());
    gradientNodes_.push_back(node);
    thinCount_ += stencil.kind == GradientStencil::Kind::Thin;
    plainCount_ += stencil.kind == GradientStencil::Kind::Plain;
    entryNodes_.insert(entryNodes_.end(), stencil.nodes.begin(), stencil.nodes.end());
    for (const Eigen::Vector3d& g : stencil.factors) {
      for (int k = 0; k < 3; ++k) entryFactors_.push_back(static_cast<Scalar>(g[k]));
    }
    starts_.push_back(static_cast<std::uint32_t>(entryNodes_.size()));
  }
  entryFactors_.push_back(0);
  assert(entryFactors_.size() == 3 * entryNodes_.size() + 1);
}

template <class Scalar>
NodeGradients<Scalar>::NodeGradients(std::size_t count) : gradients_(count + 1) {
  for (std::size_t k = 0; k < 3; ++k) gradients_.back().columns[5 * k] = Scalar(1);
}

template <class Scalar>
void NodeGradients<Scalar>::update(const QuadraticStencils<Scalar>& stencils, const PackedNodes<Scalar>& nodes,
                                   ParallelFor* threads) {
  using namespace skin_tasks;
  assert(count() == stencils.gradientCount());
  const kernels::Table<Scalar>& table = kernels::tableInUse<Scalar>();
  kernels::GradientWork<Scalar> work;
  work.starts = stencils.starts().data();
  work.neighbours = stencils.entryNodes().data();
  work.factors = stencils.entryFactors().data();
  work.nodes = nodes.data();
  work.gradients = gradients_.front().columns;
  const std::size_t tasks = taskCount(count(), kGradientsPerTask);
  runTasks(threads, tasks, [&](std::size_t task) {
    kernels::GradientWork<Scalar> part = work;
    part.firstNode = firstItem(count(), tasks, task);
    part.lastNode = firstItem(count(), tasks, task + 1);
    table.gradients(part);
  });
}

template <class Scalar>
EdgeVectors<Scalar>::EdgeVectors(const QuadraticStencils<Scalar>& stencils)
    : gradients_(stencils.plainEdgeCount() > 0 ? stencils.gradientCount() : 0), edges_(4 * stencils.edgeCount()) {
  for (std::size_t e = 0; e < stencils.edgeCount(); ++e) edges_[4 * e + 3] = stencils.restLengths()[e];
}

template <class Scalar>
void EdgeVectors<Scalar>::update(const QuadraticStencils<Scalar>& stencils, const PackedNodes<Scalar>& nodes,
                                 ParallelFor* threads) {
  using namespace skin_tasks;
  assert(edges_.size() == 4 * stencils.edgeCount());
  if (stencils.plainEdgeCount() > 0) gradients_.update(stencils, nodes, threads);
  const std::size_t plain = stencils.plainEdgeCount(), bent = stencils.edgeCount() - plain;
  const std::size_t plainTasks = plain > 0 ? taskCount(plain, kEdgesPerTask) : 0;
  const std::size_t bentTasks = bent > 0 ? taskCount(bent, kEdgesPerTask) : 0;
  runTasks(threads, plainTasks + bentTasks, [&](std::size_t task) {
    if (task < plainTasks) {
      bendByGradients(stencils, firstItem(plain, plainTasks, task), firstItem(plain, plainTasks, task + 1));
    } else {
      task -= plainTasks;
      bendByTets(stencils, nodes, firstItem(bent, bentTasks, task), firstItem(bent, bentTasks, task + 1));
    }
  });
}

template <class Scalar>
void EdgeVectors<Scalar>::bendByGradients(const QuadraticStencils<Scalar>& stencils, std::size_t first,
                                          std::size_t last) {
  kernels::EdgeWork<Scalar> work;
  work.firstEdge = first;
  work.lastEdge = last;
  work.gradientOf = stencils.edgeGradients().data();
  work.halfRest = stencils.halfRest().data();
  work.gradients = gradients_.data();
  work.edges = edges_.data();
  kernels::tableInUse<Scalar>().edges(work);
}

template <class Scalar>
void EdgeVectors<Scalar>::bendByTets(const QuadraticStencils<Scalar>& stencils, const PackedNodes<Scalar>& nodes,
                                     std::size_t first, std::size_t last) {
  const std::size_t before = 4 * stencils.plainEdgeCount();
  kernels::BendWork<Scalar> work;
  work.firstEdge = first;
  work.lastEdge = last;
  work.starts = stencils.bendStarts().data();
  work.entryNodes = stencils.bendNodes().data();
  work.factors = stencils.bendFactors().data();
  work.nodes = nodes.data();
  work.halfRest = stencils.halfRest().data() + before;
  work.edges = edges_.data() + before;
  kernels::tableInUse<Scalar>().bends(work);
}

template <class Scalar, class Out>
void skinPoints(const Embedding& embedding, const PackedNodes<Scalar>& nodes, const Bends<Scalar>& bends,
                const SkinOutput<Scalar, Out>& output, Box3* bounds, ParallelFor* threads) {
  assert(!bends.stencils || bends.stencils->runEdges().size() + 6 == 6 * dataOf(embedding).runs.size());
  auto work = skin_tasks::workFor(dataOf(embedding), nodes);
  bends.addTo(work);
  skin_tasks::skin(dataOf(embedding), work, nodes, output, bounds, threads);
}

TETSKIN_INSTANTIATE_CLASS(QuadraticStencils)
TETSKIN_INSTANTIATE_CLASS(NodeGradients)
TETSKIN_INSTANTIATE_CLASS(EdgeVectors)

#define TETSKIN_INSTANTIATE(Scalar, Out)                                                       \
  template void skinPoints(const Embedding&, const PackedNodes<Scalar>&, const Bends<Scalar>&, \
                           const SkinOutput<Scalar, Out>&, Box3*, ParallelFor*);
TETSKIN_FOR_SCALAR_PAIRS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin
