// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: what a dispatcher is told, and whom it then finds.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <tetskin/contact/src/rigid/body_contacts.h>

#include <memory>
#include <unordered_map>

namespace tetskin {

/// The bodies of one dispatcher that have surface contact. While there is a registry, the dispatcher asks it for the
/// algorithm of each new pair of a soft and a rigid body. Pairs of other soft bodies get Bullet's.
class ContactRegistry {
 public:
  /// The dispatcher's; made, and told to it, where there is none.
  static ContactRegistry& of(btCollisionDispatcher& dispatcher);
  /// Nothing where there is none.
  static ContactRegistry* find(const btCollisionDispatcher* dispatcher);
  /// Gives the dispatcher Bullet's algorithms back.
  static void remove(btCollisionDispatcher& dispatcher);

  ContactRegistry() = default;
  ContactRegistry(const ContactRegistry&) = delete;
  ContactRegistry& operator=(const ContactRegistry&) = delete;

  /// Null where the body has none.
  BodyContacts* find(const btSoftBody& body) const;
  /// lifetime  the body's: another one may have its address afterwards
  void add(BodyContacts& contacts, std::weak_ptr<const void> lifetime);
  void remove(const BodyContacts& contacts);

 private:
  /// Makes the algorithms for pairs of which the soft body is the first, or the second.
  class Maker : public btCollisionAlgorithmCreateFunc {
   public:
    Maker(const ContactRegistry& registry, bool softIsSecond, bool closestPoints);
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* first,
                                                   const btCollisionObjectWrapper* second) override;

   private:
    const ContactRegistry& registry_;
    bool closestPoints_;
  };
  void tell(btCollisionDispatcher& dispatcher);

  struct Entry {
    BodyContacts* contacts = nullptr;
    std::weak_ptr<const void> lifetime;
  };
  std::unordered_map<const btSoftBody*, Entry> bodies_;
  Maker softFirst_{*this, false, false}, softSecond_{*this, true, false};
  Maker closestFirst_{*this, false, true}, closestSecond_{*this, true, true};
};

}  // namespace tetskin
