// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletSoftBody/btSoftBodyInternals.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/src/base/exact_distance.h>
#include <tetskin/bullet/src/search/node_contacts.h>
#include <tetskin/core/src/base/mesh/triangle_geometry.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

namespace tetskin::bullet_detail {
namespace {

/// Where Bullet predicts the object to be at the end of the step.
btTransform predictedTransform(const btCollisionObjectWrapper& object) {
  const btTransform& whole = object.getCollisionObject()->getInterpolationWorldTransform();
  return object.m_preTransform ? whole * *object.m_preTransform : whole;
}

/// The box of the shape, now and as predicted, enlarged by the margin.
BvhBox<btScalar> boxOf(const btCollisionObjectWrapper& object, const btTransform& predicted, btScalar margin) {
  BvhBox<btScalar> box;
  for (const btTransform& transform : {object.getWorldTransform(), predicted}) {
    btVector3 low, high;
    object.getCollisionShape()->getAabb(transform, low, high);
    box.extend(low, high);
  }
  return box.grownBy(margin);
}

/// Bullet passes a plane as two triangles around the place where its box and the body's met first; it keeps these
/// triangles, so that a body that moves on would leave them and fall.
bool isPartOfPlane(const btCollisionObjectWrapper& object) {
  const btCollisionShape* whole = object.getCollisionObject()->getCollisionShape();
  return whole->getShapeType() == STATIC_PLANE_PROXYTYPE && object.getCollisionShape() != whole;
}

/// The contacts with an object are found one after the other.
bool hasContactsWith(const btSoftBody& body, const btCollisionObject& object) {
  const auto& contacts = body.m_nodeRigidContacts;
  return contacts.size() > 0 && contacts[contacts.size() - 1].m_cti.m_colObj == &object;
}

/// A triangle of a mesh, which Bullet passes as the hull of a prism around it. Points inside belong to its upper or
/// lower side: the others are mostly inner edges of the mesh.
class TrianglePrism {
 public:
  static std::optional<TrianglePrism> of(const btCollisionObjectWrapper& object);
  ShapeDistance distance(const btVector3& point) const;

 private:
  TriangleCorners corners_;
  Eigen::Vector3d normal_;
  double half_ = 0.0;  ///< half the thickness
};

std::optional<TrianglePrism> TrianglePrism::of(const btCollisionObjectWrapper& object) {
  const btCollisionShape& shape = *object.getCollisionShape();
  const bool isTriangle = object.m_partId >= 0;
  if (!isTriangle || shape.getShapeType() != CONVEX_HULL_SHAPE_PROXYTYPE) return {};
  const auto& hull = static_cast<const btConvexHullShape&>(shape);
  if (hull.getNumPoints() != 6) return {};
  const btVector3* points = hull.getUnscaledPoints();
  TrianglePrism prism;
  for (std::size_t k = 0; k < 3; ++k) prism.corners_[k] = toEigen((points[k] + points[k + 3]) * btScalar(0.5));
  const Eigen::Vector3d up = 0.5 * toEigen(points[0] - points[3]);
  prism.half_ = up.norm();
  if (!(prism.half_ > 0.0)) return {};
  prism.normal_ = up / prism.half_;
  return prism;
}

ShapeDistance TrianglePrism::distance(const btVector3& point) const {
  const Eigen::Vector3d p = toEigen(point);
  const double height = normal_.dot(p - corners_[0]);
  const Eigen::Vector3d level = p - height * normal_;
  const Eigen::Vector3d beside = level - closestPointOnTriangle(level, corners_).point;
  const Eigen::Vector3d up = height < 0.0 ? -normal_ : normal_;
  const double above = std::abs(height) - half_;
  const Eigen::Vector3d away = beside + std::max(above, 0.0) * up;
  const double distance = away.norm();
  const bool isBeside = beside.squaredNorm() > 1e-12 * half_ * half_;
  if (!isBeside || !(distance > 0.0)) return {static_cast<btScalar>(above), toBullet(up)};
  return {static_cast<btScalar>(distance), toBullet(Eigen::Vector3d(away / distance))};
}

/// Most steps along the path of a node; one that needs more passes by the shape at a grazing angle.
constexpr int kMaxMarches = 24;
/// Distance that counts as touching, as a fraction of the one at the beginning of the path.
constexpr btScalar kTouching = btScalar(0.01);

/// Distances of points from a shape, less the margin.
class ShapeField {
 public:
  ShapeField(btSoftBody& body, const btCollisionObjectWrapper& object)
      : exact_(ExactShape::exactShape(*object.getCollisionShape())),
        prism_(TrianglePrism::of(object)),
        sparse_(body.getWorldInfo()->m_sparsesdf),
        shape_(*object.getCollisionShape()),
        margin_(body.getCollisionShape()->getMargin()) {}

  /// point  in the shape's space
  ShapeDistance at(const btVector3& point) const {
    ShapeDistance found;
    if (exact_ || prism_) {
      found = exact_ ? exact_->distance(point) : prism_->distance(point);
      found.distance -= margin_;
    } else {
      found.distance = sparse_.Evaluate(point, &shape_, found.normal, margin_);
    }
    return found;
  }

