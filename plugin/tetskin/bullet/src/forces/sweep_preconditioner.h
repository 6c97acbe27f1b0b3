// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::bullet: what an ElasticForce gives to the conjugate gradient of Bullet's own solver.
#pragma once

#include <BulletSoftBody/btDeformableBackwardEulerObjective.h>
#include <tetskin/bullet/src/forces/forced_bodies.h>

#include <vector>

namespace tetskin {

/// A symmetric Gauss-Seidel sweep of each body of the elastic forces in a world, and masses for the others. Bullet's
/// conjugate gradient does not project what this makes.
class SweepPreconditioner : public Preconditioner {
 public:
  /// Has the body swept in this step. The first elastic force of a step installs its own, the others join it: the world
  /// resets what is installed.
  void add(btDeformableBackwardEulerObjective& objective, const ForcedBody& body);

  void reinitialize(bool) override {}
  void operator()(const TVStack& x, TVStack& b) override;

 private:
  void install(btDeformableBackwardEulerObjective& objective);

  btDeformableBackwardEulerObjective* objective_ = nullptr;
  btAlignedObjectArray<btScalar> inverseMasses_;
  std::vector<const ForcedBody*> bodies_;
};

}  // namespace tetskin
