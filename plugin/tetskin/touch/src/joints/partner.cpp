// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <LinearMath/btTransformUtil.h>
#include <tetskin/touch/src/joints/partner.h>
#include <tetskin/touch/src/points/lever.h>

#include <algorithm>
#include <cmath>

namespace tetskin::touch_detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

class PointInSpace : public Partner {
 public:
  explicit PointInSpace(const btVector3& at) : at_(btMatrix3x3::getIdentity(), at) {}
  btTransform anchor() const override { return at_; }
  void moveAnchor(const btVector3& to) override { at_.setOrigin(to); }

 private:
  btTransform at_;
};

class RigidPartner : public Partner {
 public:
  RigidPartner(btRigidBody& body, const btTransform& anchor) : body_(body), local_(anchor) {}
  btCollisionObject* object() const override { return &body_; }
  btTransform anchor() const override { return body_.getWorldTransform() * local_; }
  void moveAnchor(const btVector3& local) override { local_.setOrigin(local); }

  double speed() const override {
    return static_cast<double>(
        body_.getVelocityInLocalPoint(body_.getWorldTransform().getBasis() * local_.getOrigin()).length());
  }
  void begin() override {
    moves_ = !body_.isStaticOrKinematicObject() && body_.isActive();
    start_ = anchor().getOrigin();
    arm_ = toEigen(body_.getWorldTransform().getBasis() * local_.getOrigin());
    inverseInertia_ = toMatrix(body_.getInvInertiaTensorWorld());
    for (int k = 0; k < 3; ++k) {
      inverseMass_[k] = static_cast<double>(body_.getInvMass() * body_.getLinearFactor()[k]);
      // Of both sides: symmetric, as what is solved for must be.
      inverseInertia_.row(k) *= static_cast<double>(body_.getAngularFactor()[k]);
      inverseInertia_.col(k) *= static_cast<double>(body_.getAngularFactor()[k]);
    }
  }
  Vector6 velocity() const override {
    Vector6 v = Vector6::Zero();
    if (!moves_) return v;
    const Vector3d spin = toEigen(body_.getAngularVelocity());
    v << toEigen(body_.getLinearVelocity()) + spin.cross(arm_), spin;
    return v;
  }
  Matrix6 response() const override {
    Matrix6 k = Matrix6::Zero();
    if (!moves_) return k;
    const Matrix3d arm = crossMatrix(arm_);
    k.topLeftCorner<3, 3>() = Matrix3d(inverseMass_.asDiagonal()) - arm * inverseInertia_ * arm;
    k.topRightCorner<3, 3>() = -arm * inverseInertia_;
    k.bottomLeftCorner<3, 3>() = inverseInertia_ * arm;
    k.bottomRightCorner<3, 3>() = inverseInertia_;
    return k;
  }
  /// Bullet has moved it: what the impulse changes is moved after. And the anchor to where its velocity takes it: it
  /// has gone along an arc, off the line that was solved for.
  void apply(const Vector6& push, double dt, int sharers) override {
    if (!moves_) return;
    const Vector3d along = push.head<3>(), about = push.tail<3>();
    const btVector3 faster = toBullet(inverseMass_.cwiseProduct(along));
    const btVector3 spinning = toBullet(inverseInertia_ * (arm_.cross(along) + about));
    body_.setLinearVelocity(body_.getLinearVelocity() + faster);
    body_.setAngularVelocity(body_.getAngularVelocity() + spinning);
    if (body_.getHitFraction() < 1) return;  // stopped on its way by what it would have passed through
    btTransform moved;
    btTransformUtil::integrateTransform(body_.getWorldTransform(), faster, spinning, static_cast<btScalar>(dt), moved);
    const btVector3 due = start_ + toBullet(dt * velocity().head<3>());
    moved.getOrigin() += (due - moved * local_.getOrigin()) / static_cast<btScalar>(sharers);
    body_.proceedToTransform(moved);
  }

 private:
  btRigidBody& body_;
  btTransform local_;
  btVector3 start_{0, 0, 0};
  bool moves_ = false;
  Vector3d arm_ = Vector3d::Zero();
  Vector3d inverseMass_ = Vector3d::Zero();
  Matrix3d inverseInertia_ = Matrix3d::Zero();
};

