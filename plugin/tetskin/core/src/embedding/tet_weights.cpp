// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Matthias Müller, "100 x Simulation Speedup with Mesh Embedding", Ten Minute Physics 12, 2022
#include <tetskin/core/src/base/embedding/embedding_data.h>
#include <tetskin/core/src/base/lists.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

/// Some vertices of one tet, stored by coordinate, so that loops process several at a time.
struct VertexBlock {
  /// Twice the doubles in the widest register.
  static constexpr std::size_t kSize = 16;
  double x[kSize], y[kSize], z[kSize];
  double smallest[kSize];  ///< smallest weight
  double error[kSize];     ///< squared distance of the point that the rounded weights give

  void set(std::size_t k, const Eigen::Vector3d& vertex) {
    x[k] = vertex.x();
    y[k] = vertex.y();
    z[k] = vertex.z();
  }
  void weigh(const BarycentricMap& map, std::size_t count, const std::array<float*, 3>& weights) {
    assert(count <= kSize);
    for (std::size_t k = 0; k < count; ++k) {
      double b[4];
      map.weightsAt(x[k], y[k], z[k], b[0], b[1], b[2], b[3]);
      for (std::size_t i = 0; i < 3; ++i) weights[i][k] = static_cast<float>(b[i]);
      const double low = b[0] < b[1] ? b[0] : b[1], high = b[2] < b[3] ? b[2] : b[3];
      smallest[k] = low < high ? low : high;
    }
  }
  void measure(const TetCorners& p, std::size_t count, const std::array<float*, 3>& weights) {
    assert(count <= kSize);
    const Eigen::Vector3d edges[3] = {p[0] - p[3], p[1] - p[3], p[2] - p[3]};
    for (std::size_t k = 0; k < count; ++k) {
      const double b0 = weights[0][k], b1 = weights[1][k], b2 = weights[2][k];
      const double dx = p[3].x() + b0 * edges[0].x() + b1 * edges[1].x() + b2 * edges[2].x() - x[k];
      const double dy = p[3].y() + b0 * edges[0].y() + b1 * edges[1].y() + b2 * edges[2].y() - y[k];
      const double dz = p[3].z() + b0 * edges[0].z() + b1 * edges[1].z() + b2 * edges[2].z() - z[k];
      error[k] = dx * dx + dy * dy + dz * dz;
    }
  }
};

/// Computes the closest point of a vertex outside.
void bindOutside(std::uint32_t slot, const TetCorners& corners, const BarycentricMap& map,
                 const Eigen::Vector3d& vertex, EmbeddingData& data, EmbeddingFit& fit) {
  assert(slot >= data.insideCount && slot < data.vertexCount());
  const Eigen::Vector4d weights = map(vertex);
  fit.largestWeight = std::max(fit.largestWeight, largestWeight(weights));
  const Eigen::Vector3d closest = closestPointInTet(vertex, corners, weights);
  const Eigen::Vector4d c = map(closest);
  for (std::size_t k = 0; k < 3; ++k) {
    const double clamped =
        std::min(std::max(c[static_cast<int>(k)], 0.0), 1.0);  // rounding may put it slightly off the face
    data.closestWeights[k][slot - data.insideCount] = static_cast<float>(clamped);
  }
}

