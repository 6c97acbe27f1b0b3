// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/progress.h>

#include <cassert>
#include <utility>

namespace tetskin {
namespace {

/// Often enough for someone who waits.
constexpr std::chrono::milliseconds kAskedEach{200};

/// This thread's current progress, or null.
Progress*& current() {
  thread_local Progress* progress = nullptr;
  return progress;
}

}  // namespace

Progress::Progress(const std::function<bool(double)>& tell) : tell_(tell), outer_(current()) {
  current() = this;
}

Progress::~Progress() {
  assert(current() == this);
  current() = outer_;
}

/// What an application computes in its callback is not part of the progress: otherwise it would report endlessly, and
/// cancel the wrong computation.
class Progress::Pause {
 public:
  Pause() : before_(std::exchange(current(), nullptr)) {}
  ~Pause() { current() = before_; }
  Pause(const Pause&) = delete;
  Pause& operator=(const Pause&) = delete;

 private:
  Progress* const before_;
};

bool Progress::reach(double fraction) {
  fraction_ = fraction;
  if (!cancelled_ && tell_) {
    const Pause pause;
    cancelled_ = !tell_(fraction);
  }
  told_ = Clock::now();
  return !cancelled_;
}

void Progress::goOnWithRound() {
  Progress* const progress = current();
  if (!progress || Clock::now() - progress->told_ < kAskedEach) return;
  if (!progress->reach(progress->fraction_)) throw Cancellation();
}

}  // namespace tetskin
