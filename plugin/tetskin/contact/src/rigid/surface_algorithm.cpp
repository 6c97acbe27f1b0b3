// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionDispatch/btCollisionConfiguration.h>
#include <BulletCollision/CollisionDispatch/btEmptyCollisionAlgorithm.h>
#include <BulletSoftBody/btSoftBodyConcaveCollisionAlgorithm.h>
#include <BulletSoftBody/btSoftRigidCollisionAlgorithm.h>
#include <tetskin/bullet/src/shared/bodies/body_trees.h>
#include <tetskin/contact/src/rigid/surface_algorithm.h>

#include <cassert>
#include <utility>

namespace tetskin {
namespace {

/// True for types of rigid objects with whose shapes a soft body collides.
bool isRigidType(int type) {
  return btBroadphaseProxy::isConvex(type) || btBroadphaseProxy::isConcave(type) || btBroadphaseProxy::isCompound(type);
}

/// Bullet's own algorithm for the pair.
btCollisionAlgorithm* makeBullets(btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* first,
                                  const btCollisionObjectWrapper* second, bool closestPoints) {
  auto& dispatcher = static_cast<btCollisionDispatcher&>(*info.m_dispatcher1);
  btCollisionConfiguration& bullets = *dispatcher.getCollisionConfiguration();
  const int a = first->getCollisionShape()->getShapeType(), b = second->getCollisionShape()->getShapeType();
  btCollisionAlgorithmCreateFunc* maker =
      closestPoints ? bullets.getClosestPointsAlgorithmCreateFunc(a, b) : bullets.getCollisionAlgorithmCreateFunc(a, b);
  assert(maker);
  return maker->CreateCollisionAlgorithm(info, first, second);
}

/// The algorithm of one pair. When the body's contacts have been destroyed, it calls Bullet's.
class SurfaceAlgorithm : public btSoftRigidCollisionAlgorithm {
 public:
  SurfaceAlgorithm(std::weak_ptr<BodyContacts> contacts, const btCollisionAlgorithmConstructionInfo& info,
                   const btCollisionObjectWrapper* first, const btCollisionObjectWrapper* second, bool softIsSecond)
      : btSoftRigidCollisionAlgorithm(nullptr, info, first, second, softIsSecond),
        contacts_(std::move(contacts)),
        rigid_((softIsSecond ? first : second)->getCollisionObject()),
        softIsSecond_(softIsSecond) {}
  ~SurfaceAlgorithm() override {
    if (const auto contacts = contacts_.lock()) contacts->forget(*rigid_);
    if (!bullets_) return;
    bullets_->~btCollisionAlgorithm();
    m_dispatcher->freeCollisionAlgorithm(bullets_);
  }
  void processCollision(const btCollisionObjectWrapper* first, const btCollisionObjectWrapper* second,
                        const btDispatcherInfo& info, btManifoldResult* result) override {
    if (const auto contacts = contacts_.lock()) return contacts->collide(*(softIsSecond_ ? first : second));
    if (!bullets_) {
      btCollisionAlgorithmConstructionInfo construction(m_dispatcher, 0);
      bullets_ = makeBullets(construction, first, second, false);
    }
    bullets_->processCollision(first, second, info, result);
  }

 private:
  std::weak_ptr<BodyContacts> contacts_;
  const btCollisionObject* rigid_;
  btCollisionAlgorithm* bullets_ = nullptr;
  bool softIsSecond_;
};

// The elements of the pool, whose size Bullet does not check, are at least as large as the largest of Bullet's own
// algorithms.
static_assert(sizeof(SurfaceAlgorithm) <= sizeof(btSoftBodyConcaveCollisionAlgorithm), "no room in Bullet's pool");

/// Creates the algorithms for pairs in which the soft body is the first, or the second.
class Maker : public btCollisionAlgorithmCreateFunc {
 public:
  Maker(bool softIsSecond, bool closestPoints) : closestPoints_(closestPoints) { m_swapped = softIsSecond; }
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* first,
                                                 const btCollisionObjectWrapper* second) override;

 private:
  bool closestPoints_;
};

btCollisionAlgorithm* Maker::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                      const btCollisionObjectWrapper* first,
                                                      const btCollisionObjectWrapper* second) {
  assert(info.m_dispatcher1 && first && second);
  const btSoftBody* soft = btSoftBody::upcast((m_swapped ? second : first)->getCollisionObject());
  const std::shared_ptr<BodyContacts> contacts = soft ? contactsOf(*soft) : nullptr;
  if (!contacts || contacts->dispatcher() != info.m_dispatcher1)
    return makeBullets(info, first, second, closestPoints_);
  if (closestPoints_) {
    // A query such as contactTest: Bullet's algorithm would add its contacts to those of the step.
    void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(btEmptyAlgorithm));
    return new (memory) btEmptyAlgorithm(info);
  }
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(SurfaceAlgorithm));
  return new (memory) SurfaceAlgorithm(contacts, info, first, second, m_swapped);
}

struct Makers {
  Maker softFirst{false, false}, softSecond{true, false};
  Maker closestFirst{false, true}, closestSecond{true, true};
};

/// Never destroyed: dispatchers in global variables may be destroyed later than any static object of this file.
Makers& makers() {
  static auto* const all = new Makers;
  return *all;
}

}  // namespace

void registerSurfaceAlgorithms(btCollisionDispatcher& dispatcher) {
  Makers& all = makers();
  for (int type = 0; type < MAX_BROADPHASE_COLLISION_TYPES; ++type) {
    if (!isRigidType(type)) continue;
    dispatcher.registerCollisionCreateFunc(SOFTBODY_SHAPE_PROXYTYPE, type, &all.softFirst);
    dispatcher.registerCollisionCreateFunc(type, SOFTBODY_SHAPE_PROXYTYPE, &all.softSecond);
    dispatcher.registerClosestPointsCreateFunc(SOFTBODY_SHAPE_PROXYTYPE, type, &all.closestFirst);
    dispatcher.registerClosestPointsCreateFunc(type, SOFTBODY_SHAPE_PROXYTYPE, &all.closestSecond);
  }
}

std::shared_ptr<BodyContacts> contactsOf(const btSoftBody& body) {
  const BodyWithTrees* made = bodyWithTrees(body);
  return made ? std::static_pointer_cast<BodyContacts>(made->surfaceContacts().lock()) : nullptr;
}

}  // namespace tetskin
