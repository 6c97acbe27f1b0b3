// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/soft_body_builder.h>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <memory>
#include <vector>

#include "stress/models.h"

namespace tetskin::stress {

/// A body in the world that its force model needs, with a floor beneath it if the event needs one. Owns all of it.
class StressWorld {
 public:
  /// Throws InputError if no body can be made of the cage.
  static std::unique_ptr<StressWorld> make(const StressCase& stressCase, const StressModel& model);
  virtual ~StressWorld() = default;
  StressWorld(const StressWorld&) = delete;
  StressWorld& operator=(const StressWorld&) = delete;

  virtual btSoftBody& body() = 0;
  virtual btDiscreteDynamicsWorld& world() = 0;

  /// A box with a mass, or none: fixed.
  void addBox(const btVector3& halfExtents, const btVector3& centre, btScalar mass);
  /// One frame.
  void step(const StressCase& stressCase);

 protected:
  StressWorld() = default;
  void removeBoxes();

 private:
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> boxes_;
};

/// The stiffest neo-Hookean body of this cage for which explicit steps of these seconds are documented to be stable:
/// what `SoftBodyOptions::timeStep` bounds the default stiffness by.
double documentedStableStiffness(const TetMesh& cage, double substep);

}  // namespace tetskin::stress
