// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/src/base/dangling_nodes.h>
#include <tetskin/core/src/base/embedding/embedding_data.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <cassert>

namespace tetskin {

using namespace bullet_detail;

namespace {

PointView<const btScalar> renderNodePositions(const btSoftBody& body) {
  if (body.m_renderNodes.size() == 0) return {};
  return {&body.m_renderNodes[0].m_x.m_floats[0], static_cast<std::size_t>(body.m_renderNodes.size()),
          sizeof(btSoftBody::RenderNode)};
}

/// Weights in Bullet's precision; the fourth is computed from the other three after rounding.
btVector4 weightsIn(const BarycentricMap& map, const btVector3& point) {
  const Eigen::Vector4d b = map(toEigen(point));
  const auto b0 = static_cast<btScalar>(b[0]), b1 = static_cast<btScalar>(b[1]), b2 = static_cast<btScalar>(b[2]);
  return {b0, b1, b2, btScalar(1) - b0 - b1 - b2};
}

}  // namespace

Result<EmbedReport> bindRenderNodes(btSoftBody& body) {
  if (body.m_renderNodes.size() == 0) {
    return Status{StatusCode::Empty, "the body has no render nodes; fill m_renderNodes before binding"};
  }
  const TetMesh cage = readTetMesh(body);
  if (Status status = checkDangling(cage); !status.ok()) return status;
  EmbedOptions options;
  options.outside = OutsideRule::Barycentric;
  EmbedReport report;
  const Result<Embedding> made = embed(cage, renderNodePositions(body), options, &report);
  if (!made.ok()) return made.status();
  const EmbeddingData& embedding = dataOf(made.value());
  assert(embedding.vertexCount() == static_cast<std::size_t>(body.m_renderNodes.size()));

  body.m_z.resize(0);
  body.m_renderNodesInterpolationWeights.resize(body.m_renderNodes.size());
  body.m_renderNodesParents.resize(body.m_renderNodes.size());
  // In Bullet's order, so that its update reads them sequentially.
  for (int v = 0; v < body.m_renderNodes.size(); ++v) body.m_renderNodesParents[v].resize(4);
  const std::vector<EmbeddingData::Run>& runs = embedding.runs;
  for (std::size_t r = 0; r + 1 < runs.size(); ++r) {
    const BarycentricMap map(cornersOf(cage, cage.tets[runs[r].tet]));
    for (std::uint32_t slot = runs[r].firstSlot; slot < runs[r + 1].firstSlot; ++slot) {
      const int v = static_cast<int>(embedding.slotVertices[slot]);
      body.m_renderNodesInterpolationWeights[v] = weightsIn(map, body.m_renderNodes[v].m_x);
      for (int k = 0; k < 4; ++k) body.m_renderNodesParents[v][k] = &body.m_nodes[runs[r].nodes[k]];
    }
  }
  return report;
}

}  // namespace tetskin
