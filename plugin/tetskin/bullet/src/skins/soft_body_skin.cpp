// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/bullet/src/skins/node_samples.h>
#include <tetskin/core/src/shared/skin_binding.h>

#include <algorithm>
#include <utility>

namespace tetskin {
namespace {

Status checkNodeCount(const btSoftBody& body, std::size_t nodeCount) {
  if (static_cast<std::size_t>(body.m_nodes.size()) == nodeCount) return {};
  return {StatusCode::SizeMismatch, "the body has " + std::to_string(body.m_nodes.size()) + " nodes, but the cage " +
                                        std::to_string(nodeCount) + "; bind with the cage that the body was made of"};
}

/// Asks memory for what is there.
void prefetch(const void* where) {
#if defined(__GNUC__)
  __builtin_prefetch(where);
#else
  (void)where;
#endif
}

/// Where Bullet keeps whether a body sleeps.
struct ActivationState : btCollisionObject {
  static const void* of(const btCollisionObject& object) { return &(object.*(&ActivationState::m_activationState1)); }
};

/// Skins decided on before any is computed.
constexpr std::size_t kTogether = 512;
/// Skins whose memory is under way at a time: each has up to nine lines, and a processor waits for some dozens at most.
constexpr std::size_t kInFlight = 8;

}  // namespace

Result<EmbedReport> SoftBodySkin::bind(const btSoftBody& body, const Cage& restCage, const TriangleMesh& mesh,
                                       const SkinOptions& options) {
  if (Status s = checkNodeCount(body, restCage.nodeCount()); !s.ok()) return s;
  if (Status s = checkNodes(nodePositions(body)); !s.ok()) return s;
  if (Status s = checkInstance(options, mesh.vertexCount()); !s.ok()) return s;
  EmbedReport report;
  auto made = SoftBodyBinding::make(restCage, mesh, options, &report);
  if (!made.ok()) return made.status();
  const InstanceOptions& instance = options;
  if (Status s = bind(body, std::move(made).value(), instance); !s.ok()) return s;
  return report;
}

Result<EmbedReport> SoftBodySkin::bind(const btSoftBody& body, const Cage& restCage, PointView<const double> vertices,
                                       const SkinOptions& options) {
  TriangleMesh mesh;
  mesh.positions.reserve(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    mesh.positions.emplace_back(vertices[v][0], vertices[v][1], vertices[v][2]);
  }
  return bind(body, restCage, mesh, options);
}

Result<EmbedReport> SoftBodySkin::bind(const btSoftBody& body, const TriangleMesh& mesh, const SkinOptions& options) {
  const TetMesh cage = tetMeshOf(body);
  if (Status s = checkDangling(cage); !s.ok()) return s;
  return bind(body, cage, mesh, options);
}

Status SoftBodySkin::bind(const btSoftBody& body, std::shared_ptr<const SoftBodyBinding> binding,
                          const InstanceOptions& options) {
  if (binding) {
    if (Status status = checkNodeCount(body, binding->embedding().nodeCount()); !status.ok()) return status;
  }
  if (Status status = skin_.bind(std::move(binding), nodePositions(body), options); !status.ok()) return status;
  body_ = &body;
  nodeCount_ = body.m_nodes.size();
  tetCount_ = body.m_tetras.size();
  moved_ = between_ = teleported_ = false;
  sleeps_ = !body.isActive();
  steps_ = {};
  const PointView<const btScalar> nodes = nodePositions(body);
  const FourNodes four = nodesToSample(nodes.size(), nodes.strideBytes(), [&](std::size_t n) {
    return Eigen::Map<const Eigen::Matrix<btScalar, 3, 1>>(nodes[n]).cast<double>().eval();
  });
  for (std::size_t k = 0; k < samples_.size(); ++k) samples_[k].node = four[k];
  sample();
  return {};
}

UpdateStatus SoftBodySkin::update(btScalar alpha) {
  const UpdateStatus status = decide(alpha);
  return status == UpdateStatus::Updated ? compute(alpha) : status;
}

/// What the update is to be, as far as can be told without computing anything.
UpdateStatus SoftBodySkin::decide(btScalar alpha) {
  if (!skin_.bound()) return UpdateStatus::Unbound;
  skin_.hold();  // unless it is updated
  if (!visible_) return UpdateStatus::Hidden;
  if (body_->m_nodes.size() != nodeCount_) return topologyChanged();
  if (!body_->isActive() && !moved_ && !isBetween(alpha) && samplesUnmoved()) return UpdateStatus::Asleep;
  if (body_->m_tetras.size() != tetCount_) return topologyChanged();
  return UpdateStatus::Updated;
}

UpdateStatus SoftBodySkin::compute(btScalar alpha) {
  const bool between = isBetween(alpha);
  const UpdateStatus done = between ? skin_.update(steps_, alpha) : skin_.update(nodePositions(*body_));
  if (done != UpdateStatus::Updated) {
    moved_ = true;  // there are no good nodes to compare with
    return done;
  }
  if (teleported_) skin_.hold();
  teleported_ = false;
  moved_ = between;  // the surface is not yet where the body is
  sample();
  return UpdateStatus::Updated;
}

/// A step of other nodes, or tets, is not the one before the next.
UpdateStatus SoftBodySkin::topologyChanged() {
  between_ = false;
  steps_.forget();
  return UpdateStatus::TopologyChanged;
}

void SoftBodySkin::keepStep() {
  if (!skin_.bound() || !visible_) return;
  between_ = false;
  const bool slept = std::exchange(sleeps_, !body_->isActive());
  if (slept && sleeps_) return;  // where it was
  if (body_->m_nodes.size() != nodeCount_ || body_->m_tetras.size() != tetCount_) return steps_.forget();
  if (slept) steps_.forget();
  between_ = steps_.keep(nodePositions(*body_));
}

void SoftBodySkin::markTeleported() {
  moved_ = teleported_ = true;
  if (visible_) beginAnew();
}

/// The next step kept begins where the body is now.
void SoftBodySkin::beginAnew() {
  between_ = false;
  if (steps_.empty()) return;
  sleeps_ = !body_->isActive();
  steps_.forget();
  if (body_->m_nodes.size() == nodeCount_) (void)steps_.keep(nodePositions(*body_));
}

std::size_t SoftBodySkin::updateAll(SoftBodySkin* const* skins, std::size_t count, UpdateStatus* statuses,
                                    btScalar alpha) {
  // First all decisions, then all work: the pages that decisions touch would slow each update in between by a tenth.
  std::array<UpdateStatus, kTogether> done;
  std::size_t updated = 0;
  for (std::size_t first = 0; first < count; first += kTogether) {
    const std::size_t size = std::min(kTogether, count - first);
    for (std::size_t k = 0; k < size; k += kInFlight) {
      decideAll(skins + first + k, std::min(kInFlight, size - k), done.data() + k, alpha);
    }
    for (std::size_t k = 0; k < size; ++k) {
      if (done[k] == UpdateStatus::Updated) done[k] = skins[first + k]->compute(alpha);
      updated += done[k] == UpdateStatus::Updated;
    }
    if (statuses) std::copy_n(done.data(), size, statuses + first);
  }
  return updated;
}

/// Decides on a few skins. Each step reads what the one before has asked memory for.
void SoftBodySkin::decideAll(SoftBodySkin* const* skins, std::size_t count, UpdateStatus* statuses, btScalar alpha) {
  for (std::size_t k = 0; k < count; ++k) skins[k]->fetch();
  for (std::size_t k = 0; k < count; ++k) skins[k]->fetchBody();
  for (std::size_t k = 0; k < count; ++k) skins[k]->fetchNodes();
  for (std::size_t k = 0; k < count; ++k) statuses[k] = skins[k]->decide(alpha);
}

void SoftBodySkin::fetch() const {
  prefetch(&body_);
  prefetch(&samples_.back());
  prefetch(&skin_);
}

void SoftBodySkin::fetchBody() const {
  if (!skin_.bound() || !visible_) return;
  prefetch(&body_->m_nodes);
  prefetch(ActivationState::of(*body_));
}

void SoftBodySkin::fetchNodes() const {
  if (!skin_.bound() || !visible_ || body_->m_nodes.size() != nodeCount_) return;
  const PointView<const btScalar> now = nodePositions(*body_);
  for (const Sample& s : samples_) prefetch(now[static_cast<std::size_t>(s.node)]);
}

void SoftBodySkin::setVisible(bool visible) {
  if (visible == visible_) return;
  visible_ = visible;
  moved_ = true;  // whatever has happened meanwhile
  if (visible) {
    beginAnew();
    (void)update();
  }
  skin_.hold();  // what happened meanwhile is no motion
}

btVector3 SoftBodySkin::nodeAt(int node, btScalar alpha) const {
  assert(body_ && node >= 0 && node < body_->m_nodes.size());
  if (!isBetween(alpha)) return body_->m_nodes[node].m_x;
  const Eigen::Matrix<btScalar, 3, 1> at = steps_.nodeAt(static_cast<std::size_t>(node), alpha);
  return {at.x(), at.y(), at.z()};
}

Status SoftBodySkin::setOrigin(const btVector3& origin) {
  Status status = skin_.setOrigin(toEigen(origin));
  if (status.ok()) moved_ = true;
  return status;
}

void SoftBodySkin::sample() {
  const PointView<const btScalar> now = nodePositions(*body_);
  for (Sample& s : samples_) std::copy_n(now[static_cast<std::size_t>(s.node)], 3, s.position);
}

/// An affine map that leaves four points in place that are not in one plane leaves everything in place.
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
