// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionDispatch/btCollisionConfiguration.h>
#include <BulletCollision/CollisionDispatch/btEmptyCollisionAlgorithm.h>
#include <BulletSoftBody/btSoftBodyConcaveCollisionAlgorithm.h>
#include <BulletSoftBody/btSoftRigidCollisionAlgorithm.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/solver/src/search/contact_algorithm.h>

#include <cassert>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <tuple>

namespace tetskin::bullet_detail {
namespace {

/// True for types of rigid objects that collide with soft bodies.
bool isRigidType(int type) {
  return btBroadphaseProxy::isConvex(type) || btBroadphaseProxy::isConcave(type) || btBroadphaseProxy::isCompound(type);
}

/// Bullet's own factory of algorithms for the pair.
btCollisionAlgorithmCreateFunc* bulletsMaker(const btCollisionDispatcher& dispatcher, int a, int b, bool closest) {
  auto& bullets = const_cast<btCollisionConfiguration&>(*dispatcher.getCollisionConfiguration());
  return closest ? bullets.getClosestPointsAlgorithmCreateFunc(a, b) : bullets.getCollisionAlgorithmCreateFunc(a, b);
}

/// Creates the algorithms for pairs in which the soft body is the first, or the second.
class Maker : public btCollisionAlgorithmCreateFunc {
 public:
  /// others  the application's registered factory, for nodes and other bodies; null: Bullet's own
  Maker(btCollisionAlgorithmCreateFunc* others, bool softIsSecond, bool closestPoints)
      : others_(others), closestPoints_(closestPoints) {
    m_swapped = softIsSecond;
  }
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* first,
                                                 const btCollisionObjectWrapper* second) override;
  std::shared_ptr<BodyContacts> contactsOf(const btSoftBody& body, const btDispatcher& dispatcher) const {
    return bullet_detail::contactsOf(body, dispatcher, others_ == nullptr);
  }
  /// The algorithm that the pair would have without this library.
  btCollisionAlgorithm* makeOther(btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* first,
                                  const btCollisionObjectWrapper* second) const;

 private:
  btCollisionAlgorithmCreateFunc* others_;
  bool closestPoints_;
};

/// The algorithm of one pair. If nothing in this library finds the body's contacts, it calls the algorithm that would
/// be there without it.
class ContactAlgorithm : public btSoftRigidCollisionAlgorithm {
 public:
  ContactAlgorithm(const Maker& maker, const btCollisionAlgorithmConstructionInfo& info,
                   const btCollisionObjectWrapper* first, const btCollisionObjectWrapper* second, bool softIsSecond)
      : btSoftRigidCollisionAlgorithm(nullptr, info, first, second, softIsSecond),
        maker_(maker),
        soft_(btSoftBody::upcast((softIsSecond ? second : first)->getCollisionObject())),
        rigid_((softIsSecond ? first : second)->getCollisionObject()),
        softIsSecond_(softIsSecond) {
    contacts_ = maker_.contactsOf(*soft_, *m_dispatcher);  // a restored snapshot may know the object
  }
  ~ContactAlgorithm() override {
    if (const auto contacts = contacts_.lock()) contacts->forget(*rigid_);
    if (!other_) return;
    other_->~btCollisionAlgorithm();
    m_dispatcher->freeCollisionAlgorithm(other_);
  }
  void processCollision(const btCollisionObjectWrapper* first, const btCollisionObjectWrapper* second,
                        const btDispatcherInfo& info, btManifoldResult* result) override {
    const std::shared_ptr<BodyContacts> contacts = maker_.contactsOf(*soft_, *m_dispatcher);
    if (contacts != contacts_.lock()) contacts_ = contacts;
    if (contacts) return contacts->collide(*(softIsSecond_ ? first : second));
    btCollisionAlgorithmConstructionInfo of(m_dispatcher, 1);
    if (!other_) other_ = maker_.makeOther(of, first, second);
    other_->processCollision(first, second, info, result);
  }

