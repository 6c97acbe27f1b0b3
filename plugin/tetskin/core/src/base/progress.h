// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <chrono>
#include <cstddef>
#include <functional>

namespace tetskin {

/// Thrown by `Progress::goOn`, and caught by the computation that has a Progress.
struct TETSKIN_CORE_API Cancellation {};

/// Reports to an application how much of a long computation is done, and asks whether to continue. If a thread has
/// begun several, only the last one is asked; during the application's callback, none is.
class TETSKIN_CORE_API Progress {
 public:
  /// tell  returns false to cancel; may be empty; must outlive this
  explicit Progress(const std::function<bool(double fraction)>& tell);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Reports the fraction, unless the application has cancelled. Returns false if it has, now or before.
  bool reach(double fraction);
  bool cancelled() const { return cancelled_; }

  /// Call it in round k of a loop in any part of this thread's computation: asks the application a few times per
  /// second. Throws Cancellation if it cancels. Does nothing if no computation has begun.
  static void goOn(std::size_t k) {
    if (k % kRoundsPerClock == 0) goOnWithRound();
  }
  /// The same for rounds that take milliseconds: checks the clock in each.
  static void goOnWithRound();

 private:
  /// Reading the clock takes some tens of nanoseconds.
  static constexpr std::size_t kRoundsPerClock = 64;

  class Pause;
  using Clock = std::chrono::steady_clock;

  const std::function<bool(double)>& tell_;
  double fraction_ = 0.0;  ///< last reported
  Clock::time_point told_ = Clock::now();
  Progress* outer_;  ///< the one during which this one has begun; null: none
  bool cancelled_ = false;
};

inline Status cancelledStatus(const char* what) {
  return {StatusCode::Cancelled, std::string(what) + " was cancelled by its progress function"};
}

}  // namespace tetskin
