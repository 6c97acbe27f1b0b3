// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <LinearMath/btQuaternion.h>
#include <tetskin/contact/src/soft/rigid_motion.h>
#include <tetskin/core/src/base/arithmetic/turns.h>

#include <algorithm>

namespace tetskin::contact_detail {

/// moment   sum of the cross products of positions before and after, relative to the centres
/// inertia  about the centre, before
void RigidMotion::turn(const btVector3& moment, const btMatrix3x3& inertia) {
  /// Smaller angles are left to the deviations: rounding is larger.
  constexpr btScalar kMinAngle = btScalar(1e-5);
  /// Fraction of the trace that is added to the inertia: nodes on a line have no inertia about it.
  constexpr btScalar kRegular = btScalar(1e-3);
  const btScalar more = kRegular * (inertia[0][0] + inertia[1][1] + inertia[2][2]);
  if (!(more > 0)) return;
  btMatrix3x3 regular = inertia;
  for (int k = 0; k < 3; ++k) regular[k][k] += more;
  const btVector3 turns = regular.inverse() * moment;  // the sine of the angle, along the axis
  const btScalar sine = turns.length();
  if (!(sine > kMinAngle)) return;
  const SineAndCosine half = sineAndCosine(0.5 * arcSine(std::min(static_cast<double>(sine), 1.0)));
  const btVector3 part = turns * (static_cast<btScalar>(half.sine) / sine);
  rotation_.setRotation(btQuaternion(part.x(), part.y(), part.z(), static_cast<btScalar>(half.cosine)));
  turns_ = true;
}

}  // namespace tetskin::contact_detail
