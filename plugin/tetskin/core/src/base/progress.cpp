// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/progress.h>

#include <cassert>

namespace tetskin {
namespace {

/// Often enough for whoever waits.
constexpr std::chrono::milliseconds kAskedEach{200};

/// That of this thread; null: none.
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

bool Progress::reach(double fraction) {
  if (!cancelled_ && tell_) cancelled_ = !tell_(fraction);
  fraction_ = fraction;
  told_ = Clock::now();
  return !cancelled_;
}

void Progress::goOnWithRound() {
  Progress* const progress = current();
  if (!progress || Clock::now() - progress->told_ < kAskedEach) return;
  if (!progress->reach(progress->fraction_)) throw Cancellation();
}

}  // namespace tetskin