  /// What a node meets on its straight path in the shape's space. One that slides over an edge came near to it from
  /// aside: where its path ends beside the shape, and not on the other side of it, the side there decides. Otherwise it
  /// is the side on which the path began; a node that is too near there is pushed out whatever its direction of motion,
  /// as others may press it back in the step. A path may also lead through a shape; Bullet's field, which is only known
  /// near its shape, is not followed so far.
  std::optional<ShapeDistance> firstMet(const btVector3& begin, const btVector3& end) const {
    const ShapeDistance now = at(begin);
    ShapeDistance then = at(end);
    const bool endsBeside = then.distance < 0 && then.distance > -margin_ && then.normal.dot(now.normal) > 0;
    if (endsBeside) {
      then.distance += then.normal.dot(begin - end);
      return then;
    }
    if (now.distance < 0 || then.distance < 0) return now;
    const btScalar length = (end - begin).length();
    if (!(exact_ || prism_) || now.distance > length) return std::nullopt;
    const btScalar touching = kTouching * now.distance;
    btScalar gone = 0;
    ShapeDistance here = now;
    for (int k = 0; k < kMaxMarches && gone < length; ++k) {
      const btVector3 where = begin.lerp(end, gone / length);
      here = at(where);
      if (here.distance <= touching) {
        here.distance += here.normal.dot(begin - where);
        return here;
      }
      if (here.distance > length - gone) return std::nullopt;
      gone += here.distance;
    }
    return std::nullopt;
  }

 private:
  std::optional<ExactShape> exact_;
  std::optional<TrianglePrism> prism_;
  btSparseSdf<3>& sparse_;
  const btCollisionShape& shape_;
  btScalar margin_;
};

btSoftBody::DeformableNodeRigidContact contactOf(const btSoftBody& body, btSoftBody::Node& node,
                                                 const btCollisionObjectWrapper& object, const ShapeDistance& at) {
  const btCollisionObject& whole = *object.getCollisionObject();
  btSoftBody::DeformableNodeRigidContact contact;
  contact.m_node = &node;
  contact.m_cti.m_colObj = &whole;
  contact.m_cti.m_normal = object.getWorldTransform().getBasis() * at.normal;
  contact.m_cti.m_offset = at.distance;
  contact.m_c0.setIdentity();
  contact.m_c1.setZero();
  contact.m_c2 = node.m_im;
  contact.m_c3 = body.m_cfg.kDF * whole.getFriction();
  contact.m_c4 = whole.isStaticOrKinematicObject() ? body.m_cfg.kKHR : body.m_cfg.kCHR;
  contact.m_c5 = node.m_effectiveMass_inv;
  return contact;
}

}  // namespace

void findNodeContacts(btSoftBody& body, const btCollisionObjectWrapper& object, NodePaths& paths, bool solved) {
  assert(body.getWorldInfo() && object.getCollisionShape());
  if (solved && isPartOfPlane(object)) {
    const btCollisionObject& whole = *object.getCollisionObject();
    const btCollisionObjectWrapper plane(nullptr, whole.getCollisionShape(), &whole, whole.getWorldTransform(), -1, -1);
    if (!hasContactsWith(body, whole)) findNodeContacts(body, plane, paths, solved);
    return;
  }
  const btRigidBody* rigid = btRigidBody::upcast(object.getCollisionObject());
  const btTransform predicted = predictedTransform(object);
  const btScalar margin = body.getCollisionShape()->getMargin();
  const BvhBox<btScalar> box = boxOf(object, predicted, margin);
  const std::vector<int>& near = paths.near(box);
  if (near.empty()) return;
  if (!solved) {
    btSoftColliders::CollideSDF_RD bullets;
    bullets.psb = &body;
    bullets.m_colObj1Wrap = &object;
    bullets.m_rigidBody = const_cast<btRigidBody*>(rigid);
    bullets.dynmargin = bullets.stamargin = margin;
    // Bullet's test of a node reads the node and its distance field; the boxes in its own tree have the margin, too.
    const BvhBox<btScalar> around = box.grownBy(margin);
    for (const int n : near) {
      if (paths.boxOf(n).collides(around)) bullets.DoNode(body.m_nodes[n]);
    }
    return;
  }
  const ShapeField field(body, object);
  for (const int n : near) {
    btSoftBody::Node& node = body.m_nodes[n];
    const bool held = node.m_im == 0 && (!rigid || rigid->getInvMass() == 0);
    if (node.m_battach != 0 || held) continue;
    const btVector3 begin = object.getWorldTransform().invXform(paths[n].now);
    const std::optional<ShapeDistance> met = field.firstMet(begin, predicted.invXform(paths[n].predicted));
    if (met) body.m_nodeRigidContacts.push_back(contactOf(body, node, object, *met));
  }
}

}  // namespace tetskin::bullet_detail
