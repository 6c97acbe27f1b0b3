// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableWorld: Bullet's dispatcher and broadphase, which report when objects are added or removed where
// that is not allowed.
#pragma once

#include <btBulletCollisionCommon.h>

#include <cassert>

namespace tetskin::bullet_detail {

/// True as long as this exists. For detection: while Bullet detects contacts, it iterates over pairs and trees that
/// adding or removing an object would change.
class Running {
 public:
  explicit Running(bool& runs) : runs_(runs), before_(runs) { runs_ = true; }
  ~Running() { runs_ = before_; }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

 private:
  bool& runs_;
  const bool before_;  ///< it may be nested
};

class WatchedDispatcher : public btCollisionDispatcher {
 public:
  WatchedDispatcher(btCollisionConfiguration& configuration, bool& detects)
      : btCollisionDispatcher(&configuration), detects_(detects) {}
  void dispatchAllCollisionPairs(btOverlappingPairCache* pairs, const btDispatcherInfo& info,
                                 btDispatcher* dispatcher) override {
    const Running detection(detects_);
    btCollisionDispatcher::dispatchAllCollisionPairs(pairs, info, dispatcher);
  }

 private:
  bool& detects_;
};

/// Every object that enters or leaves a world gets its proxy created or destroyed here.
class WatchedBroadphase : public btDbvtBroadphase {
 public:
  explicit WatchedBroadphase(bool& detects) : detects_(detects) {}
  btBroadphaseProxy* createProxy(const btVector3& low, const btVector3& high, int type, void* object, int group,
                                 int mask, btDispatcher* dispatcher) override {
    assert(!detects_ && "nothing may be added in a filter, near or contact callback: do it in a tick callback");
    const Running detection(detects_);
    return btDbvtBroadphase::createProxy(low, high, type, object, group, mask, dispatcher);
  }
  void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override {
    assert(!detects_ && "nothing may be removed in a filter, near or contact callback: do it in a tick callback");
    btDbvtBroadphase::destroyProxy(proxy, dispatcher);
  }
  /// Looks for new pairs, and asks the filters.
  void setAabb(btBroadphaseProxy* proxy, const btVector3& low, const btVector3& high,
               btDispatcher* dispatcher) override {
    const Running detection(detects_);
    btDbvtBroadphase::setAabb(proxy, low, high, dispatcher);
  }
  void calculateOverlappingPairs(btDispatcher* dispatcher) override {
    const Running detection(detects_);
    btDbvtBroadphase::calculateOverlappingPairs(dispatcher);
  }

 private:
  bool& detects_;
};

}  // namespace tetskin::bullet_detail
