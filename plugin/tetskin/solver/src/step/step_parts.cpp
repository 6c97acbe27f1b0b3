// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Which steps are divided.
//
// Those in which gravity moves a soft body by more than a share of its size: contacts are searched at the position
// without them, and a body that is deeper in the ground there trembles, or falls through.
//
// Those that do not resolve an impact. An undamped body bounces as in fine steps if its impact takes some nine of them.
// Shorter impacts lose or gain up to 40 % of the rebound, so steps are divided while one goes on or is about to begin,
// by boxes around what moves: a box too many costs time, a missed one is as inexact as without. What damping or flow
// keeps from bouncing has no such steps.
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletCollision/CollisionShapes/btTriangleCallback.h>
#include <LinearMath/btAabbUtil2.h>
#include <tetskin/solver/src/base/body_forces.h>
#include <tetskin/solver/src/base/contact_filter.h>
#include <tetskin/solver/src/step/step.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

/// Of a step, for both reasons together.
constexpr double kMostParts = 64.0;
/// Of a body's size, by which gravity may move it in a step.
constexpr btScalar kMostFall = btScalar(0.06);

/// Parts in an impact. Where there would be less than the other number, it stays unresolved: they would be no better.
constexpr double kResolved = 9.0, kFewest = 3.6;
/// The share of its energy that damping must leave a body by the estimate, which is a third of what measurements show.
constexpr double kBounces = 0.06;
/// Seconds of damping in an impact's, from which on the estimate is below this share.
constexpr double kDamps = 0.28;

/// The longest side of the box around the nodes; stops early once it is at least `enough`.
btScalar sizeUpTo(const btSoftBody& body, btScalar enough) {
  assert(body.m_nodes.size() > 0);
  btVector3 low = body.m_nodes[0].m_x, high = low;
  btScalar size = 0;
  for (int n = 1; n < body.m_nodes.size() && size < enough; ++n) {
    low.setMin(body.m_nodes[n].m_x);
    high.setMax(body.m_nodes[n].m_x);
    size = (high - low)[(high - low).maxAxis()];
  }
  return size;
}

struct Box {
  btVector3 low{BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT}, high = -low;

  void add(const btVector3& point) {
    low.setMin(point);
    high.setMax(point);
  }
  /// Adds the box itself, shifted.
  void sweep(const btVector3& by) {
    btVector3 back = by, on = by;
    back.setMin(btVector3(0, 0, 0));
    on.setMax(btVector3(0, 0, 0));
    low += back;
    high += on;
  }
  bool meets(const Box& other) const { return TestAabbAgainstAabb2(low, high, other.low, other.high); }
};

/// The nodes of a body, now.
struct Cloud {
  double mass = 0.0;
  double radius = 0.0;          ///< of gyration
  btVector3 velocity{0, 0, 0};  ///< of the centre of mass

  explicit Cloud(const btSoftBody& body) {
    btVector3 centre(0, 0, 0);
    const auto each = [&](const auto& add) {
      for (int n = 0; n < body.m_nodes.size(); ++n) {
        if (body.m_nodes[n].m_im > 0) add(body.m_nodes[n], 1 / body.m_nodes[n].m_im);
      }
    };
    btScalar sum = 0, second = 0;
    each([&](const btSoftBody::Node& node, btScalar m) {
      sum += m;
      centre += m * node.m_x;
      velocity += m * node.m_v;
    });
    if (!(sum > 0)) return;
    centre /= sum;
    velocity /= sum;
    each([&](const btSoftBody::Node& node, btScalar m) { second += m * (node.m_x - centre).length2(); });
    mass = static_cast<double>(sum);
    radius = std::sqrt(static_cast<double>(second / sum));
  }
};

/// How a body moves beside an obstacle, in the world's frame.
struct Approach {
  const btSoftBody& body;
  btVector3 velocity;  ///< of the centre of mass
  btVector3 fall;      ///< by gravity
  btScalar ahead;      ///< seconds
  btScalar least;      ///< speed from which on an impact counts

  bool isFast() const { return velocity.length2() > least * least; }
};

/// Boxes around the nodes, and around their way.
struct Way {
  Box now, soon;
};

