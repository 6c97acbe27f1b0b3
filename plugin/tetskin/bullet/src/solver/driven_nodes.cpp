// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/solver/driven_nodes.h>

#include <algorithm>
#include <cmath>

namespace tetskin {
namespace {

/// Seconds. Who moves a node after a longer pause begins anew.
constexpr btScalar kLongestFrame = btScalar(0.1);
/// Of a step's way: how near counts as arrived. Bullet may have bounded the velocity.
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

/// What was given stays, or the nodes would go on with it.
void stop(btSoftBody& body, const std::vector<DrivenNode>& nodes) {
  for (const DrivenNode& of : nodes) {
    if (of.node >= body.m_nodes.size()) continue;
    btSoftBody::Node& node = body.m_nodes[of.node];
    if (node.m_im == 0 && node.m_v == of.velocity) node.m_v = node.m_vn = btVector3(0, 0, 0);
  }
}

/// Takes in what the application has done since the last step.
void notice(const btSoftBody::Node& node, DrivenNode& of) {
  if (node.m_q != of.target) {  // the body was translated, rotated or scaled
    of.position = of.target = node.m_q;
    of.left = 0;
  }
  if (!wasMoved(node)) return;
  if (of.sinceMoved > 0 && of.sinceMoved <= kLongestFrame) of.interval = of.sinceMoved;
  of.target = node.m_x;
  of.left = of.interval;
  of.sinceMoved = 0;
}

void drive(btSoftBody::Node& node, btScalar dt, DrivenNode& of) {
  const btScalar steps = btMax(std::round(of.left / dt), btScalar(1));
  of.velocity = (of.target - of.position) / (steps * dt);
  of.left -= dt;
  of.sinceMoved += dt;
  node.m_x = node.m_q = of.position;
  node.m_v = node.m_vn = of.velocity;
}

}  // namespace

DrivenNodes::Nodes* DrivenNodes::find(const btSoftBody& body) {
  const auto found = bodies_.find(&body);
  return found == bodies_.end() ? nullptr : &found->second;
}

void DrivenNodes::keepOnly(const btAlignedObjectArray<btSoftBody*>& bodies) {
  for (auto of = bodies_.begin(); of != bodies_.end();) {
    const bool here = bodies.findLinearSearch(const_cast<btSoftBody*>(of->first)) < bodies.size();
    of = here ? std::next(of) : bodies_.erase(of);
  }
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
    DrivenNode of;
    of.node = n;
    of.position = of.target = node.m_q;
    if (isKnown) of = (*known)[next];
    // A velocity of the application's own is what the node goes by.
    if (!node.m_v.isZero() && node.m_v != of.velocity) continue;
    notice(node, of);
    drive(node, dt, of);
    found_.push_back(of);
  }
  if (known || !found_.empty()) bodies_[&body].swap(found_);
}

void DrivenNodes::beforeIntegration(const btAlignedObjectArray<btSoftBody*>& awake) {
  if (bodies_.empty()) return;
  for (int b = 0; b < awake.size(); ++b) {
    Nodes* nodes = find(*awake[b]);
    if (!nodes) continue;
    const auto wasMovedSince = [&](const DrivenNode& of) {
      btSoftBody::Node& node = awake[b]->m_nodes[of.node];
      if (node.m_x == of.position) return false;
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
    for (DrivenNode& of : *nodes) {
      btSoftBody::Node& node = awake[b]->m_nodes[of.node];
      const btScalar rounding = kArrived * dt * of.velocity.length();
      of.position = (of.target - node.m_x).length() <= rounding ? of.target : node.m_x;
      of.velocity = node.m_v;
      node.m_x = node.m_q = of.target;
    }
  }
}

}  // namespace tetskin
