// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "view/view_data.h"

#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/base/bytes.h>
#include <tetskin/core/src/exported/skin_binding.h>

#include <algorithm>
#include <cassert>
#include <set>

namespace tetskin::view {
namespace {

using Indices = std::vector<std::uint32_t>;

template <class Number>
Json packedAs(const char* type, const std::vector<Number>& numbers) {
  std::string bytes;
  bytes.reserve(sizeof(Number) * numbers.size());
  for (const Number number : numbers) appendLittleEndian(number, bytes);
  return {{type, base64(bytes)}};
}

Indices flat(const std::vector<std::array<int, 2>>& edges) {
  Indices ends;
  for (const auto& edge : edges) {
    for (const int node : edge) ends.push_back(static_cast<std::uint32_t>(node));
  }
  return ends;
}

/// The cage's edges, those of the boundary first.
Json edgesOf(const TetMesh& cage) {
  std::set<std::array<int, 2>> outer;
  for (const auto& [a, b, c] : boundaryFaces(cage)) {
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      outer.insert({std::min(p, q), std::max(p, q)});
    }
  }
  std::vector<std::array<int, 2>> edges = uniqueEdges(cage);
  const auto inner = std::stable_partition(edges.begin(), edges.end(), [&](const std::array<int, 2>& edge) {
    return outer.count({std::min(edge[0], edge[1]), std::max(edge[0], edge[1])}) > 0;
  });
  return {{"ends", packed(flat(edges))}, {"outer", inner - edges.begin()}};
}

/// Three weights per vertex, by slot, from planes.
Json weightsOf(const std::array<std::vector<float>, 3>& planes, std::size_t count) {
  std::vector<float> weights;
  for (std::size_t slot = 0; slot < count; ++slot) {
    for (const std::vector<float>& plane : planes) weights.push_back(plane[slot]);
  }
  return packed(weights);
}

Json embeddingOf(const EmbeddingData& data) {
  Indices nodes, starts;
  for (const EmbeddingData::Run& run : data.runs) {
    starts.push_back(run.firstSlot);
    for (const int node : run.nodes) nodes.push_back(static_cast<std::uint32_t>(node));
  }
  nodes.resize(nodes.size() - 4);  // the last run ends the list
  return {{"runNodes", packed(nodes)},
          {"runStarts", packed(starts)},
          {"insideRuns", data.insideRunCount},
          {"slotVertices", packed(data.slotVertices)},
          {"weights", weightsOf(data.weights, data.vertexCount())},
          {"closest", weightsOf(data.closestWeights, data.vertexCount() - data.insideCount)}};
}

/// The page has one kind of edge. For one of a quadratic tet, the first gradient becomes one that gives its vector
/// along the edge, and the second the last of all, which is 0.
Json stencilsOf(const QuadraticStencils<float>& stencils) {
  Indices starts = stencils.starts(), nodes = stencils.entryNodes(), gradients = stencils.edgeGradients();
  std::vector<float> factors = stencils.entryFactors(), halves;
  factors.resize(3 * nodes.size());
  for (std::size_t edge = 0; edge < stencils.edgeCount(); ++edge) {
    const float* half = &stencils.halfRest()[4 * edge];
    halves.insert(halves.end(), half, half + 3);
    if (edge < stencils.plainEdgeCount()) continue;
    const std::size_t bent = edge - stencils.plainEdgeCount();
    for (std::size_t k = stencils.bendStarts()[bent]; k < stencils.bendStarts()[bent + 1]; ++k) {
      nodes.push_back(stencils.bendNodes()[k]);
      for (int i = 0; i < 3; ++i) factors.push_back(stencils.bendFactors()[k] * half[i] / half[3]);
    }
    gradients.push_back(static_cast<std::uint32_t>(starts.size() - 1));
    gradients.push_back(static_cast<std::uint32_t>(stencils.gradientCount() + stencils.bendStarts().size() - 1));
    starts.push_back(static_cast<std::uint32_t>(nodes.size()));
  }
  if (stencils.bendStarts().size() > 1) starts.push_back(starts.back());
  return {{"starts", packed(starts)},        {"entryNodes", packed(nodes)},
          {"entryFactors", packed(factors)}, {"edgeGradients", packed(gradients)},
          {"halfRest", packed(halves)},      {"runEdges", packed(stencils.runEdges())}};
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[at + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

Json packed(const std::vector<std::uint16_t>& words) {
  return packedAs("u16", words);
}
Json packed(const std::vector<std::uint32_t>& indices) {
  if (std::all_of(indices.begin(), indices.end(), [](std::uint32_t index) { return index <= 0xFFFF; })) {
    return packed(std::vector<std::uint16_t>(indices.begin(), indices.end()));
  }
  return packedAs("u32", indices);
}
Json packed(const std::vector<float>& numbers) {
  return packedAs("f32", numbers);
}

Json trianglesOf(const TriangleMesh& mesh) {
  Indices corners;
  for (const auto& triangle : mesh.triangles) {
    for (const int v : triangle) corners.push_back(static_cast<std::uint32_t>(v));
  }
  Json groups = Json::array();
  for (const TriangleGroup& group : mesh.groups) {
    groups.push_back({{"first", group.firstTriangle}, {"count", group.triangleCount}, {"material", group.material}});
  }
  if (groups.empty()) groups.push_back({{"first", 0}, {"count", mesh.triangleCount()}, {"material", ""}});
  return {{"triangles", packed(corners)}, {"groups", std::move(groups)}, {"vertices", mesh.vertexCount()}};
}

Json rigidMeshOf(const TriangleMesh& mesh, const Eigen::Vector3d& origin) {
  Json json = trianglesOf(mesh);
  std::vector<float> positions;
  for (const Eigen::Vector3d& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(p[k] - origin[k]));
  }
  json["positions"] = packed(positions);
  return json;
}

Json skinOf(const Cage& cage, const TriangleMesh& mesh, const Embedding& embedding) {
  assert(embedding.vertexCount() == mesh.vertexCount());
  BindingOptions options;
  options.interpolation = Interpolation::Quadratic;
  const auto binding = SkinBinding<float>::create(cage, mesh, options, embedding);
  if (!binding.status().ok()) throw ViewError(binding.status().message);
  const SkinData<float>& data = dataOf(*binding.value());
  return {{"nodes", cage.mesh.nodeCount()},
          {"tets", cage.mesh.tetCount()},
          {"edges", edgesOf(cage.mesh)},
          {"embedding", embeddingOf(dataOf(data.embedding))},
          {"stencils", stencilsOf(*data.quadratic)}};
}

}  // namespace tetskin::view
