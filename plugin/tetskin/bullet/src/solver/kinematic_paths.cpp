// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <LinearMath/btTransformUtil.h>
#include <tetskin/bullet/src/solver/kinematic_paths.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

/// Most steps per frame: what takes longer counts as no motion.
constexpr btScalar kMaxSteps = 64;
/// By how much the number of steps may differ from an integer: Bullet's angular velocities have few digits.
constexpr btScalar kWholeStep = btScalar(0.1);

/// Seconds in which the body's velocity takes it from one transform to the other; 0 if it does not.
btScalar timeOf(const btTransform& from, const btTransform& to, const btRigidBody& body) {
  const btVector3 moved = to.getOrigin() - from.getOrigin(), &velocity = body.getLinearVelocity();
  if (velocity.length2() > 0) return moved.dot(velocity) / velocity.length2();
  const btScalar rate = body.getAngularVelocity().length();
  if (!(rate > 0)) return 0;
  btVector3 axis;
  btScalar angle;
  btTransformUtil::calculateDiffAxisAngle(from, to, axis, angle);
  return angle / rate;
}

/// The number of steps in which the body moves from one transform to the other; 1 if it cannot be told.
int stepsOf(const btTransform& from, const btTransform& to, const btRigidBody& body, btScalar seconds) {
  const btScalar steps = timeOf(from, to, body) / seconds, whole = std::round(steps);
  const bool isWhole = std::abs(steps - whole) <= kWholeStep && whole >= 1 && whole <= kMaxSteps;
  return isWhole ? static_cast<int>(whole) : 1;
}

}  // namespace

btTransform KinematicPath::now() const {
  assert(done >= 1 && steps >= 1);
  if (done >= steps) return to;
  const btScalar fraction = static_cast<btScalar>(done) / static_cast<btScalar>(steps);
  return btTransform(from.getRotation().slerp(to.getRotation(), fraction),
                     from.getOrigin().lerp(to.getOrigin(), fraction));
}

void KinematicPaths::beginStep() {
  before_.swap(now_);
  now_.clear();
}

const KinematicPath& KinematicPaths::pathOf(const btRigidBody& body, btScalar seconds) {
  const auto [found, isNew] = now_.emplace(&body, KinematicPath());
  KinematicPath& path = found->second;
  if (!isNew) return path;
  const btTransform& to = body.getWorldTransform();
  const auto known = before_.find(&body);
  if (known == before_.end()) {
    path.from = path.to = path.before = to;
    return path;
  }
  path = known->second;
  path.isKnown = true;
  path.before = known->second.now();
  if (to == path.to) {
    path.done = std::min(path.done, path.steps) + 1;
    return path;
  }
  path.from = path.before;
  path.to = to;
  path.steps = stepsOf(path.from, to, body, seconds);
  path.done = 1;
  return path;
}

}  // namespace tetskin
