// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A body in a deformable world, with its forces: the members of a DeformableBody.
#pragma once

#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/src/base/body_forces.h>
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/solver/src/forces/elastic_force.h>

#include <cassert>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tetskin {
namespace bullet_detail {

inline Status invalid(const std::string& message) {
  return {StatusCode::InvalidOption, message};
}
/// Rejects gravity that moves bodies farther in a step than numbers of this precision can represent.
Status checkGravity(const btVector3& gravity, const btSoftBody& body);

/// In such an order that forces are destroyed before the body on which they act.
struct BodyInWorld : BodyOwner {
  BodyInWorld(btDeformableMultiBodyDynamicsWorld& ofWorld, btDeformableBodySolver& ofSolver,
              std::unique_ptr<btSoftBody> made)
      : world(&ofWorld),
        solver(&ofSolver),
        hasOwnSolver(deformableSolver(&ofSolver)),
        list(ofSolver.getLagrangianForceArray()),
        body(std::move(made)),
        gravity(ofWorld, *list, !hasOwnSolver, *this) {}

  // The world that the body is in, or was in last.
  btDeformableMultiBodyDynamicsWorld* world;
  btDeformableBodySolver* solver;
  bool hasOwnSolver;  ///< it is a DeformableSolver: the library can tell whether it still exists
  ForceList* list;
  // Collision filters that the body gets when it enters a world: at first Bullet's defaults for a soft body.
  int group = btBroadphaseProxy::DefaultFilter, mask = btBroadphaseProxy::AllFilter;
  std::unique_ptr<btSoftBody> body;
  std::vector<btScalar> masses;  ///< by node: its mass when it is not pinned
  ElasticMaterial material;
  double weightPressure = 1.0;  ///< see the function `weightPressure`
  ForceModel forceModel = ForceModel::Corotated;
  btScalar restMeasure = 0;  ///< when it was added
  BodyGravity gravity;
  std::unique_ptr<btDeformableLagrangianForce> elasticity;
  std::function<void(const ElasticMaterial&)> applyMaterial;  ///< sets the material of `elasticity`
  std::function<void()> moveElasticity;                       ///< tells `elasticity` that the world has changed

  template <class Force, class... Arguments>
  void makeElasticity(Arguments&&... arguments);
  /// Creates the force of the body's material.
  /// linear, quadratic  the body's tets, and paintedDamping: not used by Bullet's forces
  void makeElasticity(const SoftBodyOptions& options, const elastic_detail::RestTets& linear,
                      const std::vector<double>& paintedDamping, std::vector<QuadraticShape> quadratic);
  void apply(const ElasticMaterial& now) {
    assert(applyMaterial);
    material = now;
    applyMaterial(now);
    body->activate();
  }
  Status set(const ElasticMaterial& now) {
    Status status = checkMaterial(now);
    if (status.ok()) {
      const elastic_detail::MaterialChanges none, &changes = corotated() ? corotated()->body().changes : none;
      status = checkStiffness(*body, now, changes);
    }
    if (status.ok()) apply(now);
    return status;
  }
  /// Calls change(what the owner has set) of a corotated body and, if it succeeds, gives the result to the tets.
  template <class Change>
  Status changeMaterial(const char* what, Change&& change) {
    ElasticForce* elastic = corotated();
    if (!elastic) {
      return invalid(std::string(what) + " needs ForceModel::Corotated");
    }
    if (hasOwnSolver && solverLives() && isWithinStep(static_cast<const DeformableSolver&>(*solver))) {
      return invalid(std::string(what) + ": within a step; call it between two steps");
    }
    Status status = change(*elastic);
    if (status.ok()) body->activate();
    return status;
  }
  /// The same, and gives what the owner has set to the tets.
  template <class Change>
  Status changeSettings(const char* what, Change&& change) {
    return changeMaterial(what, [&](ElasticForce& elastic) {
      Status status = change(elastic.body().changes);
      if (status.ok()) elastic.applyChanges();
      return status;
    });
  }
  /// The same for settings by which the body must not become too stiff.
  template <class Change>
  Status changeStiffness(const char* what, Change&& change) {
    return changeSettings(what, [&](auto& changes) {
      return changes.tryChange(change, [&](const auto& changed) { return checkStiffness(*body, material, changed); });
    });
  }
  /// The same for the shapes at rest alone.
  template <class Change>
  Status changeShapes(const char* what, Change&& change) {
    return changeMaterial(what, [&](ElasticForce& elastic) {
      Status status = change(elastic.body().changes);
      if (status.ok()) elastic.applyShapes();
      return status;
    });
  }
  void enter();
  void moveTo(btDeformableMultiBodyDynamicsWorld& to);
  void serialize(WorldStream& stream) override;
  void leaveWithoutSolver();
  bool isInAWorld() const { return body->getBroadphaseHandle() != nullptr; }
  bool isInItsWorld() const { return isInAWorld() && body->getSoftBodySolver() == solver; }
  /// True if the forces are still in the world. Removing the body from the world removes it from its forces, and
  /// elasticity drops a body with tets that it cannot simulate.
  bool isActedOn() const {
    return isInItsWorld() && gravity.m_softBodies.size() > 0 && elasticity->m_softBodies.size() > 0;
  }
  /// Null with one of Bullet's forces.
  ElasticForce* corotated() {
    return forceModel == ForceModel::Corotated ? static_cast<ElasticForce*>(elasticity.get()) : nullptr;
  }
  /// Ok if its pressure may be set now.
  Status checkPressed(const std::string& call);
  /// Ok if the body may be put elsewhere now.
  Status checkIsPlaced(const std::string& call) const;
  /// Wakes bodies on or beside this one after it has gone.
  void wakeNeighbours();
  bool solverLives() const { return !hasOwnSolver || deformableSolver(solver); }
  Status checkNode(int node) const {
    if (node >= 0 && node < static_cast<int>(masses.size())) return {};
    return {StatusCode::IndexOutOfRange, "node " + std::to_string(node) + " does not exist in a cage of " +
                                             std::to_string(masses.size()) + " nodes"};
  }
};

}  // namespace bullet_detail

struct DeformableBody::Impl final : bullet_detail::BodyInWorld {
  using BodyInWorld::BodyInWorld;
};

}  // namespace tetskin
