// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::bullet: the force objects of one DeformableBody.
//
// Bullet keeps all force objects of a world in one list, and its `addForce` only looks at their types: a second body
// joins the first object of the type, whosever it is, with its gravity and its material. So ours are of a type of their
// own, and are put into the list past `addForce`.
#pragma once

#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/export.h>

#include <optional>
#include <utility>

namespace tetskin {

using ForceList = btAlignedObjectArray<btDeformableLagrangianForce*>;

/// None of Bullet's types; the largest number that their enumeration can hold.
constexpr auto kOwnForceType = static_cast<btDeformableLagrangianForceType>(7);

/// Puts a nameless force that does nothing, and is nobody's, in the place of `force`: its neighbours in the list stay
/// where they are, so that Bullet may be walking over it.
TETSKIN_BULLET_API void replaceByNothing(ForceList& list, const btDeformableLagrangianForce* force);

/// One that gives Bullet nothing, and joins nobody's body.
class TETSKIN_BULLET_API SilentForce : public btDeformableLagrangianForce {
 public:
  void addScaledForces(btScalar, TVStack&) override {}
  void addScaledExplicitForce(btScalar, TVStack&) override {}
  void addScaledDampingForce(btScalar, TVStack&) override {}
  void addScaledDampingForceDifferential(btScalar, const TVStack&, TVStack&) override {}
  void addScaledElasticForceDifferential(btScalar, const TVStack&, TVStack&) override {}
  void buildDampingForceDifferentialDiagonal(btScalar, TVStack&) override {}
  btDeformableLagrangianForceType getForceType() override { return kOwnForceType; }
};

inline bool isSilent(const btDeformableLagrangianForce& force) {
  return dynamic_cast<const SilentForce*>(&force) != nullptr;
}

/// Whether a force needs what Bullet keeps for each tet and updates in every step.
bool needsDeformation(btDeformableLagrangianForce& force);

/// A force of Bullet's for one body, in a list where nobody's body joins it. It leaves the list when the application
/// takes the body out of the world; otherwise its owner takes it out.
template <class Force>
class OwnForce : public Force {
 public:
  template <class... Arguments>
  explicit OwnForce(ForceList& list, Arguments&&... arguments)
      : Force(std::forward<Arguments>(arguments)...), list_(list) {}

  btDeformableLagrangianForceType getForceType() override { return kOwnForceType; }
  void removeSoftBody(btSoftBody* body) override {
    Force::removeSoftBody(body);
    if (this->m_softBodies.size() == 0) replaceByNothing(list_, this);
  }

 protected:
  ForceList& list_;
};

/// Gravity: the world's as it is in each substep, unless set.
///
/// In implicit worlds Bullet asks the list for the last force of type BT_GRAVITY_FORCE, gives all bodies that gravity
/// before it looks for contacts, and reads a variable that was never set if there is none. So this is of that type for
/// just as long as Bullet asks, stands in the list before all forces of the application, which therefore are asked
/// later, and gives its own body the difference.
class BodyGravity : public OwnForce<btDeformableGravityForce> {
 public:
  BodyGravity(btDeformableMultiBodyDynamicsWorld& world, ForceList& list);

  /// World units per second squared; nothing: the world's.
  void set(const std::optional<btVector3>& gravity) { own_ = gravity; }

  btDeformableLagrangianForceType getForceType() override;
  /// Of any body: forces are told before it leaves the world.
  void removeSoftBody(btSoftBody* body) override;
  /// Called at the beginning of each substep, and once a body has been removed.
  void reinitialize(bool nodeUpdated) override;
  void addScaledExplicitForce(btScalar scale, TVStack& force) override;
  void addScaledHessian(btScalar scale) override;
  /// Called between the solve of contacts and the integration, by one of these two.
  void addScaledForces(btScalar scale, TVStack& force) override;
  void addScaledDampingForce(btScalar scale, TVStack& force) override;

 private:
  btVector3 askedGravity() const;
  /// A body falls asleep where the step has just begun: Bullet does not solve for it then, but moves its nodes by the
  /// velocities that it has.
  void stopSleepers();

  btDeformableMultiBodyDynamicsWorld& world_;
  std::optional<btVector3> own_;
  const btSoftBody* removed_ = nullptr;  ///< until the next call of `reinitialize`
  bool beingAsked_ = false;
};

/// Adds forces for a body to the list: gravity before all others, elasticity after them.
void addToList(ForceList& list, BodyGravity& gravity, btDeformableLagrangianForce& elasticity, btSoftBody& body);
/// Takes them out again; the others keep their order.
TETSKIN_BULLET_API void removeFromList(ForceList& list, const btDeformableLagrangianForce* force);

}  // namespace tetskin
