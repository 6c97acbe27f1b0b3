// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: the force objects of one DeformableBody.
//
// Bullet keeps all force objects of a world in one list, and its `addForce` only looks at their types: a second body
// joins the first object of the same type, whoever owns it, with its gravity and its material. Therefore this library's
// objects have their own type, and are put into the list without `addForce`.
#pragma once

#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/src/base/own_objects.h>
#include <tetskin/export.h>

#include <optional>
#include <utility>

namespace tetskin::bullet_detail {

class WorldStream;

using ForceList = btAlignedObjectArray<btDeformableLagrangianForce*>;

/// A value different from all of Bullet's types: the largest number that their enumeration can hold.
constexpr auto kOwnForceType = static_cast<btDeformableLagrangianForceType>(7);

/// Replaces `force` in the list by an anonymous force that does nothing: the other entries keep their indices, so that
/// Bullet may be iterating over the list.
TETSKIN_SOLVER_API void replaceByNothing(ForceList& list, const btDeformableLagrangianForce* force);

/// A force that is always 0 for Bullet, and joins no other body.
class TETSKIN_SOLVER_API InactiveForce : public btDeformableLagrangianForce {
 public:
  void addScaledForces(btScalar, TVStack&) override {}
  void addScaledExplicitForce(btScalar, TVStack&) override {}
  void addScaledDampingForce(btScalar, TVStack&) override {}
  void addScaledDampingForceDifferential(btScalar, const TVStack&, TVStack&) override {}
  void addScaledElasticForceDifferential(btScalar, const TVStack&, TVStack&) override {}
  void buildDampingForceDifferentialDiagonal(btScalar, TVStack&) override {}
  btDeformableLagrangianForceType getForceType() override { return kOwnForceType; }

  /// Writes or reads, for snapshots, what the force remembers from step to step.
  virtual void serialize(WorldStream& /*stream*/) {}
  /// Writes what a snapshot relies on; when reading, refuses a world that differs.
  virtual void checkState(WorldStream& /*stream*/) {}
  /// Forgets what it remembers of a body's earlier steps: the body was moved elsewhere, or reset to its initial state.
  virtual void forget(const btSoftBody& /*body*/) {}
  /// Moves remembered positions, together with everything else in the world, which has been moved already.
  virtual void shift(const btVector3& /*by*/) {}

 private:
  OwnObject registered_{OwnObject::Kind::InactiveForce, static_cast<const btDeformableLagrangianForce*>(this)};
};

/// The force as an InactiveForce; null if it is of another class.
inline InactiveForce* inactiveForce(btDeformableLagrangianForce* force) {
  return asOwn<InactiveForce>(OwnObject::Kind::InactiveForce, force);
}
inline bool isSilent(const btDeformableLagrangianForce& force) {
  return OwnObject::is(OwnObject::Kind::InactiveForce, &force);
}

/// True if a force has left the list, and a placeholder that does nothing is in its place.
bool isPlaceholder(const btDeformableLagrangianForce* force);

/// True if a force needs the deformation gradients that Bullet updates for each tet in every step.
bool needsDeformation(btDeformableLagrangianForce& force);

/// One of Bullet's forces for one body, in a list where no other body joins it. It leaves the list when the application
/// removes the body from the world; otherwise its owner removes it.
template <class Force>
class OwnForce : public Force {
 public:
  template <class... Arguments>
  explicit OwnForce(ForceList& list, Arguments&&... arguments)
      : Force(std::forward<Arguments>(arguments)...), list_(&list) {}

  btDeformableLagrangianForceType getForceType() override { return kOwnForceType; }
  void removeSoftBody(btSoftBody* body) override {
    Force::removeSoftBody(body);
    if (this->m_softBodies.size() == 0) replaceByNothing(*list_, this);
  }
  /// Sets the list of the world that the body is about to enter.
  void setList(ForceList& list) { list_ = &list; }

 protected:
  ForceList* list_;
};

/// The owner of a body, which has created its gravity and its elasticity.
class BodyOwner {
 public:
  /// Writes or reads the owner's own data of the body, beside Bullet's state.
  virtual void serialize(WorldStream& stream) = 0;

 protected:
  ~BodyOwner() = default;
};

/// Gravity of one body: the world's in each substep, unless set.
///
/// In implicit worlds Bullet asks the list for the last force of type BT_GRAVITY_FORCE, gives all bodies that gravity
/// before it looks for contacts, and reads an uninitialised variable if there is none. Therefore this force has that
/// type only while Bullet asks. It precedes all of the application's forces in the list, so that these are asked later,
/// and gives its own body the difference.
class BodyGravity : public OwnForce<btDeformableGravityForce> {
 public:
  /// isToldOfRemovals  the solver calls `reinitialize` when a body has been removed, as Bullet's does
  BodyGravity(btDeformableMultiBodyDynamicsWorld& world, ForceList& list, bool isToldOfRemovals, BodyOwner& owner);
  /// The world that its body is about to enter; as in the constructor.
  void setWorld(btDeformableMultiBodyDynamicsWorld& world, ForceList& list, bool isToldOfRemovals);

  /// gravity  world units per second squared; empty: the world's
  void set(const std::optional<btVector3>& gravity) { own_ = gravity; }
  /// That of the next substep.
  btVector3 next() const { return own_.value_or(world_->getGravity()); }

  /// Writes or reads the gravity, and its owner's other data of the body.
  void serialize(WorldStream& stream);

  btDeformableLagrangianForceType getForceType() override;
  /// Called for any body: Bullet tells the forces before the body leaves the world.
  void removeSoftBody(btSoftBody* body) override;
  /// Called at the beginning of each substep, and by Bullet's solver when a body has been removed. Wakes the body if
  /// gravity has changed.
  void reinitialize(bool nodeUpdated) override;
  void addScaledExplicitForce(btScalar scale, TVStack& force) override;
  void addScaledHessian(btScalar scale) override;
  /// One of these two is called between the solve of contacts and the integration.
  void addScaledForces(btScalar scale, TVStack& force) override;
  void addScaledDampingForce(btScalar scale, TVStack& force) override;

 private:
  btVector3 requestedGravity() const;
  /// A body falls asleep after the step has begun: Bullet then no longer solves for it, but still moves its nodes by
  /// their velocities.
  void stopSleepers();

  OwnObject registered_{OwnObject::Kind::BodyGravity, static_cast<const btDeformableLagrangianForce*>(this)};
  btDeformableMultiBodyDynamicsWorld* world_;
  bool isToldOfRemovals_;
  std::optional<btVector3> own_;
  const btSoftBody* removed_ = nullptr;  ///< until the next call of `reinitialize`
  bool inCallback_ = false;
  BodyOwner& owner_;
};

/// Adds forces for a body to the list: gravity before all others, elasticity after them.
void addToList(ForceList& list, BodyGravity& gravity, btDeformableLagrangianForce& elasticity, btSoftBody& body);
/// Removes them from the list; the others keep their order.
TETSKIN_SOLVER_API void removeFromList(ForceList& list, const btDeformableLagrangianForce* force);

}  // namespace tetskin::bullet_detail
