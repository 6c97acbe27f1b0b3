// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <btBulletDynamicsCommon.h>

#include <functional>
#include <utility>

namespace tetskin::scenes {

/// Performs an action once, at the end of the next step, when Bullet runs its actions.
class Once : public btActionInterface {
 public:
  explicit Once(btDiscreteDynamicsWorld& world) { world.addAction(this); }
  void atTheNextStep(std::function<void()> what) { what_ = std::move(what); }
  void updateAction(btCollisionWorld*, btScalar) override {
    if (what_) std::exchange(what_, nullptr)();
  }
  void debugDraw(btIDebugDraw*) override {}

 private:
  std::function<void()> what_;
};

}  // namespace tetskin::scenes
