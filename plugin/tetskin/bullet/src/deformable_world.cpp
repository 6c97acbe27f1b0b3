// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <tetskin/bullet/deformable_world.h>

#include <cassert>

namespace tetskin {

using namespace bullet_detail;

namespace world_detail {

/// True while Bullet detects contacts: it then goes through pairs and trees that adding or removing an object changes.
class Detection {
 public:
  explicit Detection(bool& runs) : runs_(runs), before_(runs) { runs_ = true; }
  ~Detection() { runs_ = before_; }
  Detection(const Detection&) = delete;
  Detection& operator=(const Detection&) = delete;

 private:
  bool& runs_;
  const bool before_;  ///< it may run within another one
};

class WatchedDispatcher : public btCollisionDispatcher {
 public:
  WatchedDispatcher(btCollisionConfiguration& configuration, bool& detects)
      : btCollisionDispatcher(&configuration), detects_(detects) {}
  void dispatchAllCollisionPairs(btOverlappingPairCache* pairs, const btDispatcherInfo& info,
                                 btDispatcher* dispatcher) override {
    const Detection detection(detects_);
    btCollisionDispatcher::dispatchAllCollisionPairs(pairs, info, dispatcher);
  }

 private:
  bool& detects_;
};

/// Every object that enters or leaves a world has a proxy made or destroyed here.
class WatchedBroadphase : public btDbvtBroadphase {
 public:
  explicit WatchedBroadphase(bool& detects) : detects_(detects) {}
  btBroadphaseProxy* createProxy(const btVector3& low, const btVector3& high, int type, void* object, int group,
                                 int mask, btDispatcher* dispatcher) override {
    assert(!detects_ && "nothing may be added in a filter, near or contact callback: do it in a tick callback");
    const Detection detection(detects_);
    return btDbvtBroadphase::createProxy(low, high, type, object, group, mask, dispatcher);
  }
  void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override {
    assert(!detects_ && "nothing may be removed in a filter, near or contact callback: do it in a tick callback");
    btDbvtBroadphase::destroyProxy(proxy, dispatcher);
  }
  /// Looks for new pairs, and asks the filters.
  void setAabb(btBroadphaseProxy* proxy, const btVector3& low, const btVector3& high,
               btDispatcher* dispatcher) override {
    const Detection detection(detects_);
    btDbvtBroadphase::setAabb(proxy, low, high, dispatcher);
  }
  void calculateOverlappingPairs(btDispatcher* dispatcher) override {
    const Detection detection(detects_);
    btDbvtBroadphase::calculateOverlappingPairs(dispatcher);
  }

 private:
  bool& detects_;
};

}  // namespace world_detail

struct DeformableWorldObjects::Impl {
  Impl() : dispatcher(configuration, detects), broadphase(detects) {
    constraintSolver.setDeformableSolver(&deformableSolver);
  }

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  bool detects = false;
  world_detail::WatchedDispatcher dispatcher;
  world_detail::WatchedBroadphase broadphase;
  DeformableSolver deformableSolver;
  btDeformableMultiBodyConstraintSolver constraintSolver;
};

DeformableWorldObjects::DeformableWorldObjects() : impl_(std::make_unique<Impl>()) {}
DeformableWorldObjects::~DeformableWorldObjects() = default;

DeformableWorld::DeformableWorld(const DeformableWorldOptions& options)
    : btDeformableMultiBodyDynamicsWorld(&impl_->dispatcher, &impl_->broadphase, &impl_->constraintSolver,
                                         &impl_->configuration, &impl_->deformableSolver) {
  setGravity(options.gravity);
  setUseProjection(true);
  impl_->deformableSolver.setThreads(options.threads);
  impl_->deformableSolver.setDeterministic(options.deterministic);
}

DeformableWorld::~DeformableWorld() = default;

DeformableSolver& DeformableWorld::deformableSolver() {
  return impl_->deformableSolver;
}
btDeformableMultiBodyConstraintSolver& DeformableWorld::constraintSolver() {
  return impl_->constraintSolver;
}
btDbvtBroadphase& DeformableWorld::broadphase() {
  return impl_->broadphase;
}
btCollisionDispatcher& DeformableWorld::dispatcher() {
  return impl_->dispatcher;
}

}  // namespace tetskin