class LinkPartner : public Partner {
 public:
  LinkPartner(btMultiBodyLinkCollider& link, const btTransform& anchor)
      : link_(link), body_(*link.m_multiBody), local_(anchor) {}
  btCollisionObject* object() const override { return &link_; }
  btTransform anchor() const override { return link_.getWorldTransform() * local_; }
  void moveAnchor(const btVector3& local) override { local_.setOrigin(local); }

  const void* mass() const override { return &body_; }

  /// Of the fastest joint.
  double speed() const override {
    double most = 0;
    for (int k = 0; k < body_.getNumDofs() + 6; ++k) {
      most = std::max(most, std::abs(static_cast<double>(body_.getVelocityVector()[k])));
    }
    return most;
  }
  void begin() override {
    moves_ = body_.isAwake() && !link_.isStaticOrKinematicObject();
    if (!moves_) return;
    const btVector3 at = anchor().getOrigin();
    const int size = body_.getNumDofs() + 6;
    for (int row = 0; row < 6; ++row) {
      btVector3 along(0, 0, 0), about(0, 0, 0);
      (row < 3 ? along : about)[row % 3] = 1;
      jacobians_[row].resize(size);
      deltas_[row].resize(size);
      body_.fillConstraintJacobianMultiDof(link_.m_link, at, about, along, &jacobians_[row][0], scalars_, vectors_,
                                           matrices_);
      body_.calcAccelerationDeltasMultiDof(&jacobians_[row][0], &deltas_[row][0], scalars_, vectors_);
    }
  }
  Vector6 velocity() const override {
    Vector6 v = Vector6::Zero();
    for (int row = 0; moves_ && row < 6; ++row) v[row] = times(jacobians_[row], body_.getVelocityVector());
    return v;
  }
  Matrix6 response() const override {
    Matrix6 k = Matrix6::Zero();
    for (int i = 0; moves_ && i < 6; ++i) {
      for (int j = 0; j < 6; ++j) k(i, j) = times(jacobians_[i], &deltas_[j][0]);
    }
    return k;
  }
  void apply(const Vector6& push, double dt, int) override {
    if (!moves_) return;
    btAlignedObjectArray<btScalar> change;
    change.resize(body_.getNumDofs() + 6, 0);
    for (int row = 0; row < 6; ++row) {
      for (int k = 0; k < change.size(); ++k) change[k] += static_cast<btScalar>(push[row]) * deltas_[row][k];
    }
    body_.applyDeltaVeeMultiDof(&change[0], 1);
    body_.stepPositionsMultiDof(static_cast<btScalar>(dt), nullptr, &change[0]);
    btAlignedObjectArray<btQuaternion> turns;
    body_.forwardKinematics(turns, vectors_);
    body_.updateCollisionObjectWorldTransforms(turns, vectors_);
  }

 private:
  static double times(const btAlignedObjectArray<btScalar>& row, const btScalar* column) {
    double sum = 0;
    for (int k = 0; k < row.size(); ++k) sum += static_cast<double>(row[k]) * static_cast<double>(column[k]);
    return sum;
  }

  btMultiBodyLinkCollider& link_;
  btMultiBody& body_;
  btTransform local_;
  bool moves_ = false;
  btAlignedObjectArray<btScalar> jacobians_[6], deltas_[6], scalars_;
  btAlignedObjectArray<btVector3> vectors_;
  btAlignedObjectArray<btMatrix3x3> matrices_;
};

}  // namespace

std::unique_ptr<Partner> pointInSpace(const btVector3& at) {
  return std::make_unique<PointInSpace>(at);
}
std::unique_ptr<Partner> rigidPartner(btRigidBody& body, const btTransform& anchor) {
  return std::make_unique<RigidPartner>(body, anchor);
}
std::unique_ptr<Partner> linkPartner(btMultiBodyLinkCollider& link, const btTransform& anchor) {
  return std::make_unique<LinkPartner>(link, anchor);
}

}  // namespace tetskin::touch_detail