/// obstacle  velocity of what the body moves beside; `frame`, where boxes are wanted, goes along with it
Way wayOf(const btSoftBody& body, const btTransform& frame, const btVector3& obstacle, const btVector3& fall,
          btScalar ahead) {
  const btScalar margin = body.getCollisionShape()->getMargin();
  Way way;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[n];
    const btVector3 at = frame.invXform(node.m_x);
    way.now.add(at);
    way.soon.add(at);
    way.soon.add(frame.invXform(node.m_x + ahead * (node.m_v - obstacle) + fall));
  }
  way.soon.low -= btVector3(margin, margin, margin);
  way.soon.high += btVector3(margin, margin, margin);
  return way;
}

/// True if the obstacle's box is in the way, and the two come nearer along all axes along which they are apart: what
/// slides along the other does not.
bool comesNear(const Way& way, const btVector3& velocity, btScalar least, const Box& obstacle) {
  constexpr btScalar kTouching = btScalar(0.05);  // of the body's size
  if (!way.soon.meets(obstacle)) return false;
  const btVector3 size = way.now.high - way.now.low;
  for (int k = 0; k < 3; ++k) {
    const btScalar near = kTouching * size[size.maxAxis()];
    if (way.now.low[k] > obstacle.high[k] - near && !(velocity[k] < -least)) return false;
    if (way.now.high[k] < obstacle.low[k] + near && !(velocity[k] > least)) return false;
  }
  return true;
}

/// Tells whether some triangle is in the way, in its shape's frame.
class TriangleInWay : public btTriangleCallback {
 public:
  /// from  where the body is now
  TriangleInWay(const Box& box, const btVector3& from, const btVector3& velocity, btScalar least)
      : box_(box), from_(from), velocity_(velocity), least_(least) {}
  bool found() const { return found_; }

  void processTriangle(btVector3* corners, int, int) override {
    if (found_ || !TestTriangleAgainstAabb2(corners, box_.low, box_.high)) return;
    const btVector3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]),
                    half = (box_.high - box_.low) / 2;
    const bool apart = btFabs(normal.dot(box_.low + half - corners[0])) > normal.absolute().dot(half);
    const btScalar side = normal.dot(from_ - corners[0]), speed = normal.dot(velocity_);
    found_ = !apart && side * speed < 0 && btFabs(speed) > least_ * normal.length();
  }

 private:
  const Box& box_;
  const btVector3 from_, velocity_;
  btScalar least_;
  bool found_ = false;
};

/// True if some part of a shape is in the way.
/// obstacle  its velocity
bool isInWay(const btCollisionShape& shape, const btTransform& at, const btVector3& obstacle, const Approach& body) {
  if (shape.isCompound()) {
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    for (int k = 0; k < compound.getNumChildShapes(); ++k) {
      if (isInWay(*compound.getChildShape(k), at * compound.getChildTransform(k), obstacle, body)) return true;
    }
    return false;
  }
  const Way way = wayOf(body.body, at, obstacle, body.fall, body.ahead);
  const btVector3 velocity = body.velocity * at.getBasis();
  if (shape.isConcave()) {
    TriangleInWay triangles(way.soon, (way.now.low + way.now.high) / 2, velocity, body.least);
    static_cast<const btConcaveShape&>(shape).processAllTriangles(&triangles, way.soon.low, way.soon.high);
    return triangles.found();
  }
  Box box;
  shape.getAabb(btTransform::getIdentity(), box.low, box.high);
  return comesNear(way, velocity, body.least, box);
}

/// True if the body may hit the other object. Links of multibodies count as standing.
/// soon  a box around its way in the world
bool mayHit(const btCollisionObject& other, Box soon, Approach body) {
  if (const btSoftBody* soft = btSoftBody::upcast(&other)) {
    const Box box = wayOf(*soft, btTransform::getIdentity(), {0, 0, 0}, {0, 0, 0}, body.ahead).soon;
    if (!soon.meets(box)) return false;
    body.velocity -= Cloud(*soft).velocity;
    const Way way = wayOf(body.body, btTransform::getIdentity(), {0, 0, 0}, body.fall, body.ahead);
    return body.isFast() && comesNear(way, body.velocity, body.least, box);
  }
  btVector3 velocity(0, 0, 0);
  if (const btRigidBody* rigid = btRigidBody::upcast(&other)) {
    velocity = rigid->getVelocityInLocalPoint((soon.low + soon.high) / 2 - rigid->getCenterOfMassPosition());
    soon.sweep(-body.ahead * velocity);
    body.velocity -= velocity;
  }
  Box box;
  other.getCollisionShape()->getAabb(other.getWorldTransform(), box.low, box.high);
  return body.isFast() && soon.meets(box) &&
         isInWay(*other.getCollisionShape(), other.getWorldTransform(), velocity, body);
}

}  // namespace

