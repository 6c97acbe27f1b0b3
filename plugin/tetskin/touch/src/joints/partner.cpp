// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <tetskin/touch/src/joints/partner.h>

#include <algorithm>
#include <cmath>

namespace tetskin::touch_detail {
namespace {

class PointInSpace : public Partner {
 public:
  explicit PointInSpace(const btVector3& at) : at_(btMatrix3x3::getIdentity(), at) {}
  btTransform anchor() const override { return at_; }
  void moveAnchor(const btVector3& to) override { at_.setOrigin(to); }

 private:
  btTransform at_;
};

class RigidPartner : public Partner {
 public:
  RigidPartner(btRigidBody& body, const btTransform& anchor) : body_(body), local_(anchor) {}
  btCollisionObject* object() const override { return &body_; }
  btTransform anchor() const override { return body_.getWorldTransform() * local_; }
  void moveAnchor(const btVector3& local) override { local_.setOrigin(local); }
  btScalar speed() const override {
    return body_.getVelocityInLocalPoint(body_.getWorldTransform().getBasis() * local_.getOrigin()).length();
  }

 private:
  btRigidBody& body_;
  btTransform local_;
};

class LinkPartner : public Partner {
 public:
  LinkPartner(btMultiBodyLinkCollider& link, const btTransform& anchor) : link_(link), local_(anchor) {}
  btCollisionObject* object() const override { return &link_; }
  btTransform anchor() const override { return link_.getWorldTransform() * local_; }
  void moveAnchor(const btVector3& local) override { local_.setOrigin(local); }
  /// Of the fastest joint.
  btScalar speed() const override {
    const btMultiBody& body = *link_.m_multiBody;
    btScalar most = 0;
    for (int k = 0; k < body.getNumDofs() + 6; ++k) most = std::max(most, std::abs(body.getVelocityVector()[k]));
    return most;
  }

 private:
  btMultiBodyLinkCollider& link_;
  btTransform local_;
};

}  // namespace

std::unique_ptr<Partner> pointInSpace(const btVector3& at) {
  return std::make_unique<PointInSpace>(at);
}
std::unique_ptr<Partner> rigidPartner(btRigidBody& body, const btTransform& anchor) {
  return std::make_unique<RigidPartner>(body, anchor);
}
std::unique_ptr<Partner> linkPartner(btMultiBodyLinkCollider& link, const btTransform& anchor) {
  return std::make_unique<LinkPartner>(link, anchor);
}

}  // namespace tetskin::touch_detail
