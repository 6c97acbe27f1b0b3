// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <ctime>

namespace tetskin::scenes {

/// Processor time of the calling thread since construction. On an idle machine that of a clock; on a busy one, without
/// the time that other programs took.
class CpuTimer {
 public:
  double milliseconds() const { return 1e3 * (now() - start_); }
  double microseconds() const { return 1e6 * (now() - start_); }

 private:
  static double now() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  double start_ = now();
};

}  // namespace tetskin::scenes
