// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The order of pairs, and everything that follows from it, with another layout of memory.
#include "solver/rigid_scene.h"

#include <tetskin/replay/snapshot.h>

#include <unordered_map>
#include <utility>

#include "solver/deformable_test.h"
#include "support/replays.h"

namespace tetskin::test {
namespace {

void collect(btDbvtNode* node, std::vector<btDbvtNode*>& nodes) {
  if (!node) return;
  nodes.push_back(node);
  if (node->isleaf()) return;
  for (btDbvtNode* child : node->childs) collect(child, nodes);
}

/// The same tree, as if its nodes had been given each other's memory.
/// pick  the new order of the nodes, which come in the order of their addresses
void layOut(btDbvt& tree, const std::function<void(std::vector<btDbvtNode*>&)>& pick) {
  std::vector<btDbvtNode*> nodes;
  collect(tree.m_root, nodes);
  std::sort(nodes.begin(), nodes.end(), std::less<>());
  std::vector<btDbvtNode*> order = nodes;
  pick(order);
  std::unordered_map<btDbvtNode*, btDbvtNode*> at{{nullptr, nullptr}};
  for (std::size_t k = 0; k < nodes.size(); ++k) at[nodes[k]] = order[k];
  std::vector<btDbvtNode> before;
  for (const btDbvtNode* node : nodes) before.push_back(*node);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    btDbvtNode& node = *order[k];
    node = before[k];
    node.parent = at.at(node.parent);
    if (node.isleaf()) {
      static_cast<btDbvtProxy*>(node.data)->leaf = &node;
    } else {
      for (btDbvtNode*& child : node.childs) child = at.at(child);
    }
  }
  tree.m_root = at.at(tree.m_root);
}

/// Addresses that fall, and others.
void layOut(btDbvtBroadphase& broadphase, int frame) {
  std::mt19937 random(static_cast<unsigned>(frame));
  for (btDbvt& tree : broadphase.m_sets) {
    layOut(tree, [&](std::vector<btDbvtNode*>& nodes) {
      if (frame % 2 == 0) return std::reverse(nodes.begin(), nodes.end());
      std::shuffle(nodes.begin(), nodes.end(), random);
    });
  }
}

using Ids = std::vector<std::pair<int, int>>;

Ids pairsOf(btDbvtBroadphase& broadphase) {
  const btBroadphasePairArray& pairs = broadphase.getOverlappingPairCache()->getOverlappingPairArray();
  Ids ids;
  for (int k = 0; k < pairs.size(); ++k)
    ids.emplace_back(pairs[k].m_pProxy0->m_uniqueId, pairs[k].m_pProxy1->m_uniqueId);
  return ids;
}

/// The effects of boxes that wander, come and go.
struct Wandered {
  std::vector<Ids> pairs;                ///< after each frame
  std::vector<const btDbvtNode*> roots;  ///< of the tree, by frame: before the step, and after it
};

Wandered wander(bool elsewhere, bool deferred) {
  constexpr int kFrames = 60, kBoxes = 80;
  btDbvtBroadphase broadphase;
  broadphase.m_deferedcollide = deferred;
  std::mt19937 random(1);
  const auto coordinate = [&] { return btScalar(0.01) * static_cast<btScalar>(random() % 500); };
  const btVector3 half(btScalar(0.5), btScalar(0.5), btScalar(0.5));
  std::vector<btBroadphaseProxy*> proxies;
  const auto add = [&](const btVector3& at) {
    proxies.push_back(broadphase.createProxy(at - half, at + half, 0, nullptr, 1, 1, nullptr));
  };
  const auto anywhere = [&] {
    const btScalar x = coordinate(), y = coordinate();
    return btVector3(x, y, coordinate());
  };
  for (int k = 0; k < kBoxes; ++k) add(anywhere());
  Wandered result;
  for (int frame = 0; frame < kFrames; ++frame) {
    if (elsewhere) layOut(broadphase, frame);
    for (int k = 0; k < 20; ++k) {
      const btVector3 at = anywhere();
      broadphase.setAabb(proxies[random() % kBoxes], at - half, at + half, nullptr);
    }
    const std::size_t gone = random() % kBoxes;
    broadphase.destroyProxy(proxies[gone], nullptr);
    proxies.erase(proxies.begin() + static_cast<std::ptrdiff_t>(gone));
    add(anywhere());
    result.roots.push_back(broadphase.m_sets[0].m_root);
    broadphase.calculateOverlappingPairs(nullptr);
    result.roots.push_back(broadphase.m_sets[0].m_root);
    result.pairs.push_back(pairsOf(broadphase));
  }
  for (btBroadphaseProxy* proxy : proxies) broadphase.destroyProxy(proxy, nullptr);
  return result;
}

/// Bullet compares addresses of tree nodes, and lets two nodes change places, so that the upper one has the lower
/// address. The tree, and all results of its queries, stay the same.
TEST(PairOrder, DoesNotComeFromAddresses) {
  for (const bool deferred : {false, true}) {
    const Wandered here = wander(false, deferred), elsewhere = wander(true, deferred);
    EXPECT_EQ(here.pairs, elsewhere.pairs);
    int changed = 0;
    for (std::size_t k = 0; k < elsewhere.roots.size(); k += 2) changed += elsewhere.roots[k] != elsewhere.roots[k + 1];
    EXPECT_GT(changed, 5);
  }
}

/// A heap of rigid bodies of all kinds, and a soft body that falls into it.
struct Heap : RigidScene {
  Heap() {
    addFloor();
    addKinds();
    addStack(60);
    soft = DeformableBody::add(world, smallCageAbove(2)).value();
  }

  std::unique_ptr<DeformableBody> soft;
};

TEST(PairOrder, AndMotionDoNotComeFromAddresses) {
  Heap here, elsewhere;
  Bytes middle;
  std::vector<std::vector<btScalar>> frames;
  for (int frame = 0; frame < 120; ++frame) {
    if (frame == 60) middle = saved(here.world);
    layOut(elsewhere.world.broadphase(), frame);
    here.step();
    elsewhere.step();
    frames.push_back(seen(here.world));
    ASSERT_EQ(pairsOf(here.world.broadphase()), pairsOf(elsewhere.world.broadphase())) << "frame " << frame;
    ASSERT_EQ(frames.back(), seen(elsewhere.world)) << "frame " << frame;
  }
  ASSERT_TRUE(restoreSnapshot(elsewhere.world, middle.data(), middle.size()).ok());
  for (int frame = 60; frame < 120; ++frame) {
    layOut(elsewhere.world.broadphase(), frame);
    elsewhere.step();
    ASSERT_EQ(frames[static_cast<std::size_t>(frame)], seen(elsewhere.world)) << "frame " << frame << ", restored";
  }
}

}  // namespace
}  // namespace tetskin::test
