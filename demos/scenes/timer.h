// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <ctime>

namespace tetskin::scenes {

/// Time since construction, measured by one of the system's clocks.
template <clockid_t clock>
class Timer {
 public:
  double seconds() const { return now() - start_; }
  double milliseconds() const { return 1e3 * seconds(); }
  double microseconds() const { return 1e6 * seconds(); }

 private:
  static double now() {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  double start_ = now();
};

using WallTimer = Timer<CLOCK_MONOTONIC>;
/// Processor time of the calling thread. On an idle machine it equals the elapsed time; on a busy one it excludes the
/// time that other programs took.
using CpuTimer = Timer<CLOCK_THREAD_CPUTIME_ID>;
/// Processor time of all threads together.
using ProcessTimer = Timer<CLOCK_PROCESS_CPUTIME_ID>;

}  // namespace tetskin::scenes