int DeformableSolver::Impl::partsOfSteps(const btDeformableMultiBodyDynamicsWorld& world, btScalar seconds,
                                         btScalar ahead) {
  if (!(seconds > 0 && seconds < BT_LARGE_FLOAT)) return 1;
  const double fall = partsForGravity(seconds), most = std::min(static_cast<double>(impactParts), kMostParts / fall);
  // A callback may make a step within a step: the bodies are then being solved, and cannot be asked.
  if (inStep()) return static_cast<int>(fall);
  return static_cast<int>(fall *
                          partsForImpacts(world, seconds / static_cast<btScalar>(fall), ahead, std::floor(most)));
}

/// Calls a function with each force of gravity and what it adds to a body's velocity in a second, of the next step.
template <class Visit>
void DeformableSolver::Impl::eachGravity(Visit&& visit) {
  for (int i = 0; i < forces().size(); ++i) {
    const btDeformableGravityForce* force = gravityForce(forces()[i]);
    const auto* own = asOwn<BodyGravity>(OwnObject::Kind::BodyGravity, forces()[i]);
    for (int b = 0; force && b < force->m_softBodies.size(); ++b) {
      const btSoftBody& body = *force->m_softBodies[b];
      visit(body, body.m_gravityFactor * (own ? own->next() : force->m_gravity));
    }
  }
}

double DeformableSolver::Impl::partsForGravity(btScalar seconds) {
  btScalar most = 1;  // squared
  eachGravity([&](const btSoftBody& body, const btVector3& gravity) {
    const btScalar fall = gravity.length() * seconds * seconds / kMostFall;
    if (!body.isActive() || body.m_nodes.size() < 2 || !(fall < BT_LARGE_FLOAT)) return;
    const btScalar size = sizeUpTo(body, fall);
    if (size > 0) most = std::max(most, fall / size);
  });
  return std::min(std::ceil(std::sqrt(static_cast<double>(most))), kMostParts);
}

double DeformableSolver::Impl::partsForImpacts(const btDeformableMultiBodyDynamicsWorld& world, btScalar seconds,
                                               btScalar ahead, double most) {
  assert(!inStep() && seconds > 0 && ahead >= seconds && most >= 1.0);
  if (!(most > 1.0)) return 1.0;
  double parts = 1.0;
  for (int i = 0; i < forces().size(); ++i) {
    auto* elastic = dynamic_cast<ElasticForce*>(inactiveForce(forces()[i]));
    if (!elastic || elastic->body().world != &world || !elastic->body().dynamics) continue;
    const btSoftBody& body = *elastic->body().body;
    // What is damped needs no look at its nodes: an impact that it survives takes too many steps to be divided.
    if (!body.isActive() || elastic->material().damping > kDamps * kResolved * static_cast<double>(seconds)) continue;
    const Cloud cloud(body);
    const double takes = elastic->body().dynamics->bounceSeconds(cloud.mass, cloud.radius, kBounces),
                 steps = takes / static_cast<double>(seconds), wanted = std::min(std::ceil(kResolved / steps), most);
    if (!(steps * most >= kFewest && wanted > parts)) continue;
    if (impacts.includes(body) || hitsSoon(world, body, cloud.velocity, seconds, ahead)) parts = wanted;
  }
  return parts;
}

bool DeformableSolver::Impl::hitsSoon(const btDeformableMultiBodyDynamicsWorld& world, const btSoftBody& body,
                                      const btVector3& velocity, btScalar seconds, btScalar ahead) {
  btVector3 gravity(0, 0, 0);
  eachGravity([&](const btSoftBody& of, const btVector3& by) {
    if (&of == &body) gravity += by;
  });
  const btVector3 fall = (ahead * ahead / 2) * gravity;
  const Way way = wayOf(body, btTransform::getIdentity(), {0, 0, 0}, fall, ahead);
  const btVector3 size = way.now.high - way.now.low;
  const Approach approach{body, velocity, fall, ahead, leastImpact(gravity, size[size.maxAxis()], seconds)};
  const btCollisionObjectArray& inWorld = world.getCollisionObjectArray();
  for (int k = 0; k < inWorld.size(); ++k) {
    const btSoftBody* soft = btSoftBody::upcast(inWorld[k]);
    if (soft == &body || !(soft ? collidesWithSoft(body, *soft) : collidesWithRigid(body, *inWorld[k]))) continue;
    if (mayHit(*inWorld[k], way.soon, approach)) return true;
  }
  return false;
}

}  // namespace tetskin
