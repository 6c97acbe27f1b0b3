// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/motion/driven_nodes.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// Seconds. After a longer pause, a node that is moved again begins a new motion.
constexpr btScalar kMaxFrame = btScalar(0.1);
/// In intervals: a node that is moved again after a longer pause has been at rest.
constexpr btScalar kStood = btScalar(1.5);
/// Fraction of a step's path: a node nearer to its target has arrived. Bullet may have bounded its velocity.
constexpr btScalar kArrived = btScalar(1e-3);

bool wasMoved(const btSoftBody::Node& node) {
  return node.m_x != node.m_q;
}

/// Bullet itself puts anchored nodes where their anchors are.
bool isAState(const btSoftBody& body) {
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[n];
    if (node.m_im > 0 && !node.m_battach && wasMoved(node)) return true;
  }
  return false;
}

/// Sets the velocities to 0: otherwise they would stay, and move the nodes further.
void stop(btSoftBody& body, const std::vector<DrivenNode>& nodes) {
  for (const DrivenNode& driven : nodes) {
    if (driven.node >= body.m_nodes.size()) continue;
    btSoftBody::Node& node = body.m_nodes[driven.node];
    if (node.m_im == 0 && node.m_v == driven.velocity) node.m_v = node.m_vn = btVector3(0, 0, 0);
  }
}

/// Records what the application has done since the last step.
void notice(const btSoftBody::Node& node, DrivenNode& driven) {
  if (node.m_q != driven.target) {  // the body was translated, rotated or scaled
    driven.position = driven.target = driven.from = node.m_q;
    driven.left = 0;
    driven.curve = {};
    driven.motion = {};
  }
  if (!wasMoved(node)) return;
  if (driven.sinceMoved > kStood * driven.interval) driven.motion = {};
  if (driven.sinceMoved > 0 && driven.sinceMoved <= kMaxFrame) driven.interval = driven.sinceMoved;
  driven.target = node.m_x;
  driven.left = driven.interval;
  driven.sinceMoved = 0;
  driven.from = driven.position;
  driven.done = 0;
  driven.curve = {};
  driven.curve.way = driven.target - driven.from;
  if (driven.interval > 0) driven.curve = driven.motion.next(driven.curve.way, driven.interval);
}

void drive(btSoftBody::Node& node, btScalar dt, DrivenNode& driven) {
  assert(dt > 0 && driven.node >= 0);
  const btScalar steps = btMax(std::round(driven.left / dt), btScalar(1));
  ++driven.done;
  const btScalar fraction = static_cast<btScalar>(driven.done) / (static_cast<btScalar>(driven.done) + steps - 1);
  const btVector3 next = steps > 1 ? driven.from + driven.curve.at(fraction) : driven.target;
  driven.velocity = (next - driven.position) / dt;
  driven.left -= dt;
  driven.sinceMoved += dt;
  node.m_x = node.m_q = driven.position;
  node.m_v = node.m_vn = driven.velocity;
}

}  // namespace

DrivenNodes::Nodes* DrivenNodes::find(const btSoftBody& body) {
  const auto found = bodies_.find(&body);
  return found == bodies_.end() ? nullptr : &found->second;
}

void DrivenNodes::begin(const btAlignedObjectArray<btSoftBody*>& awake, btScalar dt) {
  for (int b = 0; b < awake.size(); ++b) beginBody(*awake[b], dt);
}

void DrivenNodes::beginBody(btSoftBody& body, btScalar dt) {
  Nodes* known = find(body);
  if (isAState(body)) {
    if (known) stop(body, *known);
    bodies_.erase(&body);
    return;
  }
  found_.clear();
  std::size_t next = 0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    btSoftBody::Node& node = body.m_nodes[n];
    if (node.m_im > 0) continue;
    while (known && next < known->size() && (*known)[next].node < n) ++next;
    const bool isKnown = known && next < known->size() && (*known)[next].node == n;
    if (!isKnown && !wasMoved(node)) continue;
    DrivenNode driven;
    driven.node = n;
    driven.position = driven.target = driven.from = node.m_q;
    if (isKnown) driven = (*known)[next];
    // A velocity that the application has set itself takes precedence.
    if (!node.m_v.isZero() && node.m_v != driven.velocity) continue;
    notice(node, driven);
    drive(node, dt, driven);
    found_.push_back(driven);
  }
  assert(std::is_sorted(found_.begin(), found_.end(), [](const auto& a, const auto& b) { return a.node < b.node; }));
  if (known || !found_.empty()) bodies_[&body].swap(found_);
}

/// Positions and velocities that had the body's bits before still have them afterwards.
void DrivenNodes::carry(btSoftBody& body, const Placement& placement, const std::function<void()>& moveNodes) {
  Nodes* nodes = find(body);
  if (!nodes) return moveNodes();
  const Nodes before = *nodes;
  std::vector<btSoftBody::Node> bodys;
  for (const DrivenNode& driven : before) bodys.push_back(body.m_nodes[driven.node]);
  moveNodes();
  for (std::size_t k = 0; k < before.size(); ++k) {
    const DrivenNode& was = before[k];
    const btSoftBody::Node& now = body.m_nodes[was.node];
    DrivenNode& driven = (*nodes)[k];
    placement.place(driven.position, driven.target, driven.from);
    placement.rotate(driven.velocity);
    if (was.target == bodys[k].m_q) driven.target = now.m_q;
    if (was.position == was.target) driven.position = driven.target;
    if (was.velocity == bodys[k].m_v) driven.velocity = now.m_v;
    driven.curve.rotate(placement);
    driven.motion.rotate(placement);
  }
}

void DrivenNodes::beforeIntegration(const btAlignedObjectArray<btSoftBody*>& awake) {
  if (bodies_.empty()) return;
  for (int b = 0; b < awake.size(); ++b) {
    Nodes* nodes = find(*awake[b]);
    if (!nodes) continue;
    const auto wasMovedSince = [&](const DrivenNode& driven) {
      assert(driven.node < awake[b]->m_nodes.size());
      btSoftBody::Node& node = awake[b]->m_nodes[driven.node];
      if (node.m_x == driven.position) return false;
      node.m_v = btVector3(0, 0, 0);
      return true;
    };
    nodes->erase(std::remove_if(nodes->begin(), nodes->end(), wasMovedSince), nodes->end());
  }
}

void DrivenNodes::end(const btAlignedObjectArray<btSoftBody*>& awake, btScalar dt) {
  if (bodies_.empty()) return;
  for (int b = 0; b < awake.size(); ++b) {
    Nodes* nodes = find(*awake[b]);
    if (!nodes) continue;
    for (DrivenNode& driven : *nodes) {
      btSoftBody::Node& node = awake[b]->m_nodes[driven.node];
      const btScalar rounding = kArrived * dt * driven.velocity.length();
      driven.position = (driven.target - node.m_x).length() <= rounding ? driven.target : node.m_x;
      driven.velocity = node.m_v;
      node.m_x = node.m_q = driven.target;
    }
  }
}

void DrivenNodes::serialize(WorldStream& stream) {
  stream.byObject(bodies_, [&](const btSoftBody& body, Nodes& nodes) {
    stream.each(nodes, [&](DrivenNode& driven) {
      stream(driven.node);
      if (driven.node < 0 || driven.node >= body.m_nodes.size()) stream.fail();
      stream(driven.position, driven.target, driven.velocity, driven.sinceMoved, driven.interval, driven.left,
             driven.from, driven.done);
      driven.curve.serialize(stream);
      driven.motion.serialize(stream);
    });
  });
}

}  // namespace tetskin::bullet_detail
