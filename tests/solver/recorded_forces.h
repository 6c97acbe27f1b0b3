// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A record of a world's forces, and the expectations on it.
#pragma once

#include "deformable_test.h"

#include <tetskin/solver/deformable_world.h>

#include <gtest/gtest.h>

#include <memory>
#include <utility>

namespace tetskin::test {

/// The weight of a body of 1 kg, as the tests' bodies are: the tests' gravity is 10.
constexpr double kWeight = 10.0;

inline std::unique_ptr<ForceRecord> forcesIn(EmptyWorld& world) {
  Result<std::unique_ptr<ForceRecord>> made = ForceRecord::add(world.deformable());
  EXPECT_TRUE(made.ok()) << made.status().message;
  return std::move(made).value();
}

inline btCollisionObject& floorOf(EmptyWorld& world) {
  return *world.world->getCollisionObjectArray()[0];
}

inline void expectNear(const btVector3& is, const btVector3& shall, double tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(is[k], shall[k], tolerance) << "along axis " << k;
}

inline bool isNothing(const AppliedForces& forces) {
  for (const Wrench& wrench : {forces.contact, forces.friction, forces.joints, forces.anchors}) {
    if (!wrench.force.isZero() || !wrench.torque.isZero()) return false;
  }
  return true;
}

/// Bullet's contactTest requires a callback, even where its results are not used.
struct IgnoredResults : btCollisionWorld::ContactResultCallback {
  btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int, const btCollisionObjectWrapper*,
                           int, int) override {
    return 0;
  }
};

}  // namespace tetskin::test
