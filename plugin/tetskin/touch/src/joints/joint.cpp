// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/touch/src/joints/joint.h>
#include <tetskin/touch/src/points/body_kind.h>
#include <tetskin/touch/src/points/point_data.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::touch_detail {

using namespace bullet_detail;

namespace {

/// The unit of a spring's frequency: one over Bullet's usual substep.
constexpr double kUnitRate = 240.0;
/// Upper bound of stiffness and damping that either precision can represent.
constexpr double kStiffest = 1e9;
/// Roundings of a position by which an anchor may differ and still count as unmoved.
constexpr btScalar kRoundings = 4;
/// Mean over all nodes that can move: the force needed to carry a body does not depend on how light the nodes at the
/// point are.
double meanNodeMass(const btSoftBody& body) {
  double sum = 0.0;
  int count = 0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    if (body.m_nodes[n].m_im == 0) continue;
    sum += 1.0 / static_cast<double>(body.m_nodes[n].m_im);
    ++count;
  }
  return count > 0 ? sum / count : 1.0;
}

}  // namespace

Joint::Joint(const SurfacePoint& point, const JointAnchor& anchor, const JointSettings& settings)
    : point_(point),
      solver_(point.body()->getSoftBodySolver()),
      anchor_(anchor),
      settings_(settings),
      nodeMass_(meanNodeMass(*point.body())),
      carried_(carriedPoint()),
      anchorBefore_(anchor_.inWorld()) {
  assert(point.status() == StatusCode::Ok);
  if (settings.turns) weld();
  btCollisionObject* other = anchor_.object;
  if (settings.collide || !other) return;
  // One entry per joint, because another joint between the two may be removed before this one.
  point_.body()->m_collisionDisabledObjects.push_back(other);
  hidden_ = true;
}

Joint::~Joint() {
  drop();
}

bool Joint::isInWorld() const {
  const btSoftBody* own = body();
  return own && own->getBroadphaseHandle() && own->getSoftBodySolver() == solver_;
}

void Joint::drop() {
  btSoftBody* solved = body();
  if (solved && hidden_) solved->m_collisionDisabledObjects.remove(anchor_.object);
  hidden_ = false;
  dropped_ = true;
}

CarriedPoint Joint::carriedPoint() const {
  CarriedPoint carried;
  const PointData& data = dataOf(point_);
  for (std::size_t c = 0; c < 3; ++c) {
    if (data.weights[c] == 0) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      const int node = data.corners[c].nodes[k];
      const auto last = carried.nodes.begin() + carried.count;
      const auto found = std::find(carried.nodes.begin(), last, node);
      if (found == last) carried.add(node, 0);
      carried.weights[static_cast<std::size_t>(found - carried.nodes.begin())] +=
          data.weights[c] * data.corners[c].weights[k];
    }
  }
  return carried;
}

/// The point, evaluated in the tet of the corner with the largest weight.
CarriedPoint Joint::pointBeside(const btVector3& at) const {
  const PointData& data = dataOf(point_);
  const auto c =
      static_cast<std::size_t>(std::max_element(data.weights.begin(), data.weights.end()) - data.weights.begin());
  const Tet& nodes = data.corners[c].nodes;
  const auto nodePosition = [&](std::size_t k) -> const btVector3& { return point_.body()->m_nodes[nodes[k]].m_x; };
  const btVector3 a = nodePosition(0) - nodePosition(3), b = nodePosition(1) - nodePosition(3),
                  d = nodePosition(2) - nodePosition(3);
  const btScalar volume = a.dot(b.cross(d));
  const btVector3 r = at - nodePosition(3);
  const btScalar x = r.dot(b.cross(d)) / volume, y = r.dot(d.cross(a)) / volume, z = r.dot(a.cross(b)) / volume;
  return {4, nodes, std::array<btScalar, 4>{x, y, z, 1 - x - y - z}};
}

/// The points beside are one tet's width away from the point; a flat tet has none.
void Joint::weld() {
  const btTransform anchor = anchor_.inWorld();
  btScalar farthest = 0;
  for (std::uint32_t k = 0; k < carried_.count; ++k) {
    farthest = std::max(farthest, (point_.body()->m_nodes[carried_.nodes[k]].m_x - anchor.getOrigin()).length());
  }
  for (int k = 0; k < 2; ++k) {
    beside_[k] = pointBeside(anchor.getOrigin() + farthest * anchor.getBasis().getColumn(k));
    for (const btScalar weight : beside_[k].weights) {
      if (!std::isfinite(weight)) return;
    }
  }
  arm_ = farthest;
}

btVector3 Joint::offset() const {
  return carried_.position(*point_.body()) - anchor_.inWorld().getOrigin();
}

