// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::bullet: the members of an ElasticForce, and what it does to its bodies itself.
#pragma once

#include <BulletSoftBody/btDeformableBodySolver.h>
#include <tetskin/bullet/src/forces/sweep_preconditioner.h>

#include <memory>
#include <vector>

namespace tetskin {

inline btDeformableBodySolver* solverOf(const btSoftBody& body) {
  return static_cast<btDeformableBodySolver*>(const_cast<btSoftBody&>(body).getSoftBodySolver());
}

struct ElasticForce::Parts {
  explicit Parts(const ElasticMaterial& ofMaterial) : material(ofMaterial) {}

  /// Null: none of this force's.
  ForcedBody* find(const btSoftBody* body) const;
  /// Calls visit(body) for those that the force acts on itself, in this step.
  template <class Visit>
  void forActive(Visit&& visit) const {
    for (const auto& of : bodies) {
      if (of->body->isActive() && !of->solved) visit(*of);
    }
  }

  void showTets();
  /// Builds anew what has changed; returns the bodies whose tets name no nodes any more.
  std::vector<btSoftBody*> rebuildChanged();
  /// Which bodies are alone, if that may have changed.
  void findAlone(bool nodeUpdated);

  /// out += factor K in
  void addStiffness(ForcedBody& of, double factor, const TVStack& in, TVStack& out) const;
  /// The same of the bodies' velocities, by the damping in use.
  void addDamping(ForcedBody& of, btScalar scale, TVStack& force) const;
  double dampingTime(const btSoftBody& body) const;
  void precondition(const ForcedBody& of);

  ElasticMaterial material;
  SolverLimits limits;
  std::vector<std::unique_ptr<ForcedBody>> bodies;
  SweepPreconditioner preconditioner;
  bool bodyRemoved = false;  ///< the next reinitialisation is not the beginning of a step
  int knownForces = -1;      ///< in the world, when `alone` was found out
};

}  // namespace tetskin
