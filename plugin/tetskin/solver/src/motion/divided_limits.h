// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Some limits of joints are impulses per step: those of a hinge's motor, of a multibody's motors and stops, and that at
// which a joint breaks. Where a world divides the application's step, each part has its share of them.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <utility>
#include <vector>

namespace tetskin::bullet_detail {

/// Divides the limits of all joints of a world, as long as it exists. What the application sets meanwhile stays.
class DividedLimits {
 public:
  /// parts  1 or more; of 1, nothing happens
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
  // By joint: a callback may have removed it.
  std::vector<std::pair<const btTypedConstraint*, Limit>> breaking_, motors_;
  std::vector<std::pair<const btMultiBodyConstraint*, Limit>> multibodies_;
};

}  // namespace tetskin::bullet_detail