/// Computes the weights of the vertices of one run, and how well they fit.
void bindRun(std::size_t run, const TetCorners& corners, PointReader vertices, EmbeddingData& data, EmbeddingFit& fit) {
  assert(run + 1 < data.runs.size() && data.runs[run].firstSlot < data.runs[run + 1].firstSlot);
  const BarycentricMap map(corners);
  VertexBlock block;
  const std::uint32_t last = data.runs[run + 1].firstSlot;
  for (std::uint32_t slot = data.runs[run].firstSlot; slot < last; slot += VertexBlock::kSize) {
    const std::size_t count = std::min<std::size_t>(last - slot, VertexBlock::kSize);
    const std::array<float*, 3> weights = {&data.weights[0][slot], &data.weights[1][slot], &data.weights[2][slot]};
    for (std::size_t k = 0; k < count; ++k) block.set(k, vertices[data.slotVertices[slot + k]]);
    block.weigh(map, count, weights);
    block.measure(corners, count, weights);
    for (std::size_t k = 0; k < count; ++k) {
      fit.worstBarycentric = std::max(fit.worstBarycentric, -block.smallest[k]);
      // Weights beyond float's range make the error infinite or NaN.
      const double error = block.error[k] < HUGE_VAL ? block.error[k] : HUGE_VAL;
      fit.restErrorSquared = std::max(fit.restErrorSquared, error);
    }
    for (auto s = std::max<std::uint32_t>(slot, static_cast<std::uint32_t>(data.insideCount)); s < slot + count; ++s) {
      bindOutside(s, corners, map, vertices[data.slotVertices[s]], data, fit);
    }
  }
}

/// Makes two lists per tet: the vertices inside and, after the inside lists of all tets, the vertices outside.
void sortByTet(const TetMesh& cage, const std::vector<std::int32_t>& tetOf, EmbeddingData& data) {
  const std::size_t tets = cage.tetCount();
  Lists<> lists = packLists(2 * tets, [&](auto&& add) {
    for (std::uint32_t v = 0; v < tetOf.size(); ++v) {
      const std::int32_t tet = tetOf[v];
      const std::size_t list = tet >= 0 ? static_cast<std::size_t>(tet) : tets + static_cast<std::size_t>(~tet);
      assert(list < 2 * tets);
      add(list, v);
    }
  });
  std::size_t occupied = 0;
  for (std::size_t list = 0; list < 2 * tets; ++list) occupied += lists.starts[list] < lists.starts[list + 1];
  data.runs.reserve(occupied + 1);
  for (std::size_t list = 0; list < 2 * tets; ++list) {
    if (list == tets) data.insideRunCount = data.runs.size();
    if (lists.starts[list] == lists.starts[list + 1]) continue;
    const auto tet = static_cast<std::uint32_t>(list < tets ? list : list - tets);
    const Tet& n = cage.tets[tet];
    data.runs.push_back({{n[0], n[1], n[2], n[3]}, lists.starts[list], tet});
  }
  data.runs.push_back({{}, static_cast<std::uint32_t>(tetOf.size()), static_cast<std::uint32_t>(tets)});
  data.insideCount = lists.starts[tets];
  assert(lists.values.size() == tetOf.size());
  data.slotVertices = std::move(lists.values);
  data.vertexSlots.resize(tetOf.size());
  for (std::uint32_t slot = 0; slot < tetOf.size(); ++slot) data.vertexSlots[data.slotVertices[slot]] = slot;
}

}  // namespace

Embedding embeddingFromTets(const TetMesh& cage, PointReader vertices, const std::vector<std::int32_t>& tetOf,
                            EmbeddingFit* fit) {
  assert(vertices.size() == tetOf.size() && cage.tetCount() > 0);
  auto data = std::make_shared<EmbeddingData>();
  data->nodeCount = cage.nodeCount();
  data->tetCount = cage.tetCount();
  sortByTet(cage, tetOf, *data);
  for (std::vector<float>& plane : data->weights) plane.resize(vertices.size() + EmbeddingData::kPadding);
  for (std::vector<float>& plane : data->closestWeights) {
    plane.resize(vertices.size() - data->insideCount + EmbeddingData::kPadding);
  }
  EmbeddingFit unread;
  for (std::size_t r = 0; r + 1 < data->runs.size(); ++r) {
    bindRun(r, cornersOf(cage, cage.tets[data->runs[r].tet]), vertices, *data, fit ? *fit : unread);
  }
  return Access<Embedding>::create(std::move(data));
}

}  // namespace tetskin
