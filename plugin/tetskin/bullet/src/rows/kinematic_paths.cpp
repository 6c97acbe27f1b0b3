// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <LinearMath/btTransformUtil.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/bullet/src/rows/kinematic_paths.h>
#include <tetskin/core/src/base/arithmetic/turns.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

namespace tetskin::bullet_detail {
namespace {

/// Most steps per frame: what takes longer counts as no motion.
constexpr int kMaxSteps = 64;
/// By how much the number of steps may differ from an integer: Bullet's angular velocities have few digits.
constexpr btScalar kWholeStep = btScalar(0.1);
/// Radians per frame. Bullet takes an angle from the arc cosine of its half, of which too few digits are left below
/// this one: its angular velocity does not tell then how many steps the frame has.
constexpr btScalar kSeenTurn = btScalar(5e-3);

/// The sine of the angle between two rotations: unlike its cosine, it has all digits of a small angle.
btScalar sineBetween(const btTransform& from, const btTransform& to) {
  const btMatrix3x3 turn = to.getBasis() * from.getBasis().transpose();
  return btVector3(turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]).length() / 2;
}

/// Bullet's slerp returns the first rotation if the two differ by less than 7e-4 radians, in float: an arc cosine.
btQuaternion between(const btQuaternion& from, const btQuaternion& to, btScalar fraction) {
  constexpr btScalar kStraight = btScalar(0.9999);  // cosine of half the angle up to which the arc is straight
  const btScalar cosine = from.dot(to);
  const btQuaternion end = cosine < 0 ? -to : to;
  if (btFabs(cosine) >= kStraight) return (from + (end - from) * fraction).normalized();
  const double angle = 2.0 * arcSine(std::min(1.0, 0.5 * static_cast<double>((end - from).length())));
  const double part = static_cast<double>(fraction), sine = sineAndCosine(angle).sine;
  return from * static_cast<btScalar>(sineAndCosine((1.0 - part) * angle).sine / sine) +
         end * static_cast<btScalar>(sineAndCosine(part * angle).sine / sine);
}

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
/// last  steps between the two moves before, for turns that are too small; 0: not known
int stepsOf(const btTransform& from, const btTransform& to, const btRigidBody& body, btScalar seconds, int last) {
  const bool onlyTurns = body.getLinearVelocity().isZero() && from.getOrigin() == to.getOrigin();
  if (onlyTurns && sineBetween(from, to) < kSeenTurn) return last > 0 && last <= kMaxSteps ? last : 1;
  const btScalar steps = timeOf(from, to, body) / seconds, whole = std::round(steps);
  const bool isWhole = std::abs(steps - whole) <= kWholeStep && whole >= 1 && whole <= kMaxSteps;
  return isWhole ? static_cast<int>(whole) : 1;
}

}  // namespace

btTransform KinematicPath::now() const {
  assert(done >= 1 && steps >= 1);
  if (done >= steps) return to;
  const btScalar fraction = static_cast<btScalar>(done) / static_cast<btScalar>(steps);
  return btTransform(between(from.getRotation(), to.getRotation(), fraction),
                     from.getOrigin().lerp(to.getOrigin(), fraction));
}

const KinematicPath* KinematicPaths::find(const btRigidBody& body) const {
  const auto found = paths_.find(&body);
  return found == paths_.end() ? nullptr : &found->second;
}

const KinematicPath& KinematicPaths::advance(const btRigidBody& body, btScalar seconds) {
  assert(body.isKinematicObject());
  const btTransform& to = body.getWorldTransform();
  const auto [found, isNew] = paths_.emplace(&body, KinematicPath());
  KinematicPath& path = found->second;
  path.seen = step_;
  path.isKnown = !isNew;
  if (isNew) {
    path.from = path.to = path.before = to;
    return path;
  }
  path.before = path.now();
  if (to == path.to) {
    if (path.done <= kMaxSteps) ++path.done;
    return path;
  }
  // What the body did before tells nothing if it has stood for long, or has been moved once alone.
  const int last = path.last > 0 || path.done > 1 ? path.done : 0;
  path.from = path.before;
  path.to = to;
  path.steps = stepsOf(path.from, to, body, seconds, last);
  path.last = last;
  path.done = 1;
  return path;
}

void KinematicPaths::beginStep(const std::vector<btDiscreteDynamicsWorld*>& worlds, btScalar seconds) {
  assert(seconds > 0);
  endStep();
  ++step_;
  std::size_t count = 0;
  for (btDiscreteDynamicsWorld* world : worlds) {
    const btCollisionObjectArray& objects = world->getCollisionObjectArray();
    for (int k = 0; k < objects.size(); ++k) {
      if (!objects[k]->isKinematicObject()) continue;
      btRigidBody* body = btRigidBody::upcast(objects[k]);
      if (!body) continue;
      ++count;
      const btTransform now = advance(*body, seconds).now();
      if (!(now == body->getWorldTransform())) shift(*world, k, *body, now);
    }
  }
  if (paths_.size() == count) return;
  for (auto path = paths_.begin(); path != paths_.end();) {
    path = path->second.seen == step_ ? std::next(path) : paths_.erase(path);
  }
}

/// Contacts at nodes are searched for at the interpolation transform.
void KinematicPaths::shift(btDiscreteDynamicsWorld& world, int index, btRigidBody& body, const btTransform& now) {
  shifted_.push_back({&world, index, &body, now, body.getInterpolationWorldTransform()});
  body.setWorldTransform(now);
  body.setInterpolationWorldTransform(now);
}

/// A body may have been removed in the step, and destroyed, or moved again.
void KinematicPaths::endStep() {
  for (const Shifted& shifted : shifted_) {
    const btCollisionObjectArray& objects = shifted.world->getCollisionObjectArray();
    const bool isThere = shifted.index < objects.size() && objects[shifted.index] == shifted.body;
    if (!isThere && objects.findLinearSearch(shifted.body) == objects.size()) continue;
    if (!(shifted.body->getWorldTransform() == shifted.shown)) continue;
    shifted.body->setWorldTransform(paths_.at(shifted.body).to);
    shifted.body->setInterpolationWorldTransform(shifted.interpolation);
  }
  shifted_.clear();
}

/// The rest of a path is set as the next step begins.
void KinematicPaths::visitState(WorldStream& stream) {
  stream.byObject(paths_, [&](const btRigidBody&, KinematicPath& path) {
    stream(path.from);
    stream(path.to);
    stream(path.steps);
    stream(path.done);
    stream(path.last);
    if (path.steps < 1 || path.done < 1) stream.fail();
    if (stream.restoring()) path.seen = step_;
  });
}

}  // namespace tetskin::bullet_detail
