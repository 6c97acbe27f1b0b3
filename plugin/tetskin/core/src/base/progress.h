// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <chrono>
#include <cstddef>
#include <functional>

namespace tetskin {

/// Thrown by `Progress::goOn`: caught by the computation that has a Progress.
struct TETSKIN_CORE_API Cancellation {};

/// Tells an application how much of a long computation is done, and learns whether to go on. Of several in a
/// thread, the last one begun is asked; while it is, none of them is.
class TETSKIN_CORE_API Progress {
 public:
  /// tell  returns false to cancel; may be empty; must outlive this
  explicit Progress(const std::function<bool(double fraction)>& tell);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Tells the fraction, unless the application has cancelled. Returns false if it has, now or before.
  bool reach(double fraction);
  bool cancelled() const { return cancelled_; }

  /// For whatever takes part in the computation of this thread, in round k of a loop: asks the application, some times
  /// in a second. Throws Cancellation if it cancels. Where no computation has begun, nothing happens.
  static void goOn(std::size_t k) {
    if (k % kRoundsPerClock == 0) goOnWithRound();
  }
  /// The same for rounds of milliseconds: each looks at the clock.
  static void goOnWithRound();

 private:
  /// Reading the clock takes some tens of nanoseconds.
  static constexpr std::size_t kRoundsPerClock = 64;

  class Pause;
  using Clock = std::chrono::steady_clock;

  const std::function<bool(double)>& tell_;
  double fraction_ = 0.0;  ///< told last
  Clock::time_point told_ = Clock::now();
  Progress* outer_;  ///< in whose midst this one has begun; null: none
  bool cancelled_ = false;
};

/// The status of a computation that was cancelled.
inline Status cancelledStatus(const char* what) {
  return {StatusCode::Cancelled, std::string(what) + " was cancelled by its progress function"};
}

}  // namespace tetskin
