// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/search/padded_trees.h>

#include <algorithm>
#include <cassert>

namespace tetskin::bullet_detail {
namespace {

/// Padding of the leaves: in collision margins, or in steps of motion for faster bodies. With more padding, rays visit
/// more leaves, and the trees are refitted less often.
constexpr btScalar kMinPadding = 2, kPaddingSteps = 10;
/// Bound of the padding, in diagonals of the body's box.
constexpr btScalar kMaxPadding = btScalar(0.1);

}  // namespace

bool collidesWithSoftBodies(btSoftBody& body) {
  return (body.m_cfg.collisions & btSoftBody::fCollision::SVSmask) != 0 || body.useSelfCollision();
}

bool collidesByBulletsTrees(btSoftBody& body) {
  constexpr int kFaces = btSoftBody::fCollision::SDF_RDF | btSoftBody::fCollision::SDF_MDF;
  const int rigid = body.m_cfg.collisions & btSoftBody::fCollision::RVSmask;
  const bool atNodes = rigid == 0 || rigid == btSoftBody::fCollision::SDF_RD;
  return !atNodes || (body.m_cfg.collisions & kFaces) != 0 || collidesWithSoftBodies(body);
}

bool needsBulletsTrees(btSoftBody& body) {
  return body.m_bUpdateRtCst || collidesByBulletsTrees(body);
}

void PaddedTrees::fit(btSoftBody& body, Dynamics& dynamics, btScalar step) {
  assert(dynamics.nodeCount() == static_cast<std::size_t>(body.m_nodes.size()));
  if (points_.size() != 3 * dynamics.nodeCount()) ready_ = false;
  if (ready_) drift_ = farthest(dynamics);
  fitAgain(body, dynamics, step);
}

void PaddedTrees::fitAgain(btSoftBody& body, Dynamics& dynamics, btScalar step) {
  if (body.m_fdbvt.empty() || holds(step)) return;
  const btScalar margin = body.getCollisionShape()->getMargin();
  const btScalar maximum = kMaxPadding * (body.m_bounds[1] - body.m_bounds[0]).length();
  pad_ = std::max(kMinPadding * margin, std::min(kPaddingSteps * step, maximum));
  body.m_sst.radmrg = pad_;
  body.updateFaceTree(true, true);
  body.m_sst.radmrg = margin;
  points_.resize(3 * dynamics.nodeCount());
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) std::copy_n(dynamics.point(n), 3, &points_[3 * n]);
  drift_ = 0;
  ready_ = true;
}

btScalar PaddedTrees::farthest(Dynamics& dynamics) const {
  assert(points_.size() == 3 * dynamics.nodeCount());
  btScalar maximum = 0;
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    const btScalar* now = dynamics.point(n);
    const btScalar x = now[0] - points_[3 * n], y = now[1] - points_[3 * n + 1], z = now[2] - points_[3 * n + 2];
    maximum = std::max(maximum, x * x + y * y + z * z);
  }
  return btSqrt(maximum);
}

}  // namespace tetskin::bullet_detail
