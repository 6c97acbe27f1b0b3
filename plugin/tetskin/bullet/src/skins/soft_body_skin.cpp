// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/bullet/src/base/dangling_nodes.h>
#include <tetskin/bullet/src/skins/node_samples.h>
#include <tetskin/core/src/base/compiler.h>
#include <tetskin/core/src/base/hash.h>
#include <tetskin/core/src/exported/skin_binding.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace tetskin {

using namespace bullet_detail;

namespace {

Status checkNodeCount(const btSoftBody& body, std::size_t nodeCount) {
  if (static_cast<std::size_t>(body.m_nodes.size()) == nodeCount) return {};
  return {StatusCode::SizeMismatch, "the body has " + std::to_string(body.m_nodes.size()) +
                                        " nodes, but the cage has " + std::to_string(nodeCount) +
                                        "; bind with the cage from which the body was created"};
}

/// Gives the address of Bullet's activation state.
struct ActivationState : btCollisionObject {
  static const void* addressIn(const btCollisionObject& object) {
    return &(object.*(&ActivationState::m_activationState1));
  }
};

/// One hash per axis, so that the three run in parallel.
std::uint64_t hashOf(PointView<const btScalar> nodes) {
  std::array<Hash, 3> axes;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (std::size_t k = 0; k < 3; ++k) axes[k].add(static_cast<double>(nodes[n][k]));
  }
  Hash hash;
  for (const Hash& axis : axes) hash.add(axis.value());
  return hash.value();
}

/// Number of skins that are decided before any is computed.
constexpr std::size_t kTogether = 512;
/// Number of skins whose memory is being prefetched: each has up to nine cache lines, and a processor has at most some
/// dozens in flight.
constexpr std::size_t kInFlight = 8;

}  // namespace

Result<EmbedReport> SoftBodySkin::bind(const btSoftBody& body, const Cage& restCage, const TriangleMesh& mesh,
                                       const SkinOptions& options) {
  if (Status s = checkNodeCount(body, restCage.mesh.nodeCount()); !s.ok()) return s;
  if (Status s = checkNodes(nodePositions(body)); !s.ok()) return s;
  if (Status s = checkInstance(options, mesh.vertexCount()); !s.ok()) return s;
  EmbedReport report;
  auto made = SoftBodyBinding::create(restCage, mesh, options, &report);
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
  const TetMesh cage = readTetMesh(body);
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
  const BodyWithTrees* own = bodyWithTrees(body);
  life_ = own ? own->lifetime() : std::weak_ptr<const NodeMoves>();
  moves_ = life_.lock().get();
  nodeCount_ = body.m_nodes.size();
  tetCount_ = body.m_tetras.size();
  between_ = teleported_ = false;
  sleeps_ = !body.isActive();
  steps_ = {};
  const PointView<const btScalar> nodes = nodePositions(body);
  const FourNodes four = nodesToSample(nodes.size(), nodes.strideBytes(), [&](std::size_t n) {
    return Eigen::Map<const Eigen::Matrix<btScalar, 3, 1>>(nodes[n]).cast<double>().eval();
  });
  for (std::size_t k = 0; k < samples_.size(); ++k) samples_[k].node = four[k];
  remember(true);
  return {};
}

StatusCode SoftBodySkin::update(btScalar alpha) {
  const StatusCode status = decide(alpha);
  return status == StatusCode::Ok ? compute(alpha) : status;
}

/// Decides what the update must do, as far as this is known without computing anything.
StatusCode SoftBodySkin::decide(btScalar alpha) {
  if (!skin_.bound()) return StatusCode::Unbound;
  skin_.clearMotion();  // until it is updated
  if (!visible_) return StatusCode::Hidden;
  if (!bodyLives()) return StatusCode::BodyDeleted;
  if (body_->m_nodes.size() != nodeCount_) return topologyChanged();
  if (!body_->isActive() && !moved_ && !isBetween(alpha) && unmoved()) return StatusCode::Asleep;
  if (body_->m_tetras.size() != tetCount_) return topologyChanged();
  return StatusCode::Ok;
}

StatusCode SoftBodySkin::compute(btScalar alpha) {
  assert(skin_.bound() && body_->m_nodes.size() == nodeCount_);
  const bool between = isBetween(alpha);
  const StatusCode done = between ? skin_.update(steps_, alpha) : skin_.update(nodePositions(*body_));
  if (done != StatusCode::Ok) {
    moved_ = true;  // no valid nodes to compare with
    return done;
  }
  if (teleported_) skin_.clearMotion();
  teleported_ = false;
  remember(!body_->isActive());
  moved_ |= between;  // the surface has not reached the body's position yet
  return StatusCode::Ok;
}

/// A step with other nodes or tets does not count as the previous one.
StatusCode SoftBodySkin::topologyChanged() {
  between_ = false;
  steps_.clear();
  return StatusCode::TopologyChanged;
}

