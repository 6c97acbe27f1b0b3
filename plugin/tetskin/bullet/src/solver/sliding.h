// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: friction of nodes that slide.
#pragma once

#include <BulletSoftBody/btDeformableContactConstraint.h>
#include <tetskin/bullet/src/solver/solver_bodies.h>

namespace tetskin {

/// Friction of one sliding contact as resistance, of the coefficient's force at the speed that it has. It only ever
/// takes energy away: forces, as Bullet's are, push nodes that hang together back to where they came from, and explode.
struct SlidingFriction {
  btScalar resistance = 0;  ///< force over velocity times the step; 0: nothing slides
  btVector3 velocity;       ///< along the surface, with which the step begins
};

/// Of an elastic body. After its velocities have been read, and before anything is added to its matrix.
SlidingFriction slidingOf(const SolvedBody& of, const btDeformableNodeRigidContactConstraint& contact);

/// (1 - n n^T) resistance
btMatrix3x3 resistanceAcross(const btVector3& normal, btScalar resistance);

}  // namespace tetskin
