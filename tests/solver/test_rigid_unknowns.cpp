// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <tetskin/solver/src/rows/rigid_unknowns.h>

#include <cstdlib>

#include "deformable_test.h"
#include "support/allocation_count.h"

namespace tetskin {

using namespace bullet_detail;

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr btScalar kSeconds = btScalar(1) / 240;

const btVector3 kHalf(btScalar(0.3), btScalar(0.1), btScalar(0.2));
const btVector3 kImpulse(btScalar(0.3), btScalar(-0.5), btScalar(0.2));

Vector3d eigen(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

/// A box of 2 kg that moves and turns.
struct Box {
  explicit Box(btScalar mass = 2) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    body = std::make_unique<btRigidBody>(mass, nullptr, &shape, inertia);
    moveTo(btTransform(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)), btVector3(1, 2, 3)));
    body->setLinearVelocity(btVector3(btScalar(0.3), -1, btScalar(0.5)));
    body->setAngularVelocity(btVector3(2, -3, 1));
  }
  void moveTo(const btTransform& position) {
    body->setWorldTransform(position);
    body->setInterpolationWorldTransform(position);
    body->updateInertiaTensor();
  }
  btVector3 corner() const { return body->getWorldTransform() * kHalf; }
  btVector3 arm() const { return corner() - body->getWorldTransform().getOrigin(); }

  btBoxShape shape{kHalf};
  std::unique_ptr<btRigidBody> body;
};

/// A free base and two links on hinges, already stepped by a world, because masses are asked for after Bullet's own
/// solve.
struct Chain {
  Chain() {
    world.deformable().setGravity(btVector3(0, 0, 0));
    const btVector3 inertia(btScalar(0.1), btScalar(0.2), btScalar(0.3));
    body = std::make_unique<btMultiBody>(2, btScalar(1.5), inertia, false, false);
    body->setBasePos(btVector3(0, 5, 0));
    const btQuaternion turn(btVector3(0, 1, 0), btScalar(0.4));
    for (int link = 0; link < 2; ++link) {
      const btVector3 axis = link == 0 ? btVector3(0, 0, 1) : btVector3(1, 0, 0);
      body->setupRevolute(link, 1 - btScalar(0.5) * link, inertia, link - 1, turn, axis, btVector3(btScalar(0.5), 0, 0),
                          btVector3(btScalar(0.4), 0, 0), true);
    }
    body->finalizeMultiDof();
    body->setLinearDamping(0);
    body->setAngularDamping(0);
    world.deformable().addMultiBody(body.get());
    for (int link = -1; link < 2; ++link) {
      auto& collider = colliders[static_cast<std::size_t>(link + 1)];
      collider = std::make_unique<btMultiBodyLinkCollider>(body.get(), link);
      collider->setCollisionShape(&shape);
      world.deformable().addCollisionObject(collider.get(), 2, 0);
      (link < 0 ? body->setBaseCollider(collider.get()) : void(body->getLink(link).m_collider = collider.get()));
    }
    body->setBaseVel(btVector3(btScalar(0.2), 0, btScalar(0.1)));
    body->setBaseOmega(btVector3(1, btScalar(0.5), -1));
    body->setJointVel(0, 2);
    body->setJointVel(1, -1);
    world.deformable().stepSimulation(kSeconds, 1, kSeconds);
  }
  ~Chain() {
    for (auto& collider : colliders) world.deformable().removeCollisionObject(collider.get());
    world.deformable().removeMultiBody(body.get());
  }
  Chain(const Chain&) = delete;
  Chain& operator=(const Chain&) = delete;
  btMultiBodyLinkCollider& last() { return *colliders[2]; }
  btVector3 corner() const { return colliders[2]->getWorldTransform() * btVector3(btScalar(0.1), btScalar(0.2), 0); }

  test::TetskinWorld world;
  btSphereShape shape{btScalar(0.1)};
  std::unique_ptr<btMultiBody> body;
  std::array<std::unique_ptr<btMultiBodyLinkCollider>, 3> colliders;
};

