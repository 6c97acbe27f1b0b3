// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <LinearMath/btTransformUtil.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/core/src/base/arithmetic/turns.h>
#include <tetskin/solver/src/search/kinematic_paths.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

namespace tetskin::bullet_detail {
namespace {

/// Most steps per frame: a longer pause counts as no motion.
constexpr int kMaxSteps = 64;
/// By how much the number of steps may differ from an integer: Bullet's angular velocities have few digits.
constexpr btScalar kWholeStep = btScalar(0.1);
/// Radians per frame. Bullet computes an angle from the cosine of its half; below this one too few digits are left,
/// and the angular velocity no longer tells how many steps the frame has.
constexpr btScalar kSeenTurn = btScalar(5e-3);

/// The sine of the angle between two rotations: unlike the cosine, it has all digits of a small angle.
btScalar sineBetween(const btTransform& from, const btTransform& to) {
  const btMatrix3x3 turn = to.getBasis() * from.getBasis().transpose();
  return btVector3(turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]).length() / 2;
}

/// The rotation vector that takes one rotation to another, of at most half a turn.
btVector3 rotationVector(const btTransform& from, const btTransform& to) {
  btQuaternion turn = to.getRotation() * from.getRotation().inverse();
  if (turn.w() < 0) turn = -turn;
  const btVector3 sine(turn.x(), turn.y(), turn.z());
  const auto length = static_cast<double>(sine.length());
  if (!(length > 0.0)) return {0, 0, 0};
  return sine * static_cast<btScalar>(2.0 * arcSine(std::min(length, 1.0)) / length);
}

btQuaternion turnedBy(const btQuaternion& rotation, const btVector3& vector) {
  const auto angle = static_cast<double>(vector.length());
  if (!(angle > 0.0)) return rotation;
  const SineAndCosine half = sineAndCosine(0.5 * angle);
  const btVector3 part = vector * static_cast<btScalar>(half.sine / angle);
  return (btQuaternion(part.x(), part.y(), part.z(), static_cast<btScalar>(half.cosine)) * rotation).normalized();
}

/// Seconds that the body takes from one transform to the other at its velocity; 0 if it does not get there.
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

/// The number of steps that the body takes from one transform to the other; 0 if unknown.
/// last  steps between the two moves before, used if turns are too small; 0: unknown
int stepsOf(const btTransform& from, const btTransform& to, const btRigidBody& body, btScalar seconds, int last) {
  const bool onlyTurns = body.getLinearVelocity().isZero() && from.getOrigin() == to.getOrigin();
  if (onlyTurns && sineBetween(from, to) < kSeenTurn) return last > 0 && last <= kMaxSteps ? last : 1;
  const btScalar steps = timeOf(from, to, body) / seconds, whole = std::round(steps);
  const bool isWhole = std::abs(steps - whole) <= kWholeStep && whole >= 1 && whole <= kMaxSteps;
  return isWhole ? static_cast<int>(whole) : 0;
}

}  // namespace

btTransform KinematicPath::now() const {
  assert(done >= 1 && steps >= 1);
  if (done >= steps) return to;
  const btScalar fraction = static_cast<btScalar>(done) / static_cast<btScalar>(steps);
  return btTransform(turnedBy(from.getRotation(), turns.at(fraction)), from.getOrigin() + moves.at(fraction));
}

void KinematicPath::leadTo(const btTransform& place, int frame, btScalar seconds) {
  assert(frame >= 0 && seconds > 0);
  if (done > steps) motion = turning = {};  // it has been at rest
  from = before;
  to = place;
  steps = std::max(frame, 1);
  done = 1;
  wasPut = frame == 0;
  if (wasPut) {
    motion = turning = {};
    return;
  }
  const btScalar duration = static_cast<btScalar>(steps) * seconds;
  moves = motion.next(to.getOrigin() - from.getOrigin(), duration);
  turns = turning.next(rotationVector(from, to), duration);
}

const KinematicPath* KinematicPaths::find(const btRigidBody& body) const {
  const auto found = paths_.find(&body);
  return found == paths_.end() ? nullptr : &found->second;
}

bool KinematicPaths::knowsStart(const btCollisionObject& object) const {
  const btRigidBody* body = object.isKinematicObject() ? btRigidBody::upcast(&object) : nullptr;
  const KinematicPath* path = body ? find(*body) : nullptr;
  return path && path->isKnown && !path->wasPut;
}

const btTransform& KinematicPaths::startOf(const btCollisionObject& object) const {
  return knowsStart(object) ? find(*btRigidBody::upcast(&object))->before : object.getWorldTransform();
}

const KinematicPath& KinematicPaths::advance(const btRigidBody& body, btScalar seconds) {
  assert(body.isKinematicObject());
  const btTransform& to = body.getWorldTransform();
  const auto [found, isNew] = paths_.emplace(&body, KinematicPath());
  KinematicPath& path = found->second;
  path.seen = step_;
  path.isKnown = !isNew;
  path.wasPut = false;
  if (isNew) {
    path.from = path.to = path.before = to;
    return path;
  }
  path.before = path.now();
  if (to == path.to) {
    if (path.done <= kMaxSteps) ++path.done;
    return path;
  }
  // The earlier motion tells nothing if the body has been at rest for long, or was moved only once.
  path.last = path.last > 0 || path.done > 1 ? path.done : 0;
  path.leadTo(to, stepsOf(path.before, to, body, seconds, path.last), seconds);
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

/// Contacts at nodes are searched at the interpolation transform.
void KinematicPaths::shift(btDiscreteDynamicsWorld& world, int index, btRigidBody& body, const btTransform& now) {
  shifted_.push_back({&world, index, &body, now, body.getInterpolationWorldTransform()});
  body.setWorldTransform(now);
  body.setInterpolationWorldTransform(now);
}

/// A body may have been removed during the step, and destroyed, or moved again.
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

void KinematicPaths::shift(const btVector3& by) {
  for (auto& [body, path] : paths_) {
    for (btTransform* at : {&path.from, &path.to, &path.before}) at->getOrigin() += by;
  }
}

void KinematicPaths::forget(const std::unordered_set<const btCollisionObject*>& gone) {
  for (auto path = paths_.begin(); path != paths_.end();) {
    path = gone.count(path->first) > 0 ? paths_.erase(path) : std::next(path);
  }
}

/// The rest of a path is set when the next step begins.
void KinematicPaths::serialize(WorldStream& stream) {
  stream.byObject(paths_, [&](const btRigidBody&, KinematicPath& path) {
    stream(path.from, path.to, path.steps, path.done, path.last);
    for (FrameCurve* curve : {&path.moves, &path.turns}) curve->serialize(stream);
    for (FrameMotion* motion : {&path.motion, &path.turning}) motion->serialize(stream);
    if (path.steps < 1 || path.done < 1) stream.fail();
    if (stream.restoring()) path.seen = step_;
  });
}

}  // namespace tetskin::bullet_detail
