// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/rows/contact_row.h>

#include <algorithm>
#include <cassert>

namespace tetskin::bullet_detail {
namespace {

btVector3 jointImpulse(const ContactRow& row, const btVector3& u, ContactRow::State& state) {
  assert(row.joined && row.highest >= 0);
  const btVector3 wanted = -row.stiffness * (row.directions * (u + row.offsetVelocity));
  const btScalar length = wanted.length();
  state = length > row.highest ? ContactRow::State::Slides : ContactRow::State::Sticks;
  return length > row.highest ? wanted * (row.highest / length) : wanted;
}

/// The derivative of a joint's impulse, which its largest force bounds as the normal force bounds friction.
btMatrix3x3 jointTangent(const ContactRow& row, const btVector3& u, ContactRow::State state, btScalar kept) {
  if (state == ContactRow::State::Sticks) return row.directions * row.stiffness;
  const btVector3 direction = row.directions * (u + row.offsetVelocity);
  const btScalar length = std::max(direction.length(), SIMD_EPSILON);
  return (row.directions - outerSquare(direction / length) * (1 - kept)) * (row.highest / length);
}

/// The velocity along the surface, including the velocity that would undo the offset within the step.
btVector3 slip(const ContactRow& row, const btVector3& u) {
  return u - row.normal.dot(u) * row.normal + row.offsetVelocity;
}

}  // namespace

btVector3 impulseAt(const ContactRow& row, const btVector3& u, bool sticks, ContactRow::State& state) {
  assert(!(row.stiffness < 0) && !(row.tangentStiffness < 0));
  using State = ContactRow::State;
  if (row.constant) {
    state = State::Apart;
    return row.impulse;
  }
  if (row.joined) return jointImpulse(row, u, state);
  const btScalar wanted = -row.stiffness * (row.normal.dot(u) + row.gapVelocity);
  const btScalar normal = std::min(std::max(wanted, row.lowest), row.highest);
  state = State::Apart;
  if (normal != wanted) return normal * row.normal;
  state = State::Sticks;
  btVector3 along = -row.tangentStiffness * slip(row, u);
  const btScalar maximum = row.friction * row.normalBound, length = along.length();
  if (length > maximum && !sticks) {
    state = State::Slides;
    along *= maximum / length;
  }
  return normal * row.normal + along;
}

btMatrix3x3 tangentAt(const ContactRow& row, const btVector3& u, ContactRow::State state, btScalar kept) {
  assert(kept >= 0 && kept <= 1);
  using State = ContactRow::State;
  const btMatrix3x3 one = btMatrix3x3::getIdentity();
  if (row.joined) return jointTangent(row, u, state, kept);
  if (state == State::Apart) return one * btScalar(0);
  const btMatrix3x3 across = one - outerSquare(row.normal);
  btMatrix3x3 along = across * row.tangentStiffness;
  if (state == State::Slides) {
    const btVector3 slipping = slip(row, u);
    const btScalar speed = std::max(slipping.length(), SIMD_EPSILON);
    along = (across - outerSquare(slipping / speed) * (1 - kept)) * (row.friction * row.normalBound / speed);
  }
  return outerSquare(row.normal) * row.stiffness + along;
}

}  // namespace tetskin::bullet_detail
