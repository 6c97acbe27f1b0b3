// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body_skin.h>

#include <algorithm>
#include <iterator>

namespace tetskin {
namespace {

Status checkNodeCount(const btSoftBody& body, std::size_t nodeCount) {
  if (static_cast<std::size_t>(body.m_nodes.size()) == nodeCount) return {};
  return {StatusCode::SizeMismatch, "the body has " + std::to_string(body.m_nodes.size()) + " nodes, but the cage " +
                                        std::to_string(nodeCount) + "; bind with the cage that the body was made of"};
}

/// The tet whose nodes lie closest together in memory, on the fewest pages.
const int* closestNumbered(const Embedding& embedding) {
  const auto span = [](const Embedding::Run& run) {
    const auto [low, high] = std::minmax_element(std::begin(run.nodes), std::end(run.nodes));
    return *high - *low;
  };
  const auto& runs = embedding.runs();  // the last one only closes the list
  return std::min_element(runs.begin(), runs.end() - 1, [&](const auto& a, const auto& b) { return span(a) < span(b); })
      ->nodes;
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
  const int* tet = closestNumbered(skin_.binding()->embedding);
  for (std::size_t k = 0; k < samples_.size(); ++k) samples_[k].node = tet[k];
  sample();
  return {};
}

UpdateStatus SoftBodySkin::update() {
  if (!skin_.bound()) return UpdateStatus::Unbound;
  skin_.hold();  // unless it is updated
  if (!visible_) return UpdateStatus::Hidden;
  if (body_->m_nodes.size() != nodeCount_) return UpdateStatus::TopologyChanged;
  if (!body_->isActive() && !moved_ && samplesUnmoved()) return UpdateStatus::Asleep;
  if (body_->m_tetras.size() != tetCount_) return UpdateStatus::TopologyChanged;
  const std::size_t bad = skin_.update(nodePositions(*body_));
  if (bad < skin_.nodeCount()) {
    firstBadNode_ = bad;
    moved_ = true;  // there are no good nodes to compare with
    return UpdateStatus::NonFinite;
  }
  moved_ = false;
  sample();
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

void SoftBodySkin::sample() {
  const PointView<const btScalar> now = nodePositions(*body_);
  for (Sample& s : samples_) std::copy_n(now[static_cast<std::size_t>(s.node)], 3, s.position);
}

/// An affine map that leaves the corners of a tet in place leaves everything in place.
bool SoftBodySkin::samplesUnmoved() const {
  const PointView<const btScalar> now = nodePositions(*body_);
  bool unmoved = true;
  for (const Sample& s : samples_) {
    const btScalar* p = now[static_cast<std::size_t>(s.node)];
    unmoved &= (p[0] == s.position[0]) & (p[1] == s.position[1]) & (p[2] == s.position[2]);  // no branches: in parallel
  }
  return unmoved;
}

}  // namespace tetskin
