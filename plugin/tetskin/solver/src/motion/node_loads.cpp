// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/base/node_loads.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace tetskin::bullet_detail {

void NodeLoads::add(btSoftBody& body, NodePushes forces, int steps) {
  assert(steps > 0);
  loads_.push_back({&body, std::move(forces), steps});
  body.activate();
}

void NodeLoads::drop(const btSoftBody& body) {
  const auto isOf = [&](const Load& load) { return load.body == &body; };
  loads_.erase(std::remove_if(loads_.begin(), loads_.end(), isOf), loads_.end());
}

void NodeLoads::dropAllBut(const btAlignedObjectArray<btSoftBody*>& world) {
  const auto isGone = [&](const Load& load) { return world.findLinearSearch(load.body) == world.size(); };
  loads_.erase(std::remove_if(loads_.begin(), loads_.end(), isGone), loads_.end());
}

std::vector<PointJoint>* NodeLoads::joints(btScalar seconds) {
  assert(seconds > 0);
  joints_.clear();
  for (Load& load : loads_) {
    --load.left;
    for (const NodePush& push : load.forces) {
      PointJoint& joint = joints_.emplace_back();
      joint.body = load.body;
      joint.constant = true;
      joint.at.add(push.node, 1);
      joint.impulse = toBullet(static_cast<double>(seconds) * push.push);
    }
  }
  loads_.erase(std::remove_if(loads_.begin(), loads_.end(), [](const Load& load) { return load.left == 0; }),
               loads_.end());
  return &joints_;
}

void NodeLoads::serialize(WorldStream& stream) {
  stream.each(loads_, [&](Load& load) {
    stream.object(load.body);
    stream(load.left);
    stream.each(load.forces, [&](NodePush& push) {
      stream(push.node);
      stream.plain(push.push.data(), 3);
    });
  });
  if (!stream.restoring()) return;
  const auto isDamaged = [](const Load& load) {
    const auto misses = [&](const NodePush& push) {
      return push.node < 0 || push.node >= load.body->m_nodes.size() || !push.push.allFinite();
    };
    return !load.body || load.left < 1 || std::any_of(load.forces.begin(), load.forces.end(), misses);
  };
  if (!std::any_of(loads_.begin(), loads_.end(), isDamaged)) return;
  loads_.clear();
  stream.fail();
}

}  // namespace tetskin::bullet_detail