btScalar Joint::turn() const {
  if (!(arm_ > 0)) return 0;
  const btVector3 point = carried_.position(*point_.body());
  const btVector3 x = (beside_[0].position(*point_.body()) - point).normalized();
  const btVector3 z = x.cross(beside_[1].position(*point_.body()) - point).normalized(), y = z.cross(x);
  const btMatrix3x3 now(x.x(), y.x(), z.x(), x.y(), y.y(), z.y(), x.z(), y.z(), z.z());
  btQuaternion turned;
  (now * anchor_.inWorld().getBasis().transpose()).getRotation(turned);
  return turned.getAngleShortestPath();
}

/// An end at rest stays at rest, and a moving end wakes the other. The solver lets the two fall asleep together.
void Joint::wake() {
  const btTransform anchor = anchor_.inWorld();
  const bool moved = !(anchor == anchorBefore_);
  anchorBefore_ = anchor;
  btCollisionObject* other = anchor_.object;
  if (!other) return;
  btSoftBody& own = *point_.body();
  if (other->isStaticOrKinematicObject()) {
    if (moved) own.activate();
    return;
  }
  if (other->isActive() && !own.isActive()) own.activate();
  const bool moves = own.isActive() && !(own.getDeactivationTime() > 0);
  if (moves && !other->isActive()) other->activate();
}

PointJoint Joint::rowOf(const CarriedPoint& point, const btVector3& anchor) const {
  assert(point_.body() && point.count > 0);
  PointJoint row;
  row.body = point_.body();
  row.at = point;
  row.object = anchor_.object;
  row.anchor = anchor;
  row.offset = point.position(*point_.body()) - anchor;
  return row;
}

void Joint::makeSpring(btScalar seconds, PointJoint& row) const {
  assert(seconds > 0 && settings_.stiffness > 0.0 && settings_.damping >= 0.0);
  const auto dt = static_cast<double>(seconds);
  const double mass = 4.0 * nodeMass_, rate = std::min(settings_.stiffness, kStiffest) * kUnitRate * kUnitRate;
  const double k = rate * mass;
  const double d = 2.0 * std::min(settings_.damping, kStiffest) * std::sqrt(k * mass);
  row.stiffness = static_cast<btScalar>(dt * (k * dt + d));
  row.offset *= static_cast<btScalar>(k * dt / (k * dt + d));
  if (std::isfinite(settings_.maxForce)) row.maximum = static_cast<btScalar>(settings_.maxForce * dt);
}

void Joint::addJoints(btScalar seconds, std::vector<PointJoint>& joints) {
  added_ = 0;
  slept_ = false;
  if (!body() || point_.status() != StatusCode::Ok) return;
  slept_ = !point_.body()->isActive();
  wake();
  const btTransform anchor = anchor_.inWorld();
  joints.push_back(rowOf(carried_, anchor.getOrigin()));
  if (!settings_.turns) makeSpring(seconds, joints.back());
  added_ = 1;
  for (int k = 0; k < 2 && arm_ > 0; ++k, ++added_) {
    const btVector3 axis = anchor.getBasis().getColumn(k);
    joints.push_back(rowOf(beside_[k], anchor.getOrigin() + arm_ * axis));
    joints.back().directions =
        k == 0 ? btMatrix3x3::getIdentity() - outerSquare(axis) : outerSquare(anchor.getBasis().getColumn(2));
  }
}

void Joint::finish(btScalar seconds, const PointJoint* joints) {
  assert(seconds > 0 && (added_ == 0 || joints));
  if (slept_) return;
  force_.setZero();
  torque_.setZero();
  for (int k = 0; k < added_; ++k) {
    force_ += joints[k].impulse / seconds;
    torque_ += (joints[k].anchor - joints[0].anchor).cross(joints[k].impulse) / seconds;
  }
  added_ = 0;
}

/// The previous anchor is rounded differently at the new place; that must not count as motion.
void Joint::shift(const btVector3& by) {
  if (!anchor_.object) anchor_.frame.getOrigin() += by;
  anchorBefore_.getOrigin() += by;
  const btTransform now = anchor_.inWorld();
  const btScalar rounding = kRoundings * SIMD_EPSILON * (by.length() + now.getOrigin().length());
  if ((now.getOrigin() - anchorBefore_.getOrigin()).length() <= rounding) anchorBefore_.setOrigin(now.getOrigin());
}

void Joint::serialize(WorldStream& stream) {
  stream(anchor_.frame, anchorBefore_, settings_.stiffness, settings_.damping, settings_.maxForce, nodeMass_, force_,
         torque_);
}

/// The nodes that carry the point, that is, where it was attached.
void Joint::checkState(WorldStream& stream) {
  const char* const kOthers = "other springs or welds";
  stream.same(settings_.turns, kOthers);
  stream.sameObject(body(), kOthers);
  stream.sameObject(anchor_.object, kOthers);
  stream.same(carried_.count, kOthers);
  for (std::uint32_t k = 0; k < carried_.count && !stream.failed(); ++k) {
    stream.same(carried_.nodes[k], kOthers);
    stream.same(carried_.weights[k], kOthers);
  }
}

}  // namespace tetskin::touch_detail
