// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Snapshots name each of Bullet's members: renamed ones do not compile. If another version of Bullet has more of them,
// sizes reveal it.
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyFixedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <BulletDynamics/Featherstone/btMultiBodySliderConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointLimit.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointMotor.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <btBulletDynamicsCommon.h>

namespace tetskin::test {
namespace {

struct Size {
  const char* name;
  std::size_t now, of324;  ///< in bytes: here, and of Bullet 3.24 in float, for x86-64 by GCC or clang on Linux
};

TEST(BulletsMembers, AreThoseThatSnapshotsKnow) {
#if defined(__x86_64__) && defined(__linux__)
  if (sizeof(btScalar) != sizeof(float)) GTEST_SKIP() << "the sizes are those in float";
  const Size sizes[] = {
      {"btCollisionObject", sizeof(btCollisionObject), 376},
      {"btRigidBody", sizeof(btRigidBody), 744},
      {"btSoftBody", sizeof(btSoftBody), 2064},
      {"btSoftBody::Config", sizeof(btSoftBody::Config), 208},
      {"btSoftBody::Node", sizeof(btSoftBody::Node), 256},
      {"btMultiBody", sizeof(btMultiBody), 640},
      {"btMultibodyLink", sizeof(btMultibodyLink), 688},
      {"btTypedConstraint", sizeof(btTypedConstraint), 72},
      {"btPoint2PointConstraint", sizeof(btPoint2PointConstraint), 384},
      {"btHingeConstraint", sizeof(btHingeConstraint), 792},
      {"btHingeAccumulatedAngleConstraint", sizeof(btHingeAccumulatedAngleConstraint), 800},
      {"btConeTwistConstraint", sizeof(btConeTwistConstraint), 632},
      {"btSliderConstraint", sizeof(btSliderConstraint), 1152},
      {"btGeneric6DofConstraint", sizeof(btGeneric6DofConstraint), 1336},
      {"btGeneric6DofSpringConstraint", sizeof(btGeneric6DofSpringConstraint), 1416},
      {"btGeneric6DofSpring2Constraint", sizeof(btGeneric6DofSpring2Constraint), 1488},
      {"btGearConstraint", sizeof(btGearConstraint), 112},
      {"btMultiBodyConstraint", sizeof(btMultiBodyConstraint), 96},
      {"btMultiBodyJointMotor", sizeof(btMultiBodyJointMotor), 120},
      {"btMultiBodyJointLimitConstraint", sizeof(btMultiBodyJointLimitConstraint), 104},
      {"btMultiBodyFixedConstraint", sizeof(btMultiBodyFixedConstraint), 240},
      {"btMultiBodyPoint2Point", sizeof(btMultiBodyPoint2Point), 144},
      {"btMultiBodySliderConstraint", sizeof(btMultiBodySliderConstraint), 256},
      {"btMultiBodyGearConstraint", sizeof(btMultiBodyGearConstraint), 256},
      {"btMultiBodySphericalJointMotor", sizeof(btMultiBodySphericalJointMotor), 208},
      {"btMultiBodySphericalJointLimit", sizeof(btMultiBodySphericalJointLimit), 232},
      {"btManifoldPoint", sizeof(btManifoldPoint), 208},
      {"btPersistentManifold", sizeof(btPersistentManifold), 880},
      {"btDbvtBroadphase", sizeof(btDbvtBroadphase), 256},
      {"btContactSolverInfoData", sizeof(btContactSolverInfoData), 128},
      {"btDispatcherInfo", sizeof(btDispatcherInfo), 56},
      {"btDeformableMultiBodyDynamicsWorld", sizeof(btDeformableMultiBodyDynamicsWorld), 1056},
  };
  for (const Size& size : sizes) {
    EXPECT_EQ(size.now, size.of324) << size.name
                                    << ": what is new belongs into replay/src/state, unless a step computes it anew";
  }
#else
  GTEST_SKIP() << "the sizes are those on Linux for x86-64";
#endif
}

}  // namespace
}  // namespace tetskin::test
