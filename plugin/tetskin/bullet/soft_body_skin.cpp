// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body_skin.h>

namespace tetskin {
namespace {

std::size_t sizeOf(const SkinTarget& target) {
  return std::visit(
      [](const auto& t) -> std::size_t {
        if constexpr (std::is_same_v<std::decay_t<decltype(t)>, std::monostate>) {
          return 0;
        } else {
          return t.size();
        }
      },
      target);
}

Status checkBinding(const btSoftBody& body, std::size_t nodeCount, std::size_t vertexCount,
                    const SkinOptions& options) {
  if (static_cast<std::size_t>(body.m_nodes.size()) != nodeCount) {
    return {StatusCode::SizeMismatch, "the body has " + std::to_string(body.m_nodes.size()) + " nodes, but the cage " +
                                          std::to_string(nodeCount) + "; bind with the cage that the body was made of"};
  }
  const bool own = std::holds_alternative<std::monostate>(options.target);
  if (!own && sizeOf(options.target) != vertexCount) {
    return {StatusCode::SizeMismatch, "the target holds " + std::to_string(sizeOf(options.target)) +
                                          " points, but the mesh has " + std::to_string(vertexCount) + " vertices"};
  }
  if (firstNonFinite(nodePositions(body)) != nodeCount) {
    return {StatusCode::NonFinite, "the body has node positions that are not finite; bind before it explodes"};
  }
  return {};
}

}  // namespace

const char* toString(UpdateStatus status) {
  switch (status) {
    case UpdateStatus::Updated:
      return "updated";
    case UpdateStatus::Asleep:
      return "asleep";
    case UpdateStatus::NonFinite:
      return "not finite";
    case UpdateStatus::TopologyChanged:
      return "topology changed";
    case UpdateStatus::Unbound:
      return "unbound";
  }
  return "unknown update status";
}

EmbedReport SoftBodySkin::bind(const btSoftBody& body, const TetMesh& restCage, PointView<const double> vertices,
                               const SkinOptions& options) {
  EmbedReport report;
  report.status = checkBinding(body, restCage.nodeCount(), vertices.size(), options);
  report.vertexCount = report.unbound = vertices.size();
  if (!report.ok()) return report;
  auto embedding = std::make_shared<Embedding>();
  report = embed(restCage, vertices, {options.outside}, *embedding);
  if (report.ok()) report.status = bind(body, std::move(embedding), options);
  return report;
}

EmbedReport SoftBodySkin::bind(const btSoftBody& body, const TetMesh& restCage, const TriangleMesh& mesh,
                               const SkinOptions& options) {
  return bind(body, restCage, viewOf(mesh.positions), options);
}

EmbedReport SoftBodySkin::bind(const btSoftBody& body, const TriangleMesh& mesh, const SkinOptions& options) {
  return bind(body, tetMeshOf(body), mesh, options);
}

Status SoftBodySkin::bind(const btSoftBody& body, std::shared_ptr<const Embedding> embedding,
                          const SkinOptions& options) {
  if (!embedding || embedding->empty()) return {StatusCode::Empty, "there is no embedding to bind with"};
  Status status = checkBinding(body, embedding->nodeCount(), embedding->vertexCount(), options);
  if (!status.ok()) return status;

  body_ = &body;
  nodeCount_ = body.m_nodes.size();
  tetCount_ = body.m_tetras.size();
  embedding_ = std::move(embedding);
  target_ = options.target;
  setOrigin(options.origin);
  nodes_.resize(static_cast<std::size_t>(nodeCount_));
  positions_.clear();
  if (std::holds_alternative<std::monostate>(target_)) positions_.resize(embedding_->vertexCount());
  packNodes(nodePositions(body), nodes_);
  skin();
  return {};
}

UpdateStatus SoftBodySkin::update() {
  if (!embedding_) return UpdateStatus::Unbound;
  if (body_->m_nodes.size() != nodeCount_ || body_->m_tetras.size() != tetCount_) return UpdateStatus::TopologyChanged;
  if (!body_->isActive() && !originMoved_ && nodesUnmoved()) return UpdateStatus::Asleep;
  if (!packNodes(nodePositions(*body_), nodes_)) return UpdateStatus::NonFinite;
  skin();
  return UpdateStatus::Updated;
}

void SoftBodySkin::setOrigin(const btVector3& origin) {
  origin_ = {origin.x(), origin.y(), origin.z()};
  originMoved_ = true;
}

bool SoftBodySkin::nodesUnmoved() const {
  const PointView<const btScalar> now = nodePositions(*body_);
  for (std::size_t i = 0; i < now.size(); ++i) {
    const btScalar* p = now[i];
    if (p[0] != nodes_[i][0] || p[1] != nodes_[i][1] || p[2] != nodes_[i][2]) return false;
  }
  return true;
}

void SoftBodySkin::skin() {
  if (const auto* single = std::get_if<PointView<float>>(&target_)) {
    bounds_ = skinLinear(*embedding_, nodes_, origin_, *single);
  } else if (const auto* twice = std::get_if<PointView<double>>(&target_)) {
    bounds_ = skinLinear(*embedding_, nodes_, origin_, *twice);
  } else {
    bounds_ = skinLinear(*embedding_, nodes_, origin_, viewOf(positions_));
  }
  originMoved_ = false;
}

}  // namespace tetskin