/// Assigns each unknown its position in a vector, and returns the vector's size.
Eigen::Index number(RigidUnknowns& rigids) {
  Eigen::Index size = 0;
  for (RigidUnknown& unknown : rigids.list()) {
    unknown.first = size;
    size += unknown.size;
  }
  return size;
}

/// Some numbers that are all different.
VectorXd wave(Eigen::Index size) {
  VectorXd v(size);
  for (Eigen::Index k = 0; k < size; ++k) v[k] = std::sin(1.0 + 2.3 * static_cast<double>(k));
  return v;
}

void expectTransposes(const RigidUnknowns& rigids, const RigidPoint& point, Eigen::Index size) {
  const VectorXd change = wave(size);
  VectorXd push = VectorXd::Zero(size);
  rigids.addImpulse(point, kImpulse, push);
  const double power = eigen(kImpulse).dot(eigen(rigids.velocity(point, change)));
  EXPECT_NEAR(push.dot(change), power, 1e-6 * push.norm() * change.norm());
  EXPECT_GT(push.norm(), 0.1);
}

TEST(RigidUnknowns, OfOneBodyAreOneHoweverManyPointsItIsMetAt) {
  Box box, other;
  Chain chain;
  RigidUnknowns rigids;
  EXPECT_EQ(rigids.find(*box.body), -1);
  const int first = rigids.at(*box.body, btVector3(0, 0, 0)).unknown;
  EXPECT_EQ(rigids.at(*box.body, btVector3(1, 0, 0)).unknown, first);
  EXPECT_EQ(rigids.find(*box.body), first);
  EXPECT_EQ(rigids.find(*other.body), -1);
  const int multi = rigids.at(*chain.colliders[0], btVector3(0, 0, 0)).unknown;
  EXPECT_EQ(rigids.at(chain.last(), btVector3(0, 0, 0)).unknown, multi);
  ASSERT_EQ(rigids.list().size(), 2u);
  EXPECT_EQ(rigids.list()[static_cast<std::size_t>(first)].size, 6);
  EXPECT_EQ(rigids.list()[static_cast<std::size_t>(multi)].size, 6 + 2);
  rigids.clear();
  EXPECT_EQ(rigids.find(*box.body), -1);
  EXPECT_TRUE(rigids.list().empty());
}

