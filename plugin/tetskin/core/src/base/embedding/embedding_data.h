// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The data of an Embedding.
#pragma once

#include <tetskin/core/embedding.h>
#include <tetskin/core/src/base/kernels/run.h>
#include <tetskin/core/src/base/point_reader.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tetskin {

struct EmbeddingData {
  /// The slots [firstSlot, the next run's firstSlot) belong to the tet of these nodes.
  using Run = kernels::Run;
  /// Weights are stored in arrays of one float per slot, so that kernels process several vertices at a time; each array
  /// is followed by this many zeros, which kernels may read.
  static constexpr std::size_t kPadding = 16;

  std::size_t nodeCount = 0;
  std::size_t tetCount = 0;
  std::size_t insideCount = 0;  ///< vertices inside: their slots come first
  std::size_t insideRunCount = 0;
  /// The runs of the tets with vertices inside, ascending by tet; then the runs of the tets with vertices outside,
  /// ascending by tet; and a sentinel.
  std::vector<Run> runs;
  /// vertexCount + kPadding, by slot: weights of nodes 0, 1, 2 of the slot's tet
  std::array<std::vector<float>, 3> weights;
  /// vertexCount - insideCount + kPadding, by slot - insideCount: weights of these nodes at the point of the slot's tet
  /// closest to the vertex, at rest
  std::array<std::vector<float>, 3> closestWeights;
  std::vector<std::uint32_t> slotVertices;  ///< by slot
  std::vector<std::uint32_t> vertexSlots;   ///< by vertex

  std::size_t vertexCount() const { return slotVertices.size(); }
};

template <>
struct Access<Embedding> {
  static const EmbeddingData& data(const Embedding& embedding) { return *embedding.data_; }
  static Embedding create(std::shared_ptr<const EmbeddingData> data) { return Embedding(std::move(data)); }
};

/// The data of an embedding, valid as long as one of its copies.
inline const EmbeddingData& dataOf(const Embedding& embedding) {
  return Access<Embedding>::data(embedding);
}

/// How closely the weights of an embedding reproduce the vertices; see EmbedReport.
struct EmbeddingFit {
  double largestWeight = 1.0;      ///< largest absolute weight
  double worstBarycentric = -1.0;  ///< dimensionless
  double restErrorSquared = 0.0;   ///< rest space; infinite if weights overflow a float
};

/// Sorts vertices by tet and computes their weights.
/// vertices  vertexCount x 3, rest space; float or double
/// tetOf     by vertex: its tet, or ~tet if it lies outside of it; in [0, tetCount), and not flat
/// fit       written if not null
/// Memory    the result, and 8 bytes per tet
Embedding embeddingFromTets(const TetMesh& cage, PointReader vertices, const std::vector<std::int32_t>& tetOf,
                            EmbeddingFit* fit = nullptr);

/// The report of a mesh that was rejected before anything was computed.
inline EmbedReport notEmbedded(const TriangleMesh& mesh) {
  EmbedReport report;
  report.vertexCount = report.unbound = mesh.vertexCount();
  return report;
}

}  // namespace tetskin
