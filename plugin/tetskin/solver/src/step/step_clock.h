// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: how long the stages of its steps take. Only read at the ends of stages, some ten times
// per step.
#pragma once

#include <tetskin/solver/deformable_world.h>

#include <chrono>

namespace tetskin::bullet_detail {

class StepClock {
 public:
  /// Restarts the clock: the time since the last stage belongs to no stage.
  void restart() { last_ = std::chrono::steady_clock::now(); }
  /// Adds the time since the last call to a stage.
  void end(double StepTimes::*stage) {
    const auto now = std::chrono::steady_clock::now();
    times_.*stage += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  const StepTimes& times() const { return times_; }

 private:
  StepTimes times_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace tetskin::bullet_detail
