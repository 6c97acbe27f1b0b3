// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: all that acts at points of the bodies of one world, as one force in its list. What a
// DeformableSolver calls, in a step:
//   reinitialize                              begin
//   addScaledDampingForce                     addTo
//   addScaledDampingForceDifferential         addResistance, for velocities that the solve tries
// and Bullet's world:
//   updateAction, once positions are final    finish
#pragma once

#include <LinearMath/btIDebugDraw.h>

#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <tetskin/bullet/coupling_force.h>

#include <memory>

class btDiscreteDynamicsWorld;

namespace tetskin {
class DeformableSolver;
}

namespace tetskin::touch_detail {

using VectorStack = btAlignedObjectArray<btVector3>;

/// One of them. Vectors are by node number, as Bullet has it.
class Acting {
 public:
  virtual ~Acting() = default;

  /// On which it acts; null if it is gone.
  virtual btSoftBody* body() const = 0;
  /// The body has left the world, for good.
  virtual void drop() = 0;
  /// It will not act any more.
  virtual bool spent() const = 0;
  /// What shares its mass with all others of the same: null for none.
  virtual const void* partner() const { return nullptr; }

  /// Before a step of dt seconds. sharers: of the same partner
  virtual void begin(btScalar dt, int sharers) = 0;
  /// What it does at the velocities that nodes have now: impulses.
  virtual void addTo(VectorStack& impulses) = 0;
  /// By how much less, for a change of these.
  virtual void addResistance(const VectorStack& change, VectorStack& impulses) const = 0;
  /// Positions are those after the step.
  virtual void finish() = 0;
};

class TouchForce : public CouplingForce, public btActionInterface, public std::enable_shared_from_this<TouchForce> {
 public:
  explicit TouchForce(DeformableSolver& solver) : solver_(solver) {}
  ~TouchForce() override;
  TouchForce(const TouchForce&) = delete;
  TouchForce& operator=(const TouchForce&) = delete;

  /// The one in the solver's list, or a new one.
  static std::shared_ptr<TouchForce> of(DeformableSolver& solver);
  const DeformableSolver& solver() const { return solver_; }

  /// From the next step on; in the list for as long as there is any.
  void add(std::shared_ptr<Acting> part);
  /// The world must be there. Ignores what was dropped.
  void remove(const Acting& part);
  /// To be told when positions are final.
  void watch(btDiscreteDynamicsWorld& world);

  const std::vector<std::array<btSoftBody*, 2>>& pairs() const override { return pairs_; }
  double tolerance() const override { return 5e-4; }
  void addSoftBody(btSoftBody*) override {}
  void removeSoftBody(btSoftBody* body) override;
  void reinitialize(bool nodeUpdated) override;
  void addScaledExplicitForce(btScalar, TVStack&) override {}
  void addScaledDampingForce(btScalar scale, TVStack& force) override;
  void addScaledDampingForceDifferential(btScalar scale, const TVStack& dv, TVStack& df) override;

  void updateAction(btCollisionWorld* world, btScalar dt) override;
  void debugDraw(btIDebugDraw*) override {}

 private:
  void eraseSpent();
  void beginAll(btScalar dt);
  void leave();

  DeformableSolver& solver_;
  btDiscreteDynamicsWorld* world_ = nullptr;  ///< of which it is an action
  std::vector<std::shared_ptr<Acting>> parts_;
  std::vector<std::array<btSoftBody*, 2>> pairs_;
  bool listed_ = false;
  bool removal_ = false;  ///< Bullet calls `reinitialize` next, and it is no step
};

}  // namespace tetskin::touch_detail
