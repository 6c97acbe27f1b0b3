// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Rigid bodies that own their parts, for worlds of any kind.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace tetskin::test {

inline std::unique_ptr<btRigidBody> rigidOf(btCollisionShape& shape, btScalar mass, const btTransform& at) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape.calculateLocalInertia(mass, inertia);
  auto body = std::make_unique<btRigidBody>(mass, nullptr, &shape, inertia);
  body->setWorldTransform(at);
  body->setInterpolationWorldTransform(at);
  return body;
}
inline btTransform placeAt(const btVector3& at, const btQuaternion& turned = btQuaternion::getIdentity()) {
  return btTransform(turned, at);
}

/// A rigid body, which is in a world as long as this object lives.
struct Rigid {
  Rigid(btDynamicsWorld& in, std::unique_ptr<btCollisionShape> ofShape, btScalar mass, const btTransform& at)
      : world(in), shape(std::move(ofShape)), body(rigidOf(*shape, mass, at)) {
    world.addRigidBody(body.get());
  }
  Rigid(btDynamicsWorld& in, std::unique_ptr<btCollisionShape> ofShape, btScalar mass, const btVector3& at)
      : Rigid(in, std::move(ofShape), mass, placeAt(at)) {}
  ~Rigid() { world.removeRigidBody(body.get()); }
  Rigid(const Rigid&) = delete;
  Rigid& operator=(const Rigid&) = delete;

  btRigidBody& operator*() { return *body; }
  btRigidBody* operator->() { return body.get(); }

  btVector3 momentum() const { return body->getLinearVelocity() / body->getInvMass(); }
  /// Angular momentum about the origin.
  btVector3 spin() const {
    const btMatrix3x3& frame = body->getWorldTransform().getBasis();
    const btVector3 own = frame * (body->getLocalInertia() * (frame.transpose() * body->getAngularVelocity()));
    return own + body->getWorldTransform().getOrigin().cross(momentum());
  }
  double kineticEnergy() const {
    const btVector3 turn = body->getWorldTransform().getBasis().transpose() * body->getAngularVelocity();
    const btVector3 inertia = body->getLocalInertia();
    return 0.5 * static_cast<double>(momentum().dot(body->getLinearVelocity()) + turn.dot(inertia * turn));
  }
  double height() const { return static_cast<double>(body->getWorldTransform().getOrigin().y()); }

  btDynamicsWorld& world;
  std::unique_ptr<btCollisionShape> shape;
  std::unique_ptr<btRigidBody> body;
};

/// Any number of rigid bodies, their shapes and their joints, which are in a world as long as this object lives.
class Rigids {
 public:
  explicit Rigids(btDynamicsWorld& world) : world_(world) {}
  ~Rigids() {
    for (auto& joint : joints) world_.removeConstraint(joint.get());
    for (auto& body : bodies) world_.removeRigidBody(body.get());
  }
  Rigids(const Rigids&) = delete;
  Rigids& operator=(const Rigids&) = delete;

  template <class Shape, class... Arguments>
  Shape& shape(Arguments&&... arguments) {
    return kept<Shape>(shapes_, std::forward<Arguments>(arguments)...);
  }
  /// The body's user index is its number.
  btRigidBody& add(btCollisionShape& shape, double mass, const btVector3& at) {
    bodies.push_back(rigidOf(shape, static_cast<btScalar>(mass), placeAt(at)));
    bodies.back()->setUserIndex(static_cast<int>(bodies.size()) - 1);
    world_.addRigidBody(bodies.back().get());
    return *bodies.back();
  }
  void remove(btRigidBody& body) {
    world_.removeRigidBody(&body);
    bodies.erase(std::find_if(bodies.begin(), bodies.end(), [&](const auto& one) { return one.get() == &body; }));
  }
  template <class Joint, class... Arguments>
  Joint& join(Arguments&&... arguments) {
    Joint& made = kept<Joint>(joints, std::forward<Arguments>(arguments)...);
    world_.addConstraint(&made);
    return made;
  }

  std::vector<std::unique_ptr<btRigidBody>> bodies;
  std::vector<std::unique_ptr<btTypedConstraint>> joints;

 private:
  template <class Made, class Base, class... Arguments>
  static Made& kept(std::vector<std::unique_ptr<Base>>& in, Arguments&&... arguments) {
    auto made = std::make_unique<Made>(std::forward<Arguments>(arguments)...);
    Made& result = *made;
    in.push_back(std::move(made));
    return result;
  }

  btDynamicsWorld& world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
};

/// The visible state of a world: the bits of all nodes and transforms, and of their velocities.
inline std::vector<btScalar> seen(const btCollisionWorld& world) {
  std::vector<btScalar> numbers;
  const auto add = [&](const btVector3& v) { numbers.insert(numbers.end(), {v.x(), v.y(), v.z()}); };
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int k = 0; k < objects.size(); ++k) {
    for (int i = 0; i < 3; ++i) add(objects[k]->getWorldTransform().getBasis()[i]);
    add(objects[k]->getWorldTransform().getOrigin());
    numbers.push_back(static_cast<btScalar>(objects[k]->getActivationState()));
    if (const btRigidBody* rigid = btRigidBody::upcast(objects[k])) {
      add(rigid->getLinearVelocity());
      add(rigid->getAngularVelocity());
    }
    const btSoftBody* soft = btSoftBody::upcast(objects[k]);
    for (int n = 0; soft && n < soft->m_nodes.size(); ++n) {
      add(soft->m_nodes[n].m_x);
      add(soft->m_nodes[n].m_v);
    }
  }
  return numbers;
}

}  // namespace tetskin::test