void SoftBodySkin::recordStep() {
  if (!skin_.bound() || !visible_) return;
  between_ = false;
  if (!bodyLives()) return steps_.clear();
  const bool slept = std::exchange(sleeps_, !body_->isActive());
  if (slept && sleeps_) return;  // still at the same place
  if (body_->m_nodes.size() != nodeCount_ || body_->m_tetras.size() != tetCount_) return steps_.clear();
  if (slept) steps_.clear();
  between_ = steps_.record(nodePositions(*body_));
}

void SoftBodySkin::markTeleported() {
  moved_ = teleported_ = true;
  if (visible_) restart();
}

/// The next recorded step begins at the body's current position.
void SoftBodySkin::restart() {
  between_ = false;
  if (steps_.empty()) return;
  if (!bodyLives()) return steps_.clear();
  sleeps_ = !body_->isActive();
  steps_.clear();
  if (body_->m_nodes.size() == nodeCount_) (void)steps_.record(nodePositions(*body_));
}

std::size_t SoftBodySkin::updateAll(SoftBodySkin* const* skins, std::size_t count, StatusCode* statuses, btScalar alpha,
                                    ParallelFor* threads) {
  // All decisions first, then all work: the memory pages that decisions read would slow each update in between by a
  // tenth.
  std::array<StatusCode, kTogether> done;
  std::size_t updated = 0;
  for (std::size_t first = 0; first < count; first += kTogether) {
    const std::size_t size = std::min(kTogether, count - first);
    for (std::size_t k = 0; k < size; k += kInFlight) {
      decideAll(skins + first + k, std::min(kInFlight, size - k), done.data() + k, alpha);
    }
    runTasks(threads, size, [&](std::size_t k) {
      if (done[k] == StatusCode::Ok) done[k] = skins[first + k]->compute(alpha);
    });
    updated += static_cast<std::size_t>(std::count(done.data(), done.data() + size, StatusCode::Ok));
    if (statuses) std::copy_n(done.data(), size, statuses + first);
  }
  return updated;
}

/// Decides for a few skins. Each stage reads what the one before has prefetched.
void SoftBodySkin::decideAll(SoftBodySkin* const* skins, std::size_t count, StatusCode* statuses, btScalar alpha) {
  assert(count <= kInFlight);
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
  prefetch(&body_->m_softBodySolver);
  if (moves_) prefetch(moves_);
  prefetch(ActivationState::addressIn(*body_));
}

void SoftBodySkin::fetchNodes() const {
  if (!skin_.bound() || !visible_ || !bodyLives() || body_->m_nodes.size() != nodeCount_) return;
  if (!counted_) return;  // all nodes are read
  const PointView<const btScalar> now = nodePositions(*body_);
  for (const Sample& s : samples_) prefetch(now[static_cast<std::size_t>(s.node)]);
}

void SoftBodySkin::setVisible(bool visible) {
  if (visible == visible_) return;
  visible_ = visible;
  moved_ = true;  // whatever happened in between
  if (visible) {
    restart();
    (void)update();
  }
  skin_.clearMotion();  // what happened in between is no motion
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

/// True if steps count the moves of nodes; holds while the body is in the world of the solver that counts.
bool SoftBodySkin::movesCounted() const {
  return moves_ && moves_->counter && moves_->counter == body_->m_softBodySolver;
}

/// The surface now matches the nodes: stores what will tell whether they move. If nothing counts moves, that is a hash
/// of all nodes.
/// hashes  false: the next update computes the surface anyway, unless moves are counted
void SoftBodySkin::remember(bool hashes) {
  assert(body_ && body_->m_nodes.size() == nodeCount_);
  const PointView<const btScalar> now = nodePositions(*body_);
  counted_ = movesCounted();
  moved_ = !counted_ && !hashes;
  if (moved_) return;
  seen_ = counted_ ? moves_->count : hashOf(now);
  if (!counted_) return;
  for (Sample& s : samples_) std::copy_n(now[static_cast<std::size_t>(s.node)], 3, s.position);
}

/// True if the nodes are where they were when the surface was computed. Nodes written by the application are not
/// counted; of such changes, the samples reveal only affine motions of the whole body.
bool SoftBodySkin::unmoved() const {
  assert(body_->m_nodes.size() == nodeCount_);
  if (counted_ != movesCounted()) return false;
  return counted_ ? seen_ == moves_->count && samplesUnmoved() : seen_ == hashOf(nodePositions(*body_));
}

/// An affine map that fixes four points that are not in one plane fixes everything.
bool SoftBodySkin::samplesUnmoved() const {
  assert(body_->m_nodes.size() == nodeCount_);
  const PointView<const btScalar> now = nodePositions(*body_);
  bool unmoved = true;
  for (const Sample& s : samples_) {
    const btScalar* p = now[static_cast<std::size_t>(s.node)];
    unmoved &= (p[0] == s.position[0]) & (p[1] == s.position[1]) &
               (p[2] == s.position[2]);  // no branches, so that the comparisons run in parallel
  }
  return unmoved;
}

}  // namespace tetskin
