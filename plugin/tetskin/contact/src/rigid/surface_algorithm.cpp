// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionDispatch/btCollisionConfiguration.h>
#include <BulletCollision/CollisionDispatch/btEmptyCollisionAlgorithm.h>
#include <BulletSoftBody/btSoftBodyConcaveCollisionAlgorithm.h>
#include <BulletSoftBody/btSoftRigidCollisionAlgorithm.h>
#include <tetskin/bullet/src/shared/bodies/body_trees.h>
#include <tetskin/contact/src/rigid/surface_algorithm.h>

#include <utility>

namespace tetskin {
namespace {

/// Those whose shapes a soft body meets.
bool isRigidType(int type) {
  return btBroadphaseProxy::isConvex(type) || btBroadphaseProxy::isConcave(type) || btBroadphaseProxy::isCompound(type);
}

/// Bullet's own for the pair.
btCollisionAlgorithm* makeBullets(btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* first,
                                  const btCollisionObjectWrapper* second, bool closestPoints) {
  auto& dispatcher = static_cast<btCollisionDispatcher&>(*info.m_dispatcher1);
  btCollisionConfiguration& bullets = *dispatcher.getCollisionConfiguration();
  const int a = first->getCollisionShape()->getShapeType(), b = second->getCollisionShape()->getShapeType();
  btCollisionAlgorithmCreateFunc* maker =
      closestPoints ? bullets.getClosestPointsAlgorithmCreateFunc(a, b) : bullets.getCollisionAlgorithmCreateFunc(a, b);
  return maker->CreateCollisionAlgorithm(info, first, second);
}

/// Of one pair. Once the body's contacts are gone, it is Bullet's.
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

// The pool's elements, whose size it does not check, are at least as large as the largest of Bullet's own.
static_assert(sizeof(SurfaceAlgorithm) <= sizeof(btSoftBodyConcaveCollisionAlgorithm), "no room in Bullet's pool");

/// Makes the algorithms for pairs of which the soft body is the first, or the second.
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
  const btSoftBody* soft = btSoftBody::upcast((m_swapped ? second : first)->getCollisionObject());
  const std::shared_ptr<BodyContacts> contacts = soft ? contactsOf(*soft) : nullptr;
  if (!contacts || contacts->dispatcher() != info.m_dispatcher1)
    return makeBullets(info, first, second, closestPoints_);
  if (closestPoints_) {
    // Of a query, as contactTest: Bullet's would add contacts to those of the step.
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

/// Not destroyed at the end of the program: dispatchers that are held by globals may go later than any static of ours.
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