 private:
  const Maker& maker_;
  const btSoftBody* soft_;
  const btCollisionObject* rigid_;
  btCollisionAlgorithm* other_ = nullptr;
  std::weak_ptr<BodyContacts> contacts_;  ///< those that know the rigid object
  bool softIsSecond_;
};

// The pool's elements, whose size Bullet does not check, are at least as large as the largest of Bullet's own
// algorithms.
static_assert(sizeof(ContactAlgorithm) <= sizeof(btSoftBodyConcaveCollisionAlgorithm), "no room in Bullet's pool");

btCollisionAlgorithm* Maker::makeOther(btCollisionAlgorithmConstructionInfo& info,
                                       const btCollisionObjectWrapper* first,
                                       const btCollisionObjectWrapper* second) const {
  const auto& dispatcher = static_cast<const btCollisionDispatcher&>(*info.m_dispatcher1);
  const int a = first->getCollisionShape()->getShapeType(), b = second->getCollisionShape()->getShapeType();
  auto* others = others_ ? others_ : bulletsMaker(dispatcher, a, b, closestPoints_);
  assert(others);
  return others->CreateCollisionAlgorithm(info, first, second);
}

btCollisionAlgorithm* Maker::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                      const btCollisionObjectWrapper* first,
                                                      const btCollisionObjectWrapper* second) {
  assert(info.m_dispatcher1 && first && second);
  const btSoftBody* soft = btSoftBody::upcast((m_swapped ? second : first)->getCollisionObject());
  if (!soft || !bodyWithTrees(*soft)) return makeOther(info, first, second);
  if (closestPoints_) {
    if (!contactsOf(*soft, *info.m_dispatcher1)) return makeOther(info, first, second);
    // A query such as contactTest: Bullet's algorithm would add its contacts to those of the step.
    void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(btEmptyAlgorithm));
    return new (memory) btEmptyAlgorithm(info);
  }
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(ContactAlgorithm));
  return new (memory) ContactAlgorithm(*this, info, first, second, m_swapped);
}

/// All makers, by the factory that each replaces: no more than applications have registered.
class Makers {
 public:
  /// Null if `others` is itself one of them.
  Maker* standInFor(btCollisionAlgorithmCreateFunc* others, bool softIsSecond, bool closestPoints) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (own_.count(others) > 0) return nullptr;
    std::unique_ptr<Maker>& maker = makers_[{others, softIsSecond, closestPoints}];
    if (!maker) maker = std::make_unique<Maker>(others, softIsSecond, closestPoints);
    own_.insert(maker.get());
    return maker.get();
  }

 private:
  std::mutex mutex_;
  std::map<std::tuple<btCollisionAlgorithmCreateFunc*, bool, bool>, std::unique_ptr<Maker>> makers_;
  std::set<const btCollisionAlgorithmCreateFunc*> own_;
};

/// Never destroyed: dispatchers in global variables may be destroyed later than any static object of this file.
Makers& makers() {
  static auto* const all = new Makers;
  return *all;
}

/// Gives access to protected members of a base class.
struct DispatcherMembers : btCollisionDispatcher {
  static btCollisionAlgorithmCreateFunc* registered(btCollisionDispatcher& dispatcher, int a, int b, bool closest) {
    return closest ? (dispatcher.*(&DispatcherMembers::m_doubleDispatchClosestPoints))[a][b]
                   : (dispatcher.*(&DispatcherMembers::m_doubleDispatchContactPoints))[a][b];
  }
};

void registerFor(btCollisionDispatcher& dispatcher, int a, int b, bool closest) {
  btCollisionAlgorithmCreateFunc* others = DispatcherMembers::registered(dispatcher, a, b, closest);
  if (others == bulletsMaker(dispatcher, a, b, closest)) others = nullptr;
  Maker* maker = makers().standInFor(others, b == SOFTBODY_SHAPE_PROXYTYPE, closest);
  if (!maker) return;
  closest ? dispatcher.registerClosestPointsCreateFunc(a, b, maker)
          : dispatcher.registerCollisionCreateFunc(a, b, maker);
}

}  // namespace

void registerContactAlgorithms(btCollisionDispatcher& dispatcher) {
  for (int type = 0; type < MAX_BROADPHASE_COLLISION_TYPES; ++type) {
    if (!isRigidType(type)) continue;
    for (const bool closest : {false, true}) {
      registerFor(dispatcher, SOFTBODY_SHAPE_PROXYTYPE, type, closest);
      registerFor(dispatcher, type, SOFTBODY_SHAPE_PROXYTYPE, closest);
    }
  }
}

}  // namespace tetskin::bullet_detail
