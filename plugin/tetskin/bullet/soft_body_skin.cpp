// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body_skin.h>

namespace tetskin {
namespace {

/// A teleport moves all nodes, so a few tell.
constexpr std::size_t kSampledNodes = 8;

Status checkNodeCount(const btSoftBody& body, std::size_t nodeCount) {
  if (static_cast<std::size_t>(body.m_nodes.size()) == nodeCount) return {};
  return {StatusCode::SizeMismatch, "the body has " + std::to_string(body.m_nodes.size()) + " nodes, but the cage " +
                                        std::to_string(nodeCount) + "; bind with the cage that the body was made of"};
}

}  // namespace

const char* toString(UpdateStatus status) {
  switch (status) {
    case UpdateStatus::Updated:
      return "updated";
    case UpdateStatus::Asleep:
      return "asleep";
    case UpdateStatus::Hidden:
      return "hidden";
    case UpdateStatus::NonFinite:
      return "not finite";
    case UpdateStatus::TopologyChanged:
      return "topology changed";
    case UpdateStatus::Unbound:
      return "unbound";
  }
  return "unknown update status";
}

EmbedReport SoftBodySkin::bind(const btSoftBody& body, const TetMesh& restCage, const TriangleMesh& mesh,
                               const SkinOptions& options) {
  EmbedReport report;
  report.vertexCount = report.unbound = mesh.vertexCount();
  report.status = checkNodeCount(body, restCage.nodeCount());
  if (!report.ok()) return report;
  std::shared_ptr<const SoftBodyBinding> binding;
  QuadraticReport quadratic;
  report = makeSkinBinding(restCage, mesh, options, binding, &quadratic);
  if (report.ok()) report.status = bind(body, std::move(binding), options);
  if (report.ok()) quadraticReport_ = quadratic;
  return report;
}

EmbedReport SoftBodySkin::bind(const btSoftBody& body, const TetMesh& restCage, PointView<const double> vertices,
                               const SkinOptions& options) {
  TriangleMesh mesh;
  mesh.positions.reserve(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    mesh.positions.emplace_back(vertices[v][0], vertices[v][1], vertices[v][2]);
  }
  return bind(body, restCage, mesh, options);
}

EmbedReport SoftBodySkin::bind(const btSoftBody& body, const TriangleMesh& mesh, const SkinOptions& options) {
  return bind(body, tetMeshOf(body), mesh, options);
}

Status SoftBodySkin::bind(const btSoftBody& body, std::shared_ptr<const SoftBodyBinding> binding,
                          const SkinOptions& options) {
  if (binding) {
    if (Status status = checkNodeCount(body, binding->embedding.nodeCount()); !status.ok()) return status;
  }
  if (Status status = skin_.bind(std::move(binding), nodePositions(body), options); !status.ok()) return status;
  body_ = &body;
  nodeCount_ = body.m_nodes.size();
  tetCount_ = body.m_tetras.size();
  moved_ = false;
  return {};
}

UpdateStatus SoftBodySkin::update() {
  if (!skin_.bound()) return UpdateStatus::Unbound;
  skin_.hold();  // unless it is updated
  if (!visible_) return UpdateStatus::Hidden;
  if (body_->m_nodes.size() != nodeCount_ || body_->m_tetras.size() != tetCount_) return UpdateStatus::TopologyChanged;
  if (!body_->isActive() && !moved_ && sampledNodesUnmoved()) return UpdateStatus::Asleep;
  const std::size_t bad = skin_.update(nodePositions(*body_));
  if (bad < skin_.nodeCount()) {
    firstBadNode_ = bad;
    moved_ = true;  // there are no good nodes to compare with
    return UpdateStatus::NonFinite;
  }
  moved_ = false;
  return UpdateStatus::Updated;
}

void SoftBodySkin::setVisible(bool visible) {
  if (visible == visible_) return;
  visible_ = visible;
  moved_ = true;  // whatever has happened meanwhile
  if (visible) (void)update();
  skin_.hold();  // what happened meanwhile is no motion
}

void SoftBodySkin::setOrigin(const btVector3& origin) {
  skin_.setOrigin(toEigen(origin));
  moved_ = true;
}

bool SoftBodySkin::sampledNodesUnmoved() const {
  const PointView<const btScalar> now = nodePositions(*body_);
  const std::size_t step = std::max<std::size_t>(1, now.size() / kSampledNodes);
  for (std::size_t i = 0; i < now.size(); i += step) {
    if (!skin_.nodes().isAt(i, now[i])) return false;
  }
  return true;
}

}  // namespace tetskin
