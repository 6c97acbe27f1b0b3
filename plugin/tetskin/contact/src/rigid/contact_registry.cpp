// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionDispatch/btCollisionConfiguration.h>
#include <BulletCollision/CollisionDispatch/btEmptyCollisionAlgorithm.h>
#include <BulletSoftBody/btSoftBodyConcaveCollisionAlgorithm.h>
#include <BulletSoftBody/btSoftRigidCollisionAlgorithm.h>
#include <tetskin/contact/src/rigid/contact_registry.h>

#include <cassert>
#include <memory>
#include <mutex>

namespace tetskin {
namespace {

/// Worlds of several threads may each have a dispatcher.
std::mutex& registriesMutex() {
  static std::mutex mutex;
  return mutex;
}
using Registries = std::unordered_map<const btCollisionDispatcher*, std::unique_ptr<ContactRegistry>>;
Registries& registries() {
  static Registries all;
  return all;
}

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

/// Of one pair; asks anew in each step who the soft body's contacts are. Once there are none, it is Bullet's.
class SurfaceAlgorithm : public btSoftRigidCollisionAlgorithm {
 public:
  SurfaceAlgorithm(const ContactRegistry& registry, const btCollisionAlgorithmConstructionInfo& info,
                   const btCollisionObjectWrapper* first, const btCollisionObjectWrapper* second, bool softIsSecond)
      : btSoftRigidCollisionAlgorithm(nullptr, info, first, second, softIsSecond),
        registry_(registry),
        soft_(static_cast<const btSoftBody*>((softIsSecond ? second : first)->getCollisionObject())),
        rigid_((softIsSecond ? first : second)->getCollisionObject()),
        softIsSecond_(softIsSecond) {}
  ~SurfaceAlgorithm() override {
    if (BodyContacts* contacts = registry_.find(*soft_)) contacts->forget(*rigid_);
    if (!bullets_) return;
    bullets_->~btCollisionAlgorithm();
    m_dispatcher->freeCollisionAlgorithm(bullets_);
  }
  void processCollision(const btCollisionObjectWrapper* first, const btCollisionObjectWrapper* second,
                        const btDispatcherInfo& info, btManifoldResult* result) override {
    if (BodyContacts* contacts = registry_.find(*soft_)) return contacts->collide(*(softIsSecond_ ? first : second));
    if (!bullets_) {
      btCollisionAlgorithmConstructionInfo construction(m_dispatcher, 0);
      bullets_ = makeBullets(construction, first, second, false);
    }
    bullets_->processCollision(first, second, info, result);
  }

 private:
  const ContactRegistry& registry_;
  const btSoftBody* soft_;
  const btCollisionObject* rigid_;
  btCollisionAlgorithm* bullets_ = nullptr;
  bool softIsSecond_;
};

// The pool's elements, whose size it does not check, are at least as large as the largest of Bullet's own.
static_assert(sizeof(SurfaceAlgorithm) <= sizeof(btSoftBodyConcaveCollisionAlgorithm), "no room in Bullet's pool");

}  // namespace

ContactRegistry& ContactRegistry::of(btCollisionDispatcher& dispatcher) {
  const std::lock_guard<std::mutex> lock(registriesMutex());
  std::unique_ptr<ContactRegistry>& registry = registries()[&dispatcher];
  if (!registry) registry = std::make_unique<ContactRegistry>();
  // Each time: a dispatcher that went without a word may have left its address to this one.
  registry->tell(dispatcher);
  return *registry;
}

ContactRegistry* ContactRegistry::find(const btCollisionDispatcher* dispatcher) {
  const std::lock_guard<std::mutex> lock(registriesMutex());
  const auto found = registries().find(dispatcher);
  return found == registries().end() ? nullptr : found->second.get();
}

void ContactRegistry::remove(btCollisionDispatcher& dispatcher) {
  const std::lock_guard<std::mutex> lock(registriesMutex());
  if (registries().erase(&dispatcher) == 0) return;
  btCollisionConfiguration& bullets = *dispatcher.getCollisionConfiguration();
  constexpr int kSoft = SOFTBODY_SHAPE_PROXYTYPE;
  for (int type = 0; type < MAX_BROADPHASE_COLLISION_TYPES; ++type) {
    if (!isRigidType(type)) continue;
    dispatcher.registerCollisionCreateFunc(kSoft, type, bullets.getCollisionAlgorithmCreateFunc(kSoft, type));
    dispatcher.registerCollisionCreateFunc(type, kSoft, bullets.getCollisionAlgorithmCreateFunc(type, kSoft));
    dispatcher.registerClosestPointsCreateFunc(kSoft, type, bullets.getClosestPointsAlgorithmCreateFunc(kSoft, type));
    dispatcher.registerClosestPointsCreateFunc(type, kSoft, bullets.getClosestPointsAlgorithmCreateFunc(type, kSoft));
  }
}

void ContactRegistry::tell(btCollisionDispatcher& dispatcher) {
  for (int type = 0; type < MAX_BROADPHASE_COLLISION_TYPES; ++type) {
    if (!isRigidType(type)) continue;
    dispatcher.registerCollisionCreateFunc(SOFTBODY_SHAPE_PROXYTYPE, type, &softFirst_);
    dispatcher.registerCollisionCreateFunc(type, SOFTBODY_SHAPE_PROXYTYPE, &softSecond_);
    dispatcher.registerClosestPointsCreateFunc(SOFTBODY_SHAPE_PROXYTYPE, type, &closestFirst_);
    dispatcher.registerClosestPointsCreateFunc(type, SOFTBODY_SHAPE_PROXYTYPE, &closestSecond_);
  }
}

BodyContacts* ContactRegistry::find(const btSoftBody& body) const {
  const auto found = bodies_.find(&body);
  return found == bodies_.end() || found->second.lifetime.expired() ? nullptr : found->second.contacts;
}

void ContactRegistry::add(BodyContacts& contacts, std::weak_ptr<const void> lifetime) {
  bodies_[&contacts.body()] = {&contacts, std::move(lifetime)};
}

void ContactRegistry::remove(const BodyContacts& contacts) {
  const auto found = bodies_.find(&contacts.body());
  if (found != bodies_.end() && found->second.contacts == &contacts) bodies_.erase(found);
}

ContactRegistry::Maker::Maker(const ContactRegistry& registry, bool softIsSecond, bool closestPoints)
    : registry_(registry), closestPoints_(closestPoints) {
  m_swapped = softIsSecond;
}

btCollisionAlgorithm* ContactRegistry::Maker::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                       const btCollisionObjectWrapper* first,
                                                                       const btCollisionObjectWrapper* second) {
  const auto* soft = static_cast<const btSoftBody*>((m_swapped ? second : first)->getCollisionObject());
  const bool touches = registry_.find(*soft) != nullptr;
  if (touches && closestPoints_) {
    // Of a query, as contactTest: Bullet's would add contacts to those of the step.
    void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(btEmptyAlgorithm));
    return new (memory) btEmptyAlgorithm(info);
  }
  if (touches) {
    void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(SurfaceAlgorithm));
    return new (memory) SurfaceAlgorithm(registry_, info, first, second, m_swapped);
  }
  return makeBullets(info, first, second, closestPoints_);
}

}  // namespace tetskin
