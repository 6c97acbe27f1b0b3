// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A world with one of everything that may be added to it, in touch with each other.
#pragma once

#include "touch_test.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/surface_contact.h>

#include <memory>

namespace tetskin::test {

/// A cube of half a unit in a cage of 48 tets.
struct ToyModel {
  TetMesh cage = latticeCage(2, 2, 2, 0.25);
  TriangleMesh mesh = sphere(6, 0.24, {0.25, 0.25, 0.25}, 8);
  std::shared_ptr<const SoftBodyBinding> binding = SoftBodyBinding::create(cage, mesh).value();
  std::shared_ptr<const ContactShape> shape;
  SurfaceTree tree = SurfaceTree::create(binding, mesh).value();

  ToyModel() {
    ContactShapeOptions options;
    options.gridResolution = 12;
    options.sampleCount = 100;
    shape = ContactShape::create(cage, mesh, options).value();
  }
};

inline const ToyModel& toyModel() {
  static const ToyModel made;
  return made;
}

/// A soft ball, with surface contact unless Bullet's own force acts on it.
struct Toy {
  Toy(EmptyWorld& world, const btVector3& at, ForceModel model = ForceModel::Corotated) {
    TetMesh cage = shifted(toyModel().cage, toEigen(at));
    SoftBodyOptions options;
    options.forceModel = model;
    options.youngsModulus = 3000.0;
    options.stiffnessDamping = 0.1;
    body = added(world, cage, options);
    body->body().setActivationState(DISABLE_DEACTIVATION);
    if (model == ForceModel::Corotated) touch(world);
    EXPECT_TRUE(skin.bind(body->body(), toyModel().binding).ok());
  }
  void touch(EmptyWorld& world) {
    contact.reset();
    contact = SurfaceContact::add(world.deformable(), body->body(), *toyModel().binding, toyModel().mesh, {}).value();
  }
  btSoftBody& soft() { return body->body(); }
  SurfacePoint point(int vertex) { return toyModel().tree.pointAtVertex(body->body(), vertex).value(); }

  std::unique_ptr<DeformableBody> body;
  std::unique_ptr<SurfaceContact> contact;
  SoftBodySkin skin;
};

/// A box that moves freely, as a multibody of one part.
struct FloatingBase {
  FloatingBase(EmptyWorld& ofWorld, const btVector3& at) : world(ofWorld) {
    body.setBaseWorldTransform(btTransform(btMatrix3x3::getIdentity(), at));
    body.setHasSelfCollision(false);
    body.finalizeMultiDof();
    collider.setCollisionShape(&shape);
    collider.setWorldTransform(body.getBaseWorldTransform());
    body.setBaseCollider(&collider);
    world.deformable().addCollisionObject(&collider, btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter);
    world.deformable().addMultiBody(&body);
  }
  ~FloatingBase() {
    world.deformable().removeMultiBody(&body);
    world.deformable().removeCollisionObject(&collider);
  }
  FloatingBase(const FloatingBase&) = delete;
  FloatingBase& operator=(const FloatingBase&) = delete;

  EmptyWorld& world;
  btBoxShape shape{btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1))};
  btMultiBody body{0, btScalar(0.3), btVector3(btScalar(0.002), btScalar(0.002), btScalar(0.002)), false, false};
  btMultiBodyLinkCollider collider{&body, -1};
};

/// Everything stands in a row along x, on the floor, in this order.
struct CrowdedWorld {
  explicit CrowdedWorld(ParallelFor* threads = nullptr) {
    world.bodySolver().setThreads(threads);
    addShelf();
    addRecord();
    bystander = std::make_unique<Toy>(world, at(0, 0));
    addSoftContacts();
    addLower();
    addUpper();
    addBullets();
    under = std::make_unique<Toy>(world, at(3, 0));
    addBox();
    held = std::make_unique<Toy>(world, at(4, 0.3));
    addJoints();
    carrier = std::make_unique<Toy>(world, at(5, 0));
    addBase();
  }
  static btVector3 at(int place, double height) { return {btScalar(2 * place), static_cast<btScalar>(height), 0}; }

  void addRecord() { record = ForceRecord::add(world.deformable()).value(); }
  void addShelf() { shelf = std::make_unique<RigidBox>(world, 0, at(1, -0.2), btVector3(1, btScalar(0.25), 1)); }
  std::unique_ptr<Toy> stacked(double height) {
    auto toy = std::make_unique<Toy>(world, at(1, height));
    if (contacts) {
      EXPECT_TRUE(contacts->add(toy->soft(), toyModel().shape).ok());
    }
    return toy;
  }
  void addLower() { lower = stacked(0.05); }
  void addUpper() { upper = stacked(0.55); }
  void addBullets() { bullets = std::make_unique<Toy>(world, at(2, 0), ForceModel::NeoHookean); }
  void addBox() { box = std::make_unique<RigidBox>(world, 0.3, at(3, 0.59) + btVector3(0.25, 0, 0.25)); }
  void addJoints() {
    const SurfacePoint point = held->point(0);
    hung = std::make_unique<RigidBox>(world, 0.1, *point.position() + btVector3(btScalar(0.3), btScalar(0.2), 0));
    weld = SurfaceWeld::add(world.deformable(), point, **hung).value();
    spring = SurfaceSpring::add(world.deformable(), held->point(9)).value();
  }
  void removeJoints() {
    spring.reset();
    weld.reset();
    hung.reset();
  }
  void addBase() { base = std::make_unique<FloatingBase>(world, at(5, 0.59) + btVector3(0.25, 0, 0.25)); }
  void addSoftContacts() {
    contacts = SoftContacts::add(world.deformable()).value();
    for (Toy* toy : {lower.get(), upper.get()}) {
      if (!toy) continue;
      EXPECT_TRUE(contacts->add(toy->soft(), toyModel().shape).ok());
    }
  }

  TetskinWorld world;
  std::unique_ptr<RigidBox> shelf;  ///< the support of `lower`
  std::unique_ptr<ForceRecord> record;
  std::unique_ptr<Toy> bystander, lower, upper, bullets, under, held, carrier;
  std::unique_ptr<RigidBox> box, hung;
  std::unique_ptr<FloatingBase> base;
  std::unique_ptr<SoftContacts> contacts;
  std::unique_ptr<SurfaceSpring> spring;
  std::unique_ptr<SurfaceWeld> weld;
};

}  // namespace tetskin::test