TEST(RigidUnknowns, AreNotWhatMovesAsItIsPrescribed) {
  Box still(0), led(0);
  led.body->setCollisionFlags(led.body->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  btCollisionObject object;
  object.setCollisionShape(&still.shape);
  RigidUnknowns rigids;
  for (const btCollisionObject* each :
       std::vector<const btCollisionObject*>{still.body.get(), led.body.get(), &object}) {
    const RigidPoint point = rigids.at(*each, btVector3(1, 2, 3));
    EXPECT_LT(point.unknown, 0);
    EXPECT_EQ(rigids.compliance(point, btVector3(1, 0, 0)), 0.0);
    VectorXd push = VectorXd::Zero(6);
    rigids.addImpulse(point, kImpulse, push);
    EXPECT_TRUE(push.isZero(0.0));
    EXPECT_TRUE(rigids.velocity(point, wave(6)).isZero());
  }
  EXPECT_TRUE(rigids.list().empty());
  EXPECT_TRUE(rigids.velocityAt(rigids.at(object, btVector3(1, 2, 3)), object, kSeconds).isZero());
}

TEST(RigidUnknowns, AreMovedByAnImpulseAsTheyMoveThePoint) {
  Box box, locked;
  locked.body->setLinearFactor(btVector3(1, 0, 1));
  locked.body->setAngularFactor(btVector3(1, 0, 0));
  Chain chain;
  RigidUnknowns rigids;
  std::vector<RigidPoint> points;
  for (const Box* each : {&box, &locked}) points.push_back(rigids.at(*each->body, each->corner()));
  for (const auto& collider : chain.colliders) points.push_back(rigids.at(*collider, chain.corner()));
  const Eigen::Index size = number(rigids);
  ASSERT_EQ(size, 6 + 6 + 8);
  for (const RigidPoint& point : points) {
    expectTransposes(rigids, point, size);
    // The Jacobian, by which a solve finds the stiffness of the unknowns, must move the point as they do.
    const RigidUnknown& unknown = rigids.list()[static_cast<std::size_t>(point.unknown)];
    const RigidUnknowns::Jacobian jacobian = rigids.jacobianOf(point);
    ASSERT_EQ(jacobian.cols(), unknown.size);
    const VectorXd change = wave(size);
    const Vector3d moved = eigen(rigids.velocity(point, change));
    EXPECT_LT((jacobian * change.segment(unknown.first, unknown.size) - moved).norm(), 1e-5 * change.norm());
    if (unknown.rigid) {
      EXPECT_EQ(jacobian, RigidUnknowns::toJacobian(bodyJacobian(point)));
    }
  }
}

TEST(RigidUnknowns, AreToldApartByBodiesNotByLinks) {
  Box box, other;
  Chain chain;
  EXPECT_NE(RigidUnknowns::keyOf(*box.body), RigidUnknowns::keyOf(*other.body));
  EXPECT_EQ(RigidUnknowns::keyOf(*chain.colliders[0]), RigidUnknowns::keyOf(chain.last()));
  EXPECT_NE(RigidUnknowns::keyOf(*box.body), RigidUnknowns::keyOf(chain.last()));
  RigidUnknowns rigids;
  for (const btCollisionObject* each :
       {static_cast<btCollisionObject*>(box.body.get()), static_cast<btCollisionObject*>(&chain.last())}) {
    rigids.at(*each, btVector3(0, 0, 0));
    EXPECT_EQ(RigidUnknowns::keyOf(rigids.list().back()), RigidUnknowns::keyOf(*each));
  }
}

TEST(RigidUnknowns, YieldAsBulletsBodiesDoToAnImpulse) {
  for (const bool locked : {false, true}) {
    Box box;
    if (locked) {
      // The body is aligned with the axes because the factors are along the axes.
      box.moveTo(btTransform(btQuaternion::getIdentity(), btVector3(1, 2, 3)));
      box.body->setLinearFactor(btVector3(1, 1, 0));
      box.body->setAngularFactor(btVector3(0, 0, 1));
    }
    const btVector3 direction = locked ? btVector3(btScalar(0.6), btScalar(-0.8), 0) : btVector3(1, -2, 2) / 3;
    RigidUnknowns rigids;
    const RigidPoint point = rigids.at(*box.body, box.corner());
    const btVector3 before = box.body->getVelocityInLocalPoint(box.arm());
    box.body->applyImpulse(direction, box.arm());
    const btVector3 change = box.body->getVelocityInLocalPoint(box.arm()) - before;
    EXPECT_NEAR(rigids.compliance(point, direction), change.dot(direction), 1e-5) << locked;
    if (locked) {
      EXPECT_EQ(rigids.compliance(point, btVector3(0, 0, 1)), 0.0);
    }
  }
}

TEST(RigidUnknowns, YieldAsBulletsMultibodiesDoToAnImpulse) {
  Chain chain;
  RigidUnknowns rigids;
  const btVector3 direction = btVector3(1, -2, 2) / 3;
  const RigidPoint point = rigids.at(chain.last(), chain.corner());
  ASSERT_EQ(number(rigids), 8);
  // J^T comes from the transpose that another test checks; M^-1 and the velocities are Bullet's.
  VectorXd push = VectorXd::Zero(8);
  rigids.addImpulse(point, direction, push);
  std::array<btScalar, 8> force, answer;
  for (std::size_t k = 0; k < 8; ++k) force[k] = static_cast<btScalar>(push[static_cast<Eigen::Index>(k)]);
  btAlignedObjectArray<btScalar> scratch;
  btAlignedObjectArray<btVector3> vectors;
  chain.body->calcAccelerationDeltasMultiDof(force.data(), answer.data(), scratch, vectors);
  const btVector3 before = rigids.velocityAt(point, chain.last(), kSeconds);
  chain.body->applyDeltaVeeMultiDof(answer.data(), 1);
  const btVector3 change = rigids.velocityAt(point, chain.last(), kSeconds) - before;
  EXPECT_NEAR(rigids.compliance(point, direction), change.dot(direction), 1e-4 * change.length());
  EXPECT_GT(change.dot(direction), 0.3) << "no less than of the whole mass";
}

TEST(RigidUnknowns, OfAMultibodyMoveAPointAsBulletDoes) {
  Chain chain;
  RigidUnknowns rigids;
  for (int link = 0; link < 3; ++link) {
    const auto& collider = *chain.colliders[static_cast<std::size_t>(link)];
    const btVector3 local(btScalar(0.1), btScalar(0.2), btScalar(-0.1));
    const btVector3 where = collider.getWorldTransform() * local;
    const btVector3 velocity = rigids.velocityAt(rigids.at(collider, where), collider, kSeconds);
    Chain later;  // the same chain one step later
    later.world.deformable().stepSimulation(kSeconds, 1, kSeconds);
    const auto& moved = *later.colliders[static_cast<std::size_t>(link)];
    const btVector3 went = (moved.getWorldTransform() * local - where) / kSeconds;
    EXPECT_LT((velocity - went).length(), btScalar(0.03)) << link;
    EXPECT_GT(velocity.length(), 0.1);
  }
}

int bulletsAllocations = 0;

TEST(RigidUnknowns, OfAMultibodyNeedNoMemoryForFurtherPoints) {
  Chain chain;
  RigidUnknowns rigids;
  const RigidPoint point = rigids.at(chain.last(), chain.corner());
  const btVector3 first = rigids.velocityAt(point, chain.last(), kSeconds);
  btAlignedAllocSetCustom([](std::size_t size) { return ++bulletsAllocations, std::malloc(size); }, std::free);
  const std::size_t before = test::allocationCount();
  bulletsAllocations = 0;
  const btVector3 second = rigids.velocityAt(point, chain.last(), kSeconds);
  EXPECT_EQ(test::allocationCount(), before);
  EXPECT_EQ(bulletsAllocations, 0);
  btAlignedAllocSetCustom(nullptr, nullptr);
  EXPECT_EQ(second, first);
}

TEST(RigidUnknowns, ChangeVelocitiesInBullet) {
  Box box;
  Chain chain;
  RigidUnknowns rigids;
  const RigidPoint on = rigids.at(*box.body, box.corner()), link = rigids.at(chain.last(), chain.corner());
  const VectorXd change = wave(number(rigids));
  const btVector3 linear = box.body->getLinearVelocity(), angular = box.body->getAngularVelocity();
  const btVector3 atLink = rigids.velocityAt(link, chain.last(), 0);
  std::vector<double> before(8);
  for (std::size_t k = 0; k < 8; ++k) before[k] = static_cast<double>(chain.body->getVelocityVector()[k]);
  for (const RigidUnknown& unknown : rigids.list()) RigidUnknowns::apply(unknown, change);
  EXPECT_LT((eigen(box.body->getLinearVelocity() - linear) - change.head<3>()).norm(), 1e-6);
  EXPECT_LT((eigen(box.body->getAngularVelocity() - angular) - change.segment<3>(3)).norm(), 1e-6);
  EXPECT_LT((rigids.velocityAt(on, *box.body, 0) - (linear + angular.cross(box.arm())) - rigids.velocity(on, change))
                .length(),
            1e-5);
  for (int k = 0; k < 8; ++k) {
    const double now = static_cast<double>(chain.body->getVelocityVector()[k]);
    EXPECT_NEAR(now - before[static_cast<std::size_t>(k)], change[6 + k], 1e-6) << k;
  }
  const btVector3 changed = rigids.velocityAt(link, chain.last(), 0) - atLink;
  EXPECT_LT((changed - rigids.velocity(link, change)).length(), 1e-5);
}

TEST(RigidUnknowns, StayAsTheyAreWhereTheSolveIsNotFinite) {
  Box box;
  RigidUnknowns rigids;
  rigids.at(*box.body, box.corner());
  VectorXd change = wave(number(rigids));
  change[4] = std::nan("");
  const btVector3 linear = box.body->getLinearVelocity();
  RigidUnknowns::apply(rigids.list().front(), change);
  EXPECT_EQ(box.body->getLinearVelocity(), linear);
}

TEST(RigidUnknowns, OfAJointAreMovedAlongItsRow) {
  Box box;
  RigidUnknowns rigids;
  RigidPoint point = rigids.at(*box.body, box.corner());
  const btVector3 linear(1, 2, 3), angular(-1, 0, 2);
  point.jacobian = rigids.addScalarJacobian(linear, angular);
  const VectorXd change = wave(number(rigids));
  const btVector3 moved = rigids.velocity(point, change);
  EXPECT_NEAR(moved.x(), eigen(linear).dot(change.head<3>()) + eigen(angular).dot(change.tail<3>()), 1e-5);
  EXPECT_EQ(moved.y(), 0);
  EXPECT_EQ(moved.z(), 0);
  expectTransposes(rigids, point, 6);
  const btVector3 turned = box.body->getInvInertiaTensorWorld() * angular;
  EXPECT_NEAR(rigids.compliance(point, btVector3(1, 0, 0)), linear.dot(linear) / 2 + angular.dot(turned), 1e-4);
}

TEST(RigidUnknowns, CarryAPointTheStraightWayToWhereItsTurnEnds) {
  Box box;
  RigidUnknowns rigids;
  const RigidPoint point = rigids.at(*box.body, box.corner());
  const btVector3 turning = box.body->getAngularVelocity();
  for (const btScalar seconds : {btScalar(1) / 240, btScalar(1) / 10}) {
    const btMatrix3x3 turn(btQuaternion(turning.normalized(), turning.length() * seconds));
    const btVector3 expected = box.body->getLinearVelocity() + (turn * box.arm() - box.arm()) / seconds;
    EXPECT_LT((rigids.velocityAt(point, *box.body, seconds) - expected).length(), 2e-4);
  }
  EXPECT_LT((rigids.velocityAt(point, *box.body, 0) - box.body->getVelocityInLocalPoint(box.arm())).length(), 1e-6);
}

/// The body turns so little per step that few digits of the turn's arc cosine are left.
TEST(RigidUnknowns, CarryAPointOfAKinematicBodyByItsPlaces) {
  Box box(0);
  btRigidBody& body = *box.body;
  body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  const auto placeAt = [](int step) {
    const btQuaternion turn(btVector3(0, 1, 0), btScalar(0.3) * kSeconds * static_cast<btScalar>(step));
    return btTransform(turn, btVector3(btScalar(0.5) * kSeconds * static_cast<btScalar>(step), 0, 0));
  };
  const btVector3 arm(btScalar(0.4), btScalar(0.1), btScalar(-2));
  RigidUnknowns rigids;
  const auto velocity = [&] {
    return rigids.velocityAt(rigids.at(body, body.getWorldTransform().getOrigin() + arm), body, kSeconds);
  };
  box.moveTo(placeAt(0));
  double bullets = 0.0;
  for (int step = 1; step <= 20; ++step) {
    rigids.clear();
    body.setWorldTransform(placeAt(step));
    body.saveKinematicState(kSeconds);
    rigids.paths().advance(body, kSeconds);
    const btTransform before = placeAt(step - 1);
    const btVector3 local = before.getBasis().transpose() * arm;
    const btVector3 expected = (placeAt(step) * local - before * local) / kSeconds;
    const double error = static_cast<double>((velocity() - expected).length());
    bullets = std::max(bullets, static_cast<double>((body.getVelocityInLocalPoint(arm) - expected).length()));
    if (step > 1) {
      EXPECT_LT(error, 1e-3) << step;
    }
  }
  if (sizeof(btScalar) == sizeof(float)) {
    EXPECT_GT(bullets, 3e-3) << "Bullet's own";
  }
  // The body is put elsewhere, which does not count as motion.
  rigids.clear();
  body.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 7, 0)));
  rigids.paths().advance(body, kSeconds);
  EXPECT_LT((velocity() - body.getVelocityInLocalPoint(arm)).length(), 0.01);
}

}  // namespace
}  // namespace tetskin
