// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the contact law at one point, as a function from velocities to impulses.
//
// Let u be the velocity of the point relative to the other end over the step, n the normal, g the gap, and s the offset
// from the sticking position:
//   normal      max(0, -D (n . u + max(g / dt, -pushingOut)))
//   tangential  -T (u - n n.u + s / dt), no more than the friction coefficient times the normal impulse
// A penalty so stiff that its violation is not visible, and no stiffer than the bodies themselves can be solved for: D
// is 20 effective masses, and up to 100 times that for fast motion. It is solved implicitly, at the end of the step, to
// convergence; a fixed number of passes would add energy.
//
// This work is based on:
//   David Baraff, Andrew Witkin, "Large Steps in Cloth Simulation", SIGGRAPH 1998, doi 10.1145/280814.280821
//   Danny Kaufman, Shinjiro Sueda, Doug James, Dinesh Pai, "Staggered Projections for Frictional Contact in Multibody
//   Systems", SIGGRAPH Asia 2008, doi 10.1145/1457515.1409117 (friction bounded by the normal forces last found)
#pragma once

#include <LinearMath/btMatrix3x3.h>
#include <tetskin/solver/src/base/row_source.h>
#include <tetskin/solver/src/rows/rigid_unknowns.h>

namespace tetskin::bullet_detail {

/// One end of a row: a point that nodes of a soft body carry, or a point of a rigid object.
struct RowEnd {
  /// Not an index of any body.
  static constexpr std::size_t kNoBody = ~std::size_t{0};
  std::size_t body = kNoBody;  ///< index in SolverBodies::bodies; unused for a rigid point
  RigidPoint rigid;            ///< used for a rigid point

  bool isSoft() const { return body != kNoBody; }
};

/// A row: the contact or joint between two points. Holds what each pass of the solve reads; RowOrigin has the rest.
struct ContactRow {
  enum class State { Apart, Sticks, Slides };

  // What bodies read in each pass, side by side: the row linearised in the velocity.
  btMatrix3x3 tangent;         ///< H: the negative derivative of the impulse by the velocity
  btVector3 impulse{0, 0, 0};  ///< impulse at the current velocities
  State state = State::Apart;
  bool joined = false;    ///< a joint: the penalty also pulls, with an impulse of at most `highest`
  bool constant = false;  ///< a load: the impulse keeps its initial value
  bool stuck = false;     ///< stuck in the last step, so the first pass assumes sticking

  /// The two points: the row's impulse acts on the first one, its opposite at the same position on the second one.
  std::array<RowEnd, 2> ends;

  btVector3 normal;
  /// Bounds of the impulse along the normal; of a joint, in any direction.
  btScalar lowest = 0, highest = BT_LARGE_FLOAT;
  btScalar friction = 0;
  btScalar stiffness = 0;                               ///< D, in masses
  btScalar tangentStiffness = 0;                        ///< T
  btScalar gapVelocity = 0;                             ///< max(g / dt, -pushingOut)
  btScalar normalBound = 0;                             ///< normal impulse that bounds friction
  btScalar effectiveMass = 0;                           ///< of both ends along the normal
  btVector3 offsetVelocity{0, 0, 0};                    ///< s / dt
  btVector3 relative{0, 0, 0};                          ///< u before the solve
  btVector3 given{0, 0, 0};                             ///< impulse that the velocities already include
  btVector3 slip{0, 0, 0};                              ///< u along the surface, at the current velocities
  btMatrix3x3 directions = btMatrix3x3::getIdentity();  ///< of a joint: projection to the constrained directions
};

/// Where a row comes from: what is read when the rows of a step are collected, and when their impulses are known.
struct RowOrigin {
  std::array<CarriedPoint, 2> points;         ///< of soft ends
  const btCollisionObject* object = nullptr;  ///< of the second end; null: a point in space
  btVector3 position;                         ///< of both ends, at the beginning of the step
  std::uint32_t point = 0;                    ///< number of the point within its body
  std::uint32_t sample = 0;                   ///< tells apart the places that share this number
  PointContact* contact = nullptr;            ///< the contact that the row comes from; null: another source
  PointJoint* joint = nullptr;                ///< the joint that the row comes from; null: another source
  btVector3 stickingPosition{0, 0, 0};        ///< in the object's frame
};

/// Sign of an end's impulse and velocity relative to the row's.
constexpr int signOf(std::size_t end) {
  return end == 0 ? 1 : -1;
}

/// Where a point sticks, or has slid to, at the end of a step.
struct FrictionAnchor {
  std::uint32_t point = 0, sample = 0;
  const btCollisionObject* object = nullptr;
  btVector3 normal;
  /// In the object's frame; against a soft body: its offset from the sticking position, world space.
  btVector3 position;
  btScalar normalForce = 0;  ///< of the step that stored it
  bool stuck = false;        ///< true if the point stuck in that step, false if it slid
};

/// The impulse at a relative velocity; `state` tells whether the point is separate, sticks or slides.
/// sticks  treat friction as unbounded
btVector3 impulseAt(const ContactRow& row, const btVector3& u, bool sticks, ContactRow::State& state);

/// How fast the impulse falls as velocities grow. For sticking and separate points it is the derivative. For sliding,
/// it leaves out the fraction `kept` of the part of the derivative that turns friction with the sliding direction. With
/// 0 it is the exact derivative, with which passes may cycle; with 1 it is the resistance at constant sliding speed,
/// which only ever removes energy.
btMatrix3x3 tangentAt(const ContactRow& row, const btVector3& u, ContactRow::State state, btScalar kept);

}  // namespace tetskin::bullet_detail
