// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Some limits of joints are impulses per step: those of a hinge's motor, of a multibody's motors and stops, and a
// joint's breaking threshold. When a world divides the application's step, each part gets its share of them.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <utility>
#include <vector>

namespace tetskin::bullet_detail {

/// Divides the limits of all joints of a world, as long as this exists. Limits that the application sets meanwhile
/// stay.
class DividedLimits {
 public:
  /// parts  1 or more; with 1 nothing happens
  DividedLimits(btMultiBodyDynamicsWorld& world, int parts);
  ~DividedLimits();
  DividedLimits(const DividedLimits&) = delete;
  DividedLimits& operator=(const DividedLimits&) = delete;

 private:
  struct Limit {
    btScalar before = 0, divided = 0;
  };
  Limit divide(btScalar limit) const;

  btMultiBodyDynamicsWorld& world_;
  btScalar parts_;
  // By joint, because a callback may have removed it.
  std::vector<std::pair<const btTypedConstraint*, Limit>> breaking_, motors_;
  std::vector<std::pair<const btMultiBodyConstraint*, Limit>> multibodies_;
};

}  // namespace tetskin::bullet_detail
