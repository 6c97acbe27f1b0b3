// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bullet's broadphase finds pairs in the order of its trees, and reorganises a part of each tree in every step.
// Therefore the trees are restored node by node, with all counters.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <tetskin/replay/src/state/bullet_members.h>
#include <tetskin/replay/src/state/saved_tree.h>
#include <tetskin/replay/src/state/world_state.h>

namespace tetskin::bullet_detail {
namespace {

constexpr int kFixedStage = btDbvtBroadphase::STAGECOUNT;

struct SavedProxy {
  int id = 0, group = 0, mask = 0, stage = 0;
  btVector3 low{0, 0, 0}, high{0, 0, 0};
};
/// Read as a whole, so that it is checked before the first change.
struct SavedBroadphase {
  std::vector<SavedProxy> proxies;  ///< of the objects
  std::vector<int> stages[kFixedStage + 1];
  SavedTree trees[2];
};

btDbvtProxy& proxyOf(const btCollisionObject& object) {
  return *static_cast<btDbvtProxy*>(const_cast<btBroadphaseProxy*>(object.getBroadphaseHandle()));
}
int objectOf(const btDbvtProxy& proxy) {
  return static_cast<const btCollisionObject*>(proxy.m_clientObject)->getWorldArrayIndex();
}

SavedBroadphase read(const btDbvtBroadphase& broadphase, const btCollisionObjectArray& objects) {
  SavedBroadphase saved;
  for (int k = 0; k < objects.size(); ++k) {
    const btDbvtProxy& p = proxyOf(*objects[k]);
    saved.proxies.push_back(
        {p.m_uniqueId, p.m_collisionFilterGroup, p.m_collisionFilterMask, p.stage, p.m_aabbMin, p.m_aabbMax});
  }
  for (int s = 0; s <= kFixedStage; ++s) {
    for (const btDbvtProxy* p = broadphase.m_stageRoots[s]; p; p = p->links[1]) saved.stages[s].push_back(objectOf(*p));
  }
  const auto objectAt = [](const btDbvtNode& leaf) { return objectOf(*static_cast<const btDbvtProxy*>(leaf.data)); };
  for (int k = 0; k < 2; ++k) readTree(broadphase.m_sets[k].m_root, objectAt, saved.trees[k]);
  return saved;
}

/// True if each object is there once, in the list of its stage and in the tree of this stage.
bool isWhole(const SavedBroadphase& saved, std::size_t objects) {
  if (saved.proxies.size() != objects) return false;
  const auto stageOf = [&](int object) {
    const bool exists = object >= 0 && static_cast<std::size_t>(object) < objects;
    return exists ? saved.proxies[static_cast<std::size_t>(object)].stage : -1;
  };
  std::vector<char> listed(objects, 0), leaf(objects, 0);
  std::size_t lists = 0, leaves = 0;
  for (int s = 0; s <= kFixedStage; ++s) {
    for (const int object : saved.stages[s]) {
      if (stageOf(object) != s || listed[static_cast<std::size_t>(object)]++) return false;
      ++lists;
    }
  }
  for (int k = 0; k < 2; ++k) {
    const bool whole = isTree(saved.trees[k], [&](int object) {
      const int stage = stageOf(object);
      ++leaves;
      return stage >= 0 && (stage == kFixedStage) == (k == 1) && !leaf[static_cast<std::size_t>(object)]++;
    });
    if (!whole) return false;
  }
  return lists == objects && leaves == objects;
}

void write(const SavedBroadphase& saved, btDbvtBroadphase& broadphase, const btCollisionObjectArray& objects) {
  for (int k = 0; k < objects.size(); ++k) {
    const SavedProxy& from = saved.proxies[static_cast<std::size_t>(k)];
    btDbvtProxy& p = proxyOf(*objects[k]);
    p.m_uniqueId = from.id;
    p.m_collisionFilterGroup = from.group;
    p.m_collisionFilterMask = from.mask;
    p.stage = from.stage;
    p.m_aabbMin = from.low;
    p.m_aabbMax = from.high;
  }
  for (int s = 0; s <= kFixedStage; ++s) {
    btDbvtProxy* before = nullptr;
    broadphase.m_stageRoots[s] = nullptr;
    for (const int object : saved.stages[s]) {
      btDbvtProxy& p = proxyOf(*objects[object]);
      p.links[0] = before;
      p.links[1] = nullptr;
      (before ? before->links[1] : broadphase.m_stageRoots[s]) = &p;
      before = &p;
    }
  }
  for (int k = 0; k < 2; ++k) {
    makeTree(saved.trees[k], broadphase.m_sets[k], [&](int object, btDbvtNode& leaf) {
      btDbvtProxy& proxy = proxyOf(*objects[object]);
      leaf.data = &proxy;
      proxy.leaf = &leaf;
    });
  }
}

}  // namespace

void serializeBroadphase(WorldStream& stream) {
  auto& broadphase = static_cast<btDbvtBroadphase&>(*stream.world().getBroadphase());
  const btCollisionObjectArray& objects = stream.world().getCollisionObjectArray();
  SavedBroadphase saved;
  if (stream.saving()) {
    saved = read(broadphase, objects);
    if (!isWhole(saved, static_cast<std::size_t>(objects.size()))) {
      return stream.refuse("a broadphase with proxies of more than this world's objects");
    }
  }
  stream.each(saved.proxies,
              [&](SavedProxy& p) { serializeAll(stream, p.id, p.group, p.mask, p.stage, p.low, p.high); });
  for (std::vector<int>& stage : saved.stages) stream.array(stage);
  for (SavedTree& tree : saved.trees) serializeTree(stream, tree);
  if (stream.restoring()) {
    if (stream.failed() || !isWhole(saved, static_cast<std::size_t>(objects.size()))) return stream.fail();
    write(saved, broadphase, objects);
  }
  btDbvtBroadphase& b = broadphase;
  for (btDbvt& tree : b.m_sets) serializeAll(stream, tree.m_lkhd, tree.m_opath);
  serializeAll(stream, b.m_prediction, b.m_stageCurrent, b.m_fupdates, b.m_dupdates, b.m_cupdates, b.m_newpairs,
               b.m_fixedleft, b.m_updates_call, b.m_updates_done, b.m_updates_ratio, b.m_pid, b.m_cid, b.m_gid,
               b.m_deferedcollide, b.m_needcleanup);
  // This is the index of the list into which each step puts objects.
  if (b.m_stageCurrent < 0 || b.m_stageCurrent >= kFixedStage) {
    b.m_stageCurrent = 0;
    stream.fail();
  }
}

}  // namespace tetskin::bullet_detail
