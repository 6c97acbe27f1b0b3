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

constexpr double kMostParts = 64.0;
/// Of a body's size, by which gravity may move it in a step.
constexpr btScalar kMostFall = btScalar(0.06);

/// Parts in an impact. Where there would be less than the other number, it stays unresolved: they would be no better.
constexpr double kResolved = 9.0, kFewest = 3.6;
/// The share of its energy that damping must leave a body by estimate, which is a third of what it does leave.
constexpr double kBounces = 0.06;

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

/// A box around the nodes, and around their way beside an obstacle in the next seconds.
struct Way {
  Box now, soon;
  btVector3 velocity;  ///< of the centre of mass, beside the obstacle
  btScalar least = 0;  ///< speed from which on an impact counts

  /// True if the obstacle's box is in the way, and the two come nearer along all axes along which they are apart: what
  /// slides along the other does not.
  bool meets(const Box& obstacle) const {
    constexpr btScalar kTouching = btScalar(0.05);  // of the body's size
    if (!soon.meets(obstacle)) return false;
    const btVector3 size = now.high - now.low;
    for (int k = 0; k < 3; ++k) {
      const btScalar near = kTouching * size[size.maxAxis()];
      if (now.low[k] > obstacle.high[k] - near && !(velocity[k] < -least)) return false;
      if (now.high[k] < obstacle.low[k] + near && !(velocity[k] > least)) return false;
    }
    return true;
  }
};

Way wayOf(const btSoftBody& body, const btVector3& gravity, btScalar ahead) {
  const btScalar margin = body.getCollisionShape()->getMargin();
  Way way;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[n];
    way.now.add(node.m_x);
    way.soon.add(node.m_x);
    way.soon.add(node.m_x + ahead * node.m_v + (ahead * ahead / 2) * gravity);
  }
  way.soon.low -= btVector3(margin, margin, margin);
  way.soon.high += btVector3(margin, margin, margin);
  return way;
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
bool isInWay(const btCollisionShape& shape, const btTransform& at, const Way& way) {
  if (shape.isCompound()) {
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    for (int k = 0; k < compound.getNumChildShapes(); ++k) {
      if (isInWay(*compound.getChildShape(k), at * compound.getChildTransform(k), way)) return true;
    }
    return false;
  }
  Box box;
  if (shape.isConcave()) {
    btTransformAabb(way.soon.low, way.soon.high, 0, at.inverse(), box.low, box.high);
    TriangleInWay triangles(box, at.invXform((way.now.low + way.now.high) / 2), way.velocity * at.getBasis(),
                            way.least);
    static_cast<const btConcaveShape&>(shape).processAllTriangles(&triangles, box.low, box.high);
    return triangles.found();
  }
  shape.getAabb(at, box.low, box.high);
  return way.meets(box);
}

/// True if the other object may come into the way of a body.
bool mayHit(const btCollisionObject& other, Way way, btScalar ahead) {
  if (const btSoftBody* soft = btSoftBody::upcast(&other)) {
    way.velocity -= Cloud(*soft).velocity;
    return way.meets(wayOf(*soft, {0, 0, 0}, ahead).soon);
  }
  if (const btRigidBody* rigid = btRigidBody::upcast(&other)) {
    way.velocity -= rigid->getLinearVelocity();
    way.soon.sweep(-ahead * rigid->getLinearVelocity());
  }
  return isInWay(*other.getCollisionShape(), other.getWorldTransform(), way);
}

}  // namespace

int DeformableSolver::Impl::partsOfSteps(const btDeformableMultiBodyDynamicsWorld& world, btScalar seconds,
                                         btScalar ahead, int forImpacts) {
  if (!(seconds > 0 && seconds < BT_LARGE_FLOAT)) return 1;
  const double fall = partsForGravity(seconds), most = std::min(static_cast<double>(forImpacts), kMostParts / fall);
  return static_cast<int>(fall *
                          partsForImpacts(world, seconds / static_cast<btScalar>(fall), ahead, std::floor(most)));
}

double DeformableSolver::Impl::partsForGravity(btScalar seconds) {
  btScalar most = 1;  // squared
  for (int i = 0; i < forces().size(); ++i) {
    const btDeformableGravityForce* force = gravityForce(forces()[i]);
    const auto* own = asOwn<BodyGravity>(OwnObject::Kind::BodyGravity, forces()[i]);
    for (int b = 0; force && b < force->m_softBodies.size(); ++b) {
      const btSoftBody& body = *force->m_softBodies[b];
      const btScalar fall =
          (body.m_gravityFactor * (own ? own->next() : force->m_gravity)).length() * seconds * seconds / kMostFall;
      if (!body.isActive() || body.m_nodes.size() < 2 || !(fall < BT_LARGE_FLOAT)) continue;
      const btScalar size = sizeUpTo(body, fall);
      if (size > 0) most = std::max(most, fall / size);
    }
  }
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
    if (!body.isActive()) continue;
    const Cloud cloud(body);
    const double takes = elastic->body().dynamics->bounceSeconds(cloud.mass, cloud.radius, kBounces),
                 steps = takes / static_cast<double>(seconds), wanted = std::min(std::ceil(kResolved / steps), most);
    if (!(steps * most >= kFewest && wanted > parts)) continue;
    Way way = wayOf(body, world.getGravity(), ahead);
    way.velocity = cloud.velocity;
    way.least = 2 * world.getGravity().length() * seconds;
    const auto meets = [&](const btCollisionObject& other) {
      if (&other == &body || !mayHit(other, way, ahead)) return false;
      const btSoftBody* soft = btSoftBody::upcast(&other);
      return soft ? collidesWithSoft(body, *soft) : collidesWithRigid(body, other);
    };
    const btCollisionObjectArray& inWorld = world.getCollisionObjectArray();
    bool divides = impacts.includes(body);
    for (int k = 0; k < inWorld.size() && !divides; ++k) divides = meets(*inWorld[k]);
    if (divides) parts = wanted;
  }
  return parts;
}

}  // namespace tetskin
