// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the law of contact at one point, as impulses over velocities.
//
// With u the velocity of the point over that of what it meets, over the step, n the normal, g the gap and s the offset
// from where the point sticks:
//   normal      max(0, -D (n . u + max(g / dt, -pushingOut)))
//   tangential  -T (u - n n.u + s / dt), no more than the friction coefficient times the normal impulse
// A penalty, so stiff that what it gives way by is not seen, and no stiffer than the bodies themselves can be solved
// for: D is 20 effective masses. It is solved for implicitly, at the end of the step, until it has converged; with a
// fixed number of passes it puts energy in.
//
// This work is based on:
//   David Baraff, Andrew Witkin, "Large Steps in Cloth Simulation", SIGGRAPH 1998, doi 10.1145/280814.280821
//   Danny Kaufman, Shinjiro Sueda, Doug James, Dinesh Pai, "Staggered Projections for Frictional Contact in Multibody
//   Systems", SIGGRAPH Asia 2008, doi 10.1145/1457515.1409117 (friction bounded by the normal forces last found)
#pragma once

#include <LinearMath/btMatrix3x3.h>
#include <tetskin/bullet/src/shared/solver/row_source.h>
#include <tetskin/bullet/src/solver/rigid_unknowns.h>

namespace tetskin {

/// A point that nodes of a soft body carry, or a point of a rigid object.
struct RowEnd {
  std::size_t body = 0;         ///< in SolverBodies::bodies; of a rigid point: unused
  std::uint32_t nodeCount = 0;  ///< 0: a rigid point
  std::array<int, kMaxPointNodes> nodes{};
  std::array<btScalar, kMaxPointNodes> weights{};
  RigidPoint rigid;  ///< of a rigid point

  bool isSoft() const { return nodeCount > 0; }
};

/// Of a point against another.
struct ContactRow {
  enum class State { Apart, Sticks, Slides };

  /// The first one's impulse is the row's; the second one's is the opposite, at the same place.
  std::array<RowEnd, 2> ends;
  const btCollisionObject* object = nullptr;  ///< that the second is of

  btVector3 position;                                   ///< of both, when the step begins
  PointContact* contact = nullptr;                      ///< that it is of, if any
  std::uint32_t point = 0;                              ///< its number
  bool joined = false;                                  ///< by a penalty that pulls, too, no more than `highest`
  bool constant = false;                                ///< the impulse is what it is at the beginning: a load
  PointJoint* joint = nullptr;                          ///< that it is of, if any
  btMatrix3x3 directions = btMatrix3x3::getIdentity();  ///< of a joined one: a projection to those that are held

  btVector3 normal;
  btScalar lowest = 0,
           highest = BT_LARGE_FLOAT;  ///< of the impulse along the normal; of a joined one, in any direction
  btScalar friction = 0;
  btScalar stiffness = 0;             ///< D, in masses
  btScalar tangentStiffness = 0;      ///< T
  btScalar gapVelocity = 0;           ///< max(g / dt, -pushingOut)
  btVector3 offsetVelocity{0, 0, 0};  ///< s / dt
  btVector3 relative{0, 0, 0};        ///< u where nothing is solved for yet
  btVector3 given{0, 0, 0};           ///< impulse that velocities have already
  btScalar normalBound = 0;           ///< normal impulse by which friction is bounded
  btVector3 stickingPlace{0, 0, 0};   ///< where the point sticks, in the object's frame
  bool stuck = false;                 ///< in the step before: the first pass takes it that it does still

  btScalar effectiveMass = 0;  ///< of both sides along the normal
  btVector3 slip{0, 0, 0};     ///< u along the surface, at the velocities as they are
  btVector3 impulse{0, 0, 0};  ///< likewise
  btMatrix3x3 tangent;         ///< H, by which it falls as they grow
  State state = State::Apart;
};

/// Of an end's impulse and velocity in the row's.
constexpr int signOf(std::size_t end) {
  return end == 0 ? 1 : -1;
}

/// Where a point has stuck, or slid to, in a step.
struct Sticking {
  std::uint32_t point = 0;
  const btCollisionObject* object = nullptr;
  btVector3 normal;
  btVector3 place;           ///< in the object's frame; against a soft body: how far it is from there, world space
  btScalar normalForce = 0;  ///< of the step
  bool stuck = false;        ///< and did not slide
};

/// The impulse at a velocity over that of what it meets, and what kind it is of.
/// sticks  as if friction were not bounded
btVector3 impulseAt(const ContactRow& row, const btVector3& u, bool sticks, ContactRow::State& state);

/// By how much the impulse falls as velocities grow: the derivative, but for sliding, where it leaves out `kept` of how
/// friction turns with its direction less than it resists. With 0 kept it is the derivative, and passes cycle; with 1
/// the resistance of a speed that stays, which only ever takes energy away.
btMatrix3x3 tangentAt(const ContactRow& row, const btVector3& u, ContactRow::State state, btScalar kept);

}  // namespace tetskin
